#pragma once

// Private to this room: whether anything stands between a point and a camera far away.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Triangles under a tree of boxes with eight branches, laid out along a Morton curve: built in a
/// fraction of the time that Embree's tree takes, which few lines of sight would not earn back.
class SightLines {
  public:
    struct Mesh {
        std::span<const Vec3> vertices;  ///< mm; what is given must outlive this
        std::span<const Triangle> triangles;
    };
    /// `extents`: of all vertices.
    SightLines(std::vector<Mesh> meshes, const Box& extents);

    /// A direction, unit vector, made ready for many lines.
    class Way {
      public:
        explicit Way(const Vec3& direction);

      private:
        friend class SightLines;
        Vec3 direction_;
        Vec3f inverse_;
        std::array<bool, 3> negative_;
    };
    /// Whether a triangle is met farther than `near` mm from `point`. Safe from many threads.
    bool hidden(const Vec3& point, const Way& way, double near) const;

  private:
    static constexpr std::size_t kBranches = 8;
    struct Node {  ///< the boxes of its branches; empty ones are never met
        std::array<std::array<float, kBranches>, 3> low, high;
    };
    struct Item {
        std::uint32_t key, triangle;  ///< place on the Morton curve; number through all meshes
    };
    std::vector<Item> along_curve(const Box& extents) const;
    void build_leaves(const std::vector<Item>& items, float pad);
    bool met(std::uint32_t triangle, const Vec3& point, const Way& way, double near) const;

    std::vector<Mesh> meshes_;
    std::vector<std::uint32_t> first_;       // triangle of each mesh, and the end
    std::vector<std::uint32_t> order_;       // triangles along the curve, eight a leaf
    std::vector<std::vector<Node>> levels_;  // from the root; the last level's branches are leaves
    Vec3 origin_;                            // of the boxes' single precision
};

}  // namespace beltgrinding
