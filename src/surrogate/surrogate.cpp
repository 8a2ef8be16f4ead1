#include "surrogate/surrogate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "beltgrinding/error.h"
#include "contact/peak_pressure.h"

namespace beltgrinding {
namespace {

constexpr float kDeepest = 0.05f;  // interference below zero that the features still tell apart
constexpr double kFarthest = 1.2;  // rim thicknesses from which a side face is far
constexpr int kMaxPredictions = 30;
constexpr double kForceTolerance = 1e-3;
constexpr double kSmallestBracket = 1e-4;
constexpr double kLargestJump = 0.03;
constexpr double kFirstApproach = 0.3;  // mm
constexpr double kUsualExponent = 1.6;  // of force against approach
constexpr int kBatch = 512;             // cells that are predicted at once

/// Integral image of a field on a grid; means over boxes in millimetres, of `outside` beyond it.
class BoxMeans {
  public:
    BoxMeans(const ContactGrid& grid, const Eigen::ArrayXf& values, double outside)
        : grid_(grid),
          outside_(outside),
          sums_(static_cast<std::size_t>(grid.nx + 1) * static_cast<std::size_t>(grid.ny + 1),
                0.0) {
        for (int j = 0; j < grid.ny; ++j) {
            double row = 0.0;
            for (int i = 0; i < grid.nx; ++i) {
                row += values[j * grid.nx + i] - outside;
                sums_[at(i + 1, j + 1)] = sums_[at(i + 1, j)] + row;
            }
        }
    }
    /// Mean over the box of side `side` around (s, y), both counted from the grid's corner, mm.
    double mean(double s, double y, double side) const {
        const double left = (s - 0.5 * side) / grid_.ds, right = (s + 0.5 * side) / grid_.ds;
        const double low = (y - 0.5 * side) / grid_.dy, high = (y + 0.5 * side) / grid_.dy;
        const double total = sum(right, high) - sum(left, high) - sum(right, low) + sum(left, low);
        return outside_ + total * grid_.cell_area() / (side * side);
    }

  private:
    std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.nx + 1) +
               static_cast<std::size_t>(i);
    }
    double sum(double u, double v) const {
        u = std::clamp(u, 0.0, static_cast<double>(grid_.nx));
        v = std::clamp(v, 0.0, static_cast<double>(grid_.ny));
        const int i = std::min(static_cast<int>(u), grid_.nx - 1);
        const int j = std::min(static_cast<int>(v), grid_.ny - 1);
        const double a = u - i, b = v - j;
        return (1.0 - b) * ((1.0 - a) * sums_[at(i, j)] + a * sums_[at(i + 1, j)]) +
               b * ((1.0 - a) * sums_[at(i, j + 1)] + a * sums_[at(i + 1, j + 1)]);
    }

    const ContactGrid& grid_;
    double outside_;
    std::vector<double> sums_;
};

double lowest_gap(const ContactProblem& problem) {
    return (problem.coverage > 0.0)
        .select(problem.gap, std::numeric_limits<double>::infinity())
        .minCoeff();
}

void check(const ContactGrid& grid, const ContactProblem& problem) {
    if (problem.gap.size() != grid.cells() || problem.coverage.size() != grid.cells()) {
        throw std::invalid_argument("surrogate: the contact is of another grid");
    }
}

}  // namespace

int ContactFeatures::levels() const {
    int levels = 1;
    for (double side = cell; side < rim_thickness && levels < 8; side *= 2.0) ++levels;
    return levels;
}

int ContactFeatures::size() const {
    return 1 + 1 + 8 * levels() + 2;
}

std::vector<int> ContactFeatures::candidates(const ContactGrid& grid, const ContactProblem& problem,
                                             double approach) const {
    check(grid, problem);
    const double greatest = approach - lowest_gap(problem);
    std::vector<int> cells;
    for (int k = 0; k < grid.cells(); ++k) {
        if (problem.coverage[k] > 0.0 && approach - problem.gap[k] > -kDeepest * greatest) {
            cells.push_back(k);
        }
    }
    return cells;
}

Eigen::MatrixXf ContactFeatures::of(const ContactGrid& grid, const ContactProblem& problem,
                                    double approach, const std::vector<int>& cells) const {
    check(grid, problem);
    for (const int k : cells) {
        if (k < 0 || k >= grid.cells()) {
            throw std::invalid_argument("surrogate: a cell is not of the contact's grid");
        }
    }
    const double greatest = approach - lowest_gap(problem);
    Eigen::ArrayXf depth(grid.cells()), covered(grid.cells());
    for (int k = 0; k < grid.cells(); ++k) {
        const double relative = (approach - problem.gap[k]) / greatest;  // -inf where nothing is
        depth[k] = std::clamp(static_cast<float>(relative), -kDeepest, 1.0f);
        const auto share = static_cast<float>(problem.coverage[k]);
        covered[k] = share * depth[k] - (1.0f - share) * kDeepest;
    }
    const BoxMeans boxes(grid, covered, -kDeepest);
    Eigen::MatrixXf result(size(), static_cast<Eigen::Index>(cells.size()));
    for (Eigen::Index column = 0; column < result.cols(); ++column) {
        const int k = cells[static_cast<std::size_t>(column)];
        const int i = k % grid.nx, j = k / grid.nx;
        const double s = (i + 0.5) * grid.ds, y = (j + 0.5) * grid.dy;
        int row = 0;
        const auto put = [&](double value) { result(row++, column) = static_cast<float>(value); };
        put(depth[k]);
        put(boxes.mean(s, y, cell));
        double side = cell;
        for (int level = 0; level < levels(); ++level, side *= 2.0) {
            for (int b = -1; b <= 1; ++b) {
                for (int a = -1; a <= 1; ++a) {
                    if (a != 0 || b != 0) put(boxes.mean(s + a * side, y + b * side, side));
                }
            }
        }
        put(std::min(y / rim_thickness, kFarthest));
        put(std::min((grid.ny * grid.dy - y) / rim_thickness, kFarthest));
    }
    return result;
}

