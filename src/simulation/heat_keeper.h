#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/simulation.h"
#include "contact/gap_map.h"
#include "heat/conduction.h"
#include "heightfield/sample_blocks.h"
#include "node_forces.h"

namespace beltgrinding {

/// Lets the friction of a simulation's contacts heat the part: beside it, until all is done.
class HeatKeeper {
  public:
    /// All must outlive it.
    HeatKeeper(const SampleBlocks& blocks, const HeatRequest& request, double belt_speed);

    /// The wheel presses with `pressure`, `force` N in all, for `duration` s of the running step.
    void press(const GapMap& map, const DisplacedPressure& pressure, double force, double duration);
    /// The step, which began `begin` s after the program, has lasted `duration` s. Before the first
    /// and between steps the part rests.
    void end_step(double begin, double duration, std::uint32_t motion);
    /// K: the greatest rise at the end of the last step, and the position of a sample there; none
    /// if nothing flowed in.
    double hottest() const { return conduction_.hottest(); }
    std::size_t hottest_position() const;
    /// What goes on between steps; see `Conduction`.
    Conduction::Part next_part() { return conduction_.next_part(); }
    void restore(std::span<const Conduction::Part* const> parts) { conduction_.restore(parts); }
    /// Hands over to the part and the field, at the program's end.
    void keep(double duration, HeightField& field);

  private:
    const SampleBlocks& blocks_;
    const HeatRequest& request_;
    double belt_speed_;
    double start_;  // s, of the program
    Conduction conduction_;
    std::vector<NodeShare> shares_;        // of nodes in blocks
    std::vector<std::uint32_t> first_;     // (blocks + 1), of `shares_`
    std::vector<float> forces_;            // N, of a block's shares: as many as any has
    std::vector<std::uint32_t> position_;  // by node, of its sample
    std::vector<double> area_;             // mm2 by node, of its samples
    std::vector<double> force_, work_;     // N, of one contact; N s, of the running step: by node
    std::vector<std::uint32_t> pressed_, worked_;  // those with some
};

}  // namespace beltgrinding
