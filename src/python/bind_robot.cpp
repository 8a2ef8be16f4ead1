#include <algorithm>
#include <limits>

#include "collision/collision_check.h"
#include "dict.h"
#include "robot/inverse_kinematics.h"
#include "robot/reach.h"

namespace beltgrinding::python {
namespace {

void read_limits(py::dict& d, RobotJoint& joint) {
    joint.lower = take(d, "lower", joint.lower);
    joint.upper = take(d, "upper", joint.upper);
    joint.max_speed = take(d, "max_speed", joint.max_speed);
}

RobotArm arm_from(const std::string& convention, const py::list& rows,
                  const Eigen::Matrix4d& flange, double coupling) {
    if (rows.size() != 6)
        throw InputError("call.joints", "robot: it has 6 joints, not {count}",
                         {{"count", rows.size()}});
    RobotModel model;
    std::array<py::dict, 6> given;
    for (std::size_t i = 0; i < 6; ++i) given[i] = copy_of(rows[i].cast<py::dict>());
    if (convention == "urdf") {
        for (std::size_t i = 0; i < 6; ++i) {
            model.joints[i].parent_from_joint = frame_from(
                take(given[i], "parent_from_joint", Eigen::Matrix4d(Eigen::Matrix4d::Identity())),
                "parent_from_joint",
                Fact{"robot.joint", "robot: joint {joint}: ", {{"joint", i + 1}}});
            model.joints[i].axis = take(given[i], "axis", model.joints[i].axis);
        }
    } else if (convention == "standard_dh" || convention == "modified_dh") {
        std::array<DhRow, 6> table;
        for (std::size_t i = 0; i < 6; ++i) {
            table[i].a = take(given[i], "a", 0.0);
            table[i].alpha = take(given[i], "alpha", 0.0);
            table[i].d = take(given[i], "d", 0.0);
            table[i].offset = take(given[i], "offset", 0.0);
            table[i].direction = take(given[i], "direction", 1.0);
        }
        model = model_from_dh(
            table, convention == "standard_dh" ? DhConvention::kStandard : DhConvention::kModified);
    } else {
        throw InputError(
            "call.convention",
            "robot: there is no convention '{name}'; use urdf, standard_dh or modified_dh",
            {{"name", convention}});
    }
    for (std::size_t i = 0; i < 6; ++i) {
        read_limits(given[i], model.joints[i]);
        refuse_rest(given[i], "robot joint");
    }
    model.joint6_from_flange = model.joint6_from_flange * frame_from(flange, "joint6_from_flange");
    model.coupling = coupling;
    return RobotArm(model);
}

std::string structure_name(const RobotArm& arm) {
    switch (arm.structure()) {
        case RobotArm::Structure::kSphericalWrist:
            return "spherical_wrist";
        case RobotArm::Structure::kParallelElbow:
            return "parallel_elbow";
        case RobotArm::Structure::kGeneral:
            break;
    }
    return "general";
}

/// (n, 6); `rows` are joints.
py::array_t<double> joints_array(const std::vector<Joints>& rows) {
    py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{6}});
    auto out = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (py::ssize_t j = 0; j < 6; ++j) out(static_cast<py::ssize_t>(i), j) = rows[i][j];
    }
    return array;
}

py::dict reach(const RobotArm& arm, const ToolPath& path, const py::dict& options,
               const RunContext* context) {
    ReachOptions o;
    py::dict d = copy_of(options);
    const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
    o.base_from_robot = frame_from(take(d, "base_from_robot", identity), "base_from_robot");
    o.flange_from_tcp = frame_from(take(d, "flange_from_tcp", identity), "flange_from_tcp");
    o.max_travel = take(d, "max_travel", o.max_travel);
    o.max_angle = take(d, "max_angle", o.max_angle);
    o.singularity = take(d, "singularity", o.singularity);
    o.flip = take(d, "flip", o.flip);
    o.turn_speed = take(d, "turn_speed", o.turn_speed);
    if (d.contains("start")) o.start = take(d, "start", Joints(Joints::Zero()));
    refuse_rest(d, "reach options");
    ReachResult result;
    {
        const py::gil_scoped_release release;
        result = check_reach(path, arm, o, context != nullptr ? *context : RunContext());
    }
    py::dict found;
    found["joints"] = joints_array(result.joints);
    found["events"] = events_to_list(result.events);
    found["least"] = result.least;
    found["greatest"] = result.greatest;
    found["checks"] = result.checks;
    found["arm"] = ArmInCell{arm, o.base_from_robot, o.flange_from_tcp, std::move(result.way)};
    return found;
}

}  // namespace

