#pragma once

// The height of a field between its samples.

#include <cstdint>
#include <optional>
#include <vector>

#include "beltgrinding/height_field.h"

namespace beltgrinding {

/// Finds the triangle of samples of a face that is nearest to a point. Immutable after
/// construction; safe to read from many threads.
class HeightLookup {
  public:
    explicit HeightLookup(const HeightField& field);

    struct Place {
        Triangle samples{};
        Vec3 weight = Vec3::Zero();  ///< barycentric coordinates of the nearest point
        double distance = 0.0;       ///< mm, from it
    };
    /// None where the face has no samples within a few spacings.
    std::optional<Place> find(std::uint32_t face, const Vec3& point) const;

    /// The height there, linear between the samples that met stock; none where all missed it.
    std::optional<double> height(const Place& place) const;

    /// What rays have there beside the normal, mm aside for each mm of height.
    Vec3 lean(const Place& place) const;

  private:
    using Cell = std::uint64_t;
    struct Entry {
        std::uint32_t face;
        Cell cell;
        std::uint32_t triangle;
    };
    Cell cell_of(const Eigen::Vector3i& c) const;
    Eigen::Vector3i coordinates(const Vec3& p) const;
    void search(std::uint32_t face, const Eigen::Vector3i& c, const Vec3& point,
                std::optional<Place>& best) const;

    const HeightField& field_;
    std::vector<Entry> entries_;  ///< sorted
    Vec3 origin_ = Vec3::Zero();
    double size_ = 1.0;  ///< mm, of a cell
};

/// Barycentric coordinates of the point of triangle a, b, c that is nearest to p (Ericson,
/// Real-Time Collision Detection, 2005, section 5.1.5).
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace beltgrinding
