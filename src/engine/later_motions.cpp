#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "beltgrinding/simulation_options.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kGroups = 32;  // in a block of work
constexpr double kFaint = 0.02;      // of a group's greatest: what a later motion makes nothing of
constexpr double kKept = 0.03;       // the same of what is handed over
// Of the volume, by which it may be off for what is left out to be made good.
constexpr double kLeftOut = 0.25;

/// What motions did, as later motions meet what earlier ones did.
class Passes {
  public:
    /// `removed` and `area` must outlive it.
    Passes(const Influence& removed, std::span<const float> area)
        : removed_(removed), area_(area), begin_(area.size() + 1, 0) {
        for (const std::uint32_t s : removed.sample) ++begin_[s + 1];
        for (std::size_t s = 0; s < area.size(); ++s) begin_[s + 1] += begin_[s];
        motion_.resize(removed.sample.size());
        std::vector<std::size_t> at(begin_.begin(), begin_.end() - 1);
        taken_back_.resize(removed.sample.size());
        for (std::size_t k = 0; k < removed.motions(); ++k)
            for (std::size_t e = removed.first[k]; e < removed.first[k + 1]; ++e) {
                motion_[at[removed.sample[e]]++] = static_cast<std::uint32_t>(k);
                taken_back_[e] = static_cast<float>(share(k, e, 1.0));
            }
    }

    std::size_t motions() const { return removed_.motions(); }
    std::size_t samples() const { return area_.size(); }
    double area(std::uint32_t sample) const { return area_[sample]; }
    bool known(std::size_t motion) const {
        return !removed_.feedback.empty() && removed_.feedback[motion] > 0.0F;
    }
    /// Motions that removed something at a sample, in their order.
    std::span<const std::uint32_t> at(std::uint32_t sample) const {
        return {motion_.data() + begin_[sample], motion_.data() + begin_[sample + 1]};
    }
    std::span<const std::uint32_t> under(std::size_t motion) const {
        return {removed_.sample.data() + removed_.first[motion],
                removed_.sample.data() + removed_.first[motion + 1]};
    }
    /// What a motion makes of `lower`, mm by sample, unless all that it meets is below `faint`.
    /// False: it is left as it is.
    bool grind(std::size_t motion, double faint, std::vector<double>& lower) const {
        return level(motion, faint, lower, [&](std::size_t e) { return taken_back_[e]; });
    }
    /// The same of what a motion has done itself, half of it before.
    void grind_own(std::size_t motion, std::vector<double>& lower) const {
        level(motion, 0.0, lower, [&](std::size_t e) { return share(motion, e, 0.5); });
    }

  private:
    double share(std::size_t motion, std::size_t entry, double part) const {
        if (!known(motion)) return 0.0;
        const double much = part * removed_.feedback[motion] * removed_.depth[entry];
        return -std::expm1(-std::max(much, 0.0));
    }
    template <class Share>
    bool level(std::size_t motion, double faint, std::vector<double>& lower, Share share) const {
        double most = 0.0, whole = 0.0, sum = 0.0;
        for (std::size_t e = removed_.first[motion]; e < removed_.first[motion + 1]; ++e) {
            const std::uint32_t s = removed_.sample[e];
            const double weight = share(e) * area_[s];
            most = std::max(most, std::abs(lower[s]));
            whole += weight;
            sum += weight * lower[s];
        }
        if (!(most > faint) || !(whole > 0.0)) return false;
        const double mean = sum / whole;
        for (std::size_t e = removed_.first[motion]; e < removed_.first[motion + 1]; ++e) {
            double& here = lower[removed_.sample[e]];
            here -= share(e) * (here - mean);
        }
        return true;
    }

    const Influence& removed_;
    std::span<const float> area_;
    std::vector<std::size_t> begin_;     // by sample, in `motion_`
    std::vector<std::uint32_t> motion_;  // sample by sample
    std::vector<float> taken_back_;      // by entry of `removed_`
};

/// One group after the other: how much lower the surface is.
class Lower {
  public:
    Lower(const Influence& done, const Passes& passes)
        : done_(done),
          passes_(passes),
          lower_(passes.samples(), 0.0),
          own_(passes.samples(), 0.0),
          seen_(passes.samples(), 0),
          meets_(passes.motions(), 0) {}

    /// `members`: motions of the group, ascending. Adds sample and depth of what is left.
    void group(std::span<const std::size_t> members, std::vector<std::uint32_t>& sample,
               std::vector<float>& depth) {
        if (members.empty()) return;
        auto next = members.begin();
        double most = 0.0;
        for (std::size_t k = *next; k < passes_.motions(); ++k) {
            if (meets_[k] != 0 && passes_.grind(k, kFaint * most, lower_)) see(passes_.under(k), k);
            if (next == members.end() || *next != k) continue;
            ++next;
            add(k, most);
        }
        hand_over(most, sample, depth);
        for (const std::uint32_t s : touched_) {
            lower_[s] = 0.0;
            seen_[s] = 0;
        }
        touched_.clear();
        std::fill(meets_.begin(), meets_.end(), std::uint8_t{0});
    }

