#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// One uninterrupted polyline of a section, on one face; one value per point. It runs along
/// `plane normal x surface normal`: counter-clockwise round the part, seen from where the plane's
/// normal points to.
struct SectionPiece {
    std::uint32_t face = 0;            ///< index in the shape, from 0
    bool closed = false;               ///< its last point is its first
    std::vector<double> arc_length;    ///< mm along the whole section, gaps between pieces included
    std::vector<Vec3> point;           ///< on the triangulated design surface, mm, work frame
    std::vector<Vec3> normal;          ///< unit, of the design surface
    std::vector<Vec3> ray;             ///< as `HeightField::ray`: heights are measured along it
    std::vector<double> stock_height;  ///< before grinding, mm; NaN where a sample missed the stock
    std::vector<double> height;        ///< deviation, mm; NaN where a sample missed the stock
    std::vector<double> height_sd;     ///< its standard deviation, mm; empty: not known
};

/// What a plane cuts out of a height field.
struct Section {
    Vec3 origin = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();       ///< unit, of the plane
    std::vector<SectionPiece> pieces;  ///< one after the other, each next to where the last ended
};

/// The section of the field's triangles (marching triangles; values are linear along the edges) by
/// the plane through `origin` (mm) with `normal` (any length). A chord's sagitta of about
/// spacing^2 / (8 R) is all that the points are off the true surface. Time is linear in the samples
/// and quadratic in the pieces. Throws InputError when the plane misses the samples, is no plane,
/// or the field has no triangles.
Section section_by_plane(const HeightField& field, const Vec3& origin, const Vec3& normal);

/// A field that is cut many times: boxes round neighbouring samples and triangles tell what a plane
/// cannot meet. Its sections are those of `section_by_plane`, to the bit. Safe from many threads.
class SectionIndex {
  public:
    /// The field must outlive it.
    explicit SectionIndex(const HeightField& field);
    /// As the function of that name.
    Section section_by_plane(const Vec3& origin, const Vec3& normal) const;
    /// The samples within `reach` mm of the plane, ascending. `normal`: unit vector.
    std::vector<std::uint32_t> near_plane(const Vec3& origin, const Vec3& normal,
                                          double reach) const;

  private:
    const HeightField& field_;
    std::vector<Box> samples_, triangles_;  // round so many, one after the other
};

/// The line on the surface from `from` to `to` (mm; the nearest places of the section are taken):
/// the section by the plane through both that holds the mean of the normals of their nearest
/// samples, cut off at both ends. On a plane, on a sphere, and along or around a cylinder that is
/// the geodesic. Throws InputError as above, and when the points coincide or lie one above the
/// other.
Section section_between(const HeightField& field, const Vec3& from, const Vec3& to);

}  // namespace beltgrinding
