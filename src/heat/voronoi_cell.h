#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace beltgrinding {

/// A convex polygon round the origin in the plane, cut by one line after the other; its sides know
/// what they are borders to.
class VoronoiCell {
  public:
    static constexpr std::int64_t kNothing = -1;

    /// A square of 2 `half` a side, between nothing.
    explicit VoronoiCell(double half) : count_(4) {
        const std::array<Eigen::Vector2d, 4> corners = {
            Eigen::Vector2d{-half, -half}, {half, -half}, {half, half}, {-half, half}};
        for (std::size_t k = 0; k < count_; ++k) corner_[k] = {corners[k], kNothing};
    }
    /// Keeps what has direction . x <= limit; what is new of the border is to `number`.
    void cut(const Eigen::Vector2d& direction, double limit, std::int64_t number) {
        std::array<double, kMost> at;
        bool all = true;
        for (std::size_t k = 0; k < count_; ++k) {
            at[k] = direction.dot(corner_[k].at) - limit;
            all = all && at[k] <= 0.0;
        }
        if (all || count_ == kMost) return;
        std::array<Corner, kMost> kept;
        std::size_t count = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const std::size_t next = k + 1 < count_ ? k + 1 : 0;
            if (at[k] <= 0.0) kept[count++] = corner_[k];
            if ((at[k] <= 0.0) == (at[next] <= 0.0)) continue;
            const Eigen::Vector2d &a = corner_[k].at, &b = corner_[next].at;
            kept[count++] = {a + at[k] / (at[k] - at[next]) * (b - a),
                             at[k] <= 0.0 ? number : corner_[k].side};
        }
        corner_ = kept;
        count_ = count;
    }
    double area() const {
        double sum = 0.0;
        for_sides([&sum](const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::int64_t) {
            sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
        });
        return sum;
    }
    /// Borders on nothing.
    bool open() const {
        bool found = false;
        for (std::size_t k = 0; k < count_; ++k) found = found || corner_[k].side == kNothing;
        return found;
    }
    /// Of the farthest corner.
    double radius() const {
        double most = 0.0;
        for (std::size_t k = 0; k < count_; ++k) most = std::max(most, corner_[k].at.squaredNorm());
        return std::sqrt(most);
    }
    /// Calls visit(begin, end, what it is a border to).
    template <class Visit>
    void for_sides(Visit visit) const {
        for (std::size_t k = 0; k < count_; ++k)
            visit(corner_[k].at, corner_[k + 1 < count_ ? k + 1 : 0].at, corner_[k].side);
    }

  private:
    static constexpr std::size_t kMost =
        64;  // corners; cuts add one each, more of them are left out
    struct Corner {
        Eigen::Vector2d at;
        std::int64_t side = kNothing;  // from here to the next
    };
    std::array<Corner, kMost> corner_;
    std::size_t count_;
};

}  // namespace beltgrinding
