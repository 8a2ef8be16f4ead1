#pragma once

#include <cstdint>
#include <vector>

#include "heat/depth_factors.h"
#include "heat/heat_patch.h"

namespace beltgrinding {

/// Heat on the nodes of a level, all of which is conducted together. Nodes without heat take no
/// part; those beside warm ones join them.
class HeatLayer {
  public:
    using Row = DepthModes::Row;
    /// What it lies on, as of `ThermalLevel`. `even`: the part whose coarsest level it is, or null.
    struct Grid {
        const std::vector<std::uint32_t>& first;
        const std::vector<std::uint32_t>& neighbour;
        const std::vector<float>& conductance;
        const std::vector<float>& area;
        const std::vector<float>& depth;
        const std::vector<float>& sectional;
        double spacing, dispersion;
        const PartHeat* even;
    };
    /// `rows`: K, (nodes, modes), where it keeps its heat; they and `grid.first` must outlive it.
    HeatLayer(const Grid& grid, double diffusivity, std::vector<float>& rows);
    HeatLayer(const HeatLayer&) = delete;
    HeatLayer& operator=(const HeatLayer&) = delete;

    std::size_t size() const { return mark_.size(); }
    /// Rates in 1/s, in the order of the grid's neighbours.
    const std::vector<HeatWay>& ways() const { return ways_; }

    /// K, (modes), as of `current`; 0 of one without heat.
    float* row(std::uint32_t node) { return &rows_[std::size_t{node} * kModes]; }
    const float* row(std::uint32_t node) const { return &rows_[std::size_t{node} * kModes]; }
    /// s
    double& current(std::uint32_t node) { return current_[node]; }
    double current(std::uint32_t node) const { return current_[node]; }
    bool has(std::uint32_t node) const { return mark_[node] == kHas; }
    /// What it has not yet is 0, as of `now`.
    void put(std::uint32_t node, double now) {
        if (mark_[node] == kHas) return;
        mark_[node] = kHas;
        current_[node] = now;
    }
    /// Adds a share of another layer's row, where it has any; else that becomes 0.
    void add(std::uint32_t node, float* from, const Row& share);
    /// The row becomes 0.
    void remove(std::uint32_t node);
    /// It has no heat here, and gets none, until it is put back: it is elsewhere.
    void lend(std::uint32_t node) { mark_[node] = kElsewhere; }
    /// Those that have heat, ascending.
    void list(std::vector<std::uint32_t>& nodes) const;

    /// All are brought to `now`; what flows along the surface is that of `duration` s. Nothing
    /// flows to where it is elsewhere. In a time in which all would long have gone to a coarser
    /// level, what is left here is only conducted until it is even with its neighbours.
    void conduct(double now, double duration, DepthFactors& factors);
    /// Of the last time: the nodes, ascending, and their sums, K.
    const std::vector<std::uint32_t>& nodes() const { return nodes_; }
    const std::vector<float>& sums() const { return sums_; }

  private:
    static constexpr std::size_t kModes = DepthModes::kModes;
    static constexpr std::uint8_t kHas = 0, kElsewhere = 200, kNothing = 255;

    void spread(double now, double duration);
    void join();
    /// Whether it was conducted by the spectrum, as there is one and the time is long.
    bool conduct_even(double now, double duration, DepthFactors& factors);

    const std::vector<std::uint32_t>& first_;
    std::vector<HeatWay> ways_;  // rates in 1/s
    double spacing_, dispersion_, diffusivity_;
    const PartHeat* even_;
    std::vector<float>& rows_;
    std::vector<double> current_;
    std::vector<std::uint8_t> mark_;
    std::vector<std::uint32_t> nodes_, front_, reached_;
    std::vector<std::uint32_t> place_;  // by node: in `nodes_`
    std::vector<std::uint8_t> fast_;    // of `nodes_`: has more than the slow modes
    HeatPatch patch_;
    std::vector<float> now_;  // rows of `nodes_`
    std::vector<float> sums_;
    RowConductor conductor_;
};

}  // namespace beltgrinding
