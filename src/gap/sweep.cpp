#include "gap/sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

constexpr int kMostPairs = 32;
constexpr double kWhole = 0.99;     // coverage of a cell that no edge crosses
constexpr double kShortest = 1e-6;  // cells: less is no way, and no place beside a cell's

/// Columns and rows of some cells.
struct Extent {
    int left, right, low, high;

    static Extent of(const ContactGrid& grid, const Eigen::ArrayXd& values) {
        Extent box{grid.nx, -1, grid.ny, -1};
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i) {
                if (values[j * grid.nx + i] == 0.0) continue;
                box = {std::min(box.left, i), std::max(box.right, i), std::min(box.low, j), j};
            }
        return box;
    }
};

/// Values between whole cells.
class Between {
  public:
    Between(const ContactGrid& grid, const Eigen::ArrayXd& coverage, const Eigen::ArrayXd& values)
        : grid_(grid), coverage_(coverage), values_(values) {}

    /// At a place in cells from the first one; false where an edge, or the wheel's side, is near.
    bool at(double column, double row, double& value) const {
        const int i = static_cast<int>(std::floor(column + kShortest));
        const int j = static_cast<int>(std::floor(row + kShortest));
        const double u = column - i, v = row - j;
        const int right = u > kShortest ? 1 : 0, up = v > kShortest ? 1 : 0;
        if (i < 0 || j < 0 || i + right >= grid_.nx || j + up >= grid_.ny) return false;
        const int a = j * grid_.nx + i, b = a + right, c = a + up * grid_.nx, d = c + right;
        for (const int cell : {a, b, c, d})
            if (coverage_[cell] < kWhole) return false;
        value = (1.0 - v) * ((1.0 - u) * values_[a] + u * values_[b]) +
                v * ((1.0 - u) * values_[c] + u * values_[d]);
        return true;
    }

  private:
    const ContactGrid& grid_;
    const Eigen::ArrayXd &coverage_, &values_;
};

}  // namespace

Eigen::Vector2d Sweep::way(double s, double y, double radius) const {
    const double angle = s / radius;
    return {moved.x() * std::cos(angle) - moved.z() * std::sin(angle) - turned.z() * y,
            moved.y() + turned.z() * s};
}

Eigen::ArrayXd Sweep::mean(const ContactGrid& grid, double radius, const Eigen::ArrayXd& coverage,
                           const Eigen::ArrayXd& values) const {
    const Extent box = Extent::of(grid, values);
    if (box.right < 0) return values;
    const Between between(grid, coverage, values);
    const Eigen::Vector2d middle =
        way(grid.s((box.left + box.right) / 2), grid.y((box.low + box.high) / 2), radius);
    const double cells = std::max(std::abs(middle.x()) / grid.ds, std::abs(middle.y()) / grid.dy);
    if (!(cells > kShortest)) return values;
    const int pairs = std::min(static_cast<int>(std::ceil(cells - kShortest)), kMostPairs);
    const int beyond = static_cast<int>(std::ceil(0.5 * cells)) + 1;
    const auto near = [beyond](int from, int to, int count) {
        return std::pair(std::max(from - beyond, 0), std::min(to + beyond, count - 1));
    };
    const auto [first, last] = near(box.left, box.right, grid.nx);
    const auto [low, high] = near(box.low, box.high, grid.ny);
    Eigen::ArrayXd mean = values;
    for (int j = low; j <= high; ++j) {
        for (int i = first; i <= last; ++i) {
            const int cell = j * grid.nx + i;
            if (!(coverage[cell] > 0.0)) continue;
            const Eigen::Vector2d passed = way(grid.s(i), grid.y(j), radius);
            const double along = passed.x() / grid.ds, across = passed.y() / grid.dy;
            double sum = 0.0;
            for (int k = 0; k < pairs; ++k) {
                const double share = 0.5 * (k + 0.5) / pairs;
                double before = values[cell], after = values[cell];
                // Both or none: else what a step takes would move along the surface.
                if (!between.at(i - share * along, j - share * across, before) ||
                    !between.at(i + share * along, j + share * across, after))
                    before = after = values[cell];
                sum += before + after;
            }
            mean[cell] = sum / (2 * pairs);
        }
    }
    return mean;
}

}  // namespace beltgrinding
