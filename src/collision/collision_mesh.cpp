#include "collision/collision_mesh.h"

#include <cassert>  // FCL's headers use it without including it

// The one file with FCL.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "beltgrinding/error.h"
#include "mesh/topology.h"

namespace beltgrinding {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

// Triangles of one tree: its build, which cannot be cancelled, takes less than 0.1 s.
constexpr std::size_t kChunk = 20'000;
// mm; FCL stops when both the relative and the absolute error are small enough: only the first
// counts.
constexpr double kAnyError = 1e12;
constexpr double kSame = 1e-5;              // of a body's size: vertices no further apart are one
constexpr double kSolidAngle = 4.0 * M_PI;  // of all directions

struct Chunk {
    std::shared_ptr<Model> model;
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;  // of a sphere around all
};

Chunk make_chunk(const TriangleMesh& mesh, std::size_t begin, std::size_t end) {
    Chunk chunk;
    chunk.model = std::make_shared<Model>();
    chunk.model->beginModel(static_cast<int>(end - begin), static_cast<int>(3 * (end - begin)));
    Box box;
    for (std::size_t t = begin; t < end; ++t) {
        const Triangle& triangle = mesh.triangles[t];
        std::array<Vec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = mesh.vertices[triangle[k]].cast<double>();
            box.extend(corner[k]);
        }
        chunk.model->addTriangle(corner[0], corner[1], corner[2]);
    }
    chunk.model->endModel();
    chunk.centre = box.center();
    chunk.radius = 0.5 * box.diagonal().norm();
    return chunk;
}

/// Whether every edge belongs to an even number of triangles, vertices at the same place taken as
/// one: those of neighbouring faces, and of a pole, differ by rounding.
bool is_closed(const TriangleMesh& mesh, double size) {
    std::vector<std::array<std::int64_t, 3>> key(mesh.vertices.size());
    for (std::size_t k = 0; k < key.size(); ++k) {
        for (int i = 0; i < 3; ++i) {
            key[k][static_cast<std::size_t>(i)] =
                std::llround(mesh.vertices[k][i] / (kSame * size));
        }
    }
    const std::vector<std::uint32_t> place = weld(key);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(place[t[k]], place[t[(k + 1) % 3]]);
            if (a != b) edges.emplace_back(a, b);
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t k = 0; k < edges.size(); k += 2) {
        if (k + 1 == edges.size() || edges[k] != edges[k + 1]) return false;
    }
    return true;
}

}  // namespace

struct CollisionMesh::Impl {
    std::vector<Chunk> chunks;
    TriangleMesh mesh;
    Box box;
    bool closed = false;
};

CollisionMesh::CollisionMesh(const TriangleMesh& mesh, const RunContext& context) {
    if (mesh.triangles.empty())
        throw InputError("collision.no_triangle", "a body has no triangles");
    auto impl = std::make_shared<Impl>();
    for (const Vec3f& vertex : mesh.vertices) {
        if (!vertex.allFinite())
            throw InputError("collision.vertex_not_finite", "a vertex of a body is not finite");
    }
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t k : triangle) {
            if (k >= mesh.vertices.size()) {
                throw InputError("collision.triangle_without_vertex",
                                 "a triangle of a body names a vertex that is not there");
            }
            impl->box.extend(mesh.vertices[k].cast<double>());
        }
    }
    for (std::size_t begin = 0; begin < mesh.triangles.size(); begin += kChunk) {
        context.throw_if_cancelled();
        const std::size_t end = std::min(begin + kChunk, mesh.triangles.size());
        impl->chunks.push_back(make_chunk(mesh, begin, end));
    }
    impl->mesh = mesh;
    impl->closed = is_closed(mesh, std::max(impl->box.diagonal().norm(), 1e-9));
    impl_ = std::move(impl);
}

