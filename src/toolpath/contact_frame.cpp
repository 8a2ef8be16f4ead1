#include "beltgrinding/error.h"
#include "beltgrinding/tool_path.h"

namespace beltgrinding {
namespace {

constexpr double kLeastSine = 1e-9;  // between the directions, below which they are parallel

}  // namespace

Frame contact_frame(const Vec3& point, const Vec3& into, const Vec3& along) {
    const Vec3 z = into.stableNormalized(), travel = along.stableNormalized();
    const Vec3 x = travel - travel.dot(z) * z;
    // Without a length or a number, z is zero or none, and no comparison holds.
    if (!point.allFinite() || !(z.norm() > 0.5) || !(x.norm() > kLeastSine)) {
        throw InputError("path.contact_frame",
                         "a contact frame needs finite numbers, a direction into the work, and a "
                         "direction along it that is not parallel to the first");
    }
    Frame frame = Frame::Identity();
    frame.linear().col(0) = x.normalized();
    frame.linear().col(1) = z.cross(x).normalized();
    frame.linear().col(2) = z;
    frame.translation() = point;
    return frame;
}

}  // namespace beltgrinding
