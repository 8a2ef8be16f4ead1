#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/simulation.h"
#include "pressing.h"
#include "trace_keeper.h"

namespace beltgrinding {

/// The law at work under the pressed wheel: lowers the field, and counts what the belt has done.
class Grinding {
  public:
    /// All of them must outlive it. `trace` may be null.
    Grinding(HeightField& field, Pressing& pressing, const RemovalLaw& law,
             const SimulationOptions& options, TraceKeeper* trace);

    /// Removes what the law says during one step, in as many parts as the pressure needs to follow.
    /// Appends the samples that it lowered to `changed`. Returns the volume, mm3.
    double grind(const PathStep& step, std::vector<std::uint32_t>& changed);

    const BeltState& belt() const { return belt_; }
    /// mm3, time integral of the law's rate so far.
    double integrated_rate() const { return integrated_rate_; }
    /// Hands over `SimulationResult::shifts`.
    Eigen::ArrayXXd take_shifts() { return std::move(shifts_); }
    /// s of wall time for removal and trace so far.
    const PhaseTimes& times() const { return times_; }

  private:
    double cut_all(const PathStep& step, std::vector<std::uint32_t>& changed);
    /// Removes for as long as the pressure holds, at most `left` s. Returns how long, s.
    double grind_part(const PathStep& step, double left, double& volume,
                      std::vector<std::uint32_t>& changed);

    HeightField& field_;
    Pressing& pressing_;
    const RemovalLaw& law_;
    const ProcessSettings& process_;
    const OutputRequest& outputs_;
    TraceKeeper* trace_;
    BeltState belt_;
    double integrated_rate_ = 0.0;
    Eigen::ArrayXXd shifts_;
    Eigen::ArrayXd rate_, shifted_;  // mm/s per cell
    PhaseTimes times_;
};

}  // namespace beltgrinding