NearestPoints CollisionMesh::nearest(const CollisionMesh& other, const Frame& this_from_other,
                                     const NearestPoints& known, double error) const {
    NearestPoints found;
    if (std::isfinite(known.distance)) {
        const double still = (known.here - this_from_other * known.there).norm();
        found = {still, known.here, known.there};
    }
    struct Pair {
        double bound;
        const Chunk *a, *b;
    };
    std::vector<Pair> pairs;
    for (const Chunk& a : impl_->chunks) {
        for (const Chunk& b : other.impl_->chunks) {
            const double apart = (a.centre - this_from_other * b.centre).norm();
            pairs.push_back({apart - a.radius - b.radius, &a, &b});
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& x, const Pair& y) { return x.bound < y.bound; });
    fcl::DistanceRequestd request(true);
    request.rel_err = error;
    if (error > 0.0) request.abs_err = kAnyError;
    const Frame other_from_this = this_from_other.inverse();
    for (const Pair& pair : pairs) {
        if (pair.bound * (1.0 + error) >= found.distance || found.distance <= 0.0) break;
        fcl::DistanceResultd result(found.distance);
        fcl::distance(pair.a->model.get(), fcl::Transform3d::Identity(), pair.b->model.get(),
                      this_from_other, request, result);
        if (result.o1 == nullptr || !(result.min_distance < found.distance)) continue;
        // In the frame of the world, which is this mesh's.
        found.distance = std::max(0.0, result.min_distance);
        found.here = result.nearest_points[0];
        found.there = other_from_this * result.nearest_points[1];
    }
    return found;
}

bool CollisionMesh::within(const CollisionMesh& other, const Frame& this_from_other,
                           double distance) const {
    for (const Chunk& a : impl_->chunks) {
        for (const Chunk& b : other.impl_->chunks) {
            const double apart = (a.centre - this_from_other * b.centre).norm();
            if (apart - a.radius - b.radius > distance) continue;
            if (distance > 0.0) {
                // What lies farther apart than this is not followed.
                fcl::DistanceResultd result(distance);
                const fcl::DistanceRequestd request(false);
                fcl::distance(a.model.get(), fcl::Transform3d::Identity(), b.model.get(),
                              this_from_other, request, result);
                if (result.o1 != nullptr && result.min_distance < distance) return true;
            } else {
                fcl::CollisionResultd result;
                const fcl::CollisionRequestd request;
                fcl::collide(a.model.get(), fcl::Transform3d::Identity(), b.model.get(),
                             this_from_other, request, result);
                if (result.isCollision()) return true;
            }
        }
    }
    return false;
}

double CollisionMesh::reach(const Vec3& point) const {
    double farthest = 0.0;
    for (const Vec3f& vertex : impl_->mesh.vertices) {
        farthest = std::max(farthest, (vertex.cast<double>() - point).squaredNorm());
    }
    return std::sqrt(farthest);
}

bool CollisionMesh::contains(const Vec3& point) const {
    if (!impl_->closed || !impl_->box.contains(point)) return false;
    double angle = 0.0;
    for (const Triangle& t : impl_->mesh.triangles) {
        // Van Oosterom and Strackee: The solid angle of a plane triangle (1983).
        const Vec3 a = impl_->mesh.vertices[t[0]].cast<double>() - point;
        const Vec3 b = impl_->mesh.vertices[t[1]].cast<double>() - point;
        const Vec3 c = impl_->mesh.vertices[t[2]].cast<double>() - point;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    // Either orientation: a body may come inside out.
    return std::abs(angle) > 0.5 * kSolidAngle;
}

bool CollisionMesh::surrounds(const CollisionMesh& other, const Frame& this_from_other) const {
    const auto& vertices = other.impl_->mesh.vertices;
    // Winding numbers take their time; mostly a vertex lies outside of all.
    return impl_->closed &&
           std::all_of(vertices.begin(), vertices.end(),
                       [&](const Vec3f& vertex) {
                           return impl_->box.contains(this_from_other * vertex.cast<double>());
                       }) &&
           contains(this_from_other * other.some_vertex());
}

Vec3 CollisionMesh::some_vertex() const {
    return impl_->mesh.vertices[impl_->mesh.triangles[0][0]].cast<double>();
}

}  // namespace beltgrinding
