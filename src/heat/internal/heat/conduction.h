#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "beltgrinding/heat.h"
#include "heat/coarse_heat.h"
#include "heat/depth_factors.h"
#include "heat/heat_layer.h"
#include "heat/heat_patch.h"
#include "heat/thermal_nodes.h"

namespace beltgrinding {

/// Brings the heat of a part forward in time. Near where heat comes in, in the *zone*, at every
/// step; elsewhere in sweeps now and then; on fewer and fewer nodes (`CoarseHeat`) once it has
/// become smooth.
class Conduction {
  public:
    static constexpr int kRings = 8;  ///< of nodes round the heat that are in the zone

    /// Goes on from the part's state. The part must outlive it, and keep its thickness. `rings`:
    /// from 4 to 200; with more than `kRings` all heat stays on the part's nodes.
    explicit Conduction(const PartHeat& part, int rings = kRings)
        : Conduction(part, rings, false) {}

    /// A power, N mm/s, flows into `node` in the next `advance`; several add up.
    void add(std::uint32_t node, double power);
    /// The powers flow for `duration` s, evenly, while the robot is on its way to the pose of
    /// `motion`; then they are none. Throws InputError where temperatures are beyond what can be.
    /// `before`: the share that a node's rise at the step's beginning has in what is noted as its
    /// greatest, while it rises: of a source that moves on during the step.
    void advance(double duration, std::uint32_t motion, double before = 0.0);
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
    /// The state, all of it brought to its time, on the part's nodes. Throws InputError if heat was
    /// made or lost.
    const HeatState& settle();

    /// What changed between two moments between steps, and what goes on from the latter. What it
    /// began with and all parts since make up all that a later step depends on, to the last bit.
    struct Part {
        struct Node {
            std::uint32_t node;
            float peak;             // K
            std::uint32_t source;   // motion
            std::uint8_t has;       // heat of its own
            double current, last;   // s, as in HeatLayer and HeatState
            DepthModes::Row modes;  // K
        };
        // Since the one before.
        std::vector<Node> nodes;  // ascending
        // As of now.
        double time = 0.0, heated = 0.0, zone_time = 0.0, last_sweep = 0.0;  // s
        double flowed = 0.0, bound = 0.0;                                    // as of HeatState
        std::array<double, HeatState::kModes> most{};
        std::uint32_t motion = HeatState::kNever;
        Frame place = Frame::Identity();
        Vec3 half = Vec3::Zero();
        std::vector<std::uint32_t> zone, beyond;  // nodes
        std::vector<std::uint8_t> ring;           // of the zone's
        std::vector<float> rows;                  // K, as of the zone
        std::vector<float> base, slope;           // K and K/s, of the zone's
        std::vector<float> ended;                 // K, of the zone's, or none
        double base_time = 0.0;                   // s
        CoarseHeat::Parts coarse;

        std::size_t bytes() const;
        /// Becomes both in one; `next` is the one after it.
        void append(const Part& next);
    };
    /// Since the last call, or the beginning.
    Part next_part();
    /// Goes on behind the last of `parts`, which are all from the beginning.
    void restore(std::span<const Part* const> parts);

  private:
    static constexpr std::uint8_t kOutside = 255;
    using Row = DepthModes::Row;

    /// `pulse`: what came in at 0 s, none at first, without what goes into the depth.
    Conduction(const PartHeat& part, int rings, bool pulse);
    void heat(double duration);
    /// A step in which heat gets much farther than a node.
    void dwell(double duration, std::uint32_t motion);
    void begin_pulse(const Conduction& from, double duration);
    void pulse_until(double time);
    void end_pulse();
    void add_pulse(const Row& share);
    void find_heated(const std::vector<std::uint32_t>& nodes);
    /// Keeps what flows in for `duration` s, and what can come of it.
    void account(double duration);
    void decay_bound(double duration);
    void check_bounds() const;
    void check_energy() const;
    /// N/(mm2 s): what heats the modes.
    Row source(std::uint32_t node) const;
    float flux(std::uint32_t node) const;
    void inject(const Row& gain);
    void forget_direct();
    bool zone_holds() const;
    void make_zone();
    void place_heat();
    /// Of the nodes in it and beyond it, what follows from which they are.
    void place_zone();
    void find_zone(std::vector<std::uint32_t>& nodes, std::vector<std::uint32_t>& beside);
    void join_zone();
    /// What is beyond the zone goes back to its nodes, with what flowed there; and comes from it.
    void put_beyond_back();
    void take_beyond();
    /// All goes back to the nodes.
    void leave_zone();
    /// Brings all outside the zone to the zone's time; `all`: on all levels, due or not.
    void sweep(bool all = false);
    /// Smooth heat goes to fewer nodes.
    void hand_up(bool all);
    /// What the zone's nodes have of the levels above.
    void find_base();
    /// s: how long ago heat came near a node, or as smooth as that.
    double age(std::uint32_t node) const;
    double zone_age(std::uint32_t ring) const;
    /// s: that heat needs from where it comes in to a point.
    double way(const Vec3& point) const;
    void catch_up(bool all = false);
    bool in_zone(std::uint32_t node) const { return ring_[node] != kOutside; }
    void note_peak(std::uint32_t node, float rise);
    /// At the end of a step.
    void note_now(std::uint32_t node, float rise);
    /// The zone's rises are those of a step's end; and are noted as they are, as no step follows.
    void keep_ended();
    void note_ended();

    const PartHeat& part_;
    const ThermalNodes& nodes_;
    int rings_;
    HeatMaterial material_;
    double diffusivity_;                    // mm2/s
    double unit_;                           // s, between sweeps
    HeatState state_;                       // its modes: of the layer
    std::vector<float> depth_, sectional_;  // mm, of sections; as of ThermalLevel
    HeatLayer layer_;                       // outside the zone
    CoarseHeat coarse_;
    std::vector<double> power_;           // N mm/s, by node
    std::vector<std::uint32_t> powered_;  // those with some

    HeatPatch zone_;
    std::vector<float> zone_rows_,
        zone_sums_;                        // K, of the zone, then beyond
    std::vector<float> base_, slope_;      // K and K/s, of the zone's, of the levels above
    double base_time_ = 0.0;               // s
    double before_ = 0.0;                  // as of `advance`
    std::vector<std::uint32_t> last_;      // nodes that have that
    std::vector<std::uint32_t> beyond_;    // neighbours of the zone's, outside
    std::vector<std::uint32_t> thin_;      // of the zone's: with a node on the other side
    std::vector<std::uint32_t> heated_;    // that heat flowed into last, from either side
    std::vector<std::uint8_t> ring_;       // by node: from the heat; kOutside: not in the zone
    std::vector<std::uint8_t> next_ring_;  // the same of the zone that is being made
    std::vector<std::uint32_t> place_;     // by node: in the zone
    std::vector<float> ended_;             // K, by node: at the end of the last step, or none
    std::vector<float> direct_;            // K, by node: what is faster than the modes
    double zone_time_;                     // s: what the zone is brought to
    double last_sweep_;                    // s: when
    std::vector<std::uint8_t> changed_;    // by node: since the last part
    RowConductor conductor_;
    DepthFactors factors_;
    std::unique_ptr<Conduction> pulse_;    // between steps without heat
    double hottest_ = 0.0, lowest_ = 0.0;  // K
    std::uint32_t hottest_node_ = 0;
};

}  // namespace beltgrinding
