#pragma once

#include <vector>

#include "posture/posture.h"

namespace beltgrinding {

/// Lengthens the durations of motions in passes so far that no joint turns faster than its speed
/// and none changes its speed, from motion to motion, by more than its acceleration lets it.
void keep_pace(const PostureOptions& options, std::vector<PosturePose>& way);

}  // namespace beltgrinding
