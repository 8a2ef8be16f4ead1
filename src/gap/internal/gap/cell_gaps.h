#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "contact/coverage.h"
#include "gap/edge_cells.h"
#include "gap/edge_patches.h"
#include "gap/low_steps.h"
#include "gap/placed_samples.h"

namespace beltgrinding {

/// The gap of a grid's cells, and what of them is covered: means over the samples round them.
class CellGaps {
  public:
    /// `layer`: mm, what lies further behind the nearest sample belongs to another layer. `steps`:
    /// lower steps are looked for.
    CellGaps(double layer, bool steps) : whole_layer_(layer), layer_(layer), steps_(steps) {}

    /// `layer`: as of the constructor. `sparse`: samples may lie further apart than cells are wide.
    void set_layer(double layer, bool sparse) {
        whole_layer_ = layer_ = layer;
        sparse_ = sparse;
    }
    /// Nothing is mapped.
    void clear(const ContactGrid& grid);
    /// Maps the samples, whose cells are known. Edges count near cells with gaps up to `pressable`
    /// mm.
    void map(PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
             double pressable);
    /// There is no surface under the cell.
    void leave_out(Eigen::Index cell);

    const Eigen::ArrayXd& gap() const { return gap_; }  ///< mm; +inf: no surface
    const Coverage& coverage() const { return coverage_; }
    const EdgeCells& edges() const { return edges_; }
    const EdgePatches& patches() const { return patches_; }
    /// mm: the layer that is used where no lower step is looked for or found.
    double whole_layer() const { return whole_layer_; }
    /// The same, half of the lowest step that was found.
    double layer() const { return layer_; }

  private:
    /// `map` where no edge, step or second layer is near what may bear pressure; false, with
    /// nothing of use done, where one may be.
    bool map_smooth(PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
                    double pressable);
    /// Sums up all samples by cell.
    void gather(const PlacedSamples& placed, const ContactGrid& grid);
    /// No second layer, and no step near what may bear pressure.
    bool smooth(const ContactGrid& grid) const;
    /// Of the samples in each cell.
    void find_range(const PlacedSamples& placed, const ContactGrid& grid);
    /// Gaps of cells between samples that lie further apart than they are wide, by their patches.
    void fill_between(const ContactGrid& grid);
    /// The gap of each cell, at its centre.
    void average(const PlacedSamples& placed, const ContactGrid& grid);
    /// What was gathered holds where no sample is too deep, or placed by itself since.
    void gather_again(const PlacedSamples& placed, const ContactGrid& grid);
    /// The four cells' shares in each sample: those of its layer, by how much of them is covered.
    void share(PlacedSamples& placed, const ContactGrid& grid) const;
    /// The gap of cells that are covered in part, carried to the middle of that part.
    void carry_to_middles(PlacedSamples& placed, const ContactGrid& grid);

    double whole_layer_, layer_;
    bool steps_, sparse_ = false;
    Coverage coverage_;
    Eigen::ArrayXd gap_, weight_;
    EdgeCells edges_;
    EdgePatches patches_;
    LowSteps low_steps_;
    std::vector<FourCells> four_cells_;
    std::vector<float> low_, high_;            // mm, by cell, of what is in its mean
    std::vector<std::uint8_t> inhabited_;      // by cell: a sample lies in it
    std::vector<double> nearest_, farthest_;   // mm, of the samples in a cell
    std::vector<double> between_;              // by cell: covered by what lies beside it alone
    std::vector<float> limit_;                 // mm, by cell: what lies deeper is another layer's
    std::vector<std::uint8_t> gathered_anew_;  // by the first of four cells
};

}  // namespace beltgrinding
