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

py::array_t<double> rows_of(const std::vector<Coordinates>& rows) {
    const py::ssize_t size = rows.empty() ? 6 : static_cast<py::ssize_t>(rows.front().size());
    py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), size});
    auto out = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (py::ssize_t j = 0; j < size; ++j) out(static_cast<py::ssize_t>(i), j) = rows[i][j];
    return array;
}

/// Joints with the coordinated axes of a scene, rad and m.
Coordinates coordinates_of(const ArmScene& scene, const Eigen::VectorXd& q) {
    if (q.size() != scene.size()) {
        throw InputError("call.coordinates",
                         "robot: six joints and {axes} external axes are needed, not {count} "
                         "numbers",
                         {{"axes", scene.axes().count()}, {"count", q.size()}});
    }
    return q;
}

ExternalAxes axes_from(const py::list& rows, const Frame& base_from_robot) {
    std::vector<ExternalAxis> axes;
    for (const auto& row : rows) {
        py::dict d = copy_of(row.cast<py::dict>());
        ExternalAxis one;
        one.linear = take(d, "linear", one.linear);
        one.carries_part = take(d, "carries_part", one.carries_part);
        one.coordinated = take(d, "coordinated", one.coordinated);
        one.point = take(d, "point", one.point);
        one.axis = take(d, "axis", one.axis);
        one.lower = take(d, "lower", one.lower);
        one.upper = take(d, "upper", one.upper);
        one.position = take(d, "position", one.position);
        one.max_speed = take(d, "max_speed", one.max_speed);
        refuse_rest(d, "external axis");
        axes.push_back(one);
    }
    return {std::move(axes), base_from_robot};
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

PostureOptions options_from(const py::dict& given, const ArmScene& scene) {
    PostureOptions o;
    py::dict d = copy_of(given);
    using Three = std::array<double, kOfContact>;
    const auto most = take(d, "most", Three{});
    const auto spacing = take(d, "spacing", Three{1.0, 1.0, 1.0});
    for (std::size_t k = 0; k < kOfContact; ++k) o.free[k] = {most[k], spacing[k]};
    const auto beside = take(d, "axes_spacing", std::vector<double>());
    for (std::size_t k = 0; k < scene.axes().count(); ++k) {
        const ExternalAxis& one = scene.axes()[k];
        o.free[kOfContact + k] = {one.upper - one.position, k < beside.size() ? beside[k] : 0.1,
                                  one.lower - one.position};
    }
    o.wheel_radius = take(d, "wheel_radius", o.wheel_radius);
    o.chord = take(d, "chord", o.chord);
    o.flip = take(d, "flip", o.flip);
    o.singularity = take(d, "singularity", o.singularity);
    o.clearance = take(d, "clearance", o.clearance);
    const auto rows = [&](const char* name, const Coordinates& missing) {
        return coordinates_of(scene, take(d, name, Eigen::VectorXd(missing)));
    };
    const Coordinates none = Coordinates::Zero(scene.size());
    o.home = rows("home", scene.axes().standing(Joints::Zero()));
    o.acceleration = rows("acceleration", none);
    o.jerk = rows("jerk", none);
    o.cut = take(d, "cut", o.cut);
    // A joint of unknown speed counts as one of half a turn a second, a track as one of 1 m/s.
    o.speed = scene.max_speed();
    for (Eigen::Index j = 0; j < o.speed.size(); ++j) {
        const bool linear = j >= 6 && scene.axes()[static_cast<std::size_t>(j - 6)].linear;
        if (!(o.speed[j] > 0.0)) o.speed[j] = linear ? 1.0 : M_PI;
    }
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
    const PostureOptions options = options_from(given, scene);
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
        d["free"] = std::array<double, kOfContact>{one.free[0], one.free[1], one.free[2]};
        d["frame"] = Eigen::Matrix4d(one.base_from_tcp.matrix());
        d["q"] = Eigen::VectorXd(one.q);
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

py::object link(const ArmScene& scene, const Eigen::VectorXd& from_rows,
                const Eigen::VectorXd& to_rows, double clearance, double resolution,
                std::uint32_t seed, std::size_t iterations, const RunContext* context) {
    const Coordinates from = coordinates_of(scene, from_rows), to = coordinates_of(scene, to_rows);
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
        .def(
            py::init([](const RobotArm& arm, const ToolPath& path, const py::list& bodies,
                        const Eigen::Matrix4d& base_from_robot,
                        const Eigen::Matrix4d& flange_from_tcp, const py::list& external_axes,
                        const Joints& home, const RunContext* context) {
                const Frame base = frame_from(base_from_robot, "base_from_robot");
                ArmInCell cell{arm, base, frame_from(flange_from_tcp, "flange_from_tcp"), {}, home};
                ExternalAxes axes = axes_from(external_axes, base);
                std::vector<CollisionBody> given = bodies_from(bodies);
                const py::gil_scoped_release release;
                return std::make_unique<ArmScene>(std::move(cell), std::move(axes), path.frames(),
                                                  std::move(given), of(context));
            }),
            py::arg("arm"), py::arg("path"), py::arg("bodies"), py::arg("base_from_robot"),
            py::arg("flange_from_tcp"), py::arg("external_axes") = py::list(),
            py::arg("home") = Joints(Joints::Zero()), py::arg("context") = nullptr,
            "bodies: as check_collisions takes them; of path only the cell's frames count. "
            "external_axes: dicts of linear, carries_part, coordinated, point (mm), axis, lower, "
            "upper, position, max_speed (rad, or m); base_from_robot is then with all at 0. With k "
            "coordinated axes joints q have 6 + k rows, rad and m. home: (6,) rad, where bodies at "
            "the flange that touch link 5 do so as they are built.")
        .def_property_readonly(
            "touching",
            [](const ArmScene& scene) {
                std::vector<std::string> names;
                for (const auto& pair : scene.touching())
                    names.push_back(scene.bodies()[pair.first].name);
                return names;
            },
            "names of bodies at the flange that are not looked at against link 5")
        .def_property_readonly(
            "max_speed", [](const ArmScene& scene) { return Eigen::VectorXd(scene.max_speed()); },
            "(6 + k,) rad/s and m/s; 0: not known")
        .def(
            "base_from_tcp",
            [](const ArmScene& scene, const Eigen::VectorXd& q) {
                return Eigen::Matrix4d(scene.base_from_tcp(coordinates_of(scene, q)).matrix());
            },
            py::arg("q"), "(4, 4), where the tool is at joints (6 + k,)")
        .def(
            "within",
            [](const ArmScene& scene, const Eigen::VectorXd& q, double distance) {
                return names(scene, scene.within(coordinates_of(scene, q), distance));
            },
            py::arg("q"), py::arg("distance"),
            "(name, name, 0) of two bodies nearer than distance mm at joints (6 + k,), or None")
        .def(
            "inside",
            [](const ArmScene& scene, const Eigen::VectorXd& q) {
                return names(scene, scene.inside(coordinates_of(scene, q)));
            },
            py::arg("q"), "The same of a body that lies within another")
        .def(
            "on_way",
            [](const ArmScene& scene, const Eigen::VectorXd& from_rows,
               const Eigen::VectorXd& to_rows, double clearance, double resolution) {
                const Coordinates from = coordinates_of(scene, from_rows),
                                  to = coordinates_of(scene, to_rows);
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
            [](const ArmScene& scene, const Eigen::VectorXd& q, const Eigen::Matrix4d& frame,
               double step, double turn, const std::optional<Eigen::VectorXd>& end) {
                const Coordinates from = coordinates_of(scene, q);
                const Coordinates to = end ? coordinates_of(scene, *end) : from;
                const Straight way =
                    straight_way(scene, from, frame_from(frame, "base_from_tcp"), to, step, turn);
                return py::make_tuple(rows_of(way.joints), way.whole);
            },
            py::arg("q"), py::arg("base_from_tcp"), py::arg("step") = 1.0, py::arg("turn") = 0.02,
            py::arg("end") = py::none(),
            "((n, 6 + k), whether it gets there) of the tool's straight way from joints q, in "
            "parts "
            "of step mm and turn rad; external axes go to those of end (6 + k,), None: they stand")
        .def("link", &link, py::arg("a"), py::arg("b"), py::arg("clearance") = 5.0,
             py::arg("resolution") = 0.5, py::arg("seed") = 1, py::arg("iterations") = 20'000,
             py::arg("context") = nullptr,
             "dict(joints (n, 6 + k), clearance mm that is kept, straight) of joint motions from "
             "joints to joints, or None; see find_link. Raises Cancelled.")
        .def("postures", &postures, py::arg("path"), py::arg("options") = py::dict(),
             py::arg("context") = nullptr,
             "Joint angles along a ToolPath's passes, each from a rapid pose on; see "
             "find_postures. options: most and spacing (roll rad, lean rad, shift mm), "
             "axes_spacing (k, rad or m), wheel_radius, chord, flip, singularity, clearance, home, "
             "acceleration, jerk, cut. "
             "dict(poses: dicts of pose, link, cut, torn, reached, within_limits, free, frame, q, "
             "duration, met; cost: dict of travel, acceleration, places, slow, cuts, s).");
}

}  // namespace beltgrinding::python
