#include "grinding.h"

#include <algorithm>

#include "base/stopwatch.h"

namespace beltgrinding {
namespace {

// Explicit integration in time: in one go the surface may recede by this share of the wheel's
// indentation, so that the pressure follows the removal.
constexpr double kRecession = 0.1;
constexpr int kMaxParts = 200;   // of a step
constexpr double kJoule = 1e-3;  // of a N mm

}  // namespace

Grinding::Grinding(HeightField& field, Pressing& pressing, const RemovalLaw& law,
                   const SimulationOptions& options, TraceKeeper* trace)
    : field_(field),
      pressing_(pressing),
      law_(law),
      process_(options.process),
      outputs_(options.outputs),
      trace_(trace),
      belt_(options.process.belt),
      shifts_(
          Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(field.size()),
                                static_cast<Eigen::Index>(options.outputs.shifted_laws.size()))) {}

double Grinding::set_rate(const PathStep& step) {
    const Stopwatch watch(times_.removal);
    const ContactSolution& contact = pressing_.solution();
    state_ = {process_.belt_speed, process_.belt_wear * process_.wear.remaining(belt_), step.feed,
              contact.force, contact.area};
    law_.rate(contact.pressure, state_, rate_);
    return fastest_ = rate_.maxCoeff();
}

double Grinding::removal(const PathStep& step) {
    if (pressing_.rigid()) return 0.0;
    const double fastest = set_rate(step);
    return pressing_.yields() ? fastest * step.duration : 0.0;
}

double Grinding::grind(const PathStep& step, double share, SegmentTree& tree,
                       std::vector<std::uint32_t>& changed) {
    deepest_ = pressing_.approach();
    if (pressing_.rigid()) return cut_all(step, changed);
    double volume = 0.0;
    double left = step.duration;
    const double least = step.duration / (share * kMaxParts);
    while (left > 0.0) {
        if (trace_ != nullptr) {
            const Stopwatch watch(times_.trace);
            trace_->press(pressing_.map(), pressing_.solution().pressure);
        }
        left -= grind_part(left, least, volume, changed);
        if (left <= 1e-12 * step.duration) break;
        if (!press_again(step, tree, changed)) break;
        deepest_ = std::max(deepest_, pressing_.approach());
    }
    return volume;
}

bool Grinding::press_again(const PathStep& step, SegmentTree& tree,
                           std::vector<std::uint32_t>& changed) {
    auto state = pressing_.press_again(field_, step.force);
    if (state == Pressing::State::kMoved) {
        refit(tree, changed);
        state = pressing_.press_anew(field_, tree, step.force);
    }
    if (state == Pressing::State::kNoContact) return false;
    set_rate(step);
    return true;
}

void Grinding::refit(SegmentTree& tree, std::vector<std::uint32_t>& changed) {
    const Stopwatch watch(times_.refit);
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    tree.refit(field_, changed);
}

// A rigid tool: all that overlaps goes, whatever the law.
double Grinding::cut_all(const PathStep& step, std::vector<std::uint32_t>& changed) {
    const double volume = pressing_.map().cut(field_, changed);
    belt_.volume += volume;
    belt_.time += step.duration;
    integrated_rate_ += volume;
    return volume;
}

double Grinding::grind_part(double left, double least, double& volume,
                            std::vector<std::uint32_t>& changed) {
    const Stopwatch watch(times_.removal);
    GapMap& map = pressing_.map();
    const ContactSolution& contact = pressing_.solution();
    double part = left;
    if (fastest_ > 0.0) {
        part = std::clamp(kRecession * pressing_.indentation() / fastest_, std::min(least, left),
                          left);
    }
    // No cell recedes below the unloaded wheel, however far beyond reason the force is.
    const Eigen::ArrayXd most = (contact.approach - map.gap()).max(0.0) / part;
    rate_ = rate_.min(most);
    const double removed = map.remove(field_, rate_, part, contact.approach, changed);
    for (std::size_t k = 0; k < outputs_.shifted_laws.size(); ++k) {
        outputs_.shifted_laws[k]->rate(contact.pressure, state_, shifted_);
        map.spread(shifted_.min(most) - rate_, part, shifts_.col(static_cast<Eigen::Index>(k)));
    }
    volume += removed;
    belt_.work += kJoule * contact.force * process_.belt_speed * part;
    belt_.volume += removed;
    belt_.time += part;
    integrated_rate_ += (rate_ * map.coverage()).sum() * map.grid().cell_area() * part;
    return part;
}

}  // namespace beltgrinding
