#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gap/edge_cells.h"
#include "gap/placed_samples.h"

namespace beltgrinding {

/// Steps of the surface that are lower than half a cell: two samples beside each other lie at other
/// heights than their slopes tell. A mean over both would round the step off, and the pressure at
/// its edge would be a tenth of what it is.
class LowSteps {
  public:
    /// mm: lower steps are averaged.
    static double least(const ContactGrid& grid) {
        constexpr double kLeast = 0.1;  // cells
        return kLeast * std::max(grid.ds, grid.dy);
    }
    /// The lowest step, mm, near what may bear pressure; `most` where none is lower. Of each cell's
    /// samples `low` and `high`, mm: the nearest and farthest in its mean.
    double lowest(const PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
                  const EdgeCells& cells, std::span<const float> low, std::span<const float> high,
                  double most);

  private:
    /// A sample near a cell that may be stepped, in cells, and its gap there carried to the cell.
    struct Near {
        std::uint32_t cell;
        float carried, own;  // mm, to the cell's centre, at the sample
        std::uint32_t sample;
        float s, y;              // cells
        float slope_s, slope_y;  // mm by a cell
    };
    /// Finds the cells that may be stepped. False: there is none.
    bool find_cells(const PlacedSamples& placed, const ContactGrid& grid, const EdgeCells& cells,
                    std::span<const float> low, std::span<const float> high);
    /// Finds the samples near them.
    void find_samples(const PlacedSamples& placed, const SampleBlocks& blocks,
                      const ContactGrid& grid);
    /// mm of the step between the samples of a cell; 0: there is none.
    static double step_between(const HeightField& field, std::span<Near> samples);

    std::vector<Near> near_;
    std::vector<std::uint8_t> stepped_;  // by cell: it may be
};

}  // namespace beltgrinding
