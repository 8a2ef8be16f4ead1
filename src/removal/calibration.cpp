#include "removal/calibration.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <vector>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// Hampel's parts, in scatters: up to the first a row counts in full, up to the second with the same
// pull, and from the third on not at all.
constexpr double kFull = 3.0, kLevel = 5.0, kNone = 8.0;
constexpr double kMad = 1.4826;         // median of |r| to deviation, for a normal r
constexpr double kLeastScatter = 1e-4;  // a table without scatter is not without rounding
constexpr double kNearBound = 1e-3;     // of the range
constexpr double kConverged = 1e-6;
constexpr double kMostLeverage = 0.95;
constexpr Eigen::Index kFreedomOfSandwich = 6;
constexpr int kMostIterations = 200;
constexpr int kHuberIterations = 10;  // the loss has local minima: come near them convexly
constexpr double kWinsor =
    3.0;  // deviations, beyond which a residual counts no more in the scatter
// The median may jump to and fro between two residuals for ever: from then on it stays.
constexpr int kScatterIterations = 60;
constexpr double kHuber = 1.345;

/// psi(z) / z of Hampel's loss at z >= 0 scatters.
double weight_of(double z) {
    if (z <= kFull) return 1.0;
    if (z <= kLevel) return kFull / z;
    return z < kNone ? kFull * (kNone - z) / ((kNone - kLevel) * z) : 0.0;
}

/// d psi / dz.
double curvature_of(double z) {
    if (z <= kFull) return 1.0;
    return z <= kLevel || z >= kNone ? 0.0 : -kFull / (kNone - kLevel);
}

/// The loss itself, whose derivative is psi.
double loss_of(double z) {
    if (z <= kFull) return 0.5 * z * z;
    const double full = 0.5 * kFull * kFull;
    if (z <= kLevel) return full + kFull * (z - kFull);
    const double left = std::max(kNone - z, 0.0), part = kNone - kLevel;
    return full + kFull * (kLevel - kFull) + 0.5 * kFull * (part - left * left / part);
}

/// A row under one of the areas that it can have.
struct Candidate {
    Eigen::Index row;
    Eigen::Index level;  // in `areas`, or -1 if the area is known
    double area;
    double posterior;
    double weight = 1.0;
};

/// Free parameters x = lower + (upper - lower) (1 + sin u) / 2.
class Bounds {
  public:
    explicit Bounds(const CalibrationSettings& settings) : settings_(settings) {
        for (int k = 0; k < kGrindParameters; ++k) {
            if (!settings.free[static_cast<std::size_t>(k)]) continue;
            const bool sound = settings.lower[k] < settings.upper[k] &&
                               std::isfinite(settings.lower[k] + settings.upper[k]);
            if (!sound)
                throw InputError("calibration.bounds",
                                 "calibration: bounds of a parameter are not in order");
            indices_.push_back(k);
        }
    }
    const std::vector<int>& indices() const { return indices_; }
    int size() const { return static_cast<int>(indices_.size()); }

    Eigen::VectorXd inner(const GrindVector& outer) const {
        Eigen::VectorXd u(size());
        for (int j = 0; j < size(); ++j) {
            const int k = indices_[static_cast<std::size_t>(j)];
            const double share = 2.0 * (outer[k] - settings_.lower[k]) / range(k) - 1.0;
            // At +-1 the sine is flat: a start there would stay.
            u[j] = std::asin(std::clamp(share, -0.98, 0.98));
        }
        return u;
    }
    GrindVector outer(const Eigen::VectorXd& u) const {
        GrindVector x = settings_.start;
        for (int j = 0; j < size(); ++j) {
            const int k = indices_[static_cast<std::size_t>(j)];
            x[k] = settings_.lower[k] + 0.5 * range(k) * (1.0 + std::sin(u[j]));
        }
        return x;
    }
    double slope(const Eigen::VectorXd& u, int j) const {
        return 0.5 * range(indices_[static_cast<std::size_t>(j)]) * std::cos(u[j]);
    }
    bool at_bound(const GrindVector& x, int k) const {
        const double near = kNearBound * range(k);
        return x[k] < settings_.lower[k] + near || x[k] > settings_.upper[k] - near;
    }

