#include "engine/pressing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/stopwatch.h"
#include "contact/wheel_grid.h"

namespace beltgrinding {
namespace {

// mm: where that was added for another approach, the pressed cells' gaps are wrong by no more.
constexpr double kTilted = 1e-5;
// mm: cells with larger gaps bear no pressure, as a rule, where the wheel stands as at the last
// pose; else edges are looked at once more.
constexpr double kPressable = 0.03;
constexpr int kMaxPlacements = 12;
constexpr double kUnmapped = 0.02;  // share of the force that a belt may bear beyond the cells
constexpr double kAtStop = 1e-9;    // mm
// Share of the margin by which the wheel may move while it grinds at a place: samples further away
// than that are not on its map.
constexpr double kDrift = 0.5;

}  // namespace

Pressing::Pressing(const ProcessSettings& process, double spacing, double tolerance,
                   const ContactModel& model, const RunContext& context)
    : process_(process),
      tolerance_(tolerance),
      context_(context),
      model_(model),
      tool_(tool_envelope(process)),
      map_(tool_.wheel, spacing, model.beside()),
      growth_(process.force_control || tool_.flat ? 0.0 : process.wheel_growth),
      held_at_(growth_),
      give_(process.robot_stiffness > 0.0 ? 1.0 / process.robot_stiffness : 0.0),
      largest_indentation_(std::min(model.thickness(), tool_.deepest)) {
    if (tool_.flat) map_.lie_flat(tool_.from, tool_.to, tool_.face);
}

std::size_t PressingMemory::bytes() const {
    return sizeof(PressingMemory) +
           static_cast<std::size_t>(solution.pressure.size() + solution.axial.size()) *
               sizeof(double) +
           bytes_of(hits) + near.bytes() + (memory ? memory->bytes() : 0);
}

Latest<PressingMemory> Pressing::take(std::span<const std::uint32_t>) {
    std::optional<ContactGrid> grid;
    std::shared_ptr<const ContactMemory> memory;
    if (contact_) {
        grid = contact_->grid();
        memory = contact_->memory();
    }
    return {{solution_, displaced_, grid, map_.carried(), near_, hits_, programmed_, placed_,
             held_at_, give_, localised_, gap_, stands_at_, warm_, state_, memory}};
}

void Pressing::put(std::span<const Latest<PressingMemory>* const> parts) {
    if (parts.empty()) return;
    const PressingMemory& carried = parts.back()->value;
    solution_ = carried.solution;
    displaced_ = carried.displaced;
    contact_.reset();
    if (carried.grid) {
        contact_ = model_.prepare(*carried.grid);
        contact_->remember(carried.memory);
    }
    map_.carry(carried.map);
    near_ = carried.near;
    hits_ = carried.hits;
    programmed_ = carried.programmed;
    placed_ = carried.placed;
    held_at_ = carried.held_at;
    give_ = carried.give;
    localised_ = carried.localised;
    gap_ = carried.gap;
    stands_at_ = carried.stands_at;
    warm_ = carried.warm;
    state_ = carried.state;
}

Frame Pressing::placed_frame() const {
    return programmed_ * Eigen::Translation3d(0.0, 0.0, placed_);
}

void Pressing::localise(const SampleBlocks& blocks, double margin) {
    const Stopwatch watch(times_.localise);
    const Frame frame = placed_frame();
    WheelReach reach;
    reach.centre = frame * Vec3(0.0, 0.0, -tool_.wheel.radius);
    reach.axis = frame.linear().col(1);
    reach.direction = frame.linear().col(2);
    // All that the map looks at, whichever blocks it lies in.
    reach.radius = tool_.wheel.radius + margin + map_.behind();
    reach.half_width = 0.5 * (tool_.wheel.width + blocks.field().spacing) + model_.beside();
    reach.min_along = tool_.ahead;
    near_.find(blocks, reach, hits_);
}

void Pressing::map_gap(const SampleBlocks& blocks, double reach, double pressable) {
    const Stopwatch watch(times_.gap);
    const double looked = all_edges_ ? std::numeric_limits<double>::infinity() : pressable;
    map_.update(blocks, hits_, placed_frame(), reach, tool_.ahead, looked);
}

void Pressing::solve_force(const SampleBlocks& blocks, double force) {
    ContactProblem problem;
    problem.force = force;
    solve(blocks, std::move(problem));
}

void Pressing::solve_held(const SampleBlocks& blocks) {
    ContactProblem problem;
    problem.force_control = false;
    problem.approach = held_at_ - placed_;
    problem.robot_compliance = give_;
    solve(blocks, std::move(problem));
}

void Pressing::solve(const SampleBlocks& blocks, ContactProblem problem) {
    const Stopwatch watch(times_.contact);
    const ContactGrid& grid = map_.grid();
    Eigen::ArrayXd start;
    if (warm_) start = recentre(solution_.pressure, contact_->grid(), grid);
    if (!contact_ || contact_->grid() != grid) {
        contact_.reset();  // its memory is taken again
        contact_ = model_.prepare(grid);
    }
    problem.drop = profile_drop(tool_.wheel, grid);
    problem.tolerance = tolerance_;
    problem.recession = recession_;
    problem.context = context_;
    const auto solve_once = [&] {
        problem.coverage = map_.coverage();
        if (tool_.flat) {  // whose gap is the same wherever it stands
            gap_ = problem.gap = map_.gap();
            solution_ = contact_->solve(problem, start.size() > 0 ? &start : nullptr);
            // What it started from was of no use.
            if (!solution_.converged && start.size() > 0) solution_ = contact_->solve(problem);
            // What the belt bears beyond the cells is not ground: that is no solution.
            const double missed = std::abs(solution_.force - problem.force);
            if (problem.force_control && missed > kUnmapped * problem.force)
                solution_.converged = false;
            return;
        }
        const Eigen::ArrayXd tilt = tilt_by_approach(tool_.wheel, grid, map_.gap());
        const double most_tilt = tool_.placement;
        double approach = warm_ ? std::clamp(stands_at_ - placed_, -most_tilt, most_tilt) : 0.0;
        for (bool again = true;;) {
            gap_ = map_.gap() + approach * tilt;
            problem.gap = gap_;
            solution_ = contact_->solve(problem, start.size() > 0 ? &start : nullptr);
            if (!again || !(std::abs(solution_.approach) <= tool_.placement)) break;
            if (solution_.pressure.size() != tilt.size()) break;  // a rigid tool
            const double most = (solution_.pressure > 0.0).select(tilt.abs(), 0.0).maxCoeff();
            if (std::abs(solution_.approach - approach) * most <= kTilted) break;
            approach = solution_.approach;
            start = solution_.pressure;
            again = false;
        }
    };
    solve_once();
    if (!map_.holds_for(solution_.pressure)) {
        all_edges_ = tool_.flat;
        map_.look_at_all_edges(blocks);
        solve_once();
    }
    warm_ = solution_.force > 0.0;
    stands_at_ = placed_ + solution_.approach;
    displaced_ = displaced(grid, solution_, problem.coverage, model_.beside());
    map_.reach_beside(displaced_);
    share_out(blocks, solution_);
}

void Pressing::share_out(const SampleBlocks& blocks, const ContactSolution& solution) {
    map_.sharpen_edges(blocks, solution.pressure, contact_->edge_softness());
}

bool Pressing::find_touch(const SampleBlocks& blocks, bool by_samples) {
    const double travel = process_.force_travel;
    placed_ = 0.0;
    localise(blocks, travel + tool_.margin);
    map_gap(blocks, travel + tool_.margin, std::numeric_limits<double>::infinity());
    const double lowest = by_samples ? map_.nearest() : map_.lowest();
    if (map_.empty() || !(lowest <= travel)) return false;
    placed_ = std::clamp(lowest, -travel, travel);
    return true;
}

Pressing::State Pressing::press_position(const SampleBlocks& blocks) {
    placed_ = 0.0;
    for (int i = 0; i < kMaxPlacements; ++i) {
        localise(blocks, tool_.margin);
        map_gap(blocks, tool_.margin, kPressable);
        solve_held(blocks);
        if (solution_.area <= 0.0) return State::kNoContact;
        // A rigid robot stands at its pose; another gives way, and the gap is mapped anew there.
        if (std::abs(solution_.approach) <= tool_.placement || gave_up()) break;
        placed_ += solution_.approach;
    }
    return State::kPressed;
}

Pressing::State Pressing::press(const SampleBlocks& blocks, const Frame& work_from_contact,
                                double force) {
    programmed_ = work_from_contact;
    all_edges_ = false;
    state_ = process_.force_control ? press_force(blocks, force) : press_position(blocks);
    return state_;
}

Pressing::Wanted Pressing::within_limits(double place) const {
    Wanted wanted{place, State::kPressed};
    const double deepest = placed_ + map_.lowest() + largest_indentation_;
    if (wanted.place > deepest) wanted = {deepest, State::kOverCompressed};
    if (std::abs(wanted.place) > process_.force_travel)
        wanted = {std::copysign(process_.force_travel, wanted.place), State::kBeyondTravel};
    return wanted;
}

bool Pressing::press_held(const SampleBlocks& blocks) {
    if (map_.empty()) return false;
    held_at_ = placed_;
    give_ = 0.0;
    solve_held(blocks);
    return solution_.force > 0.0;
}

Pressing::State Pressing::let_go() {
    warm_ = false;
    placed_ = 0.0;
    solution_ = ContactSolution{};
    displaced_ = DisplacedPressure{};
    return State::kNoContact;
}

bool Pressing::touch_again(const SampleBlocks& blocks, int& searches) {
    // First the surface may have fallen away from where it was at the last pose; then cells may
    // carry the flanks of a nose that is thinner than they are beyond its crown.
    const bool by_samples = searches == 1 && !tool_.flat;
    if ((searches > 0 && !by_samples) || !find_touch(blocks, by_samples)) return false;
    ++searches;
    return true;
}

Pressing::State Pressing::press_force(const SampleBlocks& blocks, double force) {
    if (force <= 0.0) return let_go();
    int searches = 0;
    if (!warm_ && !touch_again(blocks, searches)) return let_go();
    for (int i = 0;; ++i) {
        localise(blocks, tool_.margin);
        map_gap(blocks, tool_.margin, kPressable);
        if (!map_.empty()) solve_force(blocks, force);
        // A belt that cannot bear the force, however deep, goes as far as it may.
        const bool yields =
            tool_.flat && !map_.empty() && std::isfinite(map_.lowest()) && solution_.force <= 0.0;
        if (!yields && (map_.empty() || solution_.force <= 0.0)) {
            if (!touch_again(blocks, searches)) return let_go();
            continue;
        }
        const Wanted wanted = within_limits(yields ? std::numeric_limits<double>::infinity()
                                                   : placed_ + solution_.approach);
        // The last placement may be off by its remaining approach.
        const bool last = i + 1 >= kMaxPlacements || gave_up();
        if (wanted.state == State::kPressed) {
            if (last || std::abs(solution_.approach) <= tool_.placement) return wanted.state;
        } else if (const double near =
                       wanted.state == State::kBeyondTravel ? kAtStop : tool_.placement;
                   last || std::abs(wanted.place - placed_) < near) {
            if (last) {
                placed_ = wanted.place;
                localise(blocks, tool_.margin);
                map_gap(blocks, tool_.margin, kPressable);
            }
            return press_held(blocks) ? wanted.state : let_go();
        }
        placed_ = wanted.place;
    }
}

std::optional<Pressing::Pressed> Pressing::with_force(double force) {
    return pressed_otherwise(gap_, force);
}

std::optional<Pressing::Pressed> Pressing::with_gap(const Eigen::ArrayXd& change) {
    return pressed_otherwise(gap_ + change, solution_.force);
}

std::optional<Pressing::Pressed> Pressing::pressed_otherwise(Eigen::ArrayXd gap, double force) {
    if (!process_.force_control || state_ != State::kPressed || !contact_) return std::nullopt;
    const Stopwatch watch(times_.contact);
    ContactProblem problem;
    problem.gap = std::move(gap);
    problem.drop = profile_drop(tool_.wheel, map_.grid());
    problem.recession = recession_;
    problem.coverage = map_.coverage();
    problem.force_control = true;
    problem.force = force;
    problem.tolerance = tolerance_;
    problem.context = context_;
    Pressed pressed{contact_->solve(problem, &solution_.pressure), {}};
    pressed.pressure = displaced(map_.grid(), pressed.solution, problem.coverage, model_.beside());
    return pressed;
}

Pressing::State Pressing::hold(const SampleBlocks& blocks, double place, double give) {
    held_at_ = place;
    give_ = give;
    state_ = State::kNoContact;
    for (int i = 0; i < kMaxPlacements; ++i) {
        // Heights only fall, so that what was found before has all that is in reach now.
        if (!localised_ || std::abs(placed_ - *localised_) > kDrift * tool_.margin) {
            localise(blocks, (1.0 + kDrift) * tool_.margin);
            localised_ = placed_;
        }
        map_gap(blocks, tool_.margin, kPressable);
        if (map_.empty()) {
            const bool there = placed_ == place;
            placed_ = place;
            if (!there) continue;
            warm_ = false;
            solution_ = ContactSolution{};
            return state_;
        }
        solve_held(blocks);
        if (std::abs(solution_.approach) <= tool_.placement || gave_up()) break;
        placed_ += solution_.approach;
    }
    if (solution_.force > 0.0) state_ = State::kPressed;
    return state_;
}

Pressing::State Pressing::press_again(const SampleBlocks& blocks, double force) {
    if (state_ == State::kOverCompressed) return State::kMoved;  // it follows what recedes
    map_gap(blocks, tool_.margin, kPressable);
    const bool at_stop = state_ == State::kBeyondTravel;
    if (process_.force_control && !at_stop) {
        solve_force(blocks, force);
    } else {
        solve_held(blocks);
    }
    if (solution_.force <= 0.0) return State::kNoContact;
    if (at_stop) {
        const bool held = placed_ > 0.0 ? solution_.force <= force : solution_.force >= force;
        return held ? state_ : State::kMoved;
    }
    if (std::abs(solution_.approach) > kDrift * tool_.margin) return State::kMoved;
    if (!process_.force_control) return State::kPressed;
    const bool beyond = std::abs(placed_ + solution_.approach) > process_.force_travel ||
                        indentation() > largest_indentation_;
    return beyond ? State::kMoved : State::kPressed;
}

}  // namespace beltgrinding
