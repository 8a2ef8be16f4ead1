#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "gap/placed_samples.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// Where a surface bends so much that a wheel touches less of it than cells show: a blade's leading
/// edge. Looks at what the wheel may press, and tells how small the cells must be there.
class Noses {
  public:
    /// `cell`: mm, of the grid where nothing bends.
    explicit Noses(double cell) : cell_(cell) {}

    /// Looks once at the design surface of the blocks' field.
    void look(const SampleBlocks& blocks);
    /// mm: cells for the samples placed, half of those wanted elsewhere, or a quarter, and so on.
    double cell(const PlacedSamples& placed, const SampleBlocks& blocks) const;
    /// mm: cells where nothing bends.
    double widest() const { return cell_; }

  private:
    /// Of a sample.
    struct Bend {
        float radius = 0.0F;  ///< mm, of the design surface; 0: none that matters
        float apart = 0.0F;   ///< mm, to the neighbour by which that is known
    };

    double cell_;
    const HeightField* field_ = nullptr;  // that was looked at
    std::vector<Bend> bends_;             // by sample; empty: none matters
    std::vector<std::uint8_t> bent_;      // by block: some sample of it does
};

}  // namespace beltgrinding