  private:
    double range(int k) const { return settings_.upper[k] - settings_.lower[k]; }
    const CalibrationSettings& settings_;
    std::vector<int> indices_;
};

struct WeightedResiduals : Eigen::DenseFunctor<double> {
    WeightedResiduals(const MeasuredGrinds& measured, const GrindReferences& at,
                      const Bounds& limits, const std::vector<Candidate>& rows,
                      const CalibrationSettings& before, double scatter)
        : DenseFunctor<double>(limits.size(), static_cast<int>(rows.size()) + limits.size()),
          grinds(measured),
          references(at),
          bounds(limits),
          candidates(rows),
          settings(before),
          deviation(scatter) {}

    int operator()(const Eigen::VectorXd& u, Eigen::VectorXd& r) const {
        const GrindVector x = bounds.outer(u);
        const auto rows = static_cast<Eigen::Index>(candidates.size());
        for (int j = 0; j < bounds.size(); ++j) {
            const int k = bounds.indices()[static_cast<std::size_t>(j)];
            r[rows + j] = pull(k) * (x[k] - settings.prior_mean[k]);
        }
        for (Eigen::Index c = 0; c < rows; ++c) {
            const Candidate& one = candidates[static_cast<std::size_t>(c)];
            r[c] = std::sqrt(one.posterior * one.weight) *
                   (log_grind(x, references, grinds, one.row, one.area, nullptr) -
                    std::log(grinds.measured[one.row]));
        }
        return 0;
    }
    int df(const Eigen::VectorXd& u, Eigen::MatrixXd& jacobian) const {
        const GrindVector x = bounds.outer(u);
        GrindVector gradient;
        const auto rows = static_cast<Eigen::Index>(candidates.size());
        jacobian.bottomRows(bounds.size()).setZero();
        for (int j = 0; j < bounds.size(); ++j) {
            jacobian(rows + j, j) =
                pull(bounds.indices()[static_cast<std::size_t>(j)]) * bounds.slope(u, j);
        }
        for (Eigen::Index c = 0; c < rows; ++c) {
            const Candidate& one = candidates[static_cast<std::size_t>(c)];
            log_grind(x, references, grinds, one.row, one.area, &gradient);
            const double root = std::sqrt(one.posterior * one.weight);
            for (int j = 0; j < bounds.size(); ++j) {
                jacobian(c, j) = root * gradient[bounds.indices()[static_cast<std::size_t>(j)]] *
                                 bounds.slope(u, j);
            }
        }
        return 0;
    }

    const MeasuredGrinds& grinds;
    const GrindReferences& references;
    const Bounds& bounds;
    const std::vector<Candidate>& candidates;
    const CalibrationSettings& settings;
    double deviation;

  private:
    /// Weight of what is known of a parameter before, relative to a row.
    double pull(int k) const { return deviation / settings.prior_deviation[k]; }
};

/// Median of `values` under `weights`; sorts the pairs.
double weighted_median(std::vector<std::pair<double, double>>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    double total = 0.0, sum = 0.0;
    for (const auto& [value, weight] : pairs) total += weight;
    for (const auto& [value, weight] : pairs) {
        sum += weight;
        if (sum >= 0.5 * total) return value;
    }
    return pairs.back().first;
}

class Fit {
  public:
    Fit(const MeasuredGrinds& grinds, const GrindReferences& references,
        const CalibrationSettings& settings)
        : grinds_(grinds), references_(references), settings_(settings), bounds_(settings) {
        const Eigen::Index n = grinds.measured.size(), levels = grinds.areas.size();
        if (n <= bounds_.size()) {
            throw InputError(
                "calibration.too_few",
                "calibration: {grinds} grinds cannot tell {parameters} parameters; measure more",
                {{"grinds", n}, {"parameters", bounds_.size()}});
        }
        counts_ = Eigen::ArrayXd::Zero(levels);
        for (Eigen::Index i = 0; i < n; ++i) {
            if (!std::isnan(grinds.area[i])) {
                candidates_.push_back({i, -1, grinds.area[i], 1.0});
                if (levels > 0) counts_[nearest(grinds.area[i])] += 1.0;
                continue;
            }
            for (Eigen::Index k = 0; k < levels; ++k) {
                candidates_.push_back({i, k, grinds.areas[k], 1.0 / static_cast<double>(levels)});
            }
        }
        shares_ = (counts_ + 0.5) / (counts_ + 0.5).sum();
        for (Candidate& one : candidates_) {
            if (one.level >= 0) one.posterior = shares_[one.level];
        }
        x_ = settings.start;
        residual_.resize(candidates_.size());
    }

