// Own code, because reports are made without a display and their pictures are compared to the
// pixel: OpenGL needs the one and, from driver to driver, does not give the other.

#include "picture/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "base/large_memory.h"
#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "rays/ray_scene.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kMostPixels = 8192;  // a side
constexpr std::size_t kRays = 2;           // a pixel, in both directions
constexpr std::size_t kRowsOfTask = 8;     // pixels
constexpr std::size_t kPointsOfTask = 16;  // of lines of sight
constexpr std::size_t kWaysOfTask = 8;     // along which the farthest is sought
constexpr float kAmbient = 0.5F;           // share of the light that comes from everywhere
constexpr float kCreaseCosine = 0.82F;  // 35 degrees: beyond the facets of a smooth triangulation
constexpr float kDepthJump = 6.0F;      // rays' distances that a surface leaps at an outline
constexpr float kOutline = 0.35F;       // what an outline leaves of the colour
constexpr float kBackground = 255.0F;

void validate(const ColouredSurface& surface) {
    for (const Vec3& v : surface.vertices) {
        if (!v.allFinite())
            throw InputError("picture.vertex_not_finite", "picture: a vertex is not finite");
    }
    for (const Triangle& t : surface.triangles) {
        for (const std::uint32_t v : t) {
            if (v >= surface.vertices.size()) {
                throw InputError("picture.triangle_without_vertex",
                                 "picture: a triangle names a vertex that is not there");
            }
        }
    }
    if (surface.colours.size() != 1 && surface.colours.size() != surface.vertices.size()) {
        throw InputError(
            "picture.colours", "picture: {colours} colours for {vertices} vertices",
            {{"colours", surface.colours.size()}, {"vertices", surface.vertices.size()}});
    }
    if (!surface.normals.empty() && surface.normals.size() != surface.vertices.size()) {
        throw InputError(
            "picture.normals", "picture: {normals} normals for {vertices} vertices",
            {{"normals", surface.normals.size()}, {"vertices", surface.vertices.size()}});
    }
}

Vec3f rgb_of(std::uint32_t packed) {
    return {static_cast<float>(packed >> 24U & 255U), static_cast<float>(packed >> 16U & 255U),
            static_cast<float>(packed >> 8U & 255U)};
}

/// What one ray met.
struct Spot {
    float depth = std::numeric_limits<float>::quiet_NaN();  // mm beyond the target's plane
    Vec3f normal = Vec3f::Zero();                           // of the facet, towards the camera
    Vec3f colour = Vec3f::Constant(kBackground);            // lit
    bool met() const { return !std::isnan(depth); }
};

/// The camera's axes, in single precision: right, down and into the picture.
struct View {
    Vec3f right, down, into, light;
    Vec3f origin;     // of the ray through the picture's upper left corner
    float step = 0;   // mm between neighbouring rays
    float start = 0;  // mm from the target's plane back to the rays' origins
};

/// True if an outline runs between neighbouring rays, `side` (right or down) apart.
bool outlined(const Spot& a, const Spot& b, const Vec3f& side, const View& view) {
    if (!a.met() || !b.met()) return a.met() != b.met();
    if (a.normal.dot(b.normal) < kCreaseCosine) return true;
    const auto slope = [&](const Spot& s) {  // depth gained on the way to the neighbour, at most
        const float facing = std::max(-s.normal.dot(view.into), 0.05F);
        return std::abs(s.normal.dot(side)) / facing;
    };
    const float leap = std::abs(a.depth - b.depth) / view.step;
    return leap > kDepthJump + 2.0F * std::max(slope(a), slope(b));
}

}  // namespace

struct Renderer::Scene {
    std::vector<ColouredSurface> surfaces;
    Vec3 origin = Vec3::Zero();  // of the rays' single precision
    Box extents;
    std::optional<RayScene> rays;

    void build();
    /// What a row of rays meets, `y` rays down.
    void row(const View& view, float y, std::span<Spot> spots) const;
    Spot spot(const View& view, const RayScene::Hit& hit) const;
    View view_of(const Camera& camera, std::size_t width, std::size_t height) const;
};

void Renderer::Scene::build() {
    std::vector<TriangleMesh> meshes(surfaces.size());
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        reserve_large(meshes[k].triangles, surfaces[k].triangles.size());
        meshes[k].triangles = surfaces[k].triangles;
        reserve_large(meshes[k].vertices, surfaces[k].vertices.size());
        for (const Vec3& v : surfaces[k].vertices)
            meshes[k].vertices.push_back((v - origin).cast<float>());
    }
    rays.emplace(meshes, RayScene::Build::kQuick);
}

