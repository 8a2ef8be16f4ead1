#pragma once

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// The contact frame at `point` (mm): z runs `into` the work, x follows `along`, the belt's travel,
/// as far as it lies across z, and y is the wheel's axle. Neither need be a unit vector. Throws
/// InputError if a number is not finite, `into` has no length, or `along` is parallel to it.
Frame contact_frame(const Vec3& point, const Vec3& into, const Vec3& along);

}  // namespace beltgrinding
