#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "beltgrinding/height_field.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// What is looked at once in a field: where the patches of the samples on its borders lie, which
/// patches are longer than wide, and beside which samples the surface may step.
class FieldForm {
  public:
    /// Where the patch of a sample on a border has its middle, from the sample: in the work frame.
    struct Border {
        std::uint32_t sample;
        Vec3f middle;  ///< mm
        float along;   ///< mm, how far samples are apart on the border; 0: as everywhere
    };

    /// Looks at the blocks' field, unless it is that of the last call. `lowest_step`: mm, of steps
    /// that count; empty: none does.
    void look(const SampleBlocks& blocks, std::optional<double> lowest_step);

    /// Null if the sample lies on no border.
    const Border* border(std::uint32_t sample) const;
    /// Along what is longer of the sample's patch, by how much more; null: it is as long as wide.
    const Vec3f* longer(std::uint32_t sample) const {
        return longer_.empty() || longer_[sample].isZero() ? nullptr : &longer_[sample];
    }
    /// Lanes of the block beside which the surface may step.
    std::uint64_t stepped(std::uint32_t block) const { return steps_[block]; }

  private:
    void find_borders(const HeightField& field);
    void find_longer(const HeightField& field);
    void find_steps(const SampleBlocks& blocks, double lowest);

    const HeightField* field_ = nullptr;  // that was looked at
    std::size_t size_ = 0;                // samples that it had
    std::vector<Border> borders_;         // by sample
    std::vector<Vec3f> longer_;           // by sample; empty: samples lie evenly
    std::vector<std::uint64_t> steps_;    // by block: lanes
};

}  // namespace beltgrinding
