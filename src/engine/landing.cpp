#include "landing.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace beltgrinding {
namespace {

// Of the wheel's indentation: by so much it may move towards the work, or off it, in a step in
// which its force changes.
constexpr double kRamp = 0.25;
constexpr double kLeastIndentation = 1e-3;  // mm

/// Where the wheel is at that share of the step from its middle, -0.5 to 0.5.
Frame frame_at(const PathStep& step, double share) {
    Frame frame = step.work_from_contact;
    frame.translation() += share * (frame.linear() * step.moved);
    const double angle = step.turned.norm();
    if (angle > 0.0)
        frame.linear() *= Eigen::AngleAxisd(share * angle, step.turned / angle).toRotationMatrix();
    return frame;
}

}  // namespace

Landing::Landing(const ProcessSettings& process, const Pressing& pressing)
    : process_(process),
      pressing_(pressing),
      farthest_(process.force_control ? process.force_travel : process.wheel_growth),
      placed_(pressing.tool().wheel, 0.0) {}

double Landing::least_gap(const SampleBlocks& blocks, const Frame& work_from_contact,
                          double reach) {
    const ToolEnvelope& tool = pressing_.tool();
    WheelReach wheel;
    wheel.centre = work_from_contact * Vec3(0.0, 0.0, -tool.wheel.radius);
    wheel.axis = work_from_contact.linear().col(1);
    wheel.direction = work_from_contact.linear().col(2);
    wheel.radius = tool.wheel.radius + reach;
    wheel.half_width = 0.5 * (tool.wheel.width + blocks.field().spacing);
    wheel.min_along = tool.ahead;
    near_.find(blocks, wheel, hits_);
    placed_.form().look(blocks, std::nullopt);
    placed_.place(blocks, hits_, work_from_contact, {1, 1, 1.0, tool.wheel.width},
                  {reach, reach, tool.ahead});
    return placed_.least_gap();
}

bool Landing::comes_within(const SampleBlocks& blocks, const PathStep& step) {
    const double lever = 0.5 * pressing_.tool().wheel.width;
    const double way = 0.5 * (step.moved.norm() + lever * step.turned.norm());
    const double gap = least_gap(blocks, step.work_from_contact, farthest_ + way);
    // It touches nothing though it is near: not for where it is.
    if (gap <= farthest_ || gap > farthest_ + way) return false;
    return reaches(blocks, frame_at(step, -0.5)) || reaches(blocks, frame_at(step, 0.5));
}

bool Landing::goes_on(const PathStep& step, double share) const {
    const ContactGrid& grid = pressing_.map().grid();
    const Eigen::ArrayXd& pressure = pressing_.solution().pressure;
    double sum = 0.0, s = 0.0, y = 0.0;
    for (int cell = 0; cell < grid.cells(); ++cell) {
        if (!(pressure[cell] > 0.0)) continue;
        sum += pressure[cell];
        s += pressure[cell] * grid.s(cell % grid.nx);
        y += pressure[cell] * grid.y(cell / grid.nx);
    }
    const double column = (s / sum + share * step.moved.x()) / grid.ds + 0.5 * (grid.nx - 1);
    const double row = (y / sum + share * step.moved.y()) / grid.dy + 0.5 * (grid.ny - 1);
    const int i = static_cast<int>(std::lround(column));
    const int j = std::clamp(static_cast<int>(std::lround(row)), 0, grid.ny - 1);
    if (i < 0 || i >= grid.nx) return false;
    return pressing_.map().coverage()[j * grid.nx + i] > 0.0;
}

bool Landing::leaves_within(const SampleBlocks& blocks, const PathStep& step) {
    const double along = std::abs(step.moved.z());
    const double depth = std::max(pressing_.indentation(), kLeastIndentation);
    if (process_.force_control) {
        const double place = std::abs(pressing_.approach());
        const bool stopped = place + 0.5 * along > process_.force_travel;
        if (stopped && along > kRamp * depth) return true;
    } else if (0.5 * along > depth) {
        return true;
    }
    return (!goes_on(step, -0.5) && !reaches(blocks, frame_at(step, -0.5))) ||
           (!goes_on(step, 0.5) && !reaches(blocks, frame_at(step, 0.5)));
}

bool Landing::within(const SampleBlocks& blocks, const PathStep& step) {
    if (pressing_.flat() || pressing_.rigid()) return false;
    if (pressing_.solution().force > 0.0) return leaves_within(blocks, step);
    if (process_.force_control && !(step.force > 0.0)) return false;
    return comes_within(blocks, step);
}

}  // namespace beltgrinding