    Calibration run() {
        Calibration result;
        Eigen::VectorXd u = bounds_.inner(x_);
        for (int i = 0; i < kMostIterations; ++i) {
            const GrindVector before = x_;
            solve(u);
            x_ = bounds_.outer(u);
            reweigh(i < kHuberIterations, i < kScatterIterations);
            result.iterations = i + 1;
            // Parameters may be infinite (no wear, no saturation) where they are fixed.
            double change = 0.0;
            for (const int k : bounds_.indices()) {
                change = std::max(change, std::abs(x_[k] - before[k]) / (1.0 + std::abs(x_[k])));
            }
            if (i > kHuberIterations && change < kConverged) {
                result.converged = true;
                break;
            }
        }
        finish(result);
        return result;
    }

  private:
    Eigen::Index nearest(double area) const {
        Eigen::Index k = 0;
        (grinds_.areas.log() - std::log(area)).abs().minCoeff(&k);
        return k;
    }

    void solve(Eigen::VectorXd& u) {
        if (bounds_.size() == 0) return;
        WeightedResiduals functor(grinds_, references_, bounds_, candidates_, settings_, scatter_);
        Eigen::LevenbergMarquardt<WeightedResiduals> solver(functor);
        solver.setMaxfev(100);
        solver.setFtol(1e-10);
        solver.setXtol(1e-10);
        solver.minimize(u);
        if (!u.allFinite())
            throw InputError("calibration.not_converged", "calibration: the fit does not converge");
    }

