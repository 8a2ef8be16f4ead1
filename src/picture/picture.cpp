// Own code, because reports are made without a display and their pictures are compared to the
// pixel: OpenGL needs the one and, from driver to driver, does not give the other.

#include "picture/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "base/lanes.h"
#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "rasteriser.h"
#include "sight_lines.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kMostPixels = 8192;   // a side
constexpr std::size_t kRays = 2;            // a pixel, in both directions
constexpr std::size_t kRowsOfTask = 8;      // pixels
constexpr std::size_t kVerticesOfBox = 64;  // that are passed over together
constexpr std::size_t kPointsOfTask = 16;   // of lines of sight
constexpr std::size_t kWaysOfTask = 8;      // along which the farthest is sought
constexpr float kAmbient = 0.5F;            // share of the light that comes from everywhere
constexpr float kCreaseCosine = 0.82F;  // 35 degrees: beyond the facets of a smooth triangulation
constexpr float kDepthJump = 6.0F;      // rays' distances that a surface leaps at an outline
constexpr float kOutline = 0.35F;       // what an outline leaves of the colour
constexpr float kBackground = 255.0F;
constexpr float kLeastFacing = 0.05F;  // cosine: a steeper surface counts as this steep
constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();
const Vec3f kNone = Vec3f::Zero();

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
    std::uint32_t triangle = kNoTriangle;
    bool facing = true;  // not so steep that it would leap within one triangle
    bool met() const { return !std::isnan(depth); }
};

/// A camera's rays, and its axes in single precision.
struct View {
    RayGrid grid;
    Vec3f right, down, into, light;
    float step = 0;  // mm between neighbouring rays
};

/// Lights what rays meet. Neighbouring rays often meet the same triangle, of which it keeps what
/// they have in common.
class Shader {
  public:
    Shader(const std::vector<ColouredSurface>& surfaces, const View& view)
        : surfaces_(surfaces), view_(view) {}
    BELTGRINDING_INLINE Spot operator()(const RayHit& hit) {
        Spot spot;
        if (!hit.met()) return spot;
        if (hit.triangle != triangle_) take(hit.triangle);
        const float u = hit.u, v = hit.v, w = 1.0F - u - v;
        spot.depth = hit.depth;
        spot.triangle = hit.triangle;
        spot.normal = facet_;
        spot.facing = facing_;
        Vec3f lit = facet_;
        if (smooth_) {
            lit = w * normals_[0] + u * normals_[1] + v * normals_[2];
            const float length = lit.norm();
            lit = length > 1e-6F ? Vec3f((1.0F / length) * lit) : facet_;
            if (lit.dot(view_.into) > 0.0F) lit = -lit;
        }
        const Vec3f colour =
            plain_ ? colours_[0] : Vec3f(w * colours_[0] + u * colours_[1] + v * colours_[2]);
        spot.colour =
            (kAmbient + (1.0F - kAmbient) * std::max(lit.dot(view_.light), 0.0F)) * colour;
        return spot;
    }

  private:
    void take(std::uint32_t triangle) {
        triangle_ = triangle;
        std::size_t k = 0;
        for (; triangle >= surfaces_[k].triangles.size(); ++k)
            triangle -= static_cast<std::uint32_t>(surfaces_[k].triangles.size());
        const ColouredSurface& surface = surfaces_[k];
        const Triangle& t = surface.triangles[triangle];
        const Vec3& a = surface.vertices[t[0]];
        const Vec3 ab = surface.vertices[t[1]] - a, ac = surface.vertices[t[2]] - a;
        facet_ = ab.cross(ac).normalized().cast<float>();
        if (facet_.dot(view_.into) > 0.0F) facet_ = -facet_;
        facing_ = -facet_.dot(view_.into) >= kLeastFacing;
        smooth_ = !surface.normals.empty();
        plain_ = surface.colours.size() == 1;
        for (std::size_t i = 0; i < 3; ++i) {
            if (smooth_) normals_[i] = surface.normals[t[i]];
            colours_[i] = rgb_of(surface.colours[plain_ ? 0 : t[i]]);
        }
    }

    const std::vector<ColouredSurface>& surfaces_;
    const View& view_;
    std::uint32_t triangle_ = kNoTriangle;
    bool smooth_ = false, plain_ = false, facing_ = false;
    Vec3f facet_ = Vec3f::Zero();
    std::array<Vec3f, 3> normals_{kNone, kNone, kNone}, colours_ = normals_;
};

