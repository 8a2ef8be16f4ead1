#pragma once

#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// How deep the undeformed wheel reaches into a surface (`point`, mm, outward unit `normal`) at
/// each pose, mm; 0 where it touches at the contact only. A concave place that is tighter than the
/// wheel, or a wall beside the contact, shows as a depth. Depths are radial from the wheel's axis;
/// points whose normals look away from the axis do not count, nor does what meets the half of the
/// wheel that is averted from the work. With `whole` every point within the wheel counts, whatever
/// its normal: a wall beside it, too. Throws InputError, Cancelled.
std::vector<double> wheel_fit(const ContactWheel& wheel,
                              const std::vector<Frame>& work_from_contact,
                              const std::vector<Vec3>& point, const std::vector<Vec3>& normal,
                              const RunContext& context = {}, bool whole = false);

}  // namespace beltgrinding
