#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// Which cells lie at an edge of what is mapped, as far as they may bear pressure.
class EdgeCells {
  public:
    /// Of no cell it is asked whether it may bear pressure: all may.
    static constexpr double kAll = std::numeric_limits<double>::infinity();

    /// Which cells may bear pressure, their gaps (`nearest`, mm, by cell) being up to `pressable`.
    template <class Nearest>
    void find_pressable(const ContactGrid& grid, const Nearest* nearest, double pressable) {
        const auto cells = static_cast<std::size_t>(grid.cells());
        pressable_.clear();
        matters_.assign(cells, 1);
        if (!(pressable < kAll)) return;
        pressable_.resize(cells);
        for (std::size_t k = 0; k < cells; ++k) pressable_[k] = nearest[k] <= pressable ? 1 : 0;
        find_near_pressable(grid);
    }
    /// No cell is an edge cell.
    void clear(std::size_t cells) { kind_.assign(cells, kWhole); }
    /// Cells beside which there is nothing, or another layer (`layer` mm behind), are edge cells;
    /// those up to two further are near an edge. Of the samples in a cell, `nearest` and
    /// `farthest`, mm. Only where cells with gaps up to `pressable` may have to do with it.
    void mark(const ContactGrid& grid, const std::vector<double>& nearest,
              const std::vector<double>& farthest, double layer, double pressable);

    bool edge(std::size_t cell) const { return kind_[cell] == kEdge; }
    /// Neither an edge cell nor near one.
    bool whole(std::size_t cell) const { return kind_[cell] == kWhole; }
    bool any() const { return std::find(kind_.begin(), kind_.end(), kEdge) != kind_.end(); }
    /// So near to a cell that may bear pressure that an edge counts.
    bool matters(std::size_t cell) const { return matters_[cell] != 0; }
    /// No cell that an edge not looked at has to do with bears pressure (MPa, by cell).
    bool holds_for(const Eigen::ArrayXd& pressure) const;

  private:
    enum : std::uint8_t { kWhole, kNearEdge, kEdge };
    void find_near_pressable(const ContactGrid& grid);
    /// Marks the cells round those that `is` tells, up to `steps` away.
    template <class Is>
    void spread(const ContactGrid& grid, Is is, std::uint8_t kind, int steps);

    std::vector<std::uint8_t> kind_, wider_;
    std::vector<std::uint8_t> pressable_;  // empty: all edges are looked at
    std::vector<std::uint8_t> matters_;
};

}  // namespace beltgrinding
