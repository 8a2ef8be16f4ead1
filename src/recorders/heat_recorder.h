#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"
#include "heat/conduction.h"
#include "node_forces.h"

namespace beltgrinding {

/// Lets the friction of a simulation's contacts heat the part: beside it, until all is done. Before
/// the first and between steps the part rests.
class HeatRecorder final : public Keeps<Conduction::Part, Recorder> {
  public:
    /// `pause`: s before the path; `duration`: s, of it. All must outlive it.
    HeatRecorder(const SampleBlocks& blocks, const HeatRequest& request, double belt_speed,
                 double pause, double duration);

    std::string kind() const override;
    void pressed(const Press& press) override;
    /// Throws InputError where the surface boils away.
    void end_step(const StepEnd& end) override;
    void end() override;
    void keep(HeightField& field, SimulationResult&) override;
    /// K: the greatest rise at the end of the last step, and the position of a sample there; none
    /// if nothing flowed in.
    double hottest() const { return conduction_.hottest(); }
    std::size_t hottest_position() const;

  private:
    Conduction::Part take(std::span<const std::uint32_t>) override {
        return conduction_.next_part();
    }
    void put(std::span<const Conduction::Part* const> parts) override {
        conduction_.restore(parts);
    }
    /// `rise` K, from `power` N mm/s on `area` mm2, for `contact` s so far.
    void refuse_vapour(double rise, double power, double area, double contact) const;
    double share_before(double duration, double travel) const;

    const SampleBlocks& blocks_;
    const HeatRequest& request_;
    double belt_speed_;
    double start_, duration_;  // s, of the program
    Conduction conduction_;
    HeatState settled_;                    // at the program's end
    std::vector<NodeShare> shares_;        // of nodes in blocks
    std::vector<std::uint32_t> first_;     // (blocks + 1), of `shares_`
    std::vector<float> forces_;            // N, of a block's shares: as many as any has
    std::vector<std::uint32_t> position_;  // by node, of its sample
    std::vector<double> area_;             // mm2 by node, of its samples
    std::vector<double> force_, work_;     // N, of one contact; N s, of the running step: by node
    std::vector<std::uint32_t> pressed_, worked_;  // those with some
    std::vector<double> contact_;                  // s, by node: how long it was heated
};

}  // namespace beltgrinding