  private:
    /// Motions after `motion` meet these samples.
    void see(std::span<const std::uint32_t> samples, std::size_t motion) {
        for (const std::uint32_t s : samples) {
            if (std::exchange(seen_[s], std::uint8_t{1}) != 0) continue;
            touched_.push_back(s);
            for (const std::uint32_t k : passes_.at(s))
                if (k > motion) meets_[k] = passes_.known(k) ? 1 : 0;
        }
    }
    /// What a motion of the group has done.
    void add(std::size_t motion, double& most) {
        const std::span<const std::uint32_t> mine(done_.sample.data() + done_.first[motion],
                                                  done_.sample.data() + done_.first[motion + 1]);
        if (mine.empty()) return;
        for (std::size_t e = done_.first[motion]; e < done_.first[motion + 1]; ++e)
            own_[done_.sample[e]] = done_.depth[e];
        passes_.grind_own(motion, own_);
        see(mine, motion);
        see(passes_.under(motion), motion);
        const auto take = [&](std::uint32_t s) {
            lower_[s] += std::exchange(own_[s], 0.0);
            most = std::max(most, std::abs(lower_[s]));
        };
        for (const std::uint32_t s : mine) take(s);
        for (const std::uint32_t s : passes_.under(motion)) take(s);
    }
    void hand_over(double most, std::vector<std::uint32_t>& sample, std::vector<float>& depth) {
        std::sort(touched_.begin(), touched_.end());
        double whole = 0.0, kept = 0.0, greatest = 0.0;
        for (const std::uint32_t s : touched_) greatest = std::max(greatest, std::abs(lower_[s]));
        const double least = kKept * std::min(greatest, most);
        const auto keeps = [&](std::uint32_t s) { return std::abs(lower_[s]) > least; };
        for (const std::uint32_t s : touched_) {
            const double volume = lower_[s] * passes_.area(s);
            whole += volume;
            if (keeps(s)) kept += volume;
        }
        double scale = 1.0;
        if (std::abs(whole - kept) < kLeftOut * std::abs(kept)) scale = whole / kept;
        for (const std::uint32_t s : touched_) {
            if (!keeps(s)) continue;
            sample.push_back(s);
            depth.push_back(static_cast<float>(scale * lower_[s]));
        }
    }

    const Influence& done_;
    const Passes& passes_;
    std::vector<double> lower_, own_;     // mm, by sample; 0 between groups, and motions
    std::vector<std::uint8_t> seen_;      // by sample: it is touched
    std::vector<std::uint32_t> touched_;  // samples
    std::vector<std::uint8_t> meets_;     // by motion: it removed something where it is lower
};

bool whole(const Influence& influence, std::size_t samples) {
    return influence.first.size() > 0 && influence.first.back() == influence.sample.size() &&
           influence.sample.size() == influence.depth.size() &&
           std::is_sorted(influence.first.begin(), influence.first.end()) &&
           (influence.feedback.empty() || influence.feedback.size() == influence.motions()) &&
           std::all_of(influence.sample.begin(), influence.sample.end(),
                       [samples](std::uint32_t s) { return s < samples; });
}

}  // namespace

Influence Influence::in_the_end(const Influence& removed, std::span<const float> area,
                                std::span<const std::uint32_t> group, std::size_t count,
                                const RunContext& context) const {
    const bool fits =
        removed.motions() == motions() && whole(*this, area.size()) &&
        whole(removed, area.size()) && group.size() == motions() &&
        std::all_of(group.begin(), group.end(), [count](std::uint32_t g) { return g < count; });
    if (!fits)
        throw InputError("simulation.groups", "the groups of motions do not fit the influence");
    std::vector<std::vector<std::size_t>> members(count);
    for (std::size_t j = 0; j < group.size(); ++j) members[group[j]].push_back(j);
    const Passes passes(removed, area);
    std::vector<Influence> blocks((count + kGroups - 1) / kGroups);
    parallel_blocks(count, kGroups, context, [&](std::size_t begin, std::size_t end) {
        Lower lower(*this, passes);
        Influence& block = blocks[begin / kGroups];
        for (std::size_t g = begin; g < end; ++g) {
            lower.group(members[g], block.sample, block.depth);
            block.first.push_back(block.sample.size());
        }
    });
    Influence result;
    for (const Influence& block : blocks) result.append(block);
    return result;
}

}  // namespace beltgrinding