View Renderer::Scene::view_of(const Camera& camera, std::size_t width, std::size_t height) const {
    if (width == 0 || height == 0 || width > kMostPixels || height > kMostPixels) {
        throw InputError("picture.size", "picture: a side has 1 to {most} pixels",
                         {{"most", kMostPixels}});
    }
    const Vec3 right = camera.direction.cross(camera.up);
    if (!camera.target.allFinite() || !right.allFinite() ||
        !(right.norm() > 1e-9 * camera.direction.norm() * camera.up.norm()) ||
        !(camera.height > 0.0) || !std::isfinite(camera.height) || std::isnan(camera.near)) {
        throw InputError(
            "picture.camera",
            "picture: a camera needs a direction, another one that is up, and a height above 0 mm");
    }
    View view;
    const Vec3 into = camera.direction.normalized(), across = right.normalized();
    const Vec3 down = into.cross(across);
    view.into = into.cast<float>();
    view.right = across.cast<float>();
    view.down = down.cast<float>();
    view.light = (-into - 0.35 * across - 0.5 * down).normalized().cast<float>();
    const double step = camera.height / static_cast<double>(height * kRays);
    // The rays begin in front of everything.
    const double start = std::min(
        camera.near, (extents.center() - camera.target).norm() + extents.diagonal().norm());
    const Vec3 corner = camera.target - origin - start * into -
                        0.5 * step * static_cast<double>(width * kRays) * across -
                        0.5 * step * static_cast<double>(height * kRays) * down;
    view.origin = corner.cast<float>();
    view.step = static_cast<float>(step);
    view.start = static_cast<float>(start);
    return view;
}

void Renderer::Scene::row(const View& view, float y, std::span<Spot> spots) const {
    std::array<Vec3f, RayScene::kTogether> from;
    std::array<RayScene::Hit, RayScene::kTogether> hits;
    for (std::size_t first = 0; first < spots.size(); first += from.size()) {
        const std::size_t count = std::min(from.size(), spots.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const float x = static_cast<float>(first + i) + 0.5F;
            from[i] = view.origin + x * view.step * view.right + y * view.step * view.down;
        }
        rays->first_together({from.data(), count}, view.into, 0.0F,
                             std::numeric_limits<float>::infinity(), {hits.data(), count});
        for (std::size_t i = 0; i < count; ++i) spots[first + i] = spot(view, hits[i]);
    }
}

Spot Renderer::Scene::spot(const View& view, const RayScene::Hit& hit) const {
    Spot spot;
    if (hit.distance < 0.0F) return spot;
    const ColouredSurface& surface = surfaces[hit.mesh];
    const Triangle& t = surface.triangles[hit.triangle];
    const float u = hit.u, v = hit.v, w = 1.0F - u - v;
    spot.depth = hit.distance - view.start;
    spot.normal = hit.normal.normalized();
    if (spot.normal.dot(view.into) > 0.0F) spot.normal = -spot.normal;
    Vec3f lit = spot.normal;
    if (!surface.normals.empty()) {
        lit = w * surface.normals[t[0]] + u * surface.normals[t[1]] + v * surface.normals[t[2]];
        lit = lit.norm() > 1e-6F ? Vec3f(lit.normalized()) : spot.normal;
        if (lit.dot(view.into) > 0.0F) lit = -lit;
    }
    const bool one = surface.colours.size() == 1;
    const Vec3f colour =
        one ? rgb_of(surface.colours[0])
            : Vec3f(w * rgb_of(surface.colours[t[0]]) + u * rgb_of(surface.colours[t[1]]) +
                    v * rgb_of(surface.colours[t[2]]));
    spot.colour = (kAmbient + (1.0F - kAmbient) * std::max(lit.dot(view.light), 0.0F)) * colour;
    return spot;
}

