#pragma once

#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/geometry.h"
#include "gap/footprint.h"
#include "gap/placed_block.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// The wheel over the work at a pose, and its undeformed envelope.
class WheelPose {
  public:
    explicit WheelPose(const ContactWheel& wheel);

    void move_to(const Frame& work_from_contact) {
        contact_from_work_ = work_from_contact.inverse();
    }
    const ContactWheel& wheel() const { return wheel_; }
    const std::vector<ProfileStretch>& profile() const { return profile_; }
    const Frame& contact_from_work() const { return contact_from_work_; }
    /// Of the wheel's profile, mm per mm of width.
    double steepest_flank() const { return steepest_flank_; }
    /// How the gap rises round the wheel and along its axis (mm per mm, as of a cylinder) over a
    /// surface with that normal (work frame) where it is `gap` mm off the wheel at `s` mm.
    Eigen::Vector2d slopes(const Vec3& normal, double s, double gap) const;
    /// How far of `wanted` mm the sample may be lowered until it lies on the envelope, moved by
    /// `approach` mm along the contact frame's z.
    double down_to_envelope(const SampleBlocks& blocks, const Footprint& f, double approach,
                            double wanted) const;

  private:
    ContactWheel wheel_;
    std::vector<ProfileStretch> profile_;
    double steepest_flank_ = 0.0;
    Frame contact_from_work_ = Frame::Identity();
};

}  // namespace beltgrinding
