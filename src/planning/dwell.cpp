#include "planning/dwell.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "beltgrinding/error.h"
#include "normal_matrix.h"

namespace beltgrinding {
namespace {

constexpr double kInside = 0.01;      // of the way between the bounds, where the first x keeps
constexpr double kToBound = 0.995;    // of the way to a bound, at most, in a step
constexpr double kBarrierFall = 0.2;  // of the barrier, from one to the next
constexpr double kBarrierPower = 1.5;
constexpr double kSolvedFor = 10.0;  // times the barrier: so well a barrier's problem is solved
constexpr double kFirstBarrier = 0.1;
constexpr double kLoose = 1e-2;  // accuracy before the last reweighting
// Of half the band, beyond which deviations are let go of, one after the other: nearer and nearer
// to counting what is out.
constexpr double kReach[] = {1.0, 0.3, 0.1};
constexpr int kFurther = 3;      // reweightings by each but the first
constexpr double kGain = 0.001;  // of the weight, that has to come into the band
constexpr double kArmijo = 1e-4;
constexpr int kHalvings = 40;
constexpr double kRidge =
    1e-12;  // of the largest diagonal element, for motions that cannot be told apart

void refuse_unless(bool good, const char* name) {
    if (!good) {
        throw InputError("planning.arrays", "plan: {name} does not fit the ground field and path",
                         {{"name", std::string(name)}});
    }
}

/// What deviations cost, sample by sample: value, slope and curvature.
class Cost {
  public:
    Cost(const DwellProblem& problem, const DwellSettings& settings)
        : problem_(problem),
          settings_(settings),
          inner_(settings.inner_share * problem.half),
          weight_(problem.weight / problem.weight.sum()),
          trust_(Eigen::ArrayXd::Ones(problem.weight.size())) {}

    /// r; `reach`: of half the band.
    void reweigh(const Eigen::ArrayXd& e, double reach) {
        const Eigen::ArrayXd beyond = (e.abs() - problem_.half).max(0.0);
        trust_ = 1.0 / (1.0 + (beyond / (reach * problem_.half)).square());
    }
    /// Of the weight, in the band.
    double inside(const Eigen::ArrayXd& e) const {
        return (weight_ * (e.abs() <= problem_.half).cast<double>()).sum();
    }
    double value(const Eigen::ArrayXd& e) const {
        const Eigen::ArrayXd outer = (e.abs() - inner_).max(0.0);
        return 0.5 *
               (weight_ * trust_ *
                (settings_.inner_cost * e.square() + (1.0 - settings_.inner_cost) * outer.square()))
                   .sum();
    }
    Eigen::ArrayXd slope(const Eigen::ArrayXd& e) const {
        const Eigen::ArrayXd outer = (e.abs() - inner_).max(0.0);
        return weight_ * trust_ *
               (settings_.inner_cost * e + (1.0 - settings_.inner_cost) * outer * e.sign());
    }
    Eigen::ArrayXd curvature(const Eigen::ArrayXd& e) const {
        const Eigen::ArrayXd beyond = (e.abs() > inner_).cast<double>();
        return weight_ * trust_ * (settings_.inner_cost + (1.0 - settings_.inner_cost) * beyond);
    }

  private:
    const DwellProblem& problem_;
    const DwellSettings& settings_;
    Eigen::ArrayXd inner_;   // mm
    Eigen::ArrayXd weight_;  // sums to 1
    Eigen::ArrayXd trust_;   // r
};

/// The variables: motions that remove something and may change.
struct Variables {
    std::vector<std::uint32_t> motion;
    std::vector<char> chained;  // k and k + 1 are neighbours
    Eigen::ArrayXd lower, upper, pace, time_cost;

