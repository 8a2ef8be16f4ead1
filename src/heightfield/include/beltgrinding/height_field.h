#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/packed_triangles.h"

namespace beltgrinding {

/// Bits of `HeightField::flags`.
enum SampleFlag : std::uint8_t {
    kOnBoundary = 1,  ///< lies on a trimming edge of its face
    kMissed = 2,      ///< the normal ray met no stock within the search distance; height is 0
    kDefective = 4,   ///< the stock lies below the design surface here
    kDegenerate = 8,  ///< the surface has no normal here (pole); a neighbouring one is used
};

/// Which motions removed from each sample. A *motion* is that to a programmed pose, numbered from 0
/// through all programs of a job in order: the pose's number plus those of the programs before.
/// All arrays have one value per sample, or are empty: then nothing is known.
struct RemovalTrace {
    static constexpr std::uint32_t kNever = 0xFFFFFFFF;  ///< no motion removed from the sample

    std::vector<std::uint32_t> first;     ///< motion that removed first, or kNever
    std::vector<std::uint32_t> last;      ///< motion that removed last, or kNever
    std::vector<std::uint32_t> dominant;  ///< motion that removed most (the first such), or kNever
    std::vector<float> dominant_depth;    ///< mm along the normal that the dominant one removed
    std::vector<float> peak_pressure;     ///< MPa, largest that the sample saw; 0: none

    /// Nothing is known.
    bool empty() const { return first.empty(); }
    /// Makes room for n samples that nothing has touched yet.
    void reset(std::size_t n);
    /// Forgets all.
    void clear() { *this = {}; }
    /// Whether the wheel ever touched sample i, even without removing anything.
    bool touched(std::size_t i) const { return peak_pressure[i] > 0.0F || first[i] != kNever; }
    /// Bytes held by all arrays.
    std::size_t bytes() const;
};

/// How hot each sample became. Both arrays have one value per sample, or are empty: not computed.
struct HeatTrace {
    static constexpr std::uint32_t kNever = 0xFFFFFFFF;  ///< heat never came there

    std::vector<float> rise;  ///< K, greatest rise of temperature above the start's
    std::vector<std::uint32_t>
        motion;  ///< numbered as in a RemovalTrace, at that moment; or kNever

    /// Nothing is known.
    bool empty() const { return rise.empty(); }
    /// Forgets all.
    void clear() { *this = {}; }
};

/// What finish the passes over each sample have left. All arrays have one value per sample, or are
/// empty: not computed.
struct FinishTrace {
    static constexpr std::uint32_t kNever = 0xFFFFFFFF;  ///< no pass of this run
    static constexpr float kMostUnknown = 0.05F;         ///< of `unknown`, up to which Ra is known
    /// What the last pass had that no measurement had; what is told first of several.
    enum Outside : std::uint8_t {
        kInside,     ///< nothing
        kPressure,   ///< its mean pressure
        kBeltSpeed,  ///< the belt's speed
        kFeed,       ///< the feed
        kBeltWear    ///< what remains of the belt's cut
    };

    std::vector<float> settled;   ///< um: shares of the passes' own Ra, added up; see `roughness`
    std::vector<float> unknown;   ///< share of Ra that is from what is not known, [0, 1]
    std::vector<Vec3f> lay;       ///< unit, in the tangent plane, work frame: where the last pass
                                  ///< scratched along; 0: no pass
    std::vector<float> crossing;  ///< rad, [0, pi/2], between the last two passes' lays; NaN: none
    std::vector<std::uint32_t> passes;  ///< counted
    std::vector<std::uint32_t> motion;  ///< of the last pass, numbered as in a RemovalTrace;
                                        ///< kNever: no pass, or an earlier run's
    std::vector<std::uint8_t> outside;  ///< an Outside

