#include "surface_under_belt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace beltgrinding {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();
constexpr double kSteepest = 0.25;  // cosine: surfaces that face the belt less do not meet it
constexpr int kPasses = 4;          // of Newton's method along a normal
constexpr double kExact = 1e-9;     // mm: close enough; straight down at once
constexpr double kHalfCell = 0.5;   // that the map reaches beyond its cells' middles
constexpr double kLayer = 1.0;      // mm/mm: a greater step between rows is no slope

/// Difference quotient of what exists on either side, 0 where nothing does.
double slope_of(double before, double here, double after, double step) {
    const auto ok = [&](double rise) { return std::abs(rise) <= kLayer * step; };
    const bool left = ok(here - before), right = ok(after - here);
    if (left && right) return (after - before) / (2.0 * step);
    if (left) return (here - before) / step;
    return right ? (after - here) / step : 0.0;
}

}  // namespace

std::vector<BeltRow> rows_under_belt(const ContactGrid& grid, double width) {
    std::vector<BeltRow> rows;
    for (int j = 0; j < grid.ny; ++j) {
        const double low = std::max(grid.y(j) - 0.5 * grid.dy, -0.5 * width);
        const double high = std::min(grid.y(j) + 0.5 * grid.dy, 0.5 * width);
        if (high - low > 1e-9 * grid.dy) rows.push_back({j, 0.5 * (low + high), high - low});
    }
    return rows;
}

SurfaceUnderBelt::SurfaceUnderBelt(const ContactGrid& grid, const ContactProblem& problem,
                                   const std::vector<BeltRow>& rows, double thickness)
    : grid_(grid), problem_(problem), rows_(rows), half_(0.5 * thickness) {
    const auto count = static_cast<Eigen::Index>(rows.size());
    height_.resize(grid.nx, count);
    slope_.setZero(grid.nx, count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const int first = rows[static_cast<std::size_t>(k)].row * grid.nx;
        for (int i = 0; i < grid.nx; ++i) {
            const double gap = problem.gap[first + i];
            const bool there = std::isfinite(gap) && problem.coverage[first + i] > 0.0;
            height_(i, k) = there ? -gap - half_ : kNothing;
        }
    }
    for (Eigen::Index k = 0; k < count; ++k) {
        const auto& row = rows[static_cast<std::size_t>(k)];
        for (int i = 0; i < grid.nx; ++i) {
            const double before = k > 0 ? height_(i, k - 1) : kNothing;
            const double after = k + 1 < count ? height_(i, k + 1) : kNothing;
            slope_(i, k) = slope_of(before, height_(i, k), after, grid.dy);
            // A row that lies within the belt in part has its middle there.
            height_(i, k) += slope_(i, k) * (row.y - grid.y(row.row));
        }
    }
    by_row_ = height_.transpose();
}

SurfaceUnderBelt::Height SurfaceUnderBelt::at(int row, double x) const {
    const double place = x / grid_.ds + 0.5 * (grid_.nx - 1);
    if (!(place >= -kHalfCell) || !(place <= grid_.nx - 1 + kHalfCell)) return {kNothing, 0.0, 0.0};
    const int nearest = std::clamp(static_cast<int>(std::lround(place)), 0, grid_.nx - 1);
    const double cover =
        problem_.coverage[rows_[static_cast<std::size_t>(row)].row * grid_.nx + nearest];
    const int first = std::clamp(static_cast<int>(std::floor(place)) - 1, 0, grid_.nx - 4);
    const double t = place - first;
    if (grid_.nx >= 4 && t > 0.0 && t < 3.0) {
        const double* z = &height_(first, row);
        if (std::isfinite(z[0] + z[1] + z[2] + z[3])) {
            // Lagrange's cubic through four cells.
            const std::array<double, 4> l = {-(t - 1) * (t - 2) * (t - 3) / 6,
                                             t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2,
                                             t * (t - 1) * (t - 2) / 6};
            const std::array<double, 4> d = {
                -(3 * t * t - 12 * t + 11) / 6, (3 * t * t - 10 * t + 6) / 2,
                -(3 * t * t - 8 * t + 3) / 2, (3 * t * t - 6 * t + 2) / 6};
            Height h{0.0, 0.0, cover};
            for (std::size_t k = 0; k < 4; ++k) {
                h.z += l[k] * z[k];
                h.slope += d[k] * z[k] / grid_.ds;
            }
            return h;
        }
    }
    const double here = height_(nearest, row);
    if (!std::isfinite(here)) return {kNothing, 0.0, 0.0};
    const double before = nearest > 0 ? height_(nearest - 1, row) : kNothing;
    const double after = nearest + 1 < grid_.nx ? height_(nearest + 1, row) : kNothing;
    const double slope = slope_of(before, here, after, grid_.ds);
    return {here + slope * grid_.ds * (place - nearest), slope, cover};
}

