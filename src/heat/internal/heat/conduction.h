#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/heat.h"
#include "heat/thermal_nodes.h"

namespace beltgrinding {

/// Brings the heat of a part forward in time. Near where heat comes in, in the *zone*, at every
/// step; elsewhere in sweeps now and then, whose intervals grow with the time since heat came near.
class Conduction {
  public:
    static constexpr int kRings = 8;  ///< of nodes round the heat that are in the zone

    /// Goes on from the part's state. The part must outlive it, and keep its thickness. `rings`:
    /// from 4 to 200.
    explicit Conduction(const PartHeat& part, int rings = kRings);

    /// A power, N mm/s, flows into `node` in the next `advance`; several add up.
    void add(std::uint32_t node, double power);
    /// The powers flow for `duration` s, evenly, while the robot is on its way to the pose of
    /// `motion`; then they are none.
    void advance(double duration, std::uint32_t motion);
    /// Nothing flows in until `time` s.
    void idle(double time);

    /// s
    double time() const { return state_.time; }
    /// K: greatest rise at the end of the last `advance`, and the node.
    double hottest() const { return hottest_; }
    std::uint32_t hottest_node() const { return hottest_node_; }
    /// K, of a node at the end of the last `advance`, up to what `settle` would add to it; behind
    /// the heat source that may be a few per cent.
    double rise(std::uint32_t node) const;
    /// The state, all of it brought to its time.
    const HeatState& settle();

  private:
    /// Some nodes and the ways between them.
    struct Patch {
        std::vector<std::uint32_t> nodes;             // ascending
        std::vector<std::uint32_t> first, neighbour;  // the latter: numbers in `nodes`
        // What a K of difference does: 1/s, or 1 if for an interval of the way's own.
        std::vector<float> rate;
        std::vector<float> mean_rate;  // of the first mode, by the sections' thickness
        double most = 0.0;             // greatest sum of a node's rates
    };
    /// Fills `patch.nodes`' ways; interval(node, node) is a factor on each, 0: no way.
    template <class Interval>
    void join(Patch& patch, Interval interval);
    void conduct(const Patch& patch, double duration);
    void decay(std::uint32_t node, double duration);
    void set_duration(double duration);
    void heat(double duration);
    bool zone_holds() const;
    void make_zone();
    /// Brings those to `now` that are due, all of the zone and of `must`, or `everything`; a way is
    /// conducted through for the time since one of its ends was due, so that nothing is lost.
    void sweep(double now, std::span<const std::uint32_t> must, bool everything);
    void set_levels(double now);
    /// The zone is given up, and what is due brought to the state's time.
    void catch_up();
    void leave_zone();
    void note_peaks(std::span<const std::uint32_t> nodes, bool heated);

    const ThermalNodes& nodes_;
    int rings_;
    HeatMaterial material_;
    double diffusivity_;  // mm2/s
    double longest_;      // s, that a zone is kept, or a step takes
    HeatState state_;
    std::vector<double> power_;           // N mm/s, by node
    std::vector<std::uint32_t> powered_;  // those with some
    Patch zone_, swept_;
    std::vector<std::uint8_t> ring_;    // by node: from the heat; kOutside: not in the zone
    std::vector<std::uint32_t> place_;  // by node: in the patch that is being made
    std::vector<float> direct_;         // K, by node: what is faster than the modes
    std::vector<float> rows_[3];        // K, of a patch
    DepthModes::Row decay_{}, gain_{};  // after a `duration_` s
    double duration_ = -1.0;
    std::vector<std::uint8_t> level_;  // by node: swept every longest_ times 2^level s
    int sweeps_ = 0;
    std::vector<std::uint8_t> due_;  // by node: in the sweep
    double zone_time_;               // s: what the zone is brought to
    double zone_made_;               // s: when
    double hottest_ = 0.0;
    std::uint32_t hottest_node_ = 0;
};

}  // namespace beltgrinding