    explicit Variables(const DwellProblem& p) {
        for (std::size_t j = 0; j < p.influence->motions(); ++j) {
            const auto k = static_cast<Eigen::Index>(j);
            if (p.influence->first[j + 1] > p.influence->first[j] && p.upper[k] > p.lower[k]) {
                motion.push_back(static_cast<std::uint32_t>(j));
            }
        }
        const auto n = static_cast<Eigen::Index>(motion.size());
        lower.resize(n);
        upper.resize(n);
        pace.resize(n);
        time_cost = Eigen::ArrayXd::Zero(n);
        chained.assign(motion.size(), 0);
        for (Eigen::Index v = 0; v < n; ++v) {
            const auto at = static_cast<std::size_t>(v);
            const auto j = static_cast<Eigen::Index>(motion[at]);
            lower[v] = p.lower[j];
            upper[v] = p.upper[j];
            pace[v] = p.pace[j];
            if (p.time_cost.size() > 0) time_cost[v] = p.time_cost[j];
            chained[at] = static_cast<char>(v + 1 < n && motion[at + 1] == motion[at] + 1 &&
                                            p.pace[j] > 0.0 && p.pace[j + 1] > 0.0);
        }
        const double mean = n > 0 ? pace.mean() : 0.0;
        if (mean > 0.0) pace /= mean;
    }
};

/// One convex problem, for the weights as they are.
class Interior {
  public:
    Interior(const DwellProblem& problem, const DwellSettings& settings, const Variables& variables,
             NormalMatrix& normal, const RunContext& context)
        : settings_(settings),
          v_(variables),
          normal_(normal),
          context_(context),
          cost_(problem, settings) {
        const Eigen::ArrayXd span = v_.upper - v_.lower;
        x_ = Eigen::ArrayXd::Ones(v_.lower.size())
                 .max(v_.lower + kInside * span)
                 .min(v_.upper - kInside * span);
        excess_ = problem.excess - offset(problem);
        e_ = deviations(x_);
        const auto& first = normal_.weighted(cost_.curvature(e_));
        double trace = 0.0;
        for (Eigen::Index k = 0; k < x_.size(); ++k) trace += first.coeff(k, k);
        smoothing_ = settings.smoothing * trace / static_cast<double>(x_.size());
        look();
        scale_ = std::max(gradient_.abs().maxCoeff(), 1e-300);
        below_ = above_ = Eigen::ArrayXd::Constant(x_.size(), kFirstBarrier * scale_);
        below_ /= x_ - v_.lower;
        above_ /= v_.upper - x_;
        solver_.analyzePattern(first);
    }

    /// What `plan_dwell` finds; `factor` and `price` of the variables alone.
    DwellSolution run() {
        if (!settle(settings_.reweightings + 1, kReach[0])) {
            throw InputError("planning.not_solved",
                             "plan: the feeds were not found in {count} iterations; widen the "
                             "limits of feed, or raise the smoothing",
                             {{"count", settings_.iterations}});
        }
        DwellSolution best = found();
        if (settings_.reweightings > 0 && (v_.time_cost == 0.0).all()) {
            double most = cost_.inside(e_);
            for (const double reach : kReach) {
                if (reach == kReach[0]) continue;
                if (!settle(kFurther, reach)) break;
                if (cost_.inside(e_) <= most + kGain) break;
                most = cost_.inside(e_);
                best = found();
            }
        }
        best.iterations = iterations_;
        return best;
    }

  private:
    /// Solves for weights that follow the deviations; false where the iterations are used up.
    bool settle(int times, double reach) {
        for (int k = 0; k < times; ++k) {
            if (k > 0 || reach != kReach[0]) {
                cost_.reweigh(e_, reach);
                look();
            }
            const bool last = k + 1 == times;
            if (!solve(last ? settings_.accuracy : std::max(kLoose, settings_.accuracy))) {
                return false;
            }
        }
        return true;
    }
    DwellSolution found() const {
        DwellSolution solution;
        solution.factor = x_;
        solution.excess = e_;
        solution.price = below_ - above_;
        solution.residual = error(0.0);
        solution.objective = value_;
        return solution;
    }

