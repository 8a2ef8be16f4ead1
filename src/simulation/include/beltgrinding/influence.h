#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace beltgrinding {

/// How much every motion of a path removed at every sample: a sparse matrix, motion by motion.
struct Influence {
    std::vector<std::size_t> first = {0};  ///< (motions + 1), where a motion's entries begin
    std::vector<std::uint32_t> sample;     ///< rising within a motion
    std::vector<float> depth;              ///< mm, above 0

    /// How many there are, those that removed nothing among them.
    std::size_t motions() const { return first.size() - 1; }
    /// Goes on with the motions of `next`, the same field's, which come after these.
    void append(const Influence& next);
    /// That of groups of motions, which are changed together: `group` has the number of each
    /// motion's, below `count`. Throws InputError where the numbers do not fit.
    Influence grouped(std::span<const std::uint32_t> group, std::size_t count) const;
};

/// Collects an influence during a simulation, whose motions come one after the other.
class InfluenceKeeper {
  public:
    /// `heights`: mm (samples), before the first motion.
    explicit InfluenceKeeper(const std::vector<double>& heights)
        : height_(heights), removed_(heights.size(), 0.0) {}

    /// The motion number `motion` has lowered the samples `changed` (each named once) to `heights`.
    void remove(const std::vector<double>& heights, std::span<const std::uint32_t> changed,
                std::uint32_t motion);
    /// What has been collected, of `motions` in all. Call once.
    Influence take(std::size_t motions);

  private:
    void close(std::size_t motion);

    Influence influence_;
    std::vector<double> height_;          // mm, as of the last `remove`
    std::vector<double> removed_;         // mm, by the running motion
    std::vector<std::uint32_t> touched_;  // by the running motion
    std::uint32_t motion_ = 0;
};

}  // namespace beltgrinding