Renderer::Renderer(std::vector<ColouredSurface> surfaces, const RunContext& context)
    : scene_(std::make_unique<Scene>()) {
    bool any = false;
    for (const ColouredSurface& surface : surfaces) {
        validate(surface);
        any = any || !surface.triangles.empty();
        for (const Vec3& v : surface.vertices) scene_->extents.extend(v);
    }
    if (!any) throw InputError("picture.empty", "picture: there is nothing to be drawn");
    scene_->surfaces = std::move(surfaces);
    scene_->origin = scene_->extents.center();
    context.throw_if_cancelled();
    scene_->build();
    context.throw_if_cancelled();
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Box& Renderer::extents() const {
    return scene_->extents;
}

std::vector<std::uint8_t> Renderer::seen(const std::vector<Vec3>& points,
                                         const std::vector<Vec3>& directions, double slack) const {
    std::vector<std::uint8_t> seen(points.size() * directions.size());
    std::vector<Vec3f> ways;
    ways.reserve(directions.size());
    for (const Vec3& direction : directions) ways.push_back(direction.normalized().cast<float>());
    const auto near = static_cast<float>(slack);
    parallel_blocks(points.size(), kPointsOfTask, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const Vec3f from = (points[p] - scene_->origin).cast<float>();
            for (std::size_t d = 0; d < ways.size(); ++d) {
                const RayScene::Hit hit = scene_->rays->first(
                    from, ways[d], near, std::numeric_limits<float>::infinity());
                seen[p * ways.size() + d] = hit.distance < 0.0F ? 1 : 0;
            }
        }
    });
    return seen;
}

std::vector<Vec3> Renderer::farthest(const std::vector<Vec3>& directions) const {
    std::vector<Vec3> found;
    for (const ColouredSurface& surface : scene_->surfaces) {
        const std::vector<Vec3>& vertices = surface.vertices;
        if (vertices.empty()) continue;
        std::vector<std::array<std::size_t, 2>> ends(directions.size());
        parallel_blocks(directions.size(), kWaysOfTask, {},
                        [&](std::size_t begin, std::size_t end) {
                            const std::size_t count = end - begin;
                            std::array<double, kWaysOfTask> low{}, high{};
                            low.fill(std::numeric_limits<double>::infinity());
                            high.fill(-std::numeric_limits<double>::infinity());
                            for (std::size_t v = 0; v < vertices.size(); ++v) {
                                for (std::size_t d = 0; d < count; ++d) {
                                    const double along = directions[begin + d].dot(vertices[v]);
                                    if (along < low[d]) low[d] = along, ends[begin + d][0] = v;
                                    if (along > high[d]) high[d] = along, ends[begin + d][1] = v;
                                }
                            }
                        });
        std::vector<std::size_t> all;
        for (const auto& two : ends) all.insert(all.end(), two.begin(), two.end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        for (const std::size_t v : all) found.push_back(vertices[v]);
    }
    return found;
}

Picture Renderer::render(const Camera& camera, std::size_t width, std::size_t height,
                         const RunContext& context) const {
    const View view = scene_->view_of(camera, width, height);
    Picture picture{width, height, std::vector<std::uint8_t>(3 * width * height),
                    std::vector<float>(width * height)};
    const std::size_t columns = width * kRays + 1;  // one more, for the outlines
    parallel_blocks(height, kRowsOfTask, context, [&](std::size_t begin, std::size_t end) {
        const std::size_t rows = (end - begin) * kRays + 1;
        std::vector<Spot> spots(rows * columns);
        for (std::size_t r = 0; r < rows; ++r) {
            if (context.cancelled()) return;
            scene_->row(view, static_cast<float>(begin * kRays + r) + 0.5F,
                        {spots.data() + r * columns, columns});
        }
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < width; ++x) {
                Vec3f sum = Vec3f::Zero();
                float depth = std::numeric_limits<float>::quiet_NaN();
                for (std::size_t k = 0; k < kRays * kRays; ++k) {
                    const std::size_t at =
                        ((y - begin) * kRays + k / kRays) * columns + x * kRays + k % kRays;
                    const Spot& spot = spots[at];
                    const bool line = outlined(spot, spots[at + 1], view.right, view) ||
                                      outlined(spot, spots[at + columns], view.down, view);
                    sum += line ? Vec3f(kOutline * spot.colour) : spot.colour;
                    if (spot.met() && !(depth < spot.depth)) depth = spot.depth;
                }
                const std::size_t pixel = y * width + x;
                picture.depth[pixel] = depth;
                for (int k = 0; k < 3; ++k) {
                    const float mean = sum[k] / static_cast<float>(kRays * kRays);
                    picture.rgb[3 * pixel + static_cast<std::size_t>(k)] =
                        static_cast<std::uint8_t>(std::lround(std::clamp(mean, 0.0F, 255.0F)));
                }
            }
        }
    });
    return picture;
}

}  // namespace beltgrinding