    /// What motions that are given otherwise than they were change, mm.
    Eigen::ArrayXd offset(const DwellProblem& p) const {
        Eigen::ArrayXd change = Eigen::ArrayXd::Zero(p.excess.size());
        std::size_t next = 0;
        for (std::size_t j = 0; j < p.influence->motions(); ++j) {
            if (next < v_.motion.size() && v_.motion[next] == j) {
                ++next;
                continue;
            }
            const double more = p.lower[static_cast<Eigen::Index>(j)] - 1.0;
            if (more == 0.0) continue;
            for (std::size_t e = p.influence->first[j]; e < p.influence->first[j + 1]; ++e) {
                change[static_cast<Eigen::Index>(p.influence->sample[e])] +=
                    more * p.influence->depth[e];
            }
        }
        return change;
    }
    Eigen::ArrayXd deviations(const Eigen::ArrayXd& x) const {
        return excess_ - normal_.forward(x - 1.0);
    }
    double value(const Eigen::ArrayXd& x, const Eigen::ArrayXd& e) const {
        double sum = 0.0;
        for (Eigen::Index k = 0; k + 1 < x.size(); ++k) {
            if (v_.chained[static_cast<std::size_t>(k)] == 0) continue;
            const double step = v_.pace[k + 1] * x[k + 1] - v_.pace[k] * x[k];
            sum += step * step;
        }
        return cost_.value(e) + 0.5 * smoothing_ * sum + (v_.time_cost * x).sum();
    }
    /// Sets value and gradient at x.
    void look() {
        value_ = value(x_, e_);
        Eigen::ArrayXd& g = gradient_;
        g = v_.time_cost - normal_.transposed(cost_.slope(e_));
        for (Eigen::Index k = 0; k + 1 < x_.size(); ++k) {
            if (v_.chained[static_cast<std::size_t>(k)] == 0) continue;
            const double step = smoothing_ * (v_.pace[k + 1] * x_[k + 1] - v_.pace[k] * x_[k]);
            g[k + 1] += v_.pace[k + 1] * step;
            g[k] -= v_.pace[k] * step;
        }
    }
    NormalMatrix::Matrix hessian() {
        NormalMatrix::Matrix h = normal_.weighted(cost_.curvature(e_));
        double largest = 0.0;
        for (Eigen::Index k = 0; k < x_.size(); ++k) {
            largest = std::max(largest, h.coeffRef(k, k));
        }
        for (Eigen::Index k = 0; k < x_.size(); ++k) {
            h.coeffRef(k, k) += kRidge * largest;
            if (k + 1 == x_.size() || v_.chained[static_cast<std::size_t>(k)] == 0) continue;
            h.coeffRef(k, k) += smoothing_ * v_.pace[k] * v_.pace[k];
            h.coeffRef(k + 1, k + 1) += smoothing_ * v_.pace[k + 1] * v_.pace[k + 1];
            h.coeffRef(k + 1, k) -= smoothing_ * v_.pace[k] * v_.pace[k + 1];
        }
        return h;
    }
    double error(double barrier) const {
        const Eigen::ArrayXd dual = gradient_ - below_ + above_;
        const Eigen::ArrayXd low = below_ * (x_ - v_.lower) - barrier;
        const Eigen::ArrayXd high = above_ * (v_.upper - x_) - barrier;
        return std::max({dual.abs().maxCoeff(), low.abs().maxCoeff(), high.abs().maxCoeff()}) /
               scale_;
    }
    double walls(const Eigen::ArrayXd& x, double barrier) const {
        return -barrier * ((x - v_.lower).log() + (v_.upper - x).log()).sum();
    }

    bool solve(double accuracy) {
        double barrier =
            std::max((below_ * (x_ - v_.lower) + above_ * (v_.upper - x_)).mean() * 0.5,
                     1e-3 * accuracy * scale_);
        while (error(0.0) > accuracy) {
            const double least = 0.1 * accuracy * scale_;
            while (error(barrier) <= kSolvedFor * barrier / scale_ && barrier > least) {
                barrier =
                    std::max(least, std::min(kBarrierFall * barrier,
                                             scale_ * std::pow(barrier / scale_, kBarrierPower)));
            }
            if (iterations_ >= settings_.iterations) return false;
            ++iterations_;
            context_.throw_if_cancelled();
            step(barrier);
        }
        return true;
    }

    void step(double barrier) {
        const Eigen::ArrayXd low = x_ - v_.lower, high = v_.upper - x_;
        const Eigen::ArrayXd& g = gradient_;
        NormalMatrix::Matrix h = hessian();
        for (Eigen::Index k = 0; k < x_.size(); ++k) {
            h.coeffRef(k, k) += below_[k] / low[k] + above_[k] / high[k];
        }
        solver_.factorize(h);
        const Eigen::VectorXd right = (barrier / low - barrier / high - g).matrix();
        const Eigen::ArrayXd dx = solver_.solve(right).array();
        const Eigen::ArrayXd dlow = barrier / low - below_ - below_ / low * dx;
        const Eigen::ArrayXd dhigh = barrier / high - above_ + above_ / high * dx;
        double most = 1.0, dual = 1.0;
        for (Eigen::Index k = 0; k < x_.size(); ++k) {
            if (dx[k] < 0.0) most = std::min(most, -kToBound * low[k] / dx[k]);
            if (dx[k] > 0.0) most = std::min(most, kToBound * high[k] / dx[k]);
            if (dlow[k] < 0.0) dual = std::min(dual, -kToBound * below_[k] / dlow[k]);
            if (dhigh[k] < 0.0) dual = std::min(dual, -kToBound * above_[k] / dhigh[k]);
        }
        const double now = value_ + walls(x_, barrier);
        const double fall = ((g - barrier / low + barrier / high) * dx).sum();
        Eigen::ArrayXd x = x_, e = e_;
        for (int k = 0; k < kHalvings; ++k, most *= 0.5) {
            x = x_ + most * dx;
            e = deviations(x);
            const double then = value(x, e) + walls(x, barrier);
            if (then <= now + kArmijo * most * fall + 1e-14 * std::abs(now)) break;
        }
        x_ = x;
        e_ = e;
        look();
        below_ += dual * dlow;
        above_ += dual * dhigh;
    }

