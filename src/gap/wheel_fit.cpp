#include "gap/wheel_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "point_cells.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kPoseBlock = 16;

/// At each frame the greatest `depth(frame, number of a point)` of all points that may lie in `box`
/// (of the contact frame); 0 or more.
template <class Depth>
std::vector<double> deepest(const std::vector<Frame>& work_from_contact,
                            const std::vector<Vec3>& point, const Box& box,
                            const RunContext& context, Depth&& depth) {
    std::vector<double> found(work_from_contact.size(), 0.0);
    if (point.empty()) return found;
    const PointCells cells(point);
    parallel_blocks(found.size(), kPoseBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Frame& frame = work_from_contact[i];
            Box around;
            for (int corner = 0; corner < 8; ++corner)
                around.extend(frame * box.corner(static_cast<Box::CornerType>(corner)));
            cells.in(around,
                     [&](std::size_t k) { found[i] = std::max(found[i], depth(frame, k)); });
        }
    });
    return found;
}

}  // namespace

std::vector<double> wheel_fit(const ContactWheel& wheel,
                              const std::vector<Frame>& work_from_contact,
                              const std::vector<Vec3>& point, const std::vector<Vec3>& normal,
                              const RunContext& context, bool whole) {
    wheel.validate();
    if (point.size() != normal.size())
        throw InputError("contact.wheel_fit", "wheel_fit needs a normal for every point");
    // In the contact frame: the wheel, or its half that faces the work.
    const double far = whole ? -2.0 * wheel.radius : -wheel.radius;
    const Box box(Vec3(-wheel.radius, -0.5 * wheel.width, far),
                  Vec3(wheel.radius, 0.5 * wheel.width, 0.0));
    return deepest(work_from_contact, point, box, context, [&](const Frame& frame, std::size_t k) {
        const Vec3 y = frame.linear().col(1), z = frame.linear().col(2);
        const Vec3 d = point[k] - (frame.translation() - wheel.radius * z);
        const double along = d.dot(y), down = d.dot(z);
        if (std::abs(along) > 0.5 * wheel.width || (down <= 0 && !whole)) return 0.0;
        const Vec3 radial = d - along * y;
        if (!whole && normal[k].dot(radial) >= 0) return 0.0;
        return wheel.radius - wheel.drop(along) - radial.norm();
    });
}

std::vector<double> run_fit(const FlatRun& run, const std::vector<Frame>& work_from_contact,
                            const std::vector<Vec3>& point, const RunContext& context) {
    run.validate();
    const double from = run.face.x(run.middle - 0.5 * run.length);
    const double to = run.face.x(run.middle + 0.5 * run.length);
    const double behind = std::max(run.face.behind(from), run.face.behind(to)) + run.behind;
    const Box box(Vec3(from, -0.5 * run.width, -behind), Vec3(to, 0.5 * run.width, 0.0));
    return deepest(work_from_contact, point, box, context, [&](const Frame& frame, std::size_t k) {
        const Vec3 at = frame.linear().transpose() * (point[k] - frame.translation());
        if (!box.contains(at)) return 0.0;
        const double depth = -at.z() - run.face.behind(at.x());
        return depth <= run.behind ? std::max(depth, 0.0) : 0.0;
    });
}

void FlatRun::validate() const {
    for (const double size : {length, width, behind}) {
        if (!std::isfinite(size) || size <= 0.0)
            throw InputError("contact.flat_run",
                             "belt: its length, its width and the room behind it must be positive");
    }
    if (!std::isfinite(middle))
        throw InputError("contact.flat_run_middle", "belt: its middle is no number");
}

}  // namespace beltgrinding
