#pragma once

#include <Eigen/Core>

#include "beltgrinding/run_context.h"
#include "beltgrinding/simulation.h"

namespace beltgrinding {

/// What is known of a ground field for planning how long each motion of its path should take.
///
/// A motion that takes x times as long removes, at first order, x times as much where it did. With
/// e the heights above the middle of the tolerance's band in the end, e(x) = e - A (x - 1), wanted
/// is |e(x)| <= half.
struct DwellProblem {
    const Influence* influence = nullptr;  ///< A: motions by samples, mm
    Eigen::ArrayXd excess;                 ///< (samples) mm, e as it was ground
    Eigen::ArrayXd half;                   ///< (samples) mm, of the band, above 0
    Eigen::ArrayXd weight;                 ///< (samples) such as their area; 0: does not count
    Eigen::ArrayXd lower;                  ///< (motions) least x, at least 0
    Eigen::ArrayXd upper;                  ///< (motions) greatest x; equal to `lower`: given
    /// (motions) s/mm as it was ground: neighbours whose pace differs cost. 0: has no neighbour.
    Eigen::ArrayXd pace;
    Eigen::ArrayXd time_cost;  ///< (motions) mm2, at least 0: what x = 1 costs; empty: nothing

    /// Throws InputError naming what does not fit.
    void validate() const;
};

struct DwellSettings {
    double inner_share = 0.7;  ///< of the band, within which deviations cost `inner_cost` only
    double inner_cost = 0.3;   ///< of what they cost outside
    double smoothing = 1e-3;   ///< cost of unequal paces, against that of the deviations at first
    int reweightings = 6;      ///< of the samples that no motion can mend
    double accuracy = 1e-8;    ///< of the conditions of optimality, relative
    int iterations = 200;      ///< at most, in all

    /// Throws InputError naming the setting that is none.
    void validate() const;
};

struct DwellSolution {
    Eigen::ArrayXd factor;  ///< (motions) x
    Eigen::ArrayXd excess;  ///< (samples) mm, e(x) at first order
    Eigen::ArrayXd
        price;  ///< (motions) multiplier of the bound that x lies at: > 0 lower, < 0 upper
    double residual = 0.0;  ///< of the conditions of optimality (Karush, Kuhn, Tucker), relative
    double objective = 0.0;
    int iterations = 0;
};

/// The x of least cost: sum of weight * r * cost(e(x)) over the samples, and the smoothing. cost is
/// that of a deviation: inner_cost e^2 / 2, and (1 - inner_cost) (|e| - inner_share half)^2 / 2 of
/// what is beyond, besides `time_cost` x. r = 1 / (1 + (beyond / half)^2), anew by each
/// reweighting, lets go of what no motion can mend, `beyond` what |e| is beyond the band. Where no
/// time is paid, r goes on with a half of a few tenths, and the x with most of the weight in the
/// band is taken (after Blake and Zisserman, Visual Reconstruction, 1987: from convex to counting).
/// For given r the problem is convex; it is solved by a primal-dual interior-point method (Waechter
/// and Biegler, Mathematical Programming 106, 2006, without the filter). The same bits on any
/// number of threads. Throws InputError and Cancelled.
DwellSolution plan_dwell(const DwellProblem& problem, const DwellSettings& settings,
                         const RunContext& context = {});

}  // namespace beltgrinding
