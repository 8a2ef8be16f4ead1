#include "engine/grinding.h"

#include <algorithm>
#include <cmath>

#include "actuated_wheel.h"
#include "base/stopwatch.h"

namespace beltgrinding {
namespace {

// Explicit integration in time: in one go the surface may recede by this share of the wheel's
// indentation, so that the pressure follows the removal; where that is asked for less exactly than
// by default, of more, by the root of its tolerance, since the error goes by the share's square.
constexpr double kRecession = 0.25, kMostRecession = 0.5;
constexpr double kTolerance = 1e-3;
constexpr double kMiddle = 0.5;          // of a part's time: a wheel's pressure is that then
constexpr int kMaxParts = 200;           // of a step
constexpr double kJoule = 1e-3;          // of a N mm
constexpr double kUsualPressure = 0.05;  // MPa, of a belt that has not touched yet

}  // namespace

void rate_under(const RemovalLaw& law, const DisplacedPressure& pressure, const ProcessState& state,
                Eigen::ArrayXd& rate, Eigen::ArrayXd& beside) {
    law.rate(pressure.pressure, state, rate);
    beside.resize(0);
    if (pressure.longest() > 0.0) law.rate(pressure.beside, state, beside);
}

Grinding::Grinding(SampleBlocks& blocks, Pressing& pressing, const RemovalLaw& law,
                   const ProcessSettings& process, double tolerance, Recorders& recorders)
    : blocks_(blocks),
      pressing_(pressing),
      law_(law),
      process_(process),
      recorders_(recorders),
      recession_(
          std::clamp(kRecession * std::sqrt(tolerance / kTolerance), kRecession, kMostRecession)),
      now_{.belt = process.belt, .clock = -process.pause} {}

double Grinding::set_rate(const PathStep& step) {
    const Stopwatch watch(times_.removal);
    const ContactSolution& contact = pressing_.solution();
    state_ = {process_.belt_speed, process_.belt_wear * process_.wear.remaining(now_.belt),
              step.feed, contact.force, contact.area};
    rate_under(law_, pressing_.displaced_pressure(), state_, rate_, beside_);
    return fastest_ = rate_.maxCoeff();
}

void Grinding::expect(const PathStep& step, double duration) {
    if (pressing_.rigid()) return;
    if (!pressing_.flat()) duration *= kMiddle;
    const ContactSolution& contact = pressing_.solution();
    const double area = contact.area > 0.0 ? contact.area : 1.0;
    Eigen::ArrayXd pressure(1), rate;
    pressure[0] = contact.force > 0.0 ? contact.force / area : kUsualPressure;
    law_.rate(pressure,
              {process_.belt_speed, process_.belt_wear * process_.wear.remaining(now_.belt),
               step.feed, pressure[0] * area, area},
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
    if (pressing_.rigid()) return cut_all(step);
    double volume = 0.0;
    double left = step.duration;
    const double least = step.duration / (share * kMaxParts);
    double expected = left;  // s, by what it was pressed
    while (left > 0.0) {
        double part = holds(left, least);
        if (part < expected && !pressing_.flat()) {
            expect(step, part);
            if (!press_again(step)) break;
            part = std::min(holds(left, least), left);
        }
        volume += remove(step, part);
        left -= part;
        if (left <= 1e-12 * step.duration) break;
        expected = pressing_.flat() ? left : std::min(left, part);
        expect(step, expected);
        if (!press_again(step)) break;
        deepest_ = std::max(deepest_, pressing_.approach());
    }
    return volume;
}

double Grinding::grind(const PathStep& step, double share, ActuatedWheel& wheel) {
    deepest_ = pressing_.approach();
    impulse_ = greatest_force_ = 0.0;
    double volume = 0.0;
    double left = step.duration;
    const double least = step.duration / (share * kMaxParts);
    const auto pressed = [this] { return pressing_.solution().force > 0.0; };
    if (pressed()) set_rate(step);
    while (left > 1e-12 * step.duration) {
        double part = left;
        if (!pressing_.gave_up())
            part = std::clamp(wheel.longest(left, step.force), std::min(least, left), left);
        if (pressed()) part = holds(part, std::min(least, part));
        wheel.begin(part, step.force);
        expect(step, pressing_.flat() ? part : part / ForceActuator::kStages);
        for (int stage = 0; stage < ForceActuator::kStages; ++stage) {
            const double time = part * wheel.press_stage(blocks_);
            if (!pressed()) {
                rest(time);
                continue;
            }
            set_rate(step);
            volume += remove(step, time);
            deepest_ = std::max(deepest_, pressing_.approach());
            greatest_force_ = std::max(greatest_force_, pressing_.solution().force);
        }
        left -= part;
    }
    return volume;
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
    recorders_.tell(&Recorder::pressed, Press{pressing_, step.duration, 1.0});
    const double volume = pressing_.map().cut(blocks_);
    now_.belt.volume += volume;
    now_.belt.time += step.duration;
    now_.clock += step.duration;
    now_.integrated_rate += volume;
    return volume;
}

double Grinding::holds(double left, double least) const {
    if (!(fastest_ > 0.0) || pressing_.gave_up()) return left;
    return std::clamp(recession_ * pressing_.indentation() / fastest_, std::min(least, left), left);
}

BeltState Grinding::load(double part) {
    const Stopwatch watch(times_.removal);
    const GapMap& map = pressing_.map();
    const double work = kJoule * pressing_.pressing_force() * process_.belt_speed * part;
    BeltState mean = now_.belt;
    const auto set_rates = [&] {
        state_.belt_wear = process_.belt_wear * process_.wear.remaining(mean);
        rate_under(law_, pressing_.displaced_pressure(), state_, rate_, beside_);
    };
    mean.loading = 0.0;
    set_rates();
    mean.loading =
        process_.wear.mean_loading(now_.belt.loading, work, map.volume_rate(rate_, beside_) * part);
    set_rates();
    return mean;
}

void Grinding::rest(double seconds) {
    if (!(seconds > 0.0)) return;
    if (process_.wear.loads())
        now_.belt.loading = process_.wear.recovered(now_.belt.loading, seconds);
    now_.clock += seconds;
}

double Grinding::remove(const PathStep& step, double part) {
    note_reach();
    const bool loads = process_.wear.loads();
    const BeltState belt = loads ? load(part) : now_.belt;
    recorders_.tell(&Recorder::pressed, Press{pressing_, part, state_.belt_wear});
    GapMap& map = pressing_.map();
    const ContactSolution& contact = pressing_.solution();
    Eigen::ArrayXd most, most_beside(beside_.size());
    Sweep sweep;
    double removed = 0.0, scale = 1.0;
    {
        const Stopwatch watch(times_.removal);
        // No cell recedes below the unloaded wheel, however far beyond reason the force is.
        most = (contact.approach - map.gap()).max(0.0) / part;
        rate_ = rate_.min(most);
        if (beside_.size() > 0) {
            const Eigen::Index columns = map.grid().nx;
            most_beside << most.head(columns), most.tail(columns);
            beside_ = beside_.min(most_beside);
        }
        if (!pressing_.flat()) {
            sweep = {step.moved, step.turned};
            const double within = map.volume_rate(rate_, {});
            rate_ = map.mean_over(sweep, rate_);
            if (const double mean = map.volume_rate(rate_, {}); mean > 0.0) scale = within / mean;
            rate_ *= scale;
        }
        removed = map.remove(blocks_, rate_, beside_, part, contact.approach);
    }
    recorders_.tell(&Recorder::removed, Removal{pressing_, state_, rate_, beside_, most,
                                                most_beside, part, sweep, scale, belt});
    impulse_ += contact.force * part;
    const double work = kJoule * pressing_.pressing_force() * process_.belt_speed * part;
    now_.belt.work += work;
    now_.belt.volume += removed;
    now_.belt.time += part;
    if (loads) now_.belt.loading = process_.wear.loaded(now_.belt.loading, work, removed);
    now_.clock += part;
    now_.integrated_rate += map.volume_rate(rate_, beside_) * part;
    return removed;
}

}  // namespace beltgrinding