namespace {

class PreparedSurrogate final : public PreparedContact {
  public:
    PreparedSurrogate(const ContactGrid& grid, std::string description, ContactFeatures features,
                      std::shared_ptr<const TrainedRegression> regression)
        : PreparedContact(grid, std::move(description)),
          features_(features),
          regression_(std::move(regression)) {}

  private:
    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd*) override;
    Eigen::ArrayXd predict(const ContactProblem& problem, double approach) const;

    ContactFeatures features_;
    std::shared_ptr<const TrainedRegression> regression_;
};

Eigen::ArrayXd PreparedSurrogate::predict(const ContactProblem& problem, double approach) const {
    Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(problem.gap.size());
    const double greatest = approach - lowest_gap(problem);
    if (!(greatest > 0.0)) return pressure;
    const std::vector<int> all = features_.candidates(grid(), problem, approach);
    for (std::size_t first = 0; first < all.size(); first += kBatch) {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<int> cells(
            begin,
            begin + static_cast<std::ptrdiff_t>(std::min<std::size_t>(kBatch, all.size() - first)));
        const Eigen::VectorXf values =
            regression_->predict(features_.of(grid(), problem, approach, cells));
        for (std::size_t k = 0; k < cells.size(); ++k) {
            pressure[cells[k]] = greatest * std::max(0.0f, values[static_cast<Eigen::Index>(k)]);
        }
    }
    return pressure;
}

ContactSolution PreparedSurrogate::do_solve(const ContactProblem& problem, const Eigen::ArrayXd*) {
    ContactSolution solution;
    solution.pressure = Eigen::ArrayXd::Zero(problem.gap.size());
    solution.approach = problem.force_control ? 0.0 : problem.approach;
    const double lowest = lowest_gap(problem);
    if (!std::isfinite(lowest) || (problem.force_control && problem.force == 0.0)) {
        solution.converged = !problem.force_control || problem.force == 0.0;
        return solution;
    }
    const Eigen::ArrayXd weight = problem.coverage * grid().cell_area();
    // By what the force at this approach is too large: force control, or a robot that gives way.
    const auto excess = [&](double approach) {
        solution.pressure = predict(problem, approach);
        solution.force = (weight * solution.pressure).sum();
        ++solution.iterations;
        return problem.force_control
                   ? solution.force - problem.force
                   : approach + problem.robot_compliance * solution.force - problem.approach;
    };
    double low = lowest, high = lowest;  // approaches with too little force, and with too much
    double approach = lowest + kFirstApproach;
    if (!problem.force_control) approach = problem.approach;
    const double wanted = problem.force_control ? problem.force : problem.approach - lowest;
    if (!problem.force_control && wanted <= 0.0) {
        solution.converged = true;
        return solution;
    }
    while (solution.iterations < kMaxPredictions) {
        const double off = excess(approach);
        if (std::abs(off) <= kForceTolerance * wanted) {
            solution.converged = true;
            break;
        }
        (off > 0.0 ? high : low) = approach;
        // A regression is no monotone function: it may jump past the force.
        if (high > low && high - low < kSmallestBracket * (approach - lowest)) {
            solution.converged = std::abs(off) <= kLargestJump * wanted;
            break;
        }
        // The force is about a power of the indentation; within the bracket once there is one.
        double next = 0.5 * (low + high);
        if (problem.force_control) {
            const double ratio = std::clamp(wanted / std::max(solution.force, 1e-12), 0.01, 100.0);
            const double guess =
                lowest + (approach - lowest) * std::pow(ratio, 1.0 / kUsualExponent);
            if (high <= low || (guess > low && guess < high)) next = guess;
        }
        approach = next;
    }
    solution.approach = approach;
    if (problem.force_control && solution.force > 0.0) {
        solution.pressure *= problem.force / solution.force;
        solution.force = problem.force;
    }
    solution.area = (solution.pressure > 0.0).select(weight, 0.0).sum();
    solution.peak_pressure = peak_pressure(grid(), solution.pressure, problem.coverage);
    return solution;
}

}  // namespace

Surrogate::Surrogate(ContactFeatures features, TrainedRegression regression, std::string name)
    : features_(features), name_(std::move(name)) {
    if (!(features_.cell > 0.0) || !(features_.rim_thickness > 0.0)) {
        throw InputError("surrogate.sizes",
                         "surrogate: its cell and rim thickness must be positive");
    }
    regression.validate(features_.size());
    regression_ = std::make_shared<const TrainedRegression>(std::move(regression));
}

std::unique_ptr<PreparedContact> Surrogate::do_prepare(const ContactGrid& grid) const {
    return std::make_unique<PreparedSurrogate>(grid, describe(), features_, regression_);
}

}  // namespace beltgrinding
