// The way along a step of Newton's method on the belt's energy.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "belt_solver.h"

namespace beltgrinding {
namespace {

constexpr int kLineSteps = 20;  // of the search along a step
constexpr double kFlat = 0.1;   // of the energy's slope at its beginning: where that ends

}  // namespace

double BeltSolver::go(Request& request, const BeltPath& path, const BeltStress& stress,
                      const Step& step, bool whole, Iterate& at, Unbalanced& off) {
    Iterate change;
    change.deflection = step.deflection;
    change.lift = step.lift;
    change.bent = bending_.times(step.deflection);
    change.cells = across_->face.deflection(path.columns, step.deflection);
    change.shape = stress.shape(step.deflection);
    const auto gone = [&](double share) {
        Iterate to;
        to.deflection = at.deflection + share * change.deflection;
        to.lift = at.lift + share * change.lift;
        to.bent = at.bent + share * change.bent;
        to.cells = at.cells + share * change.cells;
        to.shape.x = at.shape.x + share * change.shape.x;
        to.shape.xy = at.shape.xy + share * change.shape.xy;
        to.shape.xx = at.shape.xx + share * change.shape.xx;
        to.shape.yy = at.shape.yy + share * change.shape.yy;
        strain(stress, to);
        return to;
    };
    // What the energy rises by along the step.
    const auto slope = [&](const Unbalanced& forces) {
        return -(forces.belt.cwiseProduct(step.deflection).sum() + forces.work * step.lift);
    };
    const double first = slope(off);
    Iterate end = gone(1.0);
    off = unbalanced(request, path, end, false);
    const double last = slope(off);
    double share = 1.0;
    if (!whole && last > kFlat * std::abs(first)) {
        share = least_along(request, stress, at, change, first, last);
        end = gone(share);
        off = unbalanced(request, path, end, false);
    }
    at = std::move(end);
    return share;
}

double BeltSolver::least_along(const Request& request, const BeltStress& stress, const Iterate& at,
                               const Iterate& change, double first, double end) const {
    // Strains are e0 + s e1 + s^2 e2 on the way.
    BeltModes e1 = stress.product(at.shape, change.shape);
    const BeltModes turned = stress.turned(change.deflection);
    e1.function = 2.0 * e1.function + turned.function;
    e1.mean = 2.0 * e1.mean + turned.mean;
    e1.lean = 2.0 * e1.lean + turned.lean;
    const BeltModes e2 = stress.product(change.shape, change.shape);
    const BeltModes s1 = stress.stress(e1), s2 = stress.stress(e2);
    const auto work = [](const BeltModes& s, const BeltModes& e) {
        return s.function.cwiseProduct(e.function).sum() + s.mean * e.mean + s.lean * e.lean;
    };
    const double rest = stress.pull({{}, 0.0, 0.0});
    // The energy's slope, but for what is not smooth.
    std::array<double, 4> smooth = {-at.smooth.cwiseProduct(change.deflection).sum(),
                                    change.bent.cwiseProduct(change.deflection).sum() +
                                        2.0 * work(at.stress, e2) + work(s1, e1) +
                                        2.0 * rest * e2.mean,
                                    3.0 * work(s1, e2), 2.0 * work(s2, e2)};
    if (yields(*request.problem)) {
        smooth[0] -= commanded(request, at.lift) * change.lift;
        if (!request.problem->force_control)
            smooth[1] += change.lift * change.lift / request.problem->robot_compliance;
    }
    const auto slope = [&](double s) {
        double sum = smooth[0] + s * (smooth[1] + s * (smooth[2] + s * smooth[3]));
        for (Eigen::Index i = 0; i < at.cells.cols(); ++i) {
            const double raised = (at.lift + s * change.lift) * cosine_[i];
            const double rising = change.lift * cosine_[i];
            for (Eigen::Index k = 0; k < at.cells.rows(); ++k) {
                const double du = change.cells(k, i), u = at.cells(k, i) + s * du;
                const double overlap = reach_(k, i) + raised - u;
                if (overlap > 0.0) sum += springs_(k, i) * overlap * (rising - du);
                if (request.backing == nullptr) continue;
                const double in = u - request.backing->rest()(k, i);
                if (in > 0.0) sum += backing_springs_(k, i) * in * du;
            }
        }
        return sum;
    };
    double low = 0.0, high = 1.0, at_low = first, at_high = end, share = 0.0;
    for (int k = 0; k < kLineSteps; ++k) {
        // Regula falsi, kept away from the ends.
        const double part = std::clamp(at_low / (at_low - at_high), 0.1, 0.9);
        const double middle = k % 3 == 2 ? 0.5 * (low + high) : std::lerp(low, high, part);
        const double value = slope(middle);
        if (value > 0.0) {
            high = middle;
            at_high = value;
        } else {
            low = middle;
            at_low = value;
        }
        share = low;
        if (low > 0.0 && std::abs(at_low) <= kFlat * std::abs(first)) break;
    }
    return share == 0.0 ? high : share;
}

}  // namespace beltgrinding
