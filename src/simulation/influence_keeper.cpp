#include "influence_keeper.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {

void Influence::append(const Influence& next) {
    const std::size_t before = sample.size();
    first.reserve(first.size() + next.motions());
    for (std::size_t k = 1; k < next.first.size(); ++k) first.push_back(before + next.first[k]);
    sample.insert(sample.end(), next.sample.begin(), next.sample.end());
    depth.insert(depth.end(), next.depth.begin(), next.depth.end());
}

Influence Influence::grouped(std::span<const std::uint32_t> group, std::size_t count) const {
    const auto fits = [count](std::uint32_t g) { return g < count; };
    if (group.size() != motions() || !std::all_of(group.begin(), group.end(), fits)) {
        throw InputError("simulation.groups", "the groups of motions do not fit the influence");
    }
    std::vector<std::vector<std::size_t>> members(count);
    for (std::size_t j = 0; j < group.size(); ++j) members[group[j]].push_back(j);
    Influence result;
    std::vector<std::pair<std::uint32_t, double>> sums;
    for (const auto& mine : members) {
        sums.clear();
        for (const std::size_t j : mine) {
            for (std::size_t e = first[j]; e < first[j + 1]; ++e) {
                sums.emplace_back(sample[e], depth[e]);
            }
        }
        // A stable order, so that the sums have the same bits wherever they are made.
        std::stable_sort(sums.begin(), sums.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (std::size_t k = 0; k < sums.size();) {
            double sum = 0.0;
            const std::uint32_t s = sums[k].first;
            for (; k < sums.size() && sums[k].first == s; ++k) sum += sums[k].second;
            result.sample.push_back(s);
            result.depth.push_back(static_cast<float>(sum));
        }
        result.first.push_back(result.sample.size());
    }
    return result;
}

void InfluenceKeeper::remove(const SampleBlocks& blocks,
                             std::span<const SampleBlocks::Change> changes, std::uint32_t motion) {
    begin(motion);
    for (const SampleBlocks::Change& change : changes) {
        const auto& before = blocks.before(change);
        for_changed({&change, 1}, [&](std::size_t position) {
            const std::uint32_t s = blocks.sample(position);
            const double removed =
                before[position % SampleBlocks::kLanes] - blocks.height(position);
            if (!(removed > 0.0)) return;  // lost in rounding
            if (removed_[s] == 0.0) touched_.push_back(s);
            removed_[s] += removed;
        });
    }
}

void InfluenceKeeper::add(std::uint32_t sample, double amount, std::uint32_t motion) {
    begin(motion);
    if (removed_[sample] == 0.0) touched_.push_back(sample);
    removed_[sample] += amount;
}

void InfluenceKeeper::Part::append(const Part& next) {
    first.insert(first.end(), next.first.begin(), next.first.end());
    sample.insert(sample.end(), next.sample.begin(), next.sample.end());
    depth.insert(depth.end(), next.depth.begin(), next.depth.end());
    motion = next.motion;
    touched = next.touched;
    removed = next.removed;
}

std::size_t InfluenceKeeper::Part::bytes() const {
    return first.size() * sizeof(std::size_t) + sample.size() * sizeof(std::uint32_t) +
           depth.size() * sizeof(float) + touched.size() * (sizeof(std::uint32_t) + sizeof(double));
}

InfluenceKeeper::Part InfluenceKeeper::next_part() {
    Part part;
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

void InfluenceKeeper::restore(const Part& part) {
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(influence_.first, part.first);
    append(influence_.sample, part.sample);
    append(influence_.depth, part.depth);
    motion_ = part.motion;
    for (const std::uint32_t s : touched_) removed_[s] = 0.0;
    touched_ = part.touched;
    for (std::size_t k = 0; k < touched_.size(); ++k) removed_[touched_[k]] = part.removed[k];
    given_first_ = influence_.first.size();
    given_entries_ = influence_.sample.size();
}

void InfluenceKeeper::begin(std::uint32_t motion) {
    if (motion == motion_) return;
    close(motion_);
    motion_ = motion;
}

// Ends the running motion, and those up to `motion` that removed nothing.
void InfluenceKeeper::close(std::size_t motion) {
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

Influence InfluenceKeeper::take(std::size_t motions) {
    close(motion_);
    influence_.first.resize(motions + 1, influence_.sample.size());
    return std::move(influence_);
}

}  // namespace beltgrinding
