#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "beltgrinding/run_context.h"
#include "robot/robot_arm.h"

namespace beltgrinding {

/// OMPL's RRT-Connect between two places of the joints, within their limits; empty: no way found.
/// Its samples are those of `seed` alone, whatever else of OMPL runs.
std::vector<Joints> rrt_connect(const RobotArm& arm, const Joints& from, const Joints& to,
                                const std::function<bool(const Joints&)>& free,
                                const std::function<bool(const Joints&, const Joints&)>& joined,
                                std::uint32_t seed, std::size_t iterations,
                                const RunContext& context);

}  // namespace beltgrinding
