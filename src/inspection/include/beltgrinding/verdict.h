#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beltgrinding/deviation.h"
#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// A part of the surface with a tolerance of its own: a profile tolerance of a surface (ISO 1101,
/// ASME Y14.5), bilateral, unequal or, with 0 on one side, unilateral.
struct ToleranceZone {
    Tolerance tolerance;                 ///< of the deviation, mm
    std::vector<std::uint32_t> faces;    ///< index in the shape, from 0; empty: all
    double edge_radius = 0.0;            ///< mm; 0: the whole faces, else their edges only (below)
    std::optional<Tolerance> thickness;  ///< of the deviation of the thickness, mm
};

/// The place that lies farthest beyond its limit or, where all is good, nearest to it.
struct WorstPoint {
    std::uint32_t sample = 0;  ///< where it is
    double value = 0.0;        ///< deviation, mm
    double limit = 0.0;        ///< mm, the one that it lies beyond or next to
    double beyond = 0.0;       ///< mm beyond the limit; negative: what is left to it
};

/// What is to be said of a part of the surface. Every sample is judged by its own zone's band.
/// Areas mm2, volumes mm3, deviations mm. A missed sample has an area but no deviation.
struct RegionVerdict {
    std::uint32_t region = 0;         ///< face, from 0; or number of the zone
    std::size_t samples = 0;          ///< all
    std::size_t missed = 0;           ///< whose rays met no stock
    std::size_t defective = 0;        ///< whose stock lay below the design
    double area = 0;                  ///< of all samples
    double missed_area = 0;           ///< of the missed ones
    double above_area = 0;            ///< with too much left
    double below_area = 0;            ///< cut too deep
    double untouched_area = 0;        ///< the wheel was never there; only with a removal trace
    double stock_volume = 0;          ///< above the design before grinding
    double removed_volume = 0;        ///< ground away
    double excess_volume = 0;         ///< above the design now
    double gouge_volume = 0;          ///< missing below the design now
    double min = 0;                   ///< smallest deviation
    double max = 0;                   ///< largest
    double mean = 0;                  ///< by area
    double rms = 0;                   ///< root of the mean square, by area
    std::optional<WorstPoint> worst;  ///< none: no sample has a deviation

    /// Something was inspected, and nothing lies beyond its limit.
    bool passed() const { return worst && above_area == 0.0 && below_area == 0.0; }
};

/// A motion's part in a cluster.
struct MotionShare {
    std::uint32_t motion = 0;  ///< its number, as in `RemovalTrace`
    double share = 0;          ///< of the cluster's area
    double depth = 0;          ///< mm, most that it removed from a sample as the dominant motion
};

/// Connected area out of tolerance, all above or all below.
struct Cluster {
    bool above = false;                ///< too much is left; else cut too deep
    std::size_t samples = 0;           ///< how many
    double area = 0;                   ///< mm2
    double volume = 0;                 ///< mm3 beyond the limits, along the normals
    WorstPoint worst;                  ///< the farthest beyond
    Vec3 centroid = Vec3::Zero();      ///< by area, mm
    Box box;                           ///< mm, work frame
    double extent = 0;                 ///< mm along its longest principal axis
    double width = 0;                  ///< mm along the second one
    std::vector<std::uint32_t> faces;  ///< from 0, ascending
    std::vector<std::uint32_t> zones;  ///< ascending
    double untouched_area = 0;         ///< mm2
    /// Largest share first. Below: by the dominant motion of each sample, which made the gouge.
    /// Above: every motion that removed there first, last or most; the shares may add up to more
    /// than 1.
    std::vector<MotionShare> motions;
};

/// What is to be said of the whole surface and its parts.
struct Verdict {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;  ///< in no cluster

    RegionVerdict whole;                 ///< the whole surface
    std::vector<RegionVerdict> faces;    ///< ascending by face
    std::vector<RegionVerdict> zones;    ///< as given, and the rest at the end
    std::vector<Cluster> clusters;       ///< largest area first
    std::vector<std::uint32_t> zone;     ///< of every sample
    std::vector<std::uint32_t> cluster;  ///< of every sample, or kNone
};

/// Judges the deviations of all samples by the zones' bands, and by `rest` where no zone is; finds
/// the clusters: samples on the same side that the triangles join, over borders of faces by
/// nearness. Linear in the samples but for the clusters' order. Throws InputError for a bad zone.
Verdict judge(const HeightField& field, const std::vector<ToleranceZone>& zones,
              const Tolerance& rest);

}  // namespace beltgrinding
