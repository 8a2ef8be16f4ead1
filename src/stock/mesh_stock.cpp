#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "beltgrinding/stock.h"
#include "rays/ray_scene.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 4096;  // rays per task
constexpr int kMaxLayers = 16;        // surfaces crossed by one ray before it gives up
constexpr float kAdvance = 1e-4F;     // mm beyond a hit from which the ray goes on
// mm: outward surfaces closer together than this are one surface scanned twice; the outer counts.
constexpr float kDoubleSurface = 0.05F;

/// Height of the stock over one sample, or NaN for a miss. See `apply_mesh` for the rule.
float stock_height(const RayScene& scene, const Vec3f& point, const Vec3f& ray,
                   const StockOptions& options) {
    const float longer = ray.norm();
    const Vec3f normal = ray / longer;
    const float above = static_cast<float>(options.search_above) * longer;
    const float below = static_cast<float>(options.search_below) * longer;
    const auto least = static_cast<float>(options.least_cosine);
    // Outward: the first surface through which the ray leaves material; one entered before it means
    // that the design point itself lies outside of the stock, under a gap.
    bool entered = false;
    float best = std::nanf("");
    float near = 0.0F;
    for (int layer = 0; layer < kMaxLayers; ++layer) {
        const RayScene::Hit hit = scene.first(point, normal, near, above);
        if (hit.distance < 0.0F) break;
        near = hit.distance + kAdvance;
        if (hit.cosine < least) continue;
        if (hit.leaving) {
            if (!std::isnan(best) && hit.distance - best > kDoubleSurface) break;
            best = hit.distance;
        } else if (std::isnan(best)) {
            entered = true;
        }
    }
    if (!std::isnan(best) && !entered) return best / longer;
    // Inward: the surface from which the material begins, met from outside.
    near = 0.0F;
    for (int layer = 0; layer < kMaxLayers; ++layer) {
        const RayScene::Hit inward = scene.first(point, -normal, near, below);
        if (inward.distance < 0.0F) break;
        if (inward.cosine >= least) {
            return inward.leaving ? std::nanf("") : -inward.distance / longer;
        }
        near = inward.distance + kAdvance;
    }
    return std::nanf("");
}

void validate(const HeightField& field, const TriangleMesh& mesh, const StockOptions& options) {
    field.validate();
    if (mesh.vertices.empty() || mesh.triangles.empty()) {
        throw InputError("stock.no_triangle", "stock: the mesh has no triangle");
    }
    if (!(options.search_above > 0.0) || !(options.search_below >= 0.0)) {
        throw InputError("stock.search",
                         "stock: the search distances must be positive, in millimetres");
    }
    if (!(options.least_cosine >= 0.0 && options.least_cosine < 1.0)) {
        throw InputError("stock.least_cosine", "stock: the least cosine must be in [0, 1)");
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (!mesh.vertices[i].allFinite()) {
            throw InputError("stock.vertex_not_finite",
                             "stock: vertex {vertex} of the mesh is not finite", {{"vertex", i}});
        }
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::uint32_t v : mesh.triangles[i]) {
            if (v >= mesh.vertices.size()) {
                throw InputError(
                    "stock.triangle_without_vertex",
                    "stock: triangle {triangle} of the mesh names a vertex that is not there",
                    {{"triangle", i}});
            }
        }
    }
    if (field.size() == 0)
        throw InputError("stock.empty_field", "stock: the height field is empty");
}

/// What is wrong when hardly a ray hits: a unit, or a frame.
[[noreturn]] void explain_misses(const HeightField& field, const TriangleMesh& mesh,
                                 double present) {
    Box design, stock;
    for (const Vec3& p : field.point) design.extend(p);
    for (const Vec3f& v : mesh.vertices) stock.extend(v.cast<double>());
    const double across = design.diagonal().norm(), stock_across = stock.diagonal().norm();
    const double ratio = across / std::max(stock_across, 1e-12);
    const struct {
        double unit;  // mm
        const char* code;
        const char* form;
    } units[] = {
        {1000.0, "stock.in_metres",
         "stock: no ray meets the mesh; it seems to be in metres (the design is {design:.4g} mm "
         "across, the stock {stock:.4g} mm); set its unit to {unit:.4g} mm"},
        {25.4, "stock.in_inches",
         "stock: no ray meets the mesh; it seems to be in inches (the design is {design:.4g} mm "
         "across, the stock {stock:.4g} mm); set its unit to {unit:.4g} mm"},
        {10.0, "stock.in_centimetres",
         "stock: no ray meets the mesh; it seems to be in centimetres (the design is {design:.4g} "
         "mm across, the stock {stock:.4g} mm); set its unit to {unit:.4g} mm"},
        {1.0, "stock.in_millimetres",
         "stock: no ray meets the mesh; it seems to be in millimetres (the design is {design:.4g} "
         "mm across, the stock {stock:.4g} mm); set its unit to {unit:.4g} mm"},
        {0.001, "stock.in_micrometres",
         "stock: no ray meets the mesh; it seems to be in micrometres (the design is {design:.4g} "
         "mm across, the stock {stock:.4g} mm); set its unit to {unit:.4g} mm"},
    };
    for (const auto& one : units) {
        const double factor = one.unit / present;
        if (std::abs(std::log(factor)) < std::log(2.0)) continue;  // the unit that it has
        if (ratio > factor / 2.0 && ratio < factor * 2.0) {
            throw InputError(one.code, one.form,
                             {{"design", across}, {"stock", stock_across}, {"unit", one.unit}});
        }
    }
    throw InputError(
        "stock.no_hit",
        "stock: no ray meets the mesh within the search distance (the design is {design:.4g} mm "
        "across, the stock {stock:.4g} mm), their centres are {apart:.4g} mm apart; check the "
        "stock's placement and unit, or search farther",
        {{"design", across},
         {"stock", stock_across},
         {"apart", (design.center() - stock.center()).norm()}});
}

