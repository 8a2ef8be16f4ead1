#pragma once

#include <cstdint>
#include <vector>

#include "engine/pressing.h"
#include "gap/placed_samples.h"

namespace beltgrinding {

/// Finds steps in which a wheel comes to the work, or leaves it: what is ground at their middle is
/// not what is ground all the while.
class Landing {
  public:
    /// Both must outlive it.
    Landing(const ProcessSettings& process, const Pressing& pressing);

    /// The wheel, which is pressed at the step's middle, touches during a part of the step only, or
    /// meets its force during a part of it.
    bool within(const SampleBlocks& blocks, const PathStep& step);

  private:
    /// The wheel as far from its programmed pose as it may go meets the work.
    bool reaches(const SampleBlocks& blocks, const Frame& work_from_contact) {
        return least_gap(blocks, work_from_contact, farthest_) <= farthest_;
    }
    /// mm, of the samples under the wheel; +inf: none is within `reach` mm.
    double least_gap(const SampleBlocks& blocks, const Frame& work_from_contact, double reach);
    bool comes_within(const SampleBlocks& blocks, const PathStep& step);
    bool leaves_within(const SampleBlocks& blocks, const PathStep& step);
    /// The surface goes on where the contact's centre will be, or was, by `share` of the step.
    bool goes_on(const PathStep& step, double share) const;

    const ProcessSettings& process_;
    const Pressing& pressing_;
    double farthest_;  // mm along z
    PlacedSamples placed_;
    NearBlocks near_;
    std::vector<std::uint32_t> hits_;
};

}  // namespace beltgrinding