std::vector<RidgePoint> SurfaceUnderBelt::ridge() const {
    std::vector<RidgePoint> points;
    double last = kNothing;
    for (int i = 0; i < grid_.nx; ++i) {
        Eigen::Index k = 0;
        if (!std::isfinite(height_.row(i).maxCoeff(&k))) continue;
        const double before = i > 0 ? height_(i - 1, k) : kNothing;
        const double after = i + 1 < grid_.nx ? height_(i + 1, k) : kNothing;
        const double slope = slope_of(before, height_(i, k), after, grid_.ds);
        const double root = std::sqrt(1.0 + slope * slope);
        const double x = grid_.s(i) - half_ * slope / root;
        if (!(x > last)) continue;  // in a hollow narrower than the belt is thick
        last = x;
        points.push_back({x, height_(i, k) + half_ / root, grid_.s(i)});
    }
    return points;
}

SurfaceUnderBelt::Height SurfaceUnderBelt::along_normal(int row, const BeltPath& path, int column,
                                                        double lift, double& u) const {
    const auto c = static_cast<std::size_t>(column);
    const double sine = std::sin(path.angle[c]), cosine = std::cos(path.angle[c]);
    Height h{};
    u = 0.0;
    for (int pass = 0; pass < kPasses; ++pass) {
        h = at(row, path.x[c] - u * sine);
        if (!(h.cover > 0.0)) break;
        const double facing = cosine + h.slope * sine;
        if (facing < kSteepest) {
            h.cover = 0.0;
            break;
        }
        const double off = path.z[c] + u * cosine - h.z - lift;
        u -= off / facing;
        if (sine == 0.0 || std::abs(off) < kExact) break;
    }
    return h;
}

void SurfaceUnderBelt::along_normals(const BeltPath& path, int column, double lift, int first,
                                     Normals& normals) const {
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const auto c = static_cast<std::size_t>(column);
    const double middle = path.x[c] / grid_.ds + 0.5 * (grid_.nx - 1);
    // Newton's differences, for t columns from the first one on.
    const auto z0 = by_row_.col(first), z1 = by_row_.col(first + 1), z2 = by_row_.col(first + 2),
               z3 = by_row_.col(first + 3);
    const Eigen::ArrayXd d1 = z1 - z0, d2 = 0.5 * (z2 - 2.0 * z1 + z0),
                         d3 = (z3 - 3.0 * z2 + 3.0 * z1 - z0) / 6.0;
    const double sine = std::sin(path.angle[c]), cosine = std::cos(path.angle[c]);
    Eigen::ArrayXd u = Eigen::ArrayXd::Zero(rows), slope(rows), t(rows), off(rows), facing(rows);
    for (int pass = 0; pass < kPasses; ++pass) {
        t = (middle - first) - sine / grid_.ds * u;
        slope = (d1 + (2.0 * t - 1.0) * d2 + (3.0 * t * (t - 2.0) + 2.0) * d3) / grid_.ds;
        facing = cosine + sine * slope;
        off = (path.z[c] - lift) + cosine * u - (z0 + t * (d1 + (t - 1.0) * (d2 + (t - 2.0) * d3)));
        u -= off / facing;
        if (sine == 0.0) break;
        bool exact = true;
        for (Eigen::Index k = 0; k < rows; ++k) exact = exact && !(std::abs(off[k]) >= kExact);
        if (exact) break;
    }
    const Eigen::ArrayXd place = middle - sine / grid_.ds * u;
    // The cubic of other columns would be met beyond the middle ones, but for those at the ends.
    const double low = first == 0 ? 0.0 : first + 1.0;
    const double high = first == grid_.nx - 4 ? grid_.nx - 1.0 : first + 2.0;
    for (Eigen::Index k = 0; k < rows; ++k) {
        if (!(place[k] >= low && place[k] <= high && facing[k] >= kSteepest)) continue;
        normals.found[static_cast<std::size_t>(k)] = 1;
        normals.u[k] = u[k];
        normals.place[k] = place[k];
        normals.slope[k] = slope[k];
    }
}

