#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "beltgrinding/run_context.h"
#include "robot/external_axes.h"

namespace beltgrinding {

/// OMPL's RRT-Connect between two places of joints and external axes, within their limits; empty:
/// no way found. Its samples are those of `seed` alone, whatever else of OMPL runs.
std::vector<Coordinates> rrt_connect(
    const Coordinates& lower, const Coordinates& upper, const Coordinates& from,
    const Coordinates& to, const std::function<bool(const Coordinates&)>& free,
    const std::function<bool(const Coordinates&, const Coordinates&)>& joined, std::uint32_t seed,
    std::size_t iterations, const RunContext& context);

}  // namespace beltgrinding
