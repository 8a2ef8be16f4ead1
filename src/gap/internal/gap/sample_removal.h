#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "gap/cell_table.h"
#include "gap/placed_samples.h"

namespace beltgrinding {

/// What the wheel takes from the samples that are placed under it.
class SampleRemoval {
  public:
    /// What the cells ask for: mm/s per cell along the surface's normal, and beyond the side faces,
    /// as `DisplacedPressure::beside`; for how long.
    struct Asked {
        const Eigen::ArrayXd& rate;
        const Eigen::ArrayXd& beside;
        double duration;  ///< s
    };

    /// Samples were placed anew: none was kept back.
    void start(std::size_t blocks) { has_taken_.assign(blocks, 0); }
    /// Lowers the samples as `GapMap::remove`, by `volume` mm3 of the cells.
    double remove(PlacedSamples& placed, SampleBlocks& blocks, const ContactGrid& grid,
                  const Asked& asked, double volume, double approach);
    /// As `GapMap::for_samples`.
    template <class Visit>
    void for_samples(const PlacedSamples& placed, const ContactGrid& grid, const Asked& asked,
                     Visit visit) const {
        const Bilinear* table = table_.fill(grid, asked.rate, asked.duration);
        float values[kBlockLanes];
        const auto regular = placed.regular();
        for (std::size_t k = 0; k < regular.size(); ++k) {
            const float any = -std::numeric_limits<float>::infinity();
            if (!interpolate(regular[k], table, any, values)) continue;
            const float* taken = taken_of(k);
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                if (values[lane] == 0.0f) continue;
                const double share = taken != nullptr ? taken[lane] : 1.0;
                visit(std::size_t{regular[k].block} * kBlockLanes + lane, share * values[lane]);
            }
        }
        sum_rates(placed, grid, asked, sums_);
        const auto footprints = placed.footprints();
        for (std::size_t k = 0; k < footprints.size(); ++k) {
            const Footprint& f = footprints[k];
            if (sums_[k] != 0.0) visit(f.position, f.taken * sums_[k] * asked.duration);
        }
    }
    /// What the last `remove` scaled the samples' volume by, so that it is the cells'.
    double scale() const { return scale_; }
    void set_scale(double scale) { scale_ = scale; }

  private:
    /// mm3 of the samples that the envelope holds back, of the others; whether it holds any.
    struct Held {
        double kept = 0.0, free = 0.0;
        bool any = false;
    };
    /// What each sample is asked for; the volume of that, mm3.
    double ask(const PlacedSamples& placed, const SampleBlocks& blocks, const ContactGrid& grid,
               const Asked& asked);
    /// How far each sample may be lowered: lanes of a block; footprints.
    void look_at_block(const PlacedSamples& placed, const SampleBlocks& blocks, std::size_t k,
                       double approach, Held& held);
    void look_at_footprints(const PlacedSamples& placed, const SampleBlocks& blocks,
                            double approach, Held& held);
    /// Notes that free samples give `more` times what was asked for.
    void note_taken(double more);
    /// Lowers by `factor` times what is asked for; the volume, mm3.
    double lower_regular(const PlacedSamples& placed, SampleBlocks& blocks, double factor);
    /// The same of the footprints: `more` times the scale. Adds the volume to `removed`. `held`:
    /// the envelope holds some back, so that it is to be noted.
    void lower_footprints(PlacedSamples& placed, SampleBlocks& blocks, double more, bool held,
                          double& removed);
    /// mm that each footprint is lowered by in 1 s, if nothing holds it.
    static void sum_rates(const PlacedSamples& placed, const ContactGrid& grid, const Asked& asked,
                          std::vector<double>& sums);
    /// Share of what the rate asked for, by lane; null: all of it.
    const float* taken_of(std::size_t placed) const {
        return has_taken_[placed] != 0 ? &taken_[placed * kBlockLanes] : nullptr;
    }

    double scale_ = 1.0;
    mutable CellTable table_;
    std::vector<float> lowering_;          // mm, of regular lanes
    std::vector<double> volumes_;          // mm3 of that, by placed block
    std::vector<float> taken_;             // as `taken_of`, of regular lanes
    std::vector<std::uint8_t> has_taken_;  // by placed block; else all of it
    std::vector<std::uint8_t> active_;     // by placed block: something is taken
    std::vector<std::uint64_t> free_;      // by placed block: lanes that nothing holds
    std::vector<std::pair<std::size_t, double>> limited_;  // of `lowering_`: room, mm
    std::vector<double> asked_, room_;                     // mm, by footprint
    mutable std::vector<double> sums_;                     // mm/s, by footprint
};

/// Lowers every sample that reaches into the wheel's envelope onto it, along its own normal: a
/// rigid tool. Returns the volume, mm3.
double cut_to_envelope(const PlacedSamples& placed, SampleBlocks& blocks);

}  // namespace beltgrinding
