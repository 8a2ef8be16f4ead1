#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace beltgrinding {

using Vec3 = Eigen::Vector3d;   ///< mm, or a unit vector
using Vec3f = Eigen::Vector3f;  ///< mm, or a unit vector, where single precision is enough
using Frame =
    Eigen::Isometry3d;  ///< a rigid transform, named `a_from_b`: maps b's coordinates to a's
using Box = Eigen::AlignedBox3d;  ///< mm

/// Three indices of vertices or samples, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A bare triangle mesh in millimetres.
struct TriangleMesh {
    std::vector<Vec3f> vertices;      ///< mm
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
};

}  // namespace beltgrinding
