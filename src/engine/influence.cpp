#include <algorithm>
#include <utility>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation_options.h"

namespace beltgrinding {

void Influence::append(const Influence& next) {
    const std::size_t before = sample.size();
    if (!feedback.empty() || !next.feedback.empty()) {
        feedback.resize(motions(), 0.0F);
        feedback.insert(feedback.end(), next.feedback.begin(), next.feedback.end());
        feedback.resize(motions() + next.motions(), 0.0F);
    }
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

}  // namespace beltgrinding
