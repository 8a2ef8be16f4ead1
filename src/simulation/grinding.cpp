#include "grinding.h"

#include <algorithm>

#include "base/stopwatch.h"

namespace beltgrinding {
namespace {

// Explicit integration in time: in one go the surface may recede by this share of the wheel's
// indentation, so that the pressure follows the removal.
constexpr double kRecession = 0.1;
constexpr int kMaxParts = 200;  // of a step
// Relative: well above what a contact is solved to, and small enough for a derivative.
constexpr double kMoreForce = 0.05;
constexpr double kJoule = 1e-3;          // of a N mm
constexpr double kUsualPressure = 0.05;  // MPa, of a belt that has not touched yet

}  // namespace

Grinding::Grinding(SampleBlocks& blocks, Pressing& pressing, const RemovalLaw& law,
                   const SimulationOptions& options, TraceKeeper* trace, HeatKeeper* heat,
                   FinishKeeper* finish)
    : blocks_(blocks),
      pressing_(pressing),
      law_(law),
      process_(options.process),
      outputs_(options.outputs),
      trace_(trace),
      heat_(heat),
      finish_(finish),
      belt_(options.process.belt),
      shifts_(
          Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(blocks.field().size()),
                                static_cast<Eigen::Index>(options.outputs.shifted_laws.size()))) {
    if (outputs_.force_influence) force_influence_.emplace(blocks.field().size());
}

double Grinding::set_rate(const PathStep& step) {
    const Stopwatch watch(times_.removal);
    const ContactSolution& contact = pressing_.solution();
    state_ = {process_.belt_speed, process_.belt_wear * process_.wear.remaining(belt_), step.feed,
              contact.force, contact.area};
    set_rate(law_, rate_, beside_);
    return fastest_ = rate_.maxCoeff();
}

void Grinding::set_rate(const RemovalLaw& law, Eigen::ArrayXd& rate, Eigen::ArrayXd& beside) {
    const DisplacedPressure& pressure = pressing_.displaced_pressure();
    law.rate(pressure.pressure, state_, rate);
    beside.resize(0);
    if (pressure.longest() > 0.0) law.rate(pressure.beside, state_, beside);
}

void Grinding::expect(const PathStep& step, double duration) {
    if (!pressing_.flat()) return;
    const ContactSolution& contact = pressing_.solution();
    const double area = contact.area > 0.0 ? contact.area : 1.0;
    Eigen::ArrayXd pressure(1), rate;
    pressure[0] = contact.force > 0.0 ? contact.force / area : kUsualPressure;
    law_.rate(pressure,
              {process_.belt_speed, process_.belt_wear * process_.wear.remaining(belt_), step.feed,
               pressure[0] * area, area},
              rate);
    pressing_.recede(rate[0] * duration / pressure[0]);
}

double Grinding::removal(const PathStep& step) {
    if (pressing_.rigid()) return 0.0;
    const double fastest = set_rate(step);
    return pressing_.yields() ? fastest * step.duration : 0.0;
}

double Grinding::grind(const PathStep& step, double share) {
    deepest_ = pressing_.approach();
    impulse_ = greatest_force_ = 0.0;
    motion_ = step.pose;
    if (pressing_.rigid()) return cut_all(step);
    double volume = 0.0;
    double left = step.duration;
    const double least = step.duration / (share * kMaxParts);
    while (left > 0.0) {
        follow_trace();
        const double part = holds(left, least);
        volume += remove(part);
        left -= part;
        if (left <= 1e-12 * step.duration) break;
        expect(step, left);
        if (!press_again(step)) break;
        deepest_ = std::max(deepest_, pressing_.approach());
    }
    return volume;
}

double Grinding::grind(const PathStep& step, double share, ActuatedWheel& wheel) {
    deepest_ = pressing_.approach();
    impulse_ = greatest_force_ = 0.0;
    motion_ = step.pose;
    double volume = 0.0;
    double left = step.duration;
    const double least = step.duration / (share * kMaxParts);
    const auto pressed = [this] { return pressing_.solution().force > 0.0; };
    if (pressed()) set_rate(step);
    while (left > 1e-12 * step.duration) {
        double part = std::clamp(wheel.longest(left, step.force), std::min(least, left), left);
        if (pressed()) part = holds(part, std::min(least, part));
        wheel.begin(part, step.force);
        expect(step, part);
        for (int stage = 0; stage < ForceActuator::kStages; ++stage) {
            const double time = part * wheel.press_stage(blocks_);
            if (!pressed()) continue;
            follow_trace();
            set_rate(step);
            volume += remove(time);
            deepest_ = std::max(deepest_, pressing_.approach());
            greatest_force_ = std::max(greatest_force_, pressing_.solution().force);
        }
        left -= part;
    }
    return volume;
}

void Grinding::follow_trace() {
    note_reach();
    if (trace_ == nullptr) return;
    const Stopwatch watch(times_.trace);
    trace_->press(pressing_.map(), pressing_.displaced_pressure());
}

bool Grinding::press_again(const PathStep& step) {
    auto state = pressing_.press_again(blocks_, step.force);
    if (state == Pressing::State::kMoved) state = pressing_.press_anew(blocks_, step.force);
    if (state == Pressing::State::kNoContact) return false;
    set_rate(step);
    return true;
}

// A rigid tool: all that overlaps goes, whatever the law.
double Grinding::cut_all(const PathStep& step) {
    note_reach();
    const double volume = pressing_.map().cut(blocks_);
    belt_.volume += volume;
    belt_.time += step.duration;
    integrated_rate_ += volume;
    return volume;
}

