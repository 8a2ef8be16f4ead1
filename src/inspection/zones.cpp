#include "inspection/zones.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "point_grid.h"

namespace beltgrinding {
namespace {

// Neighbouring faces sample their common edge each for itself, at the spacing within 10 %: the next
// sample of the other one is at most half of that away.
constexpr double kAcross = 0.75;               // spacings
constexpr double kSharpCosine = 0.8660254038;  // of 30 degrees
constexpr std::size_t kBlock = 4096;           // samples per task
constexpr double kFlat = 1e-6;                 // a triangle with a smaller sine has no plane

void check(const Tolerance& t, const char* code, const char* form) {
    if (!std::isfinite(t.lower) || !std::isfinite(t.upper) || t.lower > t.upper) {
        throw InputError(code, form);
    }
}

struct Tensor {  // symmetric, upper triangle by rows; and the weight
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, weight = 0;
};

/// Adds a triangle's curvature tensor, weighted by its area, to its three samples.
void add_curvature(const HeightField& field, const Triangle& t, std::vector<Tensor>& tensors) {
    const Vec3 a = field.point[t[0]], ab = field.point[t[1]] - a, ac = field.point[t[2]] - a;
    const Vec3 cross = ab.cross(ac);
    const double twice_area = cross.norm();
    if (!(twice_area > kFlat * ab.norm() * ac.norm())) return;
    const Vec3 u = ab.normalized(), v = (cross / twice_area).cross(u);
    // II (e) = dn along each edge e, for the symmetric II = (p q; q r): least squares.
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        const Vec3 e = field.point[to] - field.point[from];
        const Vec3 dn = (field.normal[to] - field.normal[from]).cast<double>();
        const double x = e.dot(u), y = e.dot(v), nx = dn.dot(u), ny = dn.dot(v);
        normal(0, 0) += x * x;
        normal(0, 1) += x * y;
        normal(1, 1) += x * x + y * y;
        normal(1, 2) += x * y;
        normal(2, 2) += y * y;
        right += Vec3(x * nx, y * nx + x * ny, y * ny);
    }
    normal(1, 0) = normal(0, 1);
    normal(2, 1) = normal(1, 2);
    const Vec3 ii = normal.ldlt().solve(right);
    if (!ii.allFinite()) return;
    const Eigen::Matrix3d tensor = ii[0] * u * u.transpose() + ii[2] * v * v.transpose() +
                                   ii[1] * (u * v.transpose() + v * u.transpose());
    for (const std::uint32_t i : t) {
        Tensor& sum = tensors[i];
        const auto add = [&](float& to, double value) {
            to += static_cast<float>(twice_area * value);
        };
        add(sum.xx, tensor(0, 0));
        add(sum.xy, tensor(0, 1));
        add(sum.xz, tensor(0, 2));
        add(sum.yy, tensor(1, 1));
        add(sum.yz, tensor(1, 2));
        add(sum.zz, tensor(2, 2));
        add(sum.weight, 1.0);
    }
}

float largest_curvature(const Tensor& t, const Vec3& n) {
    if (!(t.weight > 0.0F)) return 0.0F;
    Eigen::Matrix3d tensor;
    tensor << t.xx, t.xy, t.xz, t.xy, t.yy, t.yz, t.xz, t.yz, t.zz;
    const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
    const double a = u.dot(tensor * u), b = u.dot(tensor * v), c = v.dot(tensor * v);
    return static_cast<float>((0.5 * (a + c) + std::hypot(0.5 * (a - c), b)) / t.weight);
}

std::vector<std::uint32_t> all_samples(const HeightField& field) {
    std::vector<std::uint32_t> all(field.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

/// Marks the samples within `radius` mm of one of `borders` on the same face.
std::vector<std::uint8_t> near_borders(const HeightField& field, std::vector<std::uint32_t> borders,
                                       double radius) {
    std::vector<std::uint8_t> marked(field.size(), 0);
    const auto by_face = [&](std::uint32_t a, std::uint32_t b) {
        return field.face[a] != field.face[b] ? field.face[a] < field.face[b] : a < b;
    };
    std::sort(borders.begin(), borders.end(), by_face);
    std::map<std::uint32_t, PointGrid> grids;  // of each face that has borders
    for (auto begin = borders.begin(); begin != borders.end();) {
        const std::uint32_t face = field.face[*begin];
        const auto end = std::find_if(begin, borders.end(),
                                      [&](std::uint32_t i) { return field.face[i] != face; });
        grids.emplace(std::piecewise_construct, std::forward_as_tuple(face),
                      std::forward_as_tuple(std::span<const Vec3>(field.point),
                                            std::vector<std::uint32_t>(begin, end), radius));
        begin = end;
    }
    if (grids.empty()) return marked;
    parallel_blocks(field.size(), kBlock, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto grid = grids.find(field.face[i]);
            if (grid != grids.end() && grid->second.any_near(field.point[i])) marked[i] = 1;
        }
    });
    return marked;
}

}  // namespace