    const DwellSettings& settings_;
    const Variables& v_;
    NormalMatrix& normal_;
    const RunContext& context_;
    Cost cost_;
    Eigen::ArrayXd excess_;  // mm, with what is given, x = 1
    Eigen::ArrayXd x_, e_, below_, above_;
    Eigen::ArrayXd gradient_;  // at x
    double value_ = 0.0;       // at x
    double smoothing_ = 0.0, scale_ = 1.0;
    int iterations_ = 0;
    Eigen::SimplicialLDLT<NormalMatrix::Matrix, Eigen::Lower> solver_;
};

}  // namespace

void DwellProblem::validate() const {
    refuse_unless(influence != nullptr && excess.allFinite(), "excess");
    const auto samples = static_cast<std::size_t>(excess.size());
    const auto motions = static_cast<Eigen::Index>(influence->motions());
    refuse_unless(influence->first.back() == influence->sample.size() &&
                      influence->sample.size() == influence->depth.size() &&
                      std::is_sorted(influence->first.begin(), influence->first.end()),
                  "influence");
    for (const std::uint32_t s : influence->sample) refuse_unless(s < samples, "influence");
    refuse_unless(half.size() == excess.size() && half.allFinite() && (half > 0.0).all(), "half");
    refuse_unless(weight.size() == excess.size() && weight.allFinite() && (weight >= 0.0).all() &&
                      weight.sum() > 0.0,
                  "weight");
    refuse_unless(lower.size() == motions && lower.allFinite() && (lower >= 0.0).all(), "lower");
    refuse_unless(upper.size() == motions && upper.allFinite() && (upper >= lower).all(), "upper");
    refuse_unless(pace.size() == motions && pace.allFinite() && (pace >= 0.0).all(), "pace");
    refuse_unless(time_cost.size() == 0 || (time_cost.size() == motions && time_cost.allFinite() &&
                                            (time_cost >= 0.0).all()),
                  "time_cost");
}

void DwellSettings::validate() const {
    const bool good = inner_share >= 0.0 && inner_share <= 1.0 && inner_cost > 0.0 &&
                      inner_cost <= 1.0 && smoothing >= 0.0 && std::isfinite(smoothing) &&
                      reweightings >= 0 && accuracy > 0.0 && iterations > 0;
    if (!good)
        throw InputError("planning.settings", "plan: a setting of the solver is out of its range");
}

DwellSolution plan_dwell(const DwellProblem& problem, const DwellSettings& settings,
                         const RunContext& context) {
    settings.validate();
    problem.validate();
    const Variables variables(problem);
    if (variables.motion.empty()) {
        throw InputError("planning.nothing_free",
                         "plan: no motion that removes something may change its feed; widen the "
                         "limits, or free some motions");
    }
    NormalMatrix normal(*problem.influence, static_cast<std::size_t>(problem.excess.size()),
                        variables.motion, variables.chained, context);
    Interior interior(problem, settings, variables, normal, context);
    const DwellSolution found = interior.run();
    DwellSolution solution = found;
    solution.factor = problem.lower;
    const auto motions = static_cast<Eigen::Index>(problem.influence->motions());
    for (Eigen::Index j = 0; j < motions; ++j) {
        if (problem.upper[j] > problem.lower[j]) {
            solution.factor[j] = std::clamp(1.0, problem.lower[j], problem.upper[j]);
        }
    }
    solution.price = Eigen::ArrayXd::Zero(motions);
    for (std::size_t v = 0; v < variables.motion.size(); ++v) {
        const auto j = static_cast<Eigen::Index>(variables.motion[v]);
        solution.factor[j] = found.factor[static_cast<Eigen::Index>(v)];
        solution.price[j] = found.price[static_cast<Eigen::Index>(v)];
    }
    return solution;
}

}  // namespace beltgrinding
