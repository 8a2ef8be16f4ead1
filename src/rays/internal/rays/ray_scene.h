#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Triangles in Embree, to be met by rays. Single precision: keep the mesh near its origin.
class RayScene {
  public:
    /// How much time the search tree is worth.
    enum class Build { kQuick, kBest };
    /// Copies what it needs. Throws InputError if Embree does not start or the memory is too small.
    explicit RayScene(const TriangleMesh& mesh);
    /// Several meshes; one without triangles is never met.
    RayScene(std::span<const TriangleMesh> meshes, Build build);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    struct Hit {
        float distance = -1.0F;  ///< mm for a unit direction; negative: none
        bool leaving = false;    ///< the ray leaves material here
        float cosine = 0.0F;     ///< between the direction and the triangle's line of normals, >= 0
        std::uint32_t triangle = 0;
        std::uint32_t mesh = 0;
        Vec3f normal = Vec3f::Zero();  ///< of the triangle, of any length
        float u = 0.0F, v = 0.0F;      ///< weights of the triangle's second and third vertex
    };
    /// The first triangle between `near` and `far` mm along the ray. Safe from many threads.
    Hit first(const Vec3f& origin, const Vec3f& direction, float near, float far) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace beltgrinding