    /// Residuals, scatter, weights, and the probabilities of unknown areas.
    void reweigh(bool convex, bool rescale) {
        std::vector<std::pair<double, double>> sizes;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const Candidate& one = candidates_[c];
            residual_[c] = std::log(grinds_.measured[one.row]) -
                           log_grind(x_, references_, grinds_, one.row, one.area, nullptr);
            sizes.emplace_back(std::abs(residual_[c]), one.posterior);
        }
        const double n = static_cast<double>(grinds_.measured.size());
        const double spare = std::max(n - bounds_.size(), 1.0);
        if (rescale) {
            scatter_ = kMad * weighted_median(sizes) * std::sqrt(n / spare);
            const double limit = kWinsor * scatter_;
            double squares = 0.0;
            for (const auto& [size, share] : sizes) {
                squares += share * std::pow(std::min(size, limit), 2);
            }
            scatter_ = std::max({scatter_, std::sqrt(squares / spare), kLeastScatter});
        }
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const double z = std::abs(residual_[c]) / scatter_;
            candidates_[c].weight =
                convex ? std::min(1.0, kHuber / std::max(z, 1e-12)) : weight_of(z);
        }
        if (shares_.size() > 0) estimate_areas();
    }

    void estimate_areas() {
        Eigen::ArrayXd counts = counts_;
        for (std::size_t c = 0; c < candidates_.size();) {
            if (candidates_[c].level < 0) {
                ++c;
                continue;
            }
            const std::size_t end = c + static_cast<std::size_t>(shares_.size());
            double sum = 0.0;
            for (std::size_t d = c; d < end; ++d) {
                candidates_[d].posterior = likelihood(d);
                sum += candidates_[d].posterior;
            }
            for (std::size_t d = c; d < end; ++d) {
                candidates_[d].posterior =
                    sum > 0.0 ? candidates_[d].posterior / sum : shares_[candidates_[d].level];
                counts[candidates_[d].level] += candidates_[d].posterior;
            }
            c = end;
        }
        shares_ = counts / counts.sum();
    }

    /// Of a candidate, with the share of its area, without the factor 1 / (scatter sqrt(2 pi)).
    double likelihood(std::size_t c) const {
        const Candidate& one = candidates_[c];
        const double share = one.level < 0 ? 1.0 : shares_[one.level];
        return share * std::exp(-loss_of(std::abs(residual_[c]) / scatter_));
    }

    void finish(Calibration& result) const {
        const Eigen::Index n = grinds_.measured.size();
        result.parameters = x_;
        result.scatter = scatter_;
        result.shares = shares_;
        result.residual = result.weight = Eigen::ArrayXd::Zero(n);
        result.posterior =
            Eigen::ArrayXXd::Zero(n, std::max<Eigen::Index>(1, grinds_.areas.size()));
        std::vector<int> open;
        for (const int k : bounds_.indices()) {
            result.at_bound[static_cast<std::size_t>(k)] = bounds_.at_bound(x_, k);
            if (!bounds_.at_bound(x_, k)) open.push_back(k);
        }
        const auto p = static_cast<Eigen::Index>(open.size());
        const std::vector<int>& free = bounds_.indices();
        GrindMatrix information = GrindMatrix::Zero();
        Eigen::MatrixXd bread = Eigen::MatrixXd::Zero(p, p);
        Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(p, n), slopes = scores;
        Eigen::ArrayXd likelihoods = Eigen::ArrayXd::Zero(n);
        GrindVector gradient;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const Candidate& one = candidates_[c];
            log_grind(x_, references_, grinds_, one.row, one.area, &gradient);
            const Eigen::VectorXd j = gradient(open);
            const double z = std::abs(residual_[c]) / scatter_, weight = weight_of(z);
            const double curvature = curvature_of(z), psi = residual_[c] * weight;
            information += one.posterior * weight * gradient * gradient.transpose();
            likelihoods[one.row] += likelihood(c);
            bread += one.posterior * curvature * j * j.transpose();
            if (one.level >= 0) {  // Louis: what is not known of the area is no information
                bread -= one.posterior * std::pow(psi / scatter_, 2) * j * j.transpose();
            }
            scores.col(one.row) += one.posterior * psi * j;
            slopes.col(one.row) += one.posterior * j;
            result.residual[one.row] += one.posterior * residual_[c];
            result.weight[one.row] += one.posterior * weight;
            result.posterior(one.row, std::max<Eigen::Index>(one.level, 0)) = one.posterior;
        }
        for (Eigen::Index i = 0; i < n; ++i) {
            if (std::isnan(grinds_.area[i])) {
                const Eigen::VectorXd score = scores.col(i) / scatter_;
                bread += score * score.transpose();
            }
        }
        result.log_likelihood =
            likelihoods.log().sum() - static_cast<double>(n) * std::log(scatter_);
        result.information.setZero();
        result.information(free, free) = information(free, free);
        result.covariance.setZero();
        if (p == 0) return;
        if (Eigen::LLT<Eigen::MatrixXd>(bread).info() != Eigen::Success) {
            bread = information(open, open);
        }
        const double variance = scatter_ * scatter_;
        Eigen::VectorXd prior(p);
        for (Eigen::Index j = 0; j < p; ++j) {
            const double ratio =
                scatter_ / settings_.prior_deviation[open[static_cast<std::size_t>(j)]];
            prior[j] = ratio * ratio;
        }
        bread += prior.asDiagonal();
        const Eigen::MatrixXd inverse = bread.completeOrthogonalDecomposition().pseudoInverse();
        Eigen::MatrixXd meat = variance * Eigen::MatrixXd(prior.asDiagonal());
        for (Eigen::Index i = 0; i < n; ++i) {
            const double leverage = slopes.col(i).dot(inverse * slopes.col(i));
            const double rest = 1.0 - std::clamp(leverage, 0.0, kMostLeverage);
            meat += scores.col(i) * scores.col(i).transpose() / (rest * rest);
        }
        const bool few = n - static_cast<Eigen::Index>(free.size()) < kFreedomOfSandwich;
        if (few)
            result.covariance(open, open) = variance * inverse;
        else
            result.covariance(open, open) = inverse * meat * inverse;
    }

    const MeasuredGrinds& grinds_;
    const GrindReferences& references_;
    const CalibrationSettings& settings_;
    const Bounds bounds_;
    std::vector<Candidate> candidates_;
    std::vector<double> residual_;
    Eigen::ArrayXd counts_, shares_;
    GrindVector x_;
    double scatter_ = 1.0;
};

}  // namespace

Calibration calibrate(const MeasuredGrinds& grinds, const GrindReferences& references,
                      const CalibrationSettings& settings) {
    grinds.validate();
    return Fit(grinds, references, settings).run();
}

}  // namespace beltgrinding
