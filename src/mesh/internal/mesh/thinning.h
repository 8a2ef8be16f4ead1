#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Some of many samples, and which of them stands for each.
struct ThinnedSamples {
    std::vector<std::uint32_t> chosen;  ///< numbers of samples, ascending
    std::vector<std::uint32_t> place;   ///< of each sample: where in `chosen` the one for it is
};

/// At most about `most` samples, each as it is. Space is cut into cubes, which become
/// larger until they hold few enough; of the samples in a cube that belong to one group and face
/// the same way, the one nearest to their middle stays, or the first one of `keep`. Points mm,
/// normals unit vectors, a group a sample.
ThinnedSamples thinned(std::span<const Vec3> points, std::span<const Vec3f> normals,
                       std::span<const std::uint32_t> groups, std::size_t most,
                       std::span<const std::uint32_t> keep);

/// Triangles between the places of their corners, in order, without those of which two corners are
/// one.
std::vector<Triangle> replaced(std::span<const Triangle> triangles,
                               std::span<const std::uint32_t> place);

}  // namespace beltgrinding