    /// Nothing is known.
    bool empty() const { return settled.empty(); }
    /// um, Ra of sample i; NaN where it is not known.
    float roughness(std::size_t i) const;
    /// Forgets all.
    void clear() { *this = {}; }
    /// Bytes held by all arrays.
    std::size_t bytes() const;
};

/// The discrete height field: samples of the design surface, each with the segment of its normal
/// ray that is still material, as a structure of arrays. Frame: work (the part's own). Lengths in
/// mm.
///
/// `height` is signed along `ray` from `point`: + is excess stock, - is a gouge. It only ever
/// decreases during a simulation. The segment of sample i reaches from `-depth` to `height[i]`.
///
/// Rays are the normals, but for samples beside sharp convex edges between faces of the field:
/// there they lean towards the edge's bisector, which is their direction on the edge itself, and
/// are longer than 1, so that heights are still measured square to the design surface
/// (`lean_at_edges`).
///
/// Ren, Kuhlenkoetter, Mueller: Simulation and verification of belt grinding with industrial robots
/// (Int. J. Machine Tools & Manufacture 46, 2006), section 2.
struct HeightField {
    std::vector<Vec3> point;          ///< on the design surface, mm
    std::vector<Vec3f> normal;        ///< unit, out of the solid
    std::vector<float> area;          ///< design area that the sample stands for, mm2
    std::vector<float> stock_height;  ///< height before grinding, mm
    std::vector<double> height;       ///< current height, mm (double: it sums many tiny removals)
    std::vector<std::uint32_t> face;  ///< index of the sample's face in the shape, from 0
    std::vector<std::uint8_t> flags;  ///< bits of SampleFlag
    std::vector<Vec3f> rays;          ///< as `ray`; empty: all are the normals
    std::vector<float> height_sd;     ///< standard deviation of `height`, mm; empty: not known
    std::vector<float> height_error;  ///< mm that the contact's cells leave open; empty: not known
    std::vector<float> measured;      ///< height of a scan, mm; NaN where it has none; empty: none
    RemovalTrace trace;               ///< what the simulation did where; empty: not known
    HeatTrace heat;                   ///< how hot it became where; empty: not computed
    FinishTrace finish;               ///< what finish the passes left; empty: not computed
    PackedTriangles triangles;        ///< between samples, for display; never across faces
    double spacing = 0.0;             ///< nominal distance between neighbouring samples, mm
    double depth = 1.0;               ///< how far below the design surface a segment begins, mm
    /// Degrees of freedom of Student's t whose scales `height_sd` are; infinite: they are normal.
    double sd_freedom = std::numeric_limits<double>::infinity();

    /// Number of samples.
    std::size_t size() const { return point.size(); }
    /// Direction of segment i, outwards, of length 1 / cosine of its angle to the normal.
    const Vec3f& ray(std::size_t i) const { return rays.empty() ? normal[i] : rays[i]; }
    /// Whether the ray of sample i is not its normal.
    bool leans(std::size_t i) const { return !rays.empty() && rays[i] != normal[i]; }
    /// Current top of segment i, mm, work frame.
    Vec3 top(std::size_t i) const { return point[i] + height[i] * ray(i).cast<double>(); }
    /// Where segment i begins, mm, work frame.
    Vec3 bottom(std::size_t i) const { return point[i] - depth * ray(i).cast<double>(); }
    /// Makes room for n samples: heights, flags and areas 0.
    void resize(std::size_t n);
    /// Throws InputError that names the first array that is wrong: of another length than `point`,
    /// with a value that is not finite, a normal that is not of length 1, a triangle without its
    /// sample. Every function of the library that takes a field calls it.
    void validate() const;
    /// Bytes held by all arrays.
    std::size_t bytes() const;
};

/// Writes all arrays and `attributes` (a JSON text, may be empty) to an HDF5 file, atomically: a
/// failed write leaves an older file of that name as it was. Throws InputError naming the path, and
/// std::logic_error for a field that `validate` refuses, as do the next two.
void write_hdf5(const HeightField& field, const std::string& path, const std::string& attributes);

/// The same bytes to an open, empty file, by its descriptor: as they are made, so that they take no
/// memory to speak of. Returns why the file did not take them all; what is there then is no field.
/// Throws InputError when memory does not suffice.
std::error_code write_hdf5(const HeightField& field, int file, const std::string& attributes);

/// The same bytes. Throws InputError when memory does not suffice.
std::string hdf5_image(const HeightField& field, const std::string& attributes);

/// Reads what `write_hdf5` wrote; `attributes` may be null. Throws InputError naming the path, for
/// any file that is not a sound height field (wrong lengths, indices out of range, no HDF5, a
/// checksum that does not fit, data that lie in another file).
HeightField read_hdf5(const std::string& path, std::string* attributes = nullptr);

/// As `read_hdf5`, from a file's bytes; `name` is told in errors.
HeightField read_hdf5_image(std::string_view image, const std::string& name,
                            std::string* attributes = nullptr);

}  // namespace beltgrinding
