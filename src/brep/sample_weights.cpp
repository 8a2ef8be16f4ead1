#include "sample_weights.h"

namespace beltgrinding {
namespace {

constexpr int kNormalRounds = 4;  // singular samples beside singular ones

}  // namespace

std::array<double, 3> voronoi_shares(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = (b - c).squaredNorm(), lb = (c - a).squaredNorm(), lc = (a - b).squaredNorm();
    if (la >= lb + lc) return {0.5, 0.25, 0.25};
    if (lb >= lc + la) return {0.25, 0.5, 0.25};
    if (lc >= la + lb) return {0.25, 0.25, 0.5};
    // Barycentric weights of the circumcentre, halved on both sides of each corner.
    const double wa = la * (lb + lc - la), wb = lb * (lc + la - lb), wc = lc * (la + lb - lc);
    const double sum = 2 * (wa + wb + wc);
    return {(wb + wc) / sum, (wc + wa) / sum, (wa + wb) / sum};
}

void fill_singular_normals(const std::vector<Vec3>& point, const std::vector<std::uint8_t>& flags,
                           const std::vector<Triangle>& triangles, std::vector<Vec3f>& normal) {
    std::vector<std::uint32_t> left;
    for (std::uint32_t i = 0; i < flags.size(); ++i)
        if (flags[i] & kDegenerate) left.push_back(i);
    for (int round = 0; round < kNormalRounds && !left.empty(); ++round) {
        std::vector<Vec3> sum(point.size(), Vec3::Zero());
        for (const Triangle& t : triangles)
            for (std::size_t i = 0; i < 3; ++i)
                if ((flags[t[i]] & kDegenerate) && normal[t[i]].isZero())
                    sum[t[i]] += (normal[t[(i + 1) % 3]] + normal[t[(i + 2) % 3]]).cast<double>();
        for (const std::uint32_t i : left)
            if (normal[i].isZero() && sum[i].norm() > 1e-9)
                normal[i] = sum[i].normalized().cast<float>();
        std::erase_if(left, [&](std::uint32_t i) { return !normal[i].isZero(); });
    }
    // Nothing but singular samples about it: the triangles' own normals, or any unit vector.
    if (left.empty()) return;
    std::vector<Vec3> sum(point.size(), Vec3::Zero());
    for (const Triangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i)
            sum[t[i]] += (point[t[1]] - point[t[0]]).cross(point[t[2]] - point[t[0]]);
    for (const std::uint32_t i : left)
        normal[i] =
            sum[i].norm() > 0 ? Vec3f(sum[i].normalized().cast<float>()) : Vec3f(Vec3f::UnitZ());
}

}  // namespace beltgrinding
