#include "thickness/thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "inspection/zones.h"
#include "rays/ray_scene.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 4096;  // rays per task
constexpr int kMaxLayers = 16;        // surfaces met before a ray gives up
constexpr float kStart = 1e-3F;       // mm from the sample: beyond its own triangles
// Spacings by which a ray from a border keeps away from it: else it may run along the next face.
constexpr double kAside = 0.02;
constexpr float kAdvance = 1e-4F;     // mm beyond a surface from which the ray goes on
constexpr double kLeastCosine = 0.5;  // of 60 degrees: else no opposite face
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// The field's triangles, then the others'; near the origin.
TriangleMesh whole_surface(const HeightField& field, const TriangleMesh& others,
                           const Vec3& origin) {
    TriangleMesh mesh;
    mesh.vertices.reserve(field.size() + others.vertices.size());
    for (const Vec3& p : field.point) mesh.vertices.push_back((p - origin).cast<float>());
    for (const Vec3f& v : others.vertices) {
        if (!v.allFinite())
            throw InputError("thickness.vertex_not_finite",
                             "thickness: a vertex of the mesh is not finite");
        mesh.vertices.push_back((v.cast<double>() - origin).cast<float>());
    }
    mesh.triangles.reserve(field.triangles.size() + others.triangles.size());
    for (const Triangle& t : field.triangles) mesh.triangles.push_back(t);
    const auto base = static_cast<std::uint32_t>(field.size());
    for (const Triangle& t : others.triangles) {
        if (std::max({t[0], t[1], t[2]}) >= others.vertices.size()) {
            throw InputError("thickness.triangle_without_vertex",
                             "thickness: a triangle names a vertex that is not there");
        }
        mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    }
    return mesh;
}

}  // namespace

Thickness measure_thickness(const HeightField& field, const std::vector<std::uint32_t>& samples,
                            const TriangleMesh& others, const RunContext& context) {
    field.validate();
    for (const std::uint32_t i : samples) {
        if (i >= field.size()) {
            throw InputError("thickness.no_such_sample",
                             "thickness: there is no sample {sample}; the field has {count}",
                             {{"sample", i}, {"count", field.size()}});
        }
    }
    Thickness found;
    found.design.assign(samples.size(), kNone);
    found.deviation.assign(samples.size(), kNone);
    if (samples.empty()) return found;
    const Vec3 origin = field.point.front();
    const TriangleMesh mesh = whole_surface(field, others, origin);
    const RayScene scene(mesh);
    context.throw_if_cancelled();

    const std::vector<Vec3f> into = into_face(field);
    const auto aside = static_cast<float>(kAside * field.spacing);
    const auto measure = [&](std::size_t k) {
        const std::uint32_t i = samples[k];
        if ((field.flags[i] & kMissed) != 0) return;
        const Vec3f inwards = -field.normal[i];
        Vec3f from = mesh.vertices[i];
        if ((field.flags[i] & kOnBoundary) != 0) from += aside * into[i].stableNormalized();
        RayScene::Hit hit;
        float near = kStart;
        for (int layer = 0; layer < kMaxLayers; ++layer) {
            hit = scene.first(from, inwards, near, std::numeric_limits<float>::max());
            if (hit.distance < 0.0F) return;
            if (hit.leaving) break;
            near = hit.distance + kAdvance;
        }
        if (!hit.leaving) return;
        const Triangle& t = mesh.triangles[hit.triangle];
        double height = 0.0;
        if (hit.triangle < field.triangles.size()) {
            const std::array<double, 3> weight{1.0 - hit.u - hit.v, hit.u, hit.v};
            Vec3 normal = Vec3::Zero();
            for (std::size_t c = 0; c < 3; ++c) {
                if ((field.flags[t[c]] & kMissed) != 0) return;
                height += weight[c] * field.height[t[c]];
                normal += weight[c] * field.normal[t[c]].cast<double>();
            }
            const double cosine = normal.normalized().dot(inwards.cast<double>());
            if (cosine < kLeastCosine) return;
            height /= cosine;
        } else {
            const Vec3f a = mesh.vertices[t[0]];
            const Vec3f normal =
                (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
            if (normal.dot(inwards) < kLeastCosine) return;
        }
        found.design[k] = hit.distance;
        found.deviation[k] = static_cast<float>(field.height[i] + height);
    };
    parallel_blocks(samples.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) measure(k);
    });
    return found;
}

}  // namespace beltgrinding
