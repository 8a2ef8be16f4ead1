#include "bodies.h"
#include "collision/arm_scene.h"
#include "dict.h"
#include "links/link.h"
#include "posture/posture.h"

namespace beltgrinding::python {
namespace {

const RunContext& of(const RunContext* context) {
    static const RunContext kNone;
    return context != nullptr ? *context : kNone;
}

py::array_t<double> rows_of(const std::vector<Joints>& rows) {
    py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{6}});
    auto out = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (py::ssize_t j = 0; j < 6; ++j) out(static_cast<py::ssize_t>(i), j) = rows[i][j];
    return array;
}

py::object names(const ArmScene& scene, const std::optional<ArmScene::Meeting>& met) {
    if (!met) return py::none();
    return py::make_tuple(scene.bodies()[met->first].name, scene.bodies()[met->second].name,
                          met->share);
}

std::vector<PassPose> passes_of(const ToolPath& path) {
    std::vector<PassPose> poses;
    for (std::size_t i = 0; i < path.poses().size(); ++i) {
        const PathPose& one = path.poses()[i];
        poses.push_back({one.base_from_tcp, path.duration(i), i == 0 || one.rapid});
    }
    return poses;
}

PostureOptions options_from(const py::dict& given, const RobotArm& arm) {
    PostureOptions o;
    py::dict d = copy_of(given);
    const auto most = take(d, "most", Free{});
    const auto spacing = take(d, "spacing", Free{1.0, 1.0, 1.0});
    for (std::size_t k = 0; k < 3; ++k) o.free[k] = {most[k], spacing[k]};
    o.wheel_radius = take(d, "wheel_radius", o.wheel_radius);
    o.chord = take(d, "chord", o.chord);
    o.flip = take(d, "flip", o.flip);
    o.singularity = take(d, "singularity", o.singularity);
    o.clearance = take(d, "clearance", o.clearance);
    o.home = take(d, "home", o.home);
    o.acceleration = take(d, "acceleration", o.acceleration);
    o.jerk = take(d, "jerk", o.jerk);
    o.cut = take(d, "cut", o.cut);
    // A joint of unknown speed counts as one of half a turn a second.
    for (int j = 0; j < 6; ++j) o.speed[j] = arm.max_speed()[j] > 0.0 ? arm.max_speed()[j] : M_PI;
    refuse_rest(d, "posture options");
    return o;
}

py::dict cost_dict(const PostureCost& cost) {
    py::dict d;
    d["travel"] = cost.travel;
    d["acceleration"] = cost.acceleration;
    d["places"] = cost.places;
    d["slow"] = cost.slow;
    d["cuts"] = cost.cuts;
    return d;
}

py::dict postures(const ArmScene& scene, const ToolPath& path, const py::dict& given,
                  const RunContext* context) {
    const PostureOptions options = options_from(given, scene.arm());
    PostureResult result;
    {
        const py::gil_scoped_release release;
        result = find_postures(scene, passes_of(path), options, of(context));
    }
    py::list poses;
    for (const PosturePose& one : result.poses) {
        py::dict d;
        d["pose"] = one.pose;
        d["link"] = one.link;
        d["cut"] = one.cut;
        d["torn"] = one.torn;
        d["reached"] = one.reached;
        d["within_limits"] = one.within_limits;
        d["free"] = one.free;
        d["frame"] = Eigen::Matrix4d(one.base_from_tcp.matrix());
        d["q"] = one.q;
        d["duration"] = one.duration;
        d["met"] = one.meets ? py::object(py::make_tuple(scene.bodies()[one.first].name,
                                                         scene.bodies()[one.second].name))
                             : py::object(py::none());
        poses.append(d);
    }
    py::dict found;
    found["poses"] = poses;
    found["cost"] = cost_dict(result.cost);
    return found;
}

py::object link(const ArmScene& scene, const Joints& from, const Joints& to, double clearance,
                double resolution, std::uint32_t seed, std::size_t iterations,
                const RunContext* context) {
    LinkOptions options;
    options.clearance = clearance;
    options.resolution = resolution;
    options.seed = seed;
    options.iterations = iterations;
    std::optional<Link> found;
    {
        const py::gil_scoped_release release;
        found = find_link(scene, from, to, options, of(context));
    }
    if (!found) return py::none();
    py::dict d;
    d["joints"] = rows_of(found->joints);
    d["clearance"] = found->clearance;
    d["straight"] = found->straight;
    return d;
}

}  // namespace

