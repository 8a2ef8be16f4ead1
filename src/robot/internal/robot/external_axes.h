#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/geometry.h"
#include "robot/robot_arm.h"

namespace beltgrinding {

constexpr int kMostExternal = 3;       ///< coordinated external axes
constexpr double kMmOfMetre = 1000.0;  ///< linear axes are reckoned in metres, near to radians

/// Where a robot and its coordinated external axes are: six joints as `Joints`, then the axes in
/// their order, rad or m. Joints alone are the coordinates of a cell without such axes.
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6 + kMostExternal, 1>;

/// A linear track, or an axis of a positioner, with all axes at 0 in the frame of the programs.
struct ExternalAxis {
    bool linear = false;
    bool carries_part = false;  ///< else the robot
    bool coordinated = false;   ///< it moves in the passes; else it stands at `position` there
    Vec3 point = Vec3::Zero();  ///< mm, on the axis
    Vec3 axis = Vec3::UnitZ();  ///< unit vector
    double lower = 0.0, upper = 0.0;  ///< rad or m
    double position = 0.0;            ///< rad or m
    double max_speed = 0.0;           ///< rad/s or m/s; 0: not known
};

/// The external axes of a cell. An axis carries those behind it that carry the same. The frame of
/// the programs goes with the part.
class ExternalAxes {
  public:
    ExternalAxes() = default;
    /// `base_from_robot`: with all axes at 0. Throws InputError: too many that are coordinated, an
    /// axis without direction.
    ExternalAxes(std::vector<ExternalAxis> axes, const Frame& base_from_robot);

    /// Those that are coordinated.
    std::size_t count() const { return coordinated_.size(); }
    const ExternalAxis& operator[](std::size_t k) const { return axes_[coordinated_[k]]; }
    const Frame& base_at_zero() const { return at_zero_; }
    bool moves_part() const;
    bool moves_robot() const;

    /// Joints with all coordinated axes at their positions.
    Coordinates standing(const Joints& q) const;
    /// The robot's base in the frame of the programs.
    Frame base_from_robot(const Coordinates& at) const;
    /// What stands still in the room, against where it is with all axes at their positions.
    Frame base_from_room(const Coordinates& at) const;

    /// mm by which a radian or metre of each coordinated axis moves a body at most, whatever the
    /// others do. `reach`: mm, from a point that the last axis carries to the body's farthest one,
    /// where the point lies with all axes at 0.
    std::vector<double> levers(bool of_part, const Vec3& point, double reach) const;

  private:
    Frame displacement(const Coordinates& at, bool of_part) const;

    std::vector<ExternalAxis> axes_;
    std::vector<std::size_t> coordinated_;
    Frame at_zero_ = Frame::Identity();
    Frame part_standing_ = Frame::Identity();
};

}  // namespace beltgrinding