std::vector<float> convex_curvature(const HeightField& field) {
    std::vector<Tensor> tensors(field.size());
    for (const Triangle& t : field.triangles) add_curvature(field, t, tensors);
    std::vector<float> curvature(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        curvature[i] = largest_curvature(tensors[i], field.normal[i].cast<double>());
    }
    return curvature;
}

std::vector<BorderPair> border_pairs(const HeightField& field,
                                     const std::vector<std::uint32_t>& samples) {
    std::vector<std::uint32_t> borders;
    for (const std::uint32_t i : samples) {
        if ((field.flags[i] & kOnBoundary) != 0) borders.push_back(i);
    }
    const PointGrid grid(field.point, borders, kAcross * field.spacing);
    std::vector<BorderPair> pairs;
    for (const std::uint32_t i : borders) {
        grid.near(field.point[i], [&](std::uint32_t j) {
            if (i < j && field.face[i] != field.face[j]) pairs.push_back({i, j});
        });
    }
    std::sort(pairs.begin(), pairs.end(), [](const BorderPair& p, const BorderPair& q) {
        return p.a != q.a ? p.a < q.a : p.b < q.b;
    });
    return pairs;
}

std::vector<Vec3f> into_face(const HeightField& field) {
    std::vector<Vec3f> inwards(field.size(), Vec3f::Zero());
    for (const Triangle& t : field.triangles) {
        const Vec3 middle = (field.point[t[0]] + field.point[t[1]] + field.point[t[2]]) / 3.0;
        for (const std::uint32_t i : t) inwards[i] += (middle - field.point[i]).cast<float>();
    }
    return inwards;
}

std::vector<std::uint32_t> sharp_convex_borders(const HeightField& field) {
    const std::vector<BorderPair> pairs = border_pairs(field, all_samples(field));
    const std::vector<Vec3f> inwards = into_face(field);
    std::vector<std::uint8_t> sharp(field.size(), 0);
    for (const BorderPair& pair : pairs) {
        const Vec3f &n = field.normal[pair.a], &m = field.normal[pair.b];
        if (n.dot(m) > kSharpCosine) continue;
        if (n.dot(inwards[pair.b]) < 0.0F && m.dot(inwards[pair.a]) < 0.0F) {
            sharp[pair.a] = sharp[pair.b] = 1;
        }
    }
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < sharp.size(); ++i) {
        if (sharp[i] != 0) found.push_back(i);
    }
    return found;
}

std::vector<std::uint32_t> zone_of_samples(const HeightField& field,
                                           const std::vector<ToleranceZone>& zones) {
    field.validate();
    std::vector<std::uint32_t> zone(field.size(), static_cast<std::uint32_t>(zones.size()));
    std::vector<float> curvature;
    std::vector<std::uint32_t> borders;
    for (std::uint32_t z = 0; z < zones.size(); ++z) {
        const ToleranceZone& given = zones[z];
        check(given.tolerance, "inspection.tolerance",
              "tolerance: the lower limit must not lie above the upper one");
        if (given.thickness)
            check(*given.thickness, "inspection.thickness_tolerance",
                  "tolerance of the thickness: the lower limit must not lie above the upper one");
        if (!std::isfinite(given.edge_radius) || given.edge_radius < 0.0) {
            throw InputError("inspection.edge_radius",
                             "the radius of an edge zone must be positive, in millimetres");
        }
        std::vector<std::uint8_t> edge;
        if (given.edge_radius > 0.0) {
            if (curvature.empty()) {
                curvature = convex_curvature(field);
                borders = sharp_convex_borders(field);
            }
            edge = near_borders(field, borders, given.edge_radius);
            for (std::size_t i = 0; i < field.size(); ++i) {
                if (curvature[i] * given.edge_radius > 1.0) edge[i] = 1;
            }
        }
        for (std::size_t i = 0; i < field.size(); ++i) {
            const bool on_face = given.faces.empty() ||
                                 std::find(given.faces.begin(), given.faces.end(), field.face[i]) !=
                                     given.faces.end();
            if (on_face && (edge.empty() || edge[i] != 0)) zone[i] = z;
        }
    }
    return zone;
}

}  // namespace beltgrinding
