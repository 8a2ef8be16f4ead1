#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"

namespace beltgrinding {

/// What the contact's cells leave open, for `SimulationResult::unresolved`: Richardson's
/// extrapolation of the rate from cells of twice the length, the mean of all ways to join them. The
/// rate goes with the cells' length: what cells of twice the length take less, its limit takes
/// more.
class ResolutionRecorder final
    : public Keeps<ByBlock<std::array<float, SampleBlocks::kLanes>>, Recorder> {
  public:
    using Lanes = std::array<float, SampleBlocks::kLanes>;

    explicit ResolutionRecorder(const SampleBlocks& blocks);

    std::string kind() const override { return "resolution"; }
    void removed(const Removal& removal) override;
    void keep(HeightField&, SimulationResult& result) override;

  private:
    ByBlock<Lanes> take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const ByBlock<Lanes>* const> parts) override;

    /// `coarse_`: mm/s per cell, on cells of twice the length.
    void coarsen(const ContactGrid& grid, const Eigen::ArrayXd& rate,
                 const Eigen::ArrayXd& coverage);

    const SampleBlocks& blocks_;
    std::vector<Lanes> sums_;       // mm that `coarse_` takes, by block
    DisplacedPressure coarse_;      // mm/s
    Eigen::ArrayXd volume_, area_;  // by cell, joined along s
};

}  // namespace beltgrinding