constexpr std::size_t kTried = 2000;  // rays
constexpr double kMostMissed = 0.5;   // of the rays: more, and the mesh may be inside out
constexpr std::size_t kClearly = 3;   // times as many rays meet it from the other side

constexpr double kClosed = 1e-4;  // of a closed mesh's area, that its area vectors sum up to

/// Whether a mesh's area vectors cancel out, as a closed one's do.
bool closed(const TriangleMesh& mesh) {
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]].cast<double>();
        const Vec3 b = mesh.vertices[t[1]].cast<double>();
        const Vec3 c = mesh.vertices[t[2]].cast<double>();
        const Vec3 normal = (b - a).cross(c - a);
        sum += normal;
        area += normal.norm();
    }
    return sum.norm() <= kClosed * area;
}

/// Refuses an open mesh that most rays would meet if its triangles were turned. A closed one is
/// turned when it is read.
void refuse_inside_out(const HeightField& field, const std::vector<float>& found, TriangleMesh mesh,
                       const Vec3& origin, const StockOptions& options) {
    if (closed(mesh)) return;
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    const RayScene scene(mesh);
    const std::size_t stride = std::max<std::size_t>(1, field.size() / kTried);
    std::size_t tried = 0, hits = 0, turned = 0;
    for (std::size_t i = 0; i < field.size(); i += stride, ++tried) {
        const Vec3f point = (field.point[i] - origin).cast<float>();
        hits += !std::isnan(found[i]);
        turned += !std::isnan(stock_height(scene, point, field.ray(i), options));
    }
    if (static_cast<double>(turned) < kMostMissed * static_cast<double>(tried) ||
        turned < kClearly * hits)
        return;
    throw InputError(
        "stock.inside_out",
        "the mesh is inside out: {percent:.0f} % of the rays would meet it if its "
        "triangles were turned; reverse its normals and export it again",
        {{"percent", 100.0 * static_cast<double>(turned) / static_cast<double>(tried)}});
}

}  // namespace

StockReport apply_mesh(HeightField& field, const TriangleMesh& mesh, const StockOptions& options,
                       const RunContext& context) {
    validate(field, mesh, options);
    // Rays in single precision: keep the origin close, so that a part far from zero loses nothing.
    const Vec3 origin = field.point.front();
    TriangleMesh local = mesh;
    for (Vec3f& v : local.vertices) v = (v.cast<double>() - origin).cast<float>();
    const RayScene scene(local);
    context.throw_if_cancelled();

    std::vector<float> found(field.size());
    std::atomic<std::size_t> done{0};
    parallel_blocks(field.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f point = (field.point[i] - origin).cast<float>();
            found[i] = stock_height(scene, point, field.ray(i), options);
        }
        context.report(static_cast<double>(done += end - begin) /
                       static_cast<double>(field.size()));
    });

    StockReport report;
    report.missed = static_cast<std::size_t>(
        std::count_if(found.begin(), found.end(), [](float h) { return std::isnan(h); }));
    if (static_cast<double>(report.missed) > kMostMissed * static_cast<double>(field.size()))
        refuse_inside_out(field, found, std::move(local), origin, options);
    if (report.missed == field.size()) explain_misses(field, mesh, options.unit);
    for (std::size_t i = 0; i < field.size(); ++i) {
        auto flags = static_cast<std::uint8_t>(field.flags[i] & ~(kMissed | kDefective));
        float height = found[i];
        if (std::isnan(height)) {
            flags |= kMissed;
            height = 0.0F;
        } else if (height < 0.0F) {
            flags |= kDefective;
            ++report.defective;
        }
        field.flags[i] = flags;
        field.height[i] = height;
        field.stock_height[i] = height;
        report.volume += field.area[i] * std::max(height, 0.0F);
    }
    if (report.missed > 0) {
        report.warnings.push_back(
            {"stock.rays_miss",
             "{missed} of {count} rays meet no stock within the search distance",
             {{"missed", report.missed}, {"count", field.size()}}});
    }
    if (report.defective > 0) {
        report.warnings.push_back({"stock.below_design",
                                   "the stock lies below the design at {count} samples",
                                   {{"count", report.defective}}});
    }
    return report;
}

}  // namespace beltgrinding
