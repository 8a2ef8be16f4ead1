#include "influence_recorder.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "engine/grinding.h"

namespace beltgrinding {
namespace {

// Relative: well above what a contact is solved to, and small enough for a derivative.
constexpr double kMoreForce = 0.05;

}  // namespace

void InfluencePart::append(const InfluencePart& next) {
    first.insert(first.end(), next.first.begin(), next.first.end());
    sample.insert(sample.end(), next.sample.begin(), next.sample.end());
    depth.insert(depth.end(), next.depth.begin(), next.depth.end());
    motion = next.motion;
    touched = next.touched;
    removed = next.removed;
}

std::size_t InfluencePart::bytes() const {
    return first.size() * sizeof(std::size_t) + sample.size() * sizeof(std::uint32_t) +
           depth.size() * sizeof(float) + touched.size() * (sizeof(std::uint32_t) + sizeof(double));
}

InfluencePart InfluenceCollector::take(std::span<const std::uint32_t>) {
    InfluencePart part;
    const auto since = [](const auto& all, std::size_t from) {
        return std::decay_t<decltype(all)>(all.begin() + static_cast<std::ptrdiff_t>(from),
                                           all.end());
    };
    part.first = since(influence_.first, given_first_);
    part.sample = since(influence_.sample, given_entries_);
    part.depth = since(influence_.depth, given_entries_);
    part.motion = motion_;
    part.touched = touched_;
    part.removed.reserve(touched_.size());
    for (const std::uint32_t s : touched_) part.removed.push_back(removed_[s]);
    given_first_ = influence_.first.size();
    given_entries_ = influence_.sample.size();
    return part;
}

void InfluenceCollector::put(std::span<const InfluencePart* const> parts) {
    for (const InfluencePart* part : parts) {
        append<std::size_t>(influence_.first, part->first);
        append<std::uint32_t>(influence_.sample, part->sample);
        append<float>(influence_.depth, part->depth);
        motion_ = part->motion;
        for (const std::uint32_t s : touched_) removed_[s] = 0.0;
        touched_ = part->touched;
        for (std::size_t k = 0; k < touched_.size(); ++k) removed_[touched_[k]] = part->removed[k];
    }
    given_first_ = influence_.first.size();
    given_entries_ = influence_.sample.size();
}

void InfluenceCollector::go_on(std::uint32_t motion) {
    if (motion == motion_) return;
    close(motion_);
    motion_ = motion;
}

// Ends the running motion, and those up to `motion` that removed nothing.
void InfluenceCollector::close(std::size_t motion) {
    influence_.first.resize(std::max(influence_.first.size(), motion + 1),
                            influence_.sample.size());
    std::sort(touched_.begin(), touched_.end());
    for (const std::uint32_t s : touched_) {
        if (removed_[s] == 0.0) continue;  // gone again
        influence_.sample.push_back(s);
        influence_.depth.push_back(static_cast<float>(removed_[s]));
        removed_[s] = 0.0;
    }
    touched_.clear();
    influence_.first.push_back(influence_.sample.size());
}

void InfluenceCollector::add(std::uint32_t sample, double amount) {
    if (removed_[sample] == 0.0) touched_.push_back(sample);
    removed_[sample] += amount;
}

Influence InfluenceCollector::collected() {
    close(motion_);
    influence_.first.resize(motions_ + 1, influence_.sample.size());
    return std::move(influence_);
}

void InfluenceRecorder::end_step(const StepEnd& end) {
    if (end.changes.empty()) return;
    go_on(end.step.pose);
    for (const SampleBlocks::Change& change : end.changes) {
        const auto& before = blocks_.before(change);
        for_changed({&change, 1}, [&](std::size_t position) {
            const double removed =
                before[position % SampleBlocks::kLanes] - blocks_.height(position);
            if (removed > 0.0) add(blocks_.sample(position), removed);  // else lost in rounding
        });
    }
}

void ForceInfluenceRecorder::removed(const Removal& removal) {
    const double force = removal.pressing.solution().force;
    const auto more = removal.pressing.with_force((1.0 + kMoreForce) * force);
    if (!more) return;
    const auto& [stronger, pressure] = *more;
    ProcessState state = removal.state;
    state.force = stronger.force;
    state.contact_area = stronger.area;
    rate_under(law_, pressure, state, pressed_, beside_);
    const GapMap& map = removal.pressing.map();
    const Eigen::ArrayXd most = (stronger.approach - map.gap()).max(0.0) / removal.duration;
    pressed_ = pressed_.min(most);
    if (beside_.size() > 0) {
        const Eigen::Index columns = map.grid().nx;
        beside_.head(columns) = beside_.head(columns).min(most.head(columns));
        beside_.tail(columns) = beside_.tail(columns).min(most.tail(columns));
        if (removal.beside.size() > 0) beside_ -= removal.beside;
        beside_ /= kMoreForce;
    }
    map.for_samples((pressed_ - removal.rate) / kMoreForce, beside_, removal.duration,
                    [&](std::size_t position, double amount) {
                        go_on(motion_);
                        add(blocks_.sample(position), map.scale() * amount);
                    });
}

}  // namespace beltgrinding
