#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contact/coverage.h"
#include "gap/edge_cells.h"
#include "gap/placed_samples.h"

namespace beltgrinding {

/// What the patches of the samples near edges cover of the cells.
class EdgePatches {
  public:
    void clear();
    /// Edge cells are covered as far as patches of their nearest layer lie on them, the others
    /// wholly. `nearest`, mm by cell: becomes that of the patches in edge cells. Tells the samples
    /// that belong to another layer.
    void cover(PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
               const EdgeCells& edges, double layer, std::vector<double>& nearest,
               Coverage& coverage);
    /// Calls visit(footprint) for the sample of each patch.
    template <class Visit>
    void for_samples(std::span<Footprint> footprints, Visit visit) const {
        for (const EdgePatch& patch : patches_) visit(footprints[patch.footprint]);
    }
    bool empty() const { return patches_.empty(); }
    /// Calls visit(number of the footprint, its patch in cells) for each.
    template <class Visit>
    void for_patches(Visit visit) const {
        for (const EdgePatch& p : patches_) visit(p.footprint, Patch{p.s, p.y, p.half_s, p.half_y});
    }
    /// Calls visit(cell, its share that is covered, the sample's gap at its centre, mm) for what
    /// patches cover.
    template <class Visit>
    void for_cells(Visit visit) const {
        for (const PatchCell& part : covered_) visit(part.cell, part.share, part.carried);
    }

  private:
    /// In cells, from the middle of the outermost cell of lower s and y.
    struct EdgePatch {
        std::size_t footprint;
        std::size_t end;  // of its cells in `covered_`
        float s, y, half_s, half_y;
    };
    /// What of a cell a patch covers.
    struct PatchCell {
        int cell;
        double share, along, across;  // of the cell; the middle of that from the cell's, in cells
        double carried;               // mm, the sample's gap at the cell's centre
    };
    /// Finds the cells that the last patch lies on.
    void add_cells(const ContactGrid& grid, const Footprint& f);

    std::vector<EdgePatch> patches_;
    std::vector<PatchCell> covered_;  // by all patches, one after the other
};

}  // namespace beltgrinding
