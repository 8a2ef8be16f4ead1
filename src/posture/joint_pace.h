#pragma once

#include <vector>

#include "posture/posture.h"

namespace beltgrinding {

/// Lengthens the durations of motions in passes so far that no joint turns faster than its speed,
/// none changes its speed, from motion to motion, by more than its acceleration lets it, and none
/// its acceleration, from pose to pose, by more than its jerk. A run begins and ends at rest: that
/// counts for the acceleration, not for the jerk, as controllers have ramps of their own for it.
void keep_pace(const PostureOptions& options, std::vector<PosturePose>& way);

}  // namespace beltgrinding