void bind_robot(py::module_& m) {
    py::class_<ArmInCell>(m, "ArmInCell",
                          "An arm and where its joints are along a path, check by check.")
        .def("__len__", [](const ArmInCell& arm) { return arm.way.size(); });
    py::class_<RobotArm>(m, "RobotArm", "Kinematics of a serial arm of six revolute joints.")
        .def(py::init(&arm_from), py::arg("convention"), py::arg("joints"),
             py::arg("joint6_from_flange") = Eigen::Matrix4d(Eigen::Matrix4d::Identity()),
             py::arg("coupling") = 0.0,
             "convention: urdf (joints: dicts of parent_from_joint (4, 4), axis (3,)), standard_dh "
             "or modified_dh (a, alpha, d, offset, direction); all with lower, upper, max_speed; "
             "mm, rad, rad/s.")
        .def_property_readonly("structure", &structure_name)
        .def_property_readonly("length", &RobotArm::length, "mm, axis 2 to the wrist, stretched")
        .def_property_readonly("lower", [](const RobotArm& arm) { return arm.lower(); })
        .def_property_readonly("upper", [](const RobotArm& arm) { return arm.upper(); })
        .def(
            "forward",
            [](const RobotArm& arm, const Joints& q) {
                return Eigen::Matrix4d(arm.forward(q).matrix());
            },
            py::arg("q"), "robot_from_flange (4, 4) at the joints (6,), rad")
        .def(
            "placed",
            [](const RobotArm& arm, const Joints& q) {
                const RobotArm::Placed placed = arm.placed(q);
                Eigen::Matrix<double, 6, 3> axes, points;
                for (int i = 0; i < 6; ++i) {
                    axes.row(i) = placed.axis[static_cast<std::size_t>(i)];
                    points.row(i) = placed.point[static_cast<std::size_t>(i)];
                }
                return py::make_tuple(axes, points);
            },
            py::arg("q"),
            "(axes (6, 3), unit; a point on each (6, 3), mm) in the robot's base at q (6,), rad")
        .def(
            "links",
            [](const RobotArm& arm, const Joints& q) {
                py::array_t<double> frames({7, 4, 4});
                auto out = frames.mutable_unchecked<3>();
                const auto links = arm.links(q);
                for (py::ssize_t k = 0; k < 7; ++k)
                    for (py::ssize_t i = 0; i < 4; ++i)
                        for (py::ssize_t j = 0; j < 4; ++j)
                            out(k, i, j) = links[static_cast<std::size_t>(k)].matrix()(i, j);
                return frames;
            },
            py::arg("q"),
            "robot_from_link (7, 4, 4) of the foot and what each joint carries; identities at q = "
            "0")
        .def(
            "configuration",
            [](const RobotArm& arm, const Joints& q) {
                const ArmConfiguration at = configuration_at(arm, q);
                py::dict d;
                d["behind"] = at.behind;
                d["below"] = at.below;
                d["back"] = at.back;
                d["flipped"] = at.flipped;
                return d;
            },
            py::arg("q"), "Which of its configurations it is in; see ArmConfiguration.")
        .def_property_readonly("max_speed", [](const RobotArm& arm) { return arm.max_speed(); })
        .def(
            "singular_distance",
            [](const RobotArm& arm, const Joints& q) {
                const SingularDistance d = singular_distance(arm, q);
                return std::min({d.wrist, d.elbow, d.shoulder, d.general});
            },
            py::arg("q"), "rad to the nearest singularity; see SingularDistance.")
        .def("jacobian", &RobotArm::jacobian, py::arg("q"),
             "(6, 6): velocity of the flange (mm) and angular velocity per joint speed")
        .def(
            "inverse",
            [](const RobotArm& arm, const Eigen::Matrix4d& pose, const Joints& near) {
                std::vector<Joints> rows;
                for (const auto& s : inverse(arm, frame_from(pose, "robot_from_flange"), near)) {
                    rows.push_back(s.q);
                }
                return joints_array(rows);
            },
            py::arg("robot_from_flange"), py::arg("near"),
            "(k, 6): all solutions, rad, each joint within half a turn of `near` (6,)")
        .def("reach", &reach, py::arg("path"), py::arg("options") = py::dict(),
             py::arg("context") = nullptr,
             "Follows a ToolPath; see robot/reach.h. dict(joints (n, 6) rad, NaN out of reach; "
             "events; least, greatest (6,) rad; checks; arm: for check_collisions).");
}

}  // namespace beltgrinding::python