double Grinding::holds(double left, double least) const {
    if (!(fastest_ > 0.0)) return left;
    return std::clamp(kRecession * pressing_.indentation() / fastest_, std::min(least, left), left);
}

double Grinding::remove(double part) {
    GapMap& map = pressing_.map();
    const ContactSolution& contact = pressing_.solution();
    if (heat_ != nullptr) {
        const Stopwatch watch(times_.heat);
        heat_->press(map, pressing_.displaced_pressure(), pressing_.pressing_force(), part);
    }
    if (finish_ != nullptr) {
        const Stopwatch watch(times_.finish);
        finish_->press(map, pressing_.displaced_pressure(), part, state_.belt_wear);
    }
    const Stopwatch watch(times_.removal);
    // No cell recedes below the unloaded wheel, however far beyond reason the force is.
    const Eigen::ArrayXd most = (contact.approach - map.gap()).max(0.0) / part;
    rate_ = rate_.min(most);
    Eigen::ArrayXd most_beside(beside_.size());
    if (beside_.size() > 0) {
        const Eigen::Index columns = map.grid().nx;
        most_beside << most.head(columns), most.tail(columns);
        beside_ = beside_.min(most_beside);
    }
    const double removed = map.remove(blocks_, rate_, beside_, part, contact.approach);
    for (std::size_t k = 0; k < outputs_.shifted_laws.size(); ++k) {
        set_rate(*outputs_.shifted_laws[k], shifted_, shifted_beside_);
        auto shift = shifts_.col(static_cast<Eigen::Index>(k));
        map.for_samples(shifted_.min(most) - rate_, shifted_beside_.min(most_beside) - beside_,
                        part, [&](std::size_t position, double amount) {
                            shift[blocks_.sample(position)] += amount;
                        });
    }
    if (force_influence_) note_force(part);
    impulse_ += contact.force * part;
    belt_.work += kJoule * pressing_.pressing_force() * process_.belt_speed * part;
    belt_.volume += removed;
    belt_.time += part;
    integrated_rate_ += map.volume_rate(rate_, beside_) * part;
    return removed;
}

void Grinding::note_force(double part) {
    const ContactSolution& contact = pressing_.solution();
    const auto more = pressing_.with_force((1.0 + kMoreForce) * contact.force);
    if (!more) return;
    const auto& [stronger, pressure] = *more;
    ProcessState state = state_;
    state.force = stronger.force;
    state.contact_area = stronger.area;
    law_.rate(pressure.pressure, state, pressed_);
    pressed_beside_.resize(0);
    if (pressure.longest() > 0.0) law_.rate(pressure.beside, state, pressed_beside_);
    const GapMap& map = pressing_.map();
    const Eigen::ArrayXd most = (stronger.approach - map.gap()).max(0.0) / part;
    pressed_ = pressed_.min(most);
    if (pressed_beside_.size() > 0) {
        const Eigen::Index columns = map.grid().nx;
        pressed_beside_.head(columns) = pressed_beside_.head(columns).min(most.head(columns));
        pressed_beside_.tail(columns) = pressed_beside_.tail(columns).min(most.tail(columns));
        if (beside_.size() > 0) pressed_beside_ -= beside_;
        pressed_beside_ /= kMoreForce;
    }
    map.for_samples((pressed_ - rate_) / kMoreForce, pressed_beside_, part,
                    [&](std::size_t position, double amount) {
                        force_influence_->add(blocks_.sample(position), map.scale() * amount,
                                              motion_);
                    });
}

Grinding::Part Grinding::next_part() {
    return {belt_, integrated_rate_,
            force_influence_ ? force_influence_->next_part() : InfluenceKeeper::Part{}};
}

void Grinding::restore(const Part& part) {
    belt_ = part.belt;
    integrated_rate_ = part.integrated_rate;
    if (force_influence_) force_influence_->restore(part.force_influence);
}

// Calls visit(row of the blocks' array, sample).
template <class Visit>
void Grinding::for_shifts(const std::vector<std::uint32_t>& blocks, Visit visit) const {
    Eigen::Index row = 0;
    for (const std::uint32_t block : blocks) {
        const std::size_t first = std::size_t{block} * SampleBlocks::kLanes;
        for (std::size_t lane = 0; lane < SampleBlocks::kLanes; ++lane, ++row)
            if (first + lane < blocks_.samples().size())
                visit(row, static_cast<Eigen::Index>(blocks_.sample(first + lane)));
    }
}

Eigen::ArrayXXd Grinding::shifts(const std::vector<std::uint32_t>& blocks) const {
    Eigen::ArrayXXd shifts = Eigen::ArrayXXd::Zero(
        static_cast<Eigen::Index>(blocks.size() * SampleBlocks::kLanes), shifts_.cols());
    for (Eigen::Index law = 0; law < shifts_.cols(); ++law) {
        for_shifts(blocks, [&](Eigen::Index row, Eigen::Index sample) {
            shifts(row, law) = shifts_(sample, law);
        });
    }
    return shifts;
}

void Grinding::restore_shifts(const std::vector<std::uint32_t>& blocks,
                              const Eigen::ArrayXXd& shifts) {
    for (Eigen::Index law = 0; law < shifts_.cols(); ++law) {
        for_shifts(blocks, [&](Eigen::Index row, Eigen::Index sample) {
            shifts_(sample, law) = shifts(row, law);
        });
    }
}

Influence Grinding::take_force_influence(std::size_t motions) {
    return force_influence_ ? force_influence_->take(motions) : Influence{};
}

}  // namespace beltgrinding
