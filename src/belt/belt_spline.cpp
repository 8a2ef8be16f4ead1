#include "belt_spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace beltgrinding {
namespace {

constexpr int kDegree = 3;
constexpr double kGrowth = 1.5;  // of the intervals, from the side edge inwards

/// Lengths of the intervals of half the width, from the side edge inwards.
std::vector<double> half_intervals(double half, double interval, double finest) {
    std::vector<double> lengths;
    double sum = 0.0;
    for (double next = std::min(finest, interval); sum < half;
         next = std::min(kGrowth * next, interval)) {
        lengths.push_back(next);
        sum += next;
    }
    for (double& length : lengths) length *= half / sum;
    return lengths;
}

/// From side edge to side edge.
std::vector<double> lines_of(double width, double interval, double finest) {
    const std::vector<double> half = half_intervals(0.5 * width, interval, finest);
    std::vector<double> lines = {-0.5 * width};
    for (const double length : half) lines.push_back(lines.back() + length);
    lines.back() = 0.0;
    for (std::size_t k = half.size(); k-- > 0;) lines.push_back(-lines[k]);
    return lines;
}

}  // namespace

BeltSpline::BeltSpline(double width, double interval, double finest)
    : BeltSpline(lines_of(width, interval, finest)) {}

BeltSpline::BeltSpline(std::vector<double> given) : lines_(std::move(given)) {
    const std::vector<double>& lines = lines_;
    knots_.assign(kDegree, lines.front());
    knots_.insert(knots_.end(), lines.begin(), lines.end());
    knots_.insert(knots_.end(), kDegree, lines.back());

    const double gauss = std::sqrt(0.6);
    for (const auto [place, weight] :
         {std::array{-gauss, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {gauss, 5.0 / 9.0}}) {
        for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
            const double middle = 0.5 * (lines[k] + lines[k + 1]),
                         step = 0.5 * (lines[k + 1] - lines[k]);
            places_.push_back(middle + place * step);
            weights_.push_back(weight * step);
            locals_.push_back(at(places_.back()));
        }
    }
    for (Eigen::MatrixXd* m : {&values_, &slopes_, &curvatures_, &value_curvature_})
        m->setZero(count(), count());
    for (std::size_t q = 0; q < places_.size(); ++q) {
        const Local& b = locals_[q];
        for (int r = 0; r < kLocal; ++r) {
            for (int s = 0; s < kLocal; ++s) {
                const auto i = static_cast<std::size_t>(r), j = static_cast<std::size_t>(s);
                const int row = b.first + r, column = b.first + s;
                values_(row, column) += weights_[q] * b.value[i] * b.value[j];
                slopes_(row, column) += weights_[q] * b.slope[i] * b.slope[j];
                curvatures_(row, column) += weights_[q] * b.curvature[i] * b.curvature[j];
                value_curvature_(row, column) += weights_[q] * b.value[i] * b.curvature[j];
            }
        }
    }
}

Eigen::MatrixXd BeltSpline::from(const BeltSpline& other) const {
    // At the places of the one with more of them, where the products are all integrated.
    const BeltSpline& denser = places_.size() < other.places_.size() ? other : *this;
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(count(), count());
    Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(count(), other.count());
    for (std::size_t q = 0; q < denser.places_.size(); ++q) {
        const double y = denser.places_[q], w = denser.weights_[q];
        const Local a = at(y), b = other.at(y);
        for (std::size_t r = 0; r < kLocal; ++r)
            for (std::size_t s = 0; s < kLocal; ++s) {
                const auto row = static_cast<Eigen::Index>(r),
                           column = static_cast<Eigen::Index>(s);
                own(a.first + row, a.first + column) += w * a.value[r] * a.value[s];
                mixed(a.first + row, b.first + column) += w * a.value[r] * b.value[s];
            }
    }
    return own.llt().solve(mixed);
}

BeltSpline::Local BeltSpline::at(double y) const {
    // The interval that y lies in, the last one at the end.
    const auto last = static_cast<std::ptrdiff_t>(count()) - 1;
    const std::ptrdiff_t above =
        std::upper_bound(knots_.begin(), knots_.end(), y) - knots_.begin() - 1;
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above, kDegree, last));
    Local local;
    local.first = static_cast<int>(k) - kDegree;
    // Values of the degrees 0 to 3 by the recurrence of Cox and de Boor.
    std::array<std::array<double, kLocal>, kLocal> by_degree{};
    by_degree[0][0] = 1.0;
    for (std::size_t d = 1; d <= kDegree; ++d) {
        for (std::size_t r = 0; r <= d; ++r) {
            // Spline k - d + r of degree d, from those of degree d - 1.
            const std::size_t i = k - d + r;
            double sum = 0.0;
            if (r > 0)
                sum += (y - knots_[i]) / (knots_[i + d] - knots_[i]) * by_degree[d - 1][r - 1];
            if (r < d)
                sum += (knots_[i + d + 1] - y) / (knots_[i + d + 1] - knots_[i + 1]) *
                       by_degree[d - 1][r];
            by_degree[d][r] = sum;
        }
    }
    local.value = by_degree[kDegree];
    // A derivative is a difference of two of the degree below.
    const auto derive = [&](std::size_t d, const std::array<double, kLocal>& below) {
        std::array<double, kLocal> result{};
        const auto degree = static_cast<double>(d);
        for (std::size_t r = 0; r <= d; ++r) {
            const std::size_t i = k - d + r;
            if (r > 0) result[r] += degree * below[r - 1] / (knots_[i + d] - knots_[i]);
            if (r < d) result[r] -= degree * below[r] / (knots_[i + d + 1] - knots_[i + 1]);
        }
        return result;
    };
    local.slope = derive(3, by_degree[2]);
    local.curvature = derive(3, derive(2, by_degree[1]));
    return local;
}

}  // namespace beltgrinding
