#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "beltgrinding/heat.h"
#include "heat/depth_factors.h"
#include "heat/heat_layer.h"
#include "heat/thermal_levels.h"

namespace beltgrinding {

/// Heat that has become smooth, on the levels of fewer nodes above a part's (`ThermalLevel`). It
/// comes there for good: a place's temperature is the sum of what all levels have there. So
/// nothing flows between levels, and what is handed up is all that is there or a share of it, by
/// its age: how long ago heat came near, or as smooth as that.
class CoarseHeat {
  public:
    /// s: how long heat takes to a point from where it comes in, or has to be as smooth.
    using Way = std::function<double(const Vec3& point)>;
    struct Rise {
        float rise, slope;  // K, K/s
    };
    struct Risen {
        std::uint32_t node;
        float rise;  // K
    };

    /// The part must outlive it. `decays`: whether modes do.
    explicit CoarseHeat(const PartHeat& part, bool decays = true);

    bool empty() const;
    /// s: the least age of what may come.
    double ripe() const;
    /// Whether its time has come.
    bool due(double now) const;
    /// The levels that are due, or `all`, are brought to `now`, and hand up. Heat came in last at
    /// `heated` s.
    void step(double now, double heated, const Way& way, bool all = false);
    /// Nothing is left, as of `now`.
    void clear(double now);
    /// Adds a `share` of what another one of the part has; both have stepped with all levels, this
    /// one at `now`. What is not shared is taken off the other one.
    void add(CoarseHeat& other, const DepthModes::Row& share, double now);
    /// Heat begins to come in at another place.
    void move(double now, const Way& way);
    /// Of a row that has been brought to a `step`: what it keeps of it, 0 to 1; the rest is to be
    /// given.
    float kept(double age) const;
    /// Takes a node's heat, after a step. `last`: s, when heat came near the node last.
    void give(std::uint32_t node, const DepthModes::Row& row, double last);
    /// What was given becomes the levels'. Calls visit(node, row) for the nodes that it is
    /// interpolated to, with what they have of it from now on: what is left of theirs is the rest.
    using Visit = std::function<void(std::uint32_t node, const DepthModes::Row& row)>;
    void take(const Visit& visit) { take(0, visit); }
    /// After all that: rises are those of what is there now.
    void read() { read(false); }
    /// The same of all levels, wherever they are.
    void read_all() { read(true); }
    /// At a node, `now` or soon after the last step.
    Rise rise(std::uint32_t node, double now) const;
    /// After a step: nodes whose rise may be above `peak`, and their rises.
    const std::vector<Risen>& risen(const std::vector<float>& peak);
    /// Whether the rest of what has been handed up makes no difference where it is.
    static bool little(const float* row);
    /// Takes a rest, wherever it gets.
    void give_rest(std::uint32_t node, const float* row);
    /// Hands all back to the part's nodes, as of `now`; nothing is left.
    void settle(double now, HeatLayer& layer);

    /// What a level has. All of it, as of its time, s.
    struct Part {
        double time = 0.0, before = 0.0;
        std::vector<std::uint32_t> nodes;  // ascending
        std::vector<float> rows;           // K
        std::vector<double> last;          // s
    };
    struct Parts {
        double stepped = 0.0;
        std::vector<Part> levels;
        std::size_t bytes() const;
    };
    Parts parts() const;
    void restore(const Parts& parts);

  private:
    using Row = DepthModes::Row;
    struct Level {
        Level(const ThermalLevel& place, double diffusivity, double now, const PartHeat* even);

        const ThermalLevel& place;
        std::vector<float> rows;
        HeatLayer layer;
        double interval, ripe;              // s: between steps; of what may come, the least age
        double time, before;                // s, of the last step and of the one before
        std::vector<double> last;           // s, by node that has heat: when some came near last
        std::vector<Row> given;             // K, by node: what has not been taken
        std::vector<std::uint32_t> from;    // nodes with some
        std::vector<std::uint8_t> visited;  // by node of the level below
        // K and K/s, by node: as of `time`; with the levels above, as of the last step of all.
        std::vector<float> own, own_slope, total, total_slope;
        std::vector<std::uint32_t> read;  // nodes with some of their own
    };

    void make(double now);
    static float kept(const Level& to, double age);
    void give(std::size_t level, std::uint32_t finer, float area, float depth, const Row& row,
              double last);
    void take(std::size_t level, const Visit& visit);
    void give_rest(std::size_t level, std::uint32_t finer, float area, float depth,
                   const float* row);
    /// Of the levels from the step's on, or all.
    void read(bool all);
    void read_own(Level& level);
    /// Adds up what a node of the level below has of two arrays.
    static Rise between(const Level& level, std::uint32_t finer);

    const PartHeat& part_;
    double diffusivity_, interval_;
    std::vector<std::unique_ptr<Level>> levels_;
    DepthFactors factors_;
    double stepped_;
    std::vector<std::uint32_t> list_, old_, ripe_;
    std::vector<Risen> risen_;
};

}  // namespace beltgrinding
