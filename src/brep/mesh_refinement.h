#pragma once

// Private to this room: a conforming triangulation of a shape's faces, and its refinement.

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <cstdint>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

constexpr std::uint32_t kNone = 0xffffffffU;

/// The mesh while it is made. A vertex is a place; a node is a vertex as one face sees it, with the
/// face's parameters (two nodes of a face share a vertex on a seam). A segment is a piece of an
/// edge of the shape; a side is a side of triangles in one face, along a segment on the border.
struct FaceMesh {
    struct Node {
        std::uint32_t vertex = kNone;
        std::uint32_t face = 0;
        double u = 0, v = 0;
        bool any_u = false, any_v = false;  ///< at a pole: holds for every u (or v)
    };
    struct Segment {
        std::uint32_t edge = kNone;
        std::uint32_t from = kNone, to = kNone;  ///< vertices, at t0 and t1
        double t0 = 0, t1 = 0;
        std::uint32_t middle = kNone, first = kNone;  ///< first, first + 1: its halves
    };
    struct Side {
        std::uint32_t from = kNone, to = kNone;  ///< nodes; along the segment's direction
        std::uint32_t segment = kNone, coedge = kNone;
        std::uint32_t middle = kNone, first = kNone;
    };
    struct Corners {
        std::array<std::uint32_t, 3> node;
        std::array<std::uint32_t, 3> side;  ///< side[k] joins node[k] and node[k + 1]
    };
    struct Coedge {
        std::uint32_t face = 0;
        Handle(Geom2d_Curve) curve;  ///< null: unusable, the mean of the parameters is taken
    };

    std::vector<Vec3> vertices;
    std::vector<Node> nodes;
    std::vector<Segment> segments;
    std::vector<Side> sides;
    std::vector<Corners> triangles;
    std::vector<Coedge> coedges;
    std::vector<Handle(Geom_Curve)> curves;      ///< of each edge; null: a chord
    std::vector<Handle(Geom_Surface)> surfaces;  ///< of each face
    std::size_t on_chords = 0;                   ///< vertices that no curve or surface could place
};

/// Halves, with the triangles beside it, each side on a face with `fine[face]` that is longer than
/// `longest` mm, and each of several that join the same two vertices, until none is left.
void refine(FaceMesh& mesh, const std::vector<char>& fine, double longest,
            const RunContext& context);

}  // namespace beltgrinding
