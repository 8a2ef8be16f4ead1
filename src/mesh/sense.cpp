#include "mesh/sense.h"

#include <algorithm>
#include <array>
#include <utility>

#include "mesh/topology.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kMostBoxes = 64;  // of the largest pieces: what lies in a smaller one stays
constexpr double kNoVolume = 1e-9;      // of the cube over the piece's diagonal

/// One triangle's use of an edge.
struct Use {
    std::uint64_t edge;
    std::uint32_t corner;
    bool forward;
};

/// Triangles that hang together by their edges.
struct Piece {
    Box box;
    double volume = 0;
    bool closed = true;  ///< each edge has two triangles that run round alike
};

/// For each vertex one that stands for all in its place.
std::vector<std::uint32_t> places(const std::vector<Vec3>& vertices) {
    const bool finite =
        std::all_of(vertices.begin(), vertices.end(), [](const Vec3& v) { return v.allFinite(); });
    std::vector<std::array<double, 3>> keys;
    if (!finite) return {};
    keys.reserve(vertices.size());
    for (const Vec3& v : vertices) keys.push_back({v.x(), v.y(), v.z()});
    return weld(keys);
}

bool within(const Box& inner, const Box& outer) {
    return outer.contains(inner) && inner.diagonal().norm() < outer.diagonal().norm();
}

}  // namespace

std::size_t turn_outward(const std::vector<Vec3>& vertices, std::vector<Triangle>& triangles) {
    const std::vector<std::uint32_t> place = places(vertices);
    if (place.empty() || triangles.empty()) return 0;
    std::vector<Use> uses;
    uses.reserve(3 * triangles.size());
    DisjointSets joined(vertices.size());
    for (const Triangle& v : triangles) {
        const std::array corners{place[v[0]], place[v[1]], place[v[2]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2])
            continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
            uses.push_back({edge_key(a, b), a, a < b});
            joined.join(a, b);
        }
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.edge < b.edge; });
    // Pieces that only touch in a corner are one: a mesh that is so is one in the file as well.
    std::vector<Piece> pieces(vertices.size());
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t j = i;
        for (; j < uses.size() && uses[j].edge == uses[i].edge; ++j) {
        }
        if (j - i != 2 || uses[i].forward == uses[i + 1].forward)
            pieces[joined.find(uses[i].corner)].closed = false;
        i = j;
    }
    const Vec3 origin = vertices.front();  // far from zero the sums would lose digits
    std::vector<std::uint32_t> of(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        of[t] = joined.find(place[triangles[t][0]]);
        Piece& piece = pieces[of[t]];
        std::array<Vec3, 3> at;
        for (std::size_t k = 0; k < 3; ++k) {
            at[k] = vertices[triangles[t][k]] - origin;
            piece.box.extend(at[k]);
        }
        piece.volume += at[0].dot(at[1].cross(at[2])) / 6.0;
    }
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
        if (!pieces[i].box.isEmpty()) found.push_back(i);
    std::stable_sort(found.begin(), found.end(), [&](std::uint32_t a, std::uint32_t b) {
        return pieces[a].box.diagonal().norm() > pieces[b].box.diagonal().norm();
    });
    std::vector<char> turned(vertices.size(), 0);
    std::size_t count = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const Piece& piece = pieces[found[k]];
        if (!piece.closed) continue;
        const double size = piece.box.diagonal().norm();
        const auto last = found.begin() + static_cast<std::ptrdiff_t>(std::min(k, kMostBoxes));
        const auto outer = std::find_if(found.begin(), last, [&](std::uint32_t other) {
            return within(piece.box, pieces[other].box);
        });
        const bool inside_out = piece.volume < -kNoVolume * size * size * size;
        turned[found[k]] = outer == last ? inside_out : turned[*outer];
        count += turned[found[k]] != 0;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (turned[of[t]]) std::swap(triangles[t][1], triangles[t][2]);
    return count;
}

}  // namespace beltgrinding
