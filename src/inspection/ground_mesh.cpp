#include "inspection/ground_mesh.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "heightfield/height_lookup.h"
#include "mesh/topology.h"

namespace beltgrinding {
namespace {

constexpr std::uint32_t kDesignColour = 0xB9BDC4FF;
constexpr double kMitreLimit = 3.0;  // of the greatest height: how far a thin edge may move
constexpr double kTangent = 0.06;    // eigenvalue; two normals less than 20 degrees apart are below
constexpr double kNoDirection = 1e-6;
constexpr int kSlideRounds = 20;  // each adds two rings of vertices
constexpr int kSlideSweeps = 8;   // of relaxation in each
constexpr std::size_t kBlock = 1024;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Condition {
    Vec3 normal;
    double height;
};

/// The shortest d with normal . d = height for all, in the least-squares sense, by the
/// eigenvectors of the normals' sum of squares.
Vec3 displacement(const std::vector<Condition>& conditions, bool& limited) {
    if (conditions.size() == 1) return conditions[0].height * conditions[0].normal;
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    double greatest = 0;
    for (const Condition& c : conditions) {
        square += c.normal * c.normal.transpose();
        right += c.height * c.normal;
        greatest = std::max(greatest, std::abs(c.height));
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(square);
    Vec3 d = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        const double value = solver.eigenvalues()[i];
        if (value < kNoDirection) continue;
        const Vec3 axis = solver.eigenvectors().col(i);
        double along = right.dot(axis) / value;
        if (value < kTangent) {
            double low = 0, high = 0;
            for (const Condition& c : conditions) {
                low = std::min(low, c.normal.dot(axis));
                high = std::max(high, c.normal.dot(axis));
            }
            // Normals to both sides of the axis: faces nearly tangent to each other, and a
            // difference of their heights says nothing of where the edge between them goes.
            if (std::min(-low, high) > 0.1 * std::max(-low, high)) continue;
        }
        if (std::abs(along) > kMitreLimit * greatest) {
            along = std::copysign(kMitreLimit * greatest, along);
            limited = true;
        }
        d += along * axis;
    }
    return d;
}

void displace(const SurfaceMesh& mesh, const HeightField& field, const RunContext& context,
              GroundMesh& out) {
    std::vector<char> ground;
    for (const std::uint32_t f : field.face) {
        if (f >= ground.size()) ground.resize(f + std::size_t{1}, 0);
        ground[f] = 1;
    }
    const auto is_ground = [&](std::uint32_t f) { return f < ground.size() && ground[f] != 0; };
    const HeightLookup lookup(field);
    context.report(0.3);
    // Where each vertex's meetings begin.
    std::vector<std::uint32_t> first(mesh.vertices.size() + 1, 0);
    for (const SurfaceMesh::Meeting& m : mesh.meetings) ++first[m.vertex + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::atomic<std::size_t> limited{0}, asked{0}, found{0};
    parallel_blocks(mesh.vertices.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        std::vector<Condition> conditions;
        for (std::size_t v = begin; v < end; ++v) {
            conditions.clear();
            bool on_ground = false, on_other = false;
            Vec3 aside = Vec3::Zero();
            double sum = 0;
            int heights = 0;
            for (std::uint32_t m = first[v]; m < first[v + 1]; ++m) {
                const SurfaceMesh::Meeting& meeting = mesh.meetings[m];
                double h = 0;
                if (is_ground(meeting.face)) {
                    on_ground = true;
                    ++asked;
                    const auto place = lookup.find(meeting.face, mesh.vertices[v]);
                    found += place.has_value();
                    const auto height = place ? lookup.height(*place) : std::nullopt;
                    if (height) {
                        h = *height;
                        sum += h;
                        aside = h * lookup.lean(*place);
                        ++heights;
                    }
                }
                on_other |= !is_ground(meeting.face);
                conditions.push_back({meeting.normal.cast<double>(), h});
            }
            if (!on_ground) continue;
            out.standing[v] = heights == 0 ? MeshVertex::kMissed
                              : on_other   ? MeshVertex::kBorder
                                           : MeshVertex::kGround;
            if (heights == 0) continue;
            out.deviation[v] = static_cast<float>(sum / heights);
            bool held = false;
            out.vertices[v] += displacement(conditions, held);
            if (conditions.size() == 1) out.vertices[v] += aside;  // borders have their own
            if (held) ++limited;
        }
    });
    if (asked > 0 && found == 0)
        throw InputError("inspection.other_shape",
                         "the height field is not of this shape: no sample lies on its faces");
    out.limited = limited;
}

Vec3 twice_area(const std::vector<Vec3>& at, const Triangle& t) {
    return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
}

std::vector<std::uint32_t> turned_triangles(const SurfaceMesh& mesh, const GroundMesh& out) {
    std::vector<std::uint32_t> turned;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        if (twice_area(mesh.vertices, corners).dot(twice_area(out.vertices, corners)) < 0)
            turned.push_back(t);
    }
    return turned;
}

/// A sharp edge that moves sideways turns the triangles beside it over. There, and only there, the
/// vertices inside of the faces slide along, each by the mean of its neighbours' displacements in
/// its tangent plane, on ever more rings round the turned triangles until none is left.
void slide_beside_edges(const SurfaceMesh& mesh, const RunContext& context, GroundMesh& out) {
    std::vector<std::uint32_t> turned = turned_triangles(mesh, out);
    if (turned.empty()) return;
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    std::vector<Vec3f> normal(n, Vec3f::Zero());  // of vertices inside of a face; zero on borders
    for (std::size_t i = 0; i < mesh.meetings.size(); ++i) {
        const SurfaceMesh::Meeting& m = mesh.meetings[i];
        const bool alone =
            (i == 0 || mesh.meetings[i - 1].vertex != m.vertex) &&
            (i + 1 == mesh.meetings.size() || mesh.meetings[i + 1].vertex != m.vertex);
        if (alone) normal[m.vertex] = m.normal;
    }
    const VertexTriangles around(n, mesh.triangles);
    std::vector<char> slides(n, 0);
    std::vector<std::uint32_t> sliding;
    const auto let_slide = [&](std::uint32_t v) {
        if (slides[v] || normal[v].isZero()) return;
        slides[v] = 1;
        sliding.push_back(v);
    };
    std::vector<Vec3> moved;
    for (int round = 0; round < kSlideRounds && !turned.empty(); ++round) {
        context.throw_if_cancelled();
        for (const std::uint32_t t : turned)
            for (const std::uint32_t v : mesh.triangles[t])
                for (const std::uint32_t near : around.of(v))
                    for (const std::uint32_t w : mesh.triangles[near]) let_slide(w);
        for (int sweep = 0; sweep < kSlideSweeps; ++sweep) {
            moved.clear();
            for (const std::uint32_t v : sliding) {
                Vec3 mean = Vec3::Zero();
                for (const std::uint32_t t : around.of(v))
                    for (const std::uint32_t w : mesh.triangles[t])
                        if (w != v) mean += out.vertices[w] - mesh.vertices[w];
                mean /= 2.0 * static_cast<double>(around.of(v).size());
                const Vec3 up = normal[v].cast<double>();
                const double height = (out.vertices[v] - mesh.vertices[v]).dot(up);
                moved.push_back(mesh.vertices[v] + mean + (height - mean.dot(up)) * up);
            }
            for (std::size_t i = 0; i < sliding.size(); ++i) out.vertices[sliding[i]] = moved[i];
        }
        turned = turned_triangles(mesh, out);
    }
    out.slid = sliding.size();
}

void count_turned(const SurfaceMesh& mesh, GroundMesh& out) {
    std::vector<Vec3f> normal(mesh.vertices.size(), Vec3f::Zero());
    for (const SurfaceMesh::Meeting& m : mesh.meetings) normal[m.vertex] += m.normal;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 before = twice_area(mesh.vertices, t), after = twice_area(out.vertices, t);
        const Vec3f outward = normal[t[0]] + normal[t[1]] + normal[t[2]];
        if (before.dot(outward.cast<double>()) < 0) ++out.flat;
        if (after.dot(before) < 0) ++out.flipped;
    }
}

}  // namespace

