#include "influence_recorder.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "engine/grinding.h"

namespace beltgrinding {
namespace {

// Relative: well above what a contact is solved to, and small enough for a derivative.
constexpr double kMoreForce = 0.05;
// Of the wheel's indentation: a tilt of the surface that the contact is solved with once more.
constexpr double kTilt = 0.1;
constexpr double kLookEvery = 8.0;  // parts of steps of a motion

}  // namespace

void InfluencePart::append(const InfluencePart& next) {
    first.insert(first.end(), next.first.begin(), next.first.end());
    sample.insert(sample.end(), next.sample.begin(), next.sample.end());
    depth.insert(depth.end(), next.depth.begin(), next.depth.end());
    feedback.insert(feedback.end(), next.feedback.begin(), next.feedback.end());
    motion = next.motion;
    felt = next.felt;
    looks = next.looks;
    parts = next.parts;
    touched = next.touched;
    removed = next.removed;
}

std::size_t InfluencePart::bytes() const {
    return first.size() * sizeof(std::size_t) + sample.size() * sizeof(std::uint32_t) +
           (depth.size() + feedback.size()) * sizeof(float) +
           touched.size() * (sizeof(std::uint32_t) + sizeof(double));
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
    part.feedback = since(influence_.feedback, given_first_ - 1);
    part.motion = motion_;
    part.felt = felt_;
    part.looks = looks_;
    part.parts = parts_;
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
        append<float>(influence_.feedback, part->feedback);
        motion_ = part->motion;
        felt_ = part->felt;
        looks_ = part->looks;
        parts_ = part->parts;
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
    influence_.feedback.resize(influence_.first.size() - 1, 0.0F);
    if (looks_ > 0.0) influence_.feedback.back() = static_cast<float>(felt_ / looks_);
    felt_ = looks_ = parts_ = 0.0;
}

bool InfluenceCollector::due() {
    const bool now = parts_ == 0.0;
    parts_ = parts_ + 1.0 < kLookEvery ? parts_ + 1.0 : 0.0;
    return now;
}

void InfluenceCollector::feel(double more) {
    felt_ += more;
    looks_ += 1.0;
}

void InfluenceCollector::add(std::uint32_t sample, double amount) {
    if (removed_[sample] == 0.0) touched_.push_back(sample);
    removed_[sample] += amount;
}

Influence InfluenceCollector::collected() {
    close(motion_);
    influence_.first.resize(motions_ + 1, influence_.sample.size());
    influence_.feedback.resize(motions_, 0.0F);
    return std::move(influence_);
}

void InfluenceRecorder::removed(const Removal& removal) {
    go_on(step_motion_);
    if (due()) feel(feedback(removal));
}

double InfluenceRecorder::feedback(const Removal& removal) const {
    Pressing& pressing = removal.pressing;
    if (pressing.flat()) return 0.0;
    const ContactGrid& grid = pressing.map().grid();
    Eigen::ArrayXd rate, beside, changed;
    rate_under(law_, pressing.displaced_pressure(), removal.state, rate, beside);
    const Eigen::ArrayXd volume = rate * pressing.map().coverage();
    const double total = volume.sum();
    if (!(total > 0.0)) return 0.0;
    // Along and across the contact, as far as it reaches that way: about what lies beside a motion.
    Eigen::ArrayXd tilt = Eigen::ArrayXd::Zero(grid.cells());
    for (const bool along : {true, false}) {
        Eigen::ArrayXd way(grid.cells());
        for (int j = 0; j < grid.ny; ++j)
            for (int i = 0; i < grid.nx; ++i) way[j * grid.nx + i] = along ? grid.s(i) : grid.y(j);
        way -= (volume * way).sum() / total;
        const double reach = std::sqrt((volume * way.square()).sum() / total);
        if (reach > 0.0) tilt += way / reach;
    }
    const double most = (volume > 0.0).select(tilt.abs(), 0.0).maxCoeff();
    if (!(most > 0.0)) return 0.0;
    const double by = kTilt * pressing.indentation() / most;
    const auto other = pressing.with_gap(by * tilt);
    if (!other) return 0.0;
    ProcessState state = removal.state;
    state.contact_area = other->solution.area;
    rate_under(law_, other->pressure, state, changed, beside);
    const Eigen::ArrayXd less = (rate - changed) * pressing.map().coverage();
    const double found = (less * tilt).sum() / (by * (volume * tilt.square()).sum());
    return std::isfinite(found) ? std::max(found, 0.0) : 0.0;
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
    pressed_ = removal.mean(pressed_.min(most));
    if (beside_.size() > 0) {
        const Eigen::Index columns = map.grid().nx;
        beside_.head(columns) = beside_.head(columns).min(most.head(columns));
        beside_.tail(columns) = beside_.tail(columns).min(most.tail(columns));
    }
    go_on(motion_);
    const double per = map.scale() / kMoreForce;
    const auto take = [&](const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside, double sign) {
        map.for_samples(rate, beside, removal.duration, [&](std::size_t position, double amount) {
            add(blocks_.sample(position), sign * per * amount);
        });
    };
    take(removal.rate, removal.beside, -1.0);
    // At edges more pressure has other shares among the samples.
    removal.pressing.share_out(blocks_, stronger);
    take(pressed_, beside_, 1.0);
    removal.pressing.share_out(blocks_, removal.pressing.solution());
}

}  // namespace beltgrinding