/// True if an outline runs between neighbouring rays, `side` (right or down) apart.
BELTGRINDING_INLINE bool outlined(const Spot& a, const Spot& b, const Vec3f& side,
                                  const View& view) {
    if (a.triangle == b.triangle && a.facing) return false;
    if (!a.met() || !b.met()) return a.met() != b.met();
    if (a.normal.dot(b.normal) < kCreaseCosine) return true;
    const float leap = std::abs(a.depth - b.depth) / view.step;
    if (leap <= kDepthJump) return false;
    const auto slope = [&](const Spot& s) {  // depth gained on the way to the neighbour, at most
        const float facing = std::max(-s.normal.dot(view.into), kLeastFacing);
        return std::abs(s.normal.dot(side)) / facing;
    };
    return leap > kDepthJump + 2.0F * std::max(slope(a), slope(b));
}

BELTGRINDING_CLONES void shade_row(Shader& shade, std::span<const RayHit> hits, Spot* spots) {
    for (const RayHit& hit : hits) *spots++ = shade(hit);
}

/// What a band of rows is drawn in.
struct Band {
    std::vector<RayHit> hits;
    std::vector<Spot> spots;  // of a row of pixels, and a row of rays below
};

/// Work space that is used again: the pages of new memory cost more than what is drawn in it.
template <class Space>
class Spare {
  public:
    std::unique_ptr<Space> take() {
        const std::scoped_lock lock(mutex_);
        if (spaces_.empty()) return std::make_unique<Space>();
        std::unique_ptr<Space> one = std::move(spaces_.back());
        spaces_.pop_back();
        return one;
    }
    void give_back(std::unique_ptr<Space> one) {
        const std::scoped_lock lock(mutex_);
        spaces_.push_back(std::move(one));
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Space>> spaces_;
};

/// Nearest whole number of what is not negative.
std::uint8_t byte_of(float value) {
    const auto whole = static_cast<int>(value);
    return static_cast<std::uint8_t>(whole + (value - static_cast<float>(whole) >= 0.5F ? 1 : 0));
}

/// Draws row `y` of pixels from the spots of its rows of rays and of the next one.
BELTGRINDING_CLONES void draw_row(const View& view, std::span<const Spot> spots, std::size_t y,
                                  Picture& picture) {
    const std::size_t columns = view.grid.columns;
    for (std::size_t x = 0; x < picture.width; ++x) {
        Vec3f sum = Vec3f::Zero();
        float depth = std::numeric_limits<float>::quiet_NaN();
        for (std::size_t k = 0; k < kRays * kRays; ++k) {
            const std::size_t at = k / kRays * columns + x * kRays + k % kRays;
            const Spot& spot = spots[at];
            const bool line = outlined(spot, spots[at + 1], view.right, view) ||
                              outlined(spot, spots[at + columns], view.down, view);
            sum += line ? Vec3f(kOutline * spot.colour) : spot.colour;
            if (spot.met() && !(depth < spot.depth)) depth = spot.depth;
        }
        const std::size_t pixel = y * picture.width + x;
        picture.depth[pixel] = depth;
        for (int k = 0; k < 3; ++k) {
            const float mean = sum[k] / static_cast<float>(kRays * kRays);
            picture.rgb[3 * pixel + static_cast<std::size_t>(k)] =
                byte_of(std::clamp(mean, 0.0F, 255.0F));
        }
    }
}

}  // namespace

struct Renderer::Scene {
    std::vector<ColouredSurface> surfaces;
    Box extents;

    View view_of(const Camera& camera, std::size_t width, std::size_t height) const;
    /// Made when first asked for: many a picture needs none.
    const SightLines& lines() const;
    /// The triangles as they are drawn, made when first asked for.
    const std::vector<Rasteriser::Mesh>& meshes() const;

    Spare<Rasteriser> rasterisers;
    Spare<Band> bands;

  private:
    mutable std::once_flag asked, asked_meshes;
    mutable std::optional<SightLines> made;
    mutable std::vector<std::vector<Box>> boxes;
    mutable std::vector<Rasteriser::Mesh> drawn;
};

const std::vector<Rasteriser::Mesh>& Renderer::Scene::meshes() const {
    std::call_once(asked_meshes, [this] {
        boxes.reserve(surfaces.size());
        for (const ColouredSurface& one : surfaces) {
            boxes.push_back(boxes_of(one.vertices, one.triangles));
            drawn.push_back({one.vertices, one.triangles, boxes.back()});
        }
    });
    return drawn;
}