GroundMesh ground_mesh(const SurfaceMesh& mesh, const HeightField& field, bool ground,
                       const RunContext& context) {
    field.validate();
    GroundMesh out;
    out.vertices = mesh.vertices;
    out.triangles = mesh.triangles;
    out.face = mesh.face;
    out.warnings = mesh.warnings;
    out.deviation.assign(mesh.vertices.size(), kNaN);
    out.standing.assign(mesh.vertices.size(), MeshVertex::kDesign);
    out.design_check = check_mesh(mesh.vertices, mesh.triangles);
    context.report(0.2);
    if (ground) {
        displace(mesh, field, context.part(0.2, 0.8), out);
        slide_beside_edges(mesh, context, out);
    }
    out.check = ground ? check_mesh(out.vertices, out.triangles) : out.design_check;
    count_turned(mesh, out);
    for (const MeshVertex v : out.standing) out.missed += v == MeshVertex::kMissed;
    for (std::size_t i = 0; ground && i < field.size(); ++i) {
        out.defective += (field.flags[i] & kDefective) != 0;
        if ((field.flags[i] & kMissed) == 0)
            out.expected_volume += double(field.area[i]) * field.height[i];
    }
    const auto warn = [&](std::size_t count, const char* code, const char* form) {
        if (count > 0) out.warnings.push_back({code, form, {{"count", count}}});
    };
    warn(out.check.border_edges, "inspection.mesh_border_edges",
         "{count} edges of the mesh have one triangle only: it is open there, as the design is");
    warn(out.check.non_manifold_edges, "inspection.mesh_non_manifold_edges",
         "{count} edges of the mesh have more than two triangles: the design's faces meet so");
    warn(out.check.turned_edges, "inspection.mesh_turned_edges",
         "{count} edges of the mesh lie between faces of opposite orientation");
    warn(out.flipped, "inspection.mesh_flipped",
         "{count} triangles were turned over by the displacement: look at thin faces and edges "
         "beside ground ones");
    warn(out.limited, "inspection.mesh_limited",
         "{count} vertices on thin edges would have moved by more than three times their height "
         "and were held back");
    warn(out.missed, "inspection.mesh_missed",
         "{count} vertices lie where no stock was found and stay on the design");
    context.report(1.0);
    return out;
}

std::vector<std::uint32_t> mesh_colours(const GroundMesh& mesh, const ColourScale& scale) {
    std::vector<std::uint32_t> colours(mesh.vertices.size(), kDesignColour);
    for (std::size_t v = 0; v < colours.size(); ++v) {
        if (mesh.standing[v] == MeshVertex::kMissed) colours[v] = scale.missed_colour();
        if (mesh.standing[v] == MeshVertex::kGround) colours[v] = scale.colour(mesh.deviation[v]);
    }
    return colours;
}

}  // namespace beltgrinding
