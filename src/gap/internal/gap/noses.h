#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "gap/placed_samples.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// Where a surface bends so much that a wheel touches less of it than cells show: a blade's leading
/// edge. Looks at what the wheel may press, tells how small the cells must be there, across its
/// crown (along it they may be longer), and how what grinding has left leans.
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
    /// Slopes of the samples placed there become those of what grinding has left: a crown that was
    /// worn flat ends at flanks that, carried on by the design's slope, would stand above it.
    void follow_the_ground(PlacedSamples& placed, const SampleBlocks& blocks,
                           const ContactGrid& grid) const;
    /// So much of the nose is gone that its samples lie close together, whatever their normals.
    bool worn_through(const SampleBlocks& blocks, std::size_t position) const {
        return !bends_.empty() && blocks.height(position) < deepest(blocks.sample(position));
    }

  private:
    /// Of a sample.
    struct Bend {
        float radius = 0.0F;        ///< mm, of the design surface; 0: none that matters
        float apart = 0.0F;         ///< mm, to the neighbour by which that is known
        Vec3f way = Vec3f::Zero();  ///< along which it bends, unit
    };

    /// mm: rays from a nose meet in its middle; below half the way there they tell little.
    double deepest(std::uint32_t sample) const {
        const auto radius = static_cast<double>(bends_[sample].radius);
        return radius > 0.0 ? -0.5 * radius : -std::numeric_limits<double>::infinity();
    }
    void find_neighbours(const HeightField& field);
    /// How the ground surface leans against the design's at a sample, per mm along it: towards
    /// which its height rises.
    Vec3 lean(const SampleBlocks& blocks, std::uint32_t sample) const;

    /// The cell halved so often that it is nearest to `wanted`, mm.
    double halved(double wanted) const;

    double cell_;
    const HeightField* field_ = nullptr;   // that was looked at
    std::size_t size_ = 0;                 // samples that it had
    std::vector<Bend> bends_;              // by sample; empty: none matters
    std::vector<std::uint8_t> bent_;       // by block: some sample of it does
    std::vector<std::uint32_t> position_;  // by sample
    std::vector<std::uint32_t> first_;     // by sample: of its neighbours, where it bends; and one
    std::vector<std::uint32_t> neighbours_;  // samples
};

}  // namespace beltgrinding