void bind_posture(py::module_& m) {
    py::class_<ArmScene>(m, "ArmScene",
                         "A cell's bodies with the robot's arm; see ArmScene in C++.")
        .def(py::init([](const RobotArm& arm, const ToolPath& path, const py::list& bodies,
                         const Eigen::Matrix4d& base_from_robot,
                         const Eigen::Matrix4d& flange_from_tcp, const RunContext* context) {
                 ArmInCell cell{arm, frame_from(base_from_robot, "base_from_robot"),
                                frame_from(flange_from_tcp, "flange_from_tcp")};
                 std::vector<CollisionBody> given = bodies_from(bodies);
                 const py::gil_scoped_release release;
                 return std::make_unique<ArmScene>(std::move(cell), path.frames(), std::move(given),
                                                   of(context));
             }),
             py::arg("arm"), py::arg("path"), py::arg("bodies"), py::arg("base_from_robot"),
             py::arg("flange_from_tcp"), py::arg("context") = nullptr,
             "bodies: as check_collisions takes them; of path only the cell's frames count.")
        .def(
            "base_from_tcp",
            [](const ArmScene& scene, const Joints& q) {
                return Eigen::Matrix4d(scene.base_from_tcp(q).matrix());
            },
            py::arg("q"), "(4, 4), where the tool is at joints (6,), rad")
        .def(
            "within",
            [](const ArmScene& scene, const Joints& q, double distance) {
                return names(scene, scene.within(q, distance));
            },
            py::arg("q"), py::arg("distance"),
            "(name, name, 0) of two bodies nearer than distance mm at joints (6,), rad, or None")
        .def(
            "inside",
            [](const ArmScene& scene, const Joints& q) { return names(scene, scene.inside(q)); },
            py::arg("q"), "The same of a body that lies within another")
        .def(
            "on_way",
            [](const ArmScene& scene, const Joints& from, const Joints& to, double clearance,
               double resolution) {
                std::optional<ArmScene::Meeting> met;
                {
                    const py::gil_scoped_release release;
                    met = scene.on_way(from, to, clearance, resolution);
                }
                return names(scene, met);
            },
            py::arg("a"), py::arg("b"), py::arg("clearance"), py::arg("resolution"),
            "(name, name, share of the way) of the first that come nearer than clearance mm on the "
            "straight way of the joints, or None")
        .def(
            "straight_way",
            [](const ArmScene& scene, const Joints& q, const Eigen::Matrix4d& frame, double step,
               double turn) {
                const Straight way =
                    straight_way(scene, q, frame_from(frame, "base_from_tcp"), step, turn);
                return py::make_tuple(rows_of(way.joints), way.whole);
            },
            py::arg("q"), py::arg("base_from_tcp"), py::arg("step") = 1.0, py::arg("turn") = 0.02,
            "((n, 6) rad, whether it gets there) of the tool's straight way from joints q, in "
            "parts "
            "of step mm and turn rad")
        .def("link", &link, py::arg("a"), py::arg("b"), py::arg("clearance") = 5.0,
             py::arg("resolution") = 0.5, py::arg("seed") = 1, py::arg("iterations") = 20'000,
             py::arg("context") = nullptr,
             "dict(joints (n, 6) rad, clearance mm that is kept, straight) of joint motions from "
             "joints to joints, or None; see find_link. Raises Cancelled.")
        .def("postures", &postures, py::arg("path"), py::arg("options") = py::dict(),
             py::arg("context") = nullptr,
             "Joint angles along a ToolPath's passes, each from a rapid pose on; see "
             "find_postures. options: most and spacing (roll rad, lean rad, shift mm), "
             "wheel_radius, chord, flip, singularity, clearance, home, acceleration, jerk, cut. "
             "dict(poses: dicts of pose, link, cut, torn, reached, within_limits, free, frame, q, "
             "duration, met; cost: dict of travel, acceleration, places, slow, cuts, s).");
}

}  // namespace beltgrinding::python
