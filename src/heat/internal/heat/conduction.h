#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beltgrinding/heat.h"
#include "heat/heat_patch.h"
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

    /// What changed between two moments between steps, and what goes on from the latter. What it
    /// began with and all parts since make up all that a later step depends on, to the last bit.
    struct Part {
        struct Node {
            std::uint32_t node;
            float peak;                       // K
            std::uint32_t source;             // motion
            std::uint8_t level;               // of sweeps
            double current, conducted, last;  // s, as in HeatState
            DepthModes::Row modes;            // K
        };
        // Since the one before.
        std::vector<Node> nodes;  // ascending
        // As of now.
        double time = 0.0, heated = 0.0, zone_time = 0.0, last_sweep = 0.0;  // s
        std::uint32_t motion = HeatState::kNever;
        Vec3 centre = Vec3::Zero();
        double radius = 0.0;
        std::vector<std::uint32_t> zone, beyond;  // nodes
        std::vector<std::uint8_t> ring;           // of the zone's
        std::vector<float> rows;                  // K, as of the zone

        std::size_t bytes() const;
        /// Becomes both in one; `next` is the one after it.
        void append(const Part& next);
    };
    /// Since the last call, or the beginning.
    Part next_part();
    /// Goes on behind the last of `parts`, which are all from the beginning.
    void restore(std::span<const Part* const> parts);

  private:
    static constexpr std::size_t kSpans = 5;  // of a sweep's time
    static constexpr std::uint8_t kOutside = 255;
    using Row = DepthModes::Row;
    /// What the modes do in some time.
    struct Factors {
        double duration = -1.0;  // s
        Row decay{}, gain{};     // the latter: K of a flux of 1 N/(mm s) and a weight of 1 / mm
    };

    const Factors& factors(double duration);
    void heat(double duration);
    float flux(std::uint32_t node) const;
    void inject(const Row& gain);
    void forget_direct();
    bool zone_holds() const;
    void make_zone();
    /// Of the nodes in it and beyond it, what follows from which they are.
    void place_zone();
    void find_zone(std::vector<std::uint32_t>& beside);
    void join_zone();
    /// What is beyond the zone goes back to the state, with what flowed there; and comes from it.
    void put_beyond_back();
    void take_beyond();
    /// All goes back to the state.
    void leave_zone();
    /// Brings those outside the zone to `now` that are due, all round it and of `must`, or
    /// `everything`. A way is conducted through for the time since one of its ends was due, so
    /// that nothing is lost.
    void sweep(double now, std::span<const std::uint32_t> must, bool everything);
    void find_due(double now, std::span<const std::uint32_t> must, bool everything);
    void find_beside(double now);
    std::array<double, kSpans> span_ends() const;
    /// How many of a sweep's spans each node takes part in; those of more come first.
    void order(double now);
    void divide(double now);
    /// Calls visit(way, time) for the ways of a node that are conducted through; `time`: s, for
    /// which they have not been.
    template <class Visit>
    void for_due_ways(std::uint32_t node, double now, Visit visit) const;
    std::uint8_t level_of(std::uint32_t node, double now) const;
    /// What is due is brought to the state's time; the zone is given up.
    void catch_up();
    bool in_zone(std::uint32_t node) const { return ring_[node] != kOutside; }
    void note_peak(std::uint32_t node, float rise);

    const ThermalNodes& nodes_;
    int rings_;
    HeatMaterial material_;
    double diffusivity_;  // mm2/s
    double unit_;         // s, of the sweeps' intervals
    HeatState state_;
    std::vector<float> rate_, mean_rate_;  // 1/s, of all ways, as in `HeatPatch`
    std::vector<double> power_;            // N mm/s, by node
    std::vector<std::uint32_t> powered_;   // those with some

    HeatPatch zone_;
    std::vector<float> zone_rows_,
        zone_sums_;                        // K, of the zone, then beyond, then what flowed there
    std::vector<std::uint32_t> beyond_;    // neighbours of the zone's, outside
    std::vector<std::uint32_t> thin_;      // of the zone's: with a node on the other side
    std::vector<std::uint32_t> heated_;    // that heat flowed into last, from either side
    std::vector<std::uint8_t> ring_;       // by node: from the heat; kOutside: not in the zone
    std::vector<std::uint8_t> next_ring_;  // the same of the zone that is being made
    std::vector<std::uint32_t> place_;     // by node: in the zone
    std::vector<float> direct_;            // K, by node: what is faster than the modes
    double zone_time_;                     // s: what all outside the zone and it is brought to

    std::vector<std::uint8_t> level_;     // by node: swept every unit_ times 2^level s
    std::vector<std::uint8_t> due_;       // by node: kDue or kBeside in the sweep
    std::vector<std::uint8_t> fast_;      // by node of the sweep: has more than the slow modes
    std::vector<std::uint8_t> spans_;     // by node of the sweep: that it takes part in
    std::vector<std::uint32_t> touched_;  // nodes of the sweep
    std::vector<std::uint32_t> ordered_;  // the same
    std::vector<std::uint32_t> there_;    // by node of the sweep: in `ordered_`
    std::array<HeatPatch, kSpans> swept_;
    std::vector<float> rows_;  // K, of the sweep, as ordered
    double last_sweep_;        // s: when
    double noted_;             // s: time of the last part
    RowConductor conductor_;
    std::array<Factors, 64> known_;  // by their duration
    double hottest_ = 0.0;
    std::uint32_t hottest_node_ = 0;
};

}  // namespace beltgrinding
