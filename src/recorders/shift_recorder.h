#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/recorder.h"

namespace beltgrinding {

/// How much more each shifted law would remove, for `SimulationResult::shifts`.
class ShiftRecorder final : public Keeps<ByBlock<Eigen::ArrayXXd>, Recorder> {
  public:
    using Laws = std::vector<ShiftedLaw>;

    /// All must outlive it.
    ShiftRecorder(const SampleBlocks& blocks, const Laws& laws, const ProcessSettings& process);

    std::string kind() const override;
    void removed(const Removal& removal) override;
    void keep(HeightField&, SimulationResult& result) override;

  private:
    ByBlock<Eigen::ArrayXXd> take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const ByBlock<Eigen::ArrayXXd>* const> parts) override;
    template <class Visit>
    void for_lanes(std::uint32_t block, Visit visit) const;

    const SampleBlocks& blocks_;
    const Laws& laws_;
    const ProcessSettings& process_;
    Eigen::ArrayXXd shifts_;        // (samples, laws), mm
    Eigen::ArrayXd rate_, beside_;  // mm/s, of one of them
};

}  // namespace beltgrinding
