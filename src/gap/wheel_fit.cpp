#include "gap/wheel_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "point_tree.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kPoseBlock = 16;

/// At each frame the greatest `depth(frame, number of a point)` of all points, and 0 at least.
/// `most(frame, middle, away)` is no less than that of a point that is no farther than `away` from
/// `middle`.
template <class Most, class Depth>
std::vector<double> deepest(const std::vector<Frame>& work_from_contact,
                            const std::vector<Vec3>& point, const RunContext& context, Most&& most,
                            Depth&& depth) {
    std::vector<double> found(work_from_contact.size(), 0.0);
    const PointTree points(point);
    parallel_blocks(found.size(), kPoseBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Frame& frame = work_from_contact[i];
            found[i] = points.greatest(
                0.0, [&](const Vec3& middle, double away) { return most(frame, middle, away); },
                [&](std::size_t k) { return depth(frame, k); });
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
    double raised = 0.0;  // mm that the profile stands out of the radius
    for (const Eigen::Vector2d& place : wheel.profile) raised = std::max(raised, -place.y());
    const auto most = [&](const Frame& frame, const Vec3& middle, double away) {
        const Vec3 d = middle - (frame.translation() - wheel.radius * frame.linear().col(2));
        const double along = d.dot(frame.linear().col(1));
        if (std::abs(along) > 0.5 * wheel.width + away) return 0.0;
        const double radial = std::sqrt(std::max(d.squaredNorm() - along * along, 0.0));
        return wheel.radius + raised - radial + away;
    };
    const auto depth = [&](const Frame& frame, std::size_t k) {
        const Vec3 y = frame.linear().col(1), z = frame.linear().col(2);
        const Vec3 d = point[k] - (frame.translation() - wheel.radius * z);
        const double along = d.dot(y), down = d.dot(z);
        if (std::abs(along) > 0.5 * wheel.width || (down <= 0 && !whole)) return 0.0;
        const Vec3 radial = d - along * y;
        if (!whole && normal[k].dot(radial) >= 0) return 0.0;
        return wheel.radius - wheel.drop(along) - radial.norm();
    };
    return deepest(work_from_contact, point, context, most, depth);
}

std::vector<double> run_fit(const FlatRun& run, const std::vector<Frame>& work_from_contact,
                            const std::vector<Vec3>& point, const RunContext& context) {
    run.validate();
    const double from = run.face.x(run.middle - 0.5 * run.length);
    const double to = run.face.x(run.middle + 0.5 * run.length);
    const double behind = std::max(run.face.behind(from), run.face.behind(to)) + run.behind;
    const Box box(Vec3(from, -0.5 * run.width, -behind), Vec3(to, 0.5 * run.width, 0.0));
    const auto most = [&](const Frame& frame, const Vec3& middle, double away) {
        const Vec3 at = frame.linear().transpose() * (middle - frame.translation());
        return box.exteriorDistance(at) > away ? 0.0 : std::min(run.behind, away - at.z());
    };
    const auto depth = [&](const Frame& frame, std::size_t k) {
        const Vec3 at = frame.linear().transpose() * (point[k] - frame.translation());
        if (!box.contains(at)) return 0.0;
        const double deep = -at.z() - run.face.behind(at.x());
        return deep <= run.behind ? std::max(deep, 0.0) : 0.0;
    };
    return deepest(work_from_contact, point, context, most, depth);
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
