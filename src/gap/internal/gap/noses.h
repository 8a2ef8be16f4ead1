#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "gap/placed_samples.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// Where a surface bends so much that a wheel touches less of it than cells show: a blade's leading
/// edge. Looks at what the wheel may press, and tells how small the cells must be there,
/// across its crown; along it they may stay.
class Noses {
  public:
    /// `cell`: mm, of the grid where nothing bends.
    explicit Noses(double cell) : cell_(cell) {}

    /// Looks once at the design surface of the blocks' field.
    void look(const SampleBlocks& blocks);
    /// Sides of a cell along the travel and along the axis, mm.
    struct Sides {
        double along, across;
        bool operator==(const Sides&) const = default;
    };
    /// For the samples placed: half of those wanted elsewhere, or a quarter, and so on.
    Sides sides(const PlacedSamples& placed, const SampleBlocks& blocks) const;
    /// Where nothing bends.
    Sides widest() const { return {cell_, cell_}; }

  private:
    /// Of a sample.
    struct Bend {
        float radius = 0.0F;        ///< mm, of the design surface; 0: none that matters
        float apart = 0.0F;         ///< mm, to the neighbour by which that is known
        Vec3f way = Vec3f::Zero();  ///< along which it bends, unit
    };

    /// The cell halved so often that it is nearest to `wanted`, mm.
    double halved(double wanted) const;

    double cell_;
    const HeightField* field_ = nullptr;  // that was looked at
    std::size_t size_ = 0;                // samples that it had
    std::vector<Bend> bends_;             // by sample; empty: none matters
    std::vector<std::uint8_t> bent_;      // by block: some sample of it does
};

}  // namespace beltgrinding
