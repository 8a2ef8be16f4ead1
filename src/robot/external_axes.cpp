#include "robot/external_axes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {

ExternalAxes::ExternalAxes(std::vector<ExternalAxis> axes, const Frame& base_from_robot)
    : axes_(std::move(axes)), at_zero_(base_from_robot) {
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        ExternalAxis& one = axes_[k];
        const double length = one.axis.norm();
        if (!(length > 0.0) || !std::isfinite(length) || !(one.lower <= one.upper)) {
            throw InputError("robot.external_axis",
                             "external axis {axis}: it has no direction, or its limits are the "
                             "wrong way round",
                             {{"axis", k + 1}});
        }
        one.axis /= length;
        if (one.coordinated) coordinated_.push_back(k);
    }
    if (coordinated_.size() > kMostExternal) {
        throw InputError("robot.external_count",
                         "external axes: {count} are coordinated, more than {most}",
                         {{"count", coordinated_.size()}, {"most", kMostExternal}});
    }
    part_standing_ = displacement(standing(Joints::Zero()), true);
}

bool ExternalAxes::moves_part() const {
    return std::any_of(coordinated_.begin(), coordinated_.end(),
                       [&](std::size_t k) { return axes_[k].carries_part; });
}

bool ExternalAxes::moves_robot() const {
    return std::any_of(coordinated_.begin(), coordinated_.end(),
                       [&](std::size_t k) { return !axes_[k].carries_part; });
}

Coordinates ExternalAxes::standing(const Joints& q) const {
    Coordinates at(6 + static_cast<Eigen::Index>(count()));
    at.head<6>() = q;
    for (std::size_t k = 0; k < count(); ++k)
        at[6 + static_cast<Eigen::Index>(k)] = (*this)[k].position;
    return at;
}

Frame ExternalAxes::displacement(const Coordinates& at, bool of_part) const {
    Frame found = Frame::Identity();
    Eigen::Index next = 6;
    for (const ExternalAxis& one : axes_) {
        const double value = one.coordinated ? at[next++] : one.position;
        if (one.carries_part != of_part) continue;
        if (one.linear) {
            found = found * Eigen::Translation3d(value * kMmOfMetre * one.axis);
        } else {
            found = found * Eigen::Translation3d(one.point) * Eigen::AngleAxisd(value, one.axis) *
                    Eigen::Translation3d(-one.point);
        }
    }
    return found;
}

Frame ExternalAxes::base_from_robot(const Coordinates& at) const {
    return displacement(at, true).inverse() * displacement(at, false) * at_zero_;
}

Frame ExternalAxes::base_from_room(const Coordinates& at) const {
    return displacement(at, true).inverse() * part_standing_;
}

std::vector<double> ExternalAxes::levers(bool of_part, const Vec3& point, double reach) const {
    std::vector<double> found(count(), 0.0);
    Vec3 beyond = point;  // a point of the chain behind the axis, and how far the body is from it
    double radius = reach;
    std::size_t number = count();
    for (std::size_t k = axes_.size(); k-- > 0;) {
        const ExternalAxis& one = axes_[k];
        if (one.coordinated) --number;
        if (one.carries_part != of_part) continue;
        if (one.linear) {
            if (one.coordinated) found[number] = kMmOfMetre;
            radius +=
                kMmOfMetre * (one.coordinated ? std::max(std::abs(one.lower), std::abs(one.upper))
                                              : std::abs(one.position));
        } else {
            radius += (beyond - one.point).norm();
            beyond = one.point;
            if (one.coordinated) found[number] = radius;
        }
    }
    return found;
}

}  // namespace beltgrinding
