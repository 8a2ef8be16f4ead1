#pragma once

#include <vector>

#include "posture/posture.h"

namespace beltgrinding {

/// Moves what is free at each pose of a way on its own, by steps that are halved, while the cost of
/// the joints (travel, changes of speed, places) falls; within `bounds` from pose to pose, each in
/// its configuration. Poses that then meet a body keep what they had.
void smooth(const ArmScene& scene, const std::vector<PassPose>& poses,
            const PostureOptions& options, const std::vector<Free>& bounds,
            const std::array<double, kFreedoms>& spacing, std::vector<PosturePose>& way,
            const RunContext& context);

}  // namespace beltgrinding
