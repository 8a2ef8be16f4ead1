#include "pressing.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"

namespace beltgrinding {
namespace {

// mm beyond the wheel's surface in which the gap is mapped: more than the approach may change
// between two placements of the wheel, and enough for whole cells around the contact.
constexpr double kMargin = 0.2;
// mm: below this change of approach the radial gap need not be mapped anew (it would change by
// the approach times 1 - cos of the contact's half angle, 0.4 % at 5 degrees).
constexpr double kPlacement = 0.05;
constexpr int kMaxPlacements = 12;
constexpr double kAtStop = 1e-9;  // mm
// mm by which the wheel may move while it grinds at a place: samples further away than the margin
// are not on its map.
constexpr double kDrift = 0.5 * kMargin;
// Share of the radius ahead of the wheel's centre: what lies behind cannot be in the contact.
constexpr double kAhead = 0.5;

}  // namespace

Pressing::Pressing(const ProcessSettings& process, double spacing, double tolerance,
                   const ContactModel& model)
    : process_(process),
      tolerance_(tolerance),
      model_(model),
      map_(process.wheel, spacing),
      largest_indentation_(std::min(model.thickness(), (1.0 - kAhead) * process.wheel.radius)) {}

Frame Pressing::placed_frame() const {
    return programmed_ * Eigen::Translation3d(0.0, 0.0, placed_);
}

void Pressing::localise(const HeightField& field, const SegmentTree& tree, double margin) {
    const Stopwatch watch(times_.localise);
    const Frame frame = placed_frame();
    WheelReach reach;
    reach.centre = frame * Vec3(0.0, 0.0, -process_.wheel.radius);
    reach.axis = frame.linear().col(1);
    reach.direction = frame.linear().col(2);
    reach.radius = process_.wheel.radius + margin;
    reach.half_width = 0.5 * (process_.wheel.width + field.spacing);
    reach.min_along = kAhead * process_.wheel.radius;
    tree.query(field, reach, hits_);
}

void Pressing::map_gap(const HeightField& field, double reach) {
    const Stopwatch watch(times_.gap);
    map_.update(field, hits_, placed_frame(), reach);
}

void Pressing::solve(bool force_control, double force) {
    const Stopwatch watch(times_.contact);
    const ContactGrid& grid = map_.grid();
    Eigen::ArrayXd start;
    if (warm_) start = recentre(solution_.pressure, contact_->grid(), grid);
    if (!contact_ || contact_->grid() != grid) {
        contact_.reset();  // its memory is taken again
        contact_ = model_.prepare(grid);
    }
    ContactProblem problem;
    problem.gap = map_.gap();
    problem.coverage = map_.coverage();
    problem.force_control = force_control;
    problem.force = force;
    // The programmed pose, seen from where the wheel is placed; at an end stop that is the pose.
    if (!process_.force_control) {
        problem.approach = -placed_;
        if (process_.robot_stiffness > 0.0) {
            problem.robot_compliance = 1.0 / process_.robot_stiffness;
        }
    }
    problem.tolerance = tolerance_;
    solution_ = contact_->solve(problem, warm_ ? &start : nullptr);
    warm_ = solution_.force > 0.0;
}

bool Pressing::find_touch(const HeightField& field, const SegmentTree& tree) {
    const double travel = process_.force_travel;
    placed_ = 0.0;
    localise(field, tree, travel + kMargin);
    map_gap(field, travel + kMargin);
    if (map_.empty() || !(map_.lowest() <= travel)) return false;
    placed_ = std::clamp(map_.lowest(), -travel, travel);
    return true;
}

Pressing::State Pressing::press_position(const HeightField& field, const SegmentTree& tree) {
    placed_ = 0.0;
    for (int i = 0; i < kMaxPlacements; ++i) {
        localise(field, tree, kMargin);
        map_gap(field, kMargin);
        solve(false, 0.0);
        if (solution_.area <= 0.0) return State::kNoContact;
        // A rigid robot stands at its pose; another gives way, and the gap is mapped anew there.
        if (std::abs(solution_.approach) <= kPlacement) break;
        placed_ += solution_.approach;
    }
    return State::kPressed;
}

Pressing::State Pressing::press(const HeightField& field, const SegmentTree& tree,
                                const Frame& work_from_contact, double force) {
    programmed_ = work_from_contact;
    state_ = process_.force_control ? press_force(field, tree, force) : press_position(field, tree);
    return state_;
}

Pressing::State Pressing::press_force(const HeightField& field, const SegmentTree& tree,
                                      double force) {
    const auto nothing = [&] {
        warm_ = false;
        placed_ = 0.0;
        solution_ = ContactSolution{};
        return State::kNoContact;
    };
    if (force <= 0.0) return nothing();
    bool searched = false;
    if (!warm_) {
        if (!find_touch(field, tree)) return nothing();
        searched = true;
    }
    for (int i = 0;; ++i) {
        localise(field, tree, kMargin);
        map_gap(field, kMargin);
        if (!map_.empty()) solve(true, force);
        if (map_.empty() || solution_.force <= 0.0) {
            // The surface fell away from where it was at the last pose.
            if (searched || !find_touch(field, tree)) return nothing();
            searched = true;
            continue;
        }
        double wanted = placed_ + solution_.approach;
        State state = State::kPressed;
        const double deepest = placed_ + map_.lowest() + largest_indentation_;
        if (wanted > deepest) {
            wanted = deepest;
            state = State::kOverCompressed;
        }
        if (std::abs(wanted) > process_.force_travel) {
            wanted = std::copysign(process_.force_travel, wanted);
            state = State::kBeyondTravel;
        }
        // The last placement may be off by its remaining approach.
        const bool last = i + 1 >= kMaxPlacements;
        if (state == State::kPressed) {
            if (last || std::abs(solution_.approach) <= kPlacement) return state;
        } else if (const double near = state == State::kBeyondTravel ? kAtStop : kPlacement;
                   last || std::abs(wanted - placed_) < near) {
            if (last) {
                placed_ = wanted;
                localise(field, tree, kMargin);
                map_gap(field, kMargin);
            }
            if (!map_.empty()) solve(false, 0.0);
            return !map_.empty() && solution_.force > 0.0 ? state : nothing();
        }
        placed_ = wanted;
    }
}

Pressing::State Pressing::press_again(const HeightField& field, double force) {
    if (state_ == State::kOverCompressed) return State::kMoved;  // it follows what recedes
    map_gap(field, kMargin);
    const bool at_stop = state_ == State::kBeyondTravel;
    solve(process_.force_control && !at_stop, force);
    if (solution_.force <= 0.0) return State::kNoContact;
    if (at_stop) {
        const bool held = placed_ > 0.0 ? solution_.force <= force : solution_.force >= force;
        return held ? state_ : State::kMoved;
    }
    if (std::abs(solution_.approach) > kDrift) return State::kMoved;
    if (!process_.force_control) return State::kPressed;
    const bool beyond = std::abs(placed_ + solution_.approach) > process_.force_travel ||
                        indentation() > largest_indentation_;
    return beyond ? State::kMoved : State::kPressed;
}

}  // namespace beltgrinding