void SurfaceUnderBelt::along_normals(const BeltPath& path, int column, double lift,
                                     Normals& normals) const {
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    normals.found.assign(rows_.size(), 0);
    for (Eigen::ArrayXd* one : {&normals.u, &normals.place, &normals.slope}) one->resize(rows);
    const double middle =
        path.x[static_cast<std::size_t>(column)] / grid_.ds + 0.5 * (grid_.nx - 1);
    if (grid_.nx < 4 || !(middle >= 0.0) || !(middle <= grid_.nx - 1)) return;
    const int first = std::clamp(static_cast<int>(std::floor(middle)) - 1, 0, grid_.nx - 4);
    along_normals(path, column, lift, first, normals);
    if (std::find(normals.found.begin(), normals.found.end(), 0) == normals.found.end()) return;
    // Normals lean over the next column's middle; which side, the path's nearest column tells.
    const int other = middle - std::floor(middle) < 0.5 ? first - 1 : first + 1;
    if (other >= 0 && other <= grid_.nx - 4) along_normals(path, column, lift, other, normals);
}

BeltGap SurfaceUnderBelt::seen_from(const BeltPath& path, double lift) const {
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const int n = path.columns.count();
    BeltGap gap;
    gap.reach.setConstant(rows, n, kNothing);
    gap.cover.setZero(rows, n);
    Normals normals;
    Eigen::ArrayXd across(rows), facing(rows), reach(rows);
    for (int i = 0; i < n; ++i) {
        const auto c = static_cast<std::size_t>(i);
        if (const double place = path.x[c] / grid_.ds + 0.5 * (grid_.nx - 1);
            !(place >= -kHalfCell) || !(place <= grid_.nx - 1 + kHalfCell))
            continue;  // beside the map
        const double sine = std::sin(path.angle[c]), cosine = std::cos(path.angle[c]);
        along_normals(path, i, lift, normals);
        for (Eigen::Index k = 0; k < rows; ++k) {
            const auto row = static_cast<std::size_t>(k);
            int cell = 0;
            if (normals.found[row] != 0) {
                cell = static_cast<int>(std::lround(normals.place[k]));
                gap.cover(k, i) = problem_.coverage[rows_[row].row * grid_.nx + cell];
            } else {
                const Height h = along_normal(static_cast<int>(k), path, i, lift, normals.u[k]);
                cell = std::clamp(
                    static_cast<int>(std::lround((path.x[c] - normals.u[k] * sine) / grid_.ds +
                                                 0.5 * (grid_.nx - 1))),
                    0, grid_.nx - 1);
                normals.slope[k] = h.slope;
                gap.cover(k, i) = h.cover;
            }
            across[k] = slope_(cell, k);
        }
        // The middle surface lies half a thickness off, along the surface's own normal.
        facing = (cosine + normals.slope * sine) /
                 (1.0 + normals.slope.square() + across.square()).sqrt();
        reach = normals.u + half_ / facing;
        for (Eigen::Index k = 0; k < rows; ++k) {
            if (gap.cover(k, i) > 0.0 && !(facing[k] < kSteepest))
                gap.reach(k, i) = reach[k];
            else
                gap.cover(k, i) = 0.0;
        }
    }
    return gap;
}

}  // namespace beltgrinding
