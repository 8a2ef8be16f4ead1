#include "belt_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

constexpr int kLineSteps = 20;  // of the search along a step
constexpr double kFlat = 0.1;   // of the energy's slope at its beginning: where that ends

}  // namespace

double BeltDrive::commanded(double lift) const {
    if (problem.force_control) return problem.force;
    return (problem.approach - depth - lift) / problem.robot_compliance;
}

double BeltUnbalanced::left() const {
    return std::max(belt.cwiseAbs().sum(), std::abs(work));
}

BeltEnergy::BeltEnergy(const BeltBasis& basis, BeltSupport& support, const BeltStress& stress,
                       const BeltPath& path, const BeltDrive& drive)
    : basis_(basis),
      support_(support),
      stress_(stress),
      path_(path),
      drive_(drive),
      path_load_(basis.across().sheet.path_load(path)) {}

void BeltEnergy::complete(BeltIterate& at) const {
    at.bent = basis_.bending().times(at.deflection);
    at.shape = stress_.shape(at.deflection);
    strain(at);
}

void BeltEnergy::strain(BeltIterate& at) const {
    at.strain = stress_.product(at.shape, at.shape);
    const BeltModes turned = stress_.turned(at.deflection);
    at.strain.function += turned.function;
    at.strain.mean += turned.mean;
    at.strain.lean += turned.lean;
    at.stress = stress_.stress(at.strain);
    at.smooth = path_load_ - at.bent - stress_.resistance(at.shape, at.stress);
}

BeltUnbalanced BeltEnergy::unbalanced(const BeltIterate& at, bool bonded) {
    BeltUnbalanced off;
    off.belt = at.smooth;
    const bool yields = drive_.yields();
    off.borne = support_.bear(at.cells, at.lift, yields ? drive_.commanded(at.lift) : 0.0, bonded);
    if (yields) off.work = off.borne.work;
    basis_.across().face.push(path_.columns, support_.forces(), off.belt);
    return off;
}

double BeltEnergy::go(const BeltStep& step, bool whole, BeltIterate& at, BeltUnbalanced& off) {
    BeltIterate change;
    change.deflection = step.deflection;
    change.lift = step.lift;
    change.bent = basis_.bending().times(step.deflection);
    change.cells = basis_.across().face.deflection(path_.columns, step.deflection);
    change.shape = stress_.shape(step.deflection);
    const auto gone = [&](double share) {
        BeltIterate to;
        to.deflection = at.deflection + share * change.deflection;
        to.lift = at.lift + share * change.lift;
        to.bent = at.bent + share * change.bent;
        to.cells = at.cells + share * change.cells;
        to.shape.x = at.shape.x + share * change.shape.x;
        to.shape.xy = at.shape.xy + share * change.shape.xy;
        to.shape.xx = at.shape.xx + share * change.shape.xx;
        to.shape.yy = at.shape.yy + share * change.shape.yy;
        strain(to);
        return to;
    };
    // What the energy rises by along the step.
    const auto slope = [&](const BeltUnbalanced& forces) {
        return -(forces.belt.cwiseProduct(step.deflection).sum() + forces.work * step.lift);
    };
    const double first = slope(off);
    BeltIterate end = gone(1.0);
    off = unbalanced(end, false);
    const double last = slope(off);
    double share = 1.0;
    if (!whole && last > kFlat * std::abs(first)) {
        share = least_along(at, change, first, last);
        end = gone(share);
        off = unbalanced(end, false);
    }
    at = std::move(end);
    return share;
}

double BeltEnergy::least_along(const BeltIterate& at, const BeltIterate& change, double first,
                               double end) const {
    // Strains are e0 + s e1 + s^2 e2 on the way.
    BeltModes e1 = stress_.product(at.shape, change.shape);
    const BeltModes turned = stress_.turned(change.deflection);
    e1.function = 2.0 * e1.function + turned.function;
    e1.mean = 2.0 * e1.mean + turned.mean;
    e1.lean = 2.0 * e1.lean + turned.lean;
    const BeltModes e2 = stress_.product(change.shape, change.shape);
    const BeltModes s1 = stress_.stress(e1), s2 = stress_.stress(e2);
    const auto work = [](const BeltModes& s, const BeltModes& e) {
        return s.function.cwiseProduct(e.function).sum() + s.mean * e.mean + s.lean * e.lean;
    };
    const double rest = stress_.pull({{}, 0.0, 0.0});
    // The energy's slope, but for what is not smooth.
    std::array<double, 4> smooth = {-at.smooth.cwiseProduct(change.deflection).sum(),
                                    change.bent.cwiseProduct(change.deflection).sum() +
                                        2.0 * work(at.stress, e2) + work(s1, e1) +
                                        2.0 * rest * e2.mean,
                                    3.0 * work(s1, e2), 2.0 * work(s2, e2)};
    if (drive_.yields()) {
        smooth[0] -= drive_.commanded(at.lift) * change.lift;
        if (!drive_.problem.force_control)
            smooth[1] += change.lift * change.lift / drive_.problem.robot_compliance;
    }
    const auto slope = [&](double s) {
        const double sum = smooth[0] + s * (smooth[1] + s * (smooth[2] + s * smooth[3]));
        return support_.add_slope(sum, at.cells, at.lift, change.cells, change.lift, s);
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