const SightLines& Renderer::Scene::lines() const {
    std::call_once(asked, [this] {
        std::vector<SightLines::Mesh> meshes;
        for (const ColouredSurface& one : surfaces) meshes.push_back({one.vertices, one.triangles});
        made.emplace(std::move(meshes), extents);
    });
    return *made;
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
    const auto from_middle = [step](std::size_t pixels) {
        return step * (0.5 - 0.5 * static_cast<double>(pixels * kRays));
    };
    view.grid.corner = camera.target + from_middle(width) * across + from_middle(height) * down;
    view.grid.right = step * across;
    view.grid.down = step * down;
    view.grid.into = into;
    view.grid.start = std::min(
        camera.near, (extents.center() - camera.target).norm() + extents.diagonal().norm());
    view.grid.columns = static_cast<std::uint32_t>(width * kRays + 1);  // one more, for outlines
    view.grid.rows = static_cast<std::uint32_t>(height * kRays + 1);
    view.step = static_cast<float>(step);
    return view;
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
    context.throw_if_cancelled();
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Box& Renderer::extents() const {
    return scene_->extents;
}

std::vector<std::uint8_t> Renderer::seen(const std::vector<Vec3>& points,
                                         const std::vector<Vec3>& directions, double slack,
                                         std::span<const std::uint8_t> asked) const {
    if (!asked.empty() && asked.size() != points.size() * directions.size())
        throw InputError("picture.asked", "picture: a line of sight has a point and a direction");
    std::vector<std::uint8_t> seen(points.size() * directions.size());
    std::vector<SightLines::Way> ways;
    ways.reserve(directions.size());
    for (const Vec3& direction : directions) ways.emplace_back(direction.normalized());
    const SightLines& lines = scene_->lines();
    parallel_blocks(points.size(), kPointsOfTask, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            for (std::size_t d = 0; d < ways.size(); ++d) {
                const std::size_t at = p * ways.size() + d;
                if (!asked.empty() && asked[at] == 0) continue;
                seen[at] = lines.hidden(points[p], ways[d], slack) ? 0 : 1;
            }
        }
    });
    return seen;
}

std::vector<Vec3> Renderer::farthest(const std::vector<Vec3>& directions) const {
    const auto along = [](const Vec3& way, const Vec3& p) {  // in this order for boxes as well
        return (way.x() * p.x() + way.y() * p.y()) + way.z() * p.z();
    };
    std::vector<Vec3> found;
    for (const ColouredSurface& surface : scene_->surfaces) {
        const std::vector<Vec3>& vertices = surface.vertices;
        if (vertices.empty()) continue;
        std::vector<Box> boxes((vertices.size() + kVerticesOfBox - 1) / kVerticesOfBox);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            boxes[v / kVerticesOfBox].extend(vertices[v]);
        std::vector<std::array<std::size_t, 2>> ends(directions.size());
        const auto look = [&](std::size_t d, std::size_t end, const Vec3& way) {
            double most = -std::numeric_limits<double>::infinity();
            for (std::size_t b = 0; b < boxes.size(); ++b) {
                const Vec3 corner = (way.array() > 0.0).select(boxes[b].max(), boxes[b].min());
                if (!(along(way, corner) > most)) continue;  // rounding keeps the order
                const std::size_t first = b * kVerticesOfBox;
                for (std::size_t v = first; v < std::min(first + kVerticesOfBox, vertices.size());
                     ++v) {
                    const double here = along(way, vertices[v]);
                    if (here > most) most = here, ends[d][end] = v;
                }
            }
        };
        parallel_blocks(directions.size(), kWaysOfTask, {},
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t d = begin; d < end; ++d) {
                                look(d, 0, -directions[d]);
                                look(d, 1, directions[d]);
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
    const std::size_t columns = view.grid.columns;
    std::unique_ptr<Rasteriser> rasteriser = scene_->rasterisers.take();
    rasteriser->lay_out(scene_->meshes(), view.grid, kRowsOfTask * kRays, context);
    parallel_blocks(height, kRowsOfTask, context, [&](std::size_t begin, std::size_t end) {
        std::unique_ptr<Band> band = scene_->bands.take();
        band->hits.resize((kRowsOfTask * kRays + 1) * columns);
        band->spots.resize((kRays + 1) * columns);
        rasteriser->rasterise(static_cast<std::uint32_t>(begin / kRowsOfTask), band->hits);
        Shader shade(scene_->surfaces, view);
        std::span<const RayHit> hits = band->hits;
        shade_row(shade, hits.first(columns), band->spots.data());
        for (std::size_t y = begin; y < end; ++y) {
            shade_row(shade, hits.subspan(columns, kRays * columns), band->spots.data() + columns);
            hits = hits.subspan(kRays * columns);
            draw_row(view, band->spots, y, picture);
            std::copy_n(band->spots.end() - static_cast<std::ptrdiff_t>(columns), columns,
                        band->spots.begin());
        }
        scene_->bands.give_back(std::move(band));
    });
    scene_->rasterisers.give_back(std::move(rasteriser));
    return picture;
}

}  // namespace beltgrinding
