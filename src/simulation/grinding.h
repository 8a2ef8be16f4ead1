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

    /// mm that the law takes during one step at the wheel's deepest place as it is pressed now, if
    /// the wheel follows the surface; one that stands cannot grind deeper than it stands: 0.
    double removal(const PathStep& step);
    /// Removes what the law says during one step, in as many parts as the pressure needs to follow.
    /// After `removal`, for the wheel as it is pressed then. `share`: of a planned step, which has
    /// a number of parts. Appends the samples that it lowered to `changed`; the tree has to be
    /// refitted to them, except to those up to `refitted`. Returns the volume, mm3.
    double grind(const PathStep& step, double share, SegmentTree& tree,
                 std::vector<std::uint32_t>& changed);

    /// mm, where the wheel stood deepest in the last step that was ground, from its programmed
    /// pose.
    double deepest() const { return deepest_; }
    const BeltState& belt() const { return belt_; }
    /// mm3, time integral of the law's rate so far.
    double integrated_rate() const { return integrated_rate_; }
    /// Refits the tree to the samples `changed`, which are in order then, each of them once.
    void refit(SegmentTree& tree, std::vector<std::uint32_t>& changed);
    /// Hands over `SimulationResult::shifts`.
    Eigen::ArrayXXd take_shifts() { return std::move(shifts_); }
    /// s of wall time for removal and trace so far.
    const PhaseTimes& times() const { return times_; }

  private:
    /// mm/s where the law takes most, under the wheel as it is pressed.
    double set_rate(const PathStep& step);
    double cut_all(const PathStep& step, std::vector<std::uint32_t>& changed);
    /// Removes for as long as the pressure holds, at most `left` s. Returns how long, s.
    double grind_part(double left, double least, double& volume,
                      std::vector<std::uint32_t>& changed);
    /// False if the wheel has lost the work.
    bool press_again(const PathStep& step, SegmentTree& tree, std::vector<std::uint32_t>& changed);

    HeightField& field_;
    Pressing& pressing_;
    const RemovalLaw& law_;
    const ProcessSettings& process_;
    const OutputRequest& outputs_;
    TraceKeeper* trace_;
    BeltState belt_;
    double integrated_rate_ = 0.0;
    Eigen::ArrayXXd shifts_;
    ProcessState state_;             // of the wheel as pressed
    double fastest_ = 0.0;           // mm/s, the largest of `rate_`
    double deepest_ = 0.0;           // mm
    Eigen::ArrayXd rate_, shifted_;  // mm/s per cell
    PhaseTimes times_;
};

}  // namespace beltgrinding
