#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "beltgrinding/simulation.h"
#include "beltgrinding/tool_path.h"
#include "dict.h"
#include "simulation/checkpoints.h"
#include "simulation/recording.h"

namespace beltgrinding::python {
namespace {

Curve curve_from(py::dict& d, const char* key) {
    return Curve(take(d, key, std::vector<Eigen::Vector2d>()), key);
}

std::unique_ptr<RemovalLaw> law_from(const py::dict& given) {
    py::dict d = copy_of(given);
    const auto model = take<std::string>(d, "model", "local");
    LocalLawParameters p;
    p.coefficient = take(d, "coefficient", p.coefficient);
    if (model != "hammann") {
        p.pressure_threshold = take(d, "pressure_threshold", p.pressure_threshold);
        p.pressure_exponent = take(d, "pressure_exponent", p.pressure_exponent);
        p.reference_pressure = take(d, "reference_pressure", p.reference_pressure);
        p.saturation_pressure = take(d, "saturation_pressure", p.saturation_pressure);
        p.speed_exponent = take(d, "speed_exponent", p.speed_exponent);
        p.reference_speed = take(d, "reference_speed", p.reference_speed);
        p.feed_exponent = take(d, "feed_exponent", p.feed_exponent);
        p.reference_feed = take(d, "reference_feed", p.reference_feed);
        p.land_share = take(d, "land_share", p.land_share);
        p.pressure_curve = curve_from(d, "pressure_curve");
        p.speed_curve = curve_from(d, "speed_curve");
        p.feed_curve = curve_from(d, "feed_curve");
        p.land_curve = curve_from(d, "land_curve");
    }
    refuse_rest(d, "law");
    return make_removal_law(model, p);
}

BeltWear wear_from(const py::dict& given) {
    py::dict d = copy_of(given);
    BeltWear::Parameters p;
    p.model = BeltWear::model_named(take<std::string>(d, "model", "none"));
    p.variable = BeltWear::variable_named(take<std::string>(d, "variable", "work"));
    p.scale = take(d, "scale", p.scale);
    p.rest = take(d, "rest", p.rest);
    p.first_share = take(d, "first_share", p.first_share);
    p.first_scale = take(d, "first_scale", p.first_scale);
    p.exponent = take(d, "exponent", p.exponent);
    p.curve = curve_from(d, "curve");
    refuse_rest(d, "wear");
    return BeltWear(p);
}

BeltState belt_from(const py::dict& given) {
    py::dict d = copy_of(given);
    BeltState belt;
    belt.work = take(d, "work", 0.0);
    belt.volume = take(d, "volume", 0.0);
    belt.time = take(d, "time", 0.0);
    refuse_rest(d, "belt");
    return belt;
}

void take_dynamics(const py::dict& given, SimulationOptions& o) {
    py::dict d = copy_of(given);
    ForceDynamics& dynamics = o.process.dynamics;
    dynamics.lag = take(d, "lag", dynamics.lag);
    dynamics.mass = take(d, "mass", dynamics.mass);
    dynamics.damping = take(d, "damping", dynamics.damping);
    dynamics.speed_limit = take(d, "speed_limit", dynamics.speed_limit);
    o.limits.overshoot = take(d, "overshoot", o.limits.overshoot);
    o.limits.bounce = take(d, "bounce", o.limits.bounce);
    refuse_rest(d, "force_dynamics");
}

void take_heat(const py::dict& given, HeatRequest& heat) {
    if (given.empty()) return;
    py::dict d = copy_of(given);
    heat.part = take<PartHeat*>(d, "part", nullptr);
    heat.friction = take(d, "friction", heat.friction);
    heat.partition = take(d, "partition", heat.partition);
    heat.low = take(d, "low", heat.low);
    heat.high = take(d, "high", heat.high);
    heat.start = take(d, "start", heat.start);
    heat.burn = take(d, "burn", heat.burn);
    refuse_rest(d, "heat");
}

BeltMachine machine_from(const py::dict& given) {
    BeltMachine machine;
    py::dict d = copy_of(given);
    const auto kind = take<std::string>(d, "kind", "contact_wheel");
    if (kind == "free_belt") {
        machine.kind = BeltMachine::Kind::kFreeBelt;
    } else if (kind == "platen") {
        machine.kind = BeltMachine::Kind::kPlaten;
    } else if (kind != "contact_wheel") {
        throw InputError("call.belt_machine",
                         "machine: there is no kind '{name}'; use contact_wheel, free_belt or "
                         "platen",
                         {{"name", kind}});
    }
    AbrasiveBelt& belt = machine.belt;
    belt.width = take(d, "width", belt.width);
    belt.thickness = take(d, "thickness", belt.thickness);
    belt.youngs_modulus = take(d, "youngs_modulus", belt.youngs_modulus);
    belt.poissons_ratio = take(d, "poissons_ratio", belt.poissons_ratio);
    belt.tension = take(d, "tension", belt.tension);
    belt.surface_stiffness = take(d, "surface_stiffness", belt.surface_stiffness);
    machine.run.length = take(d, "length", machine.run.length);
    machine.run.position = take(d, "position", machine.run.position);
    if (take(d, "tensioned", false)) machine.run.rollers = BeltRun::Rollers::kTensioned;
    machine.platen.length = take(d, "platen_length", machine.platen.length);
    machine.platen.layer_surface_stiffness =
        take(d, "layer_surface_stiffness", machine.platen.layer_surface_stiffness);
    for (const auto& item : take(d, "layers", py::list())) {
        py::dict l = copy_of(item.cast<py::dict>());
        ContactModelParameters::Layer layer;
        layer.thickness = take(l, "thickness", layer.thickness);
        layer.youngs_modulus = take(l, "youngs_modulus", layer.youngs_modulus);
        layer.poissons_ratio = take(l, "poissons_ratio", layer.poissons_ratio);
        refuse_rest(l, "layers");
        machine.platen.layers.push_back(layer);
    }
    refuse_rest(d, "machine");
    return machine;
}

/// Of the belt, where that is pressed itself; else of the wheel.
std::unique_ptr<ContactModel> contact_from(const py::dict& compliance,
                                           const ProcessSettings& process) {
    if (process.machine.free_face()) return make_belt_contact(process.machine);
    return compliance_from(compliance, process.wheel, process.force);
}

Range range_from(const std::array<double, 2>& ends) {
    return {ends[0], ends[1]};
}

void take_finish(const py::dict& given, FinishRequest& finish) {
    if (given.empty()) return;
    py::dict d = copy_of(given);
    const auto take_range = [&d](const char* key, Range& range) {
        range = range_from(take(d, key, std::array<double, 2>{range.low, range.high}));
    };
    finish.wanted = true;
    finish.before = take(d, "before", finish.before);
    finish.rest = take(d, "rest", finish.rest);
    finish.roughness = take(d, "roughness", finish.roughness);
    finish.pressure_exponent = take(d, "pressure_exponent", finish.pressure_exponent);
    finish.speed_exponent = take(d, "speed_exponent", finish.speed_exponent);
    finish.feed_exponent = take(d, "feed_exponent", finish.feed_exponent);
    finish.cut_exponent = take(d, "cut_exponent", finish.cut_exponent);
    finish.reference_pressure = take(d, "reference_pressure", finish.reference_pressure);
    finish.reference_speed = take(d, "reference_speed", finish.reference_speed);
    finish.reference_feed = take(d, "reference_feed", finish.reference_feed);
    take_range("pressure", finish.pressure);
    take_range("speed", finish.speed);
    take_range("feed", finish.feed);
    take_range("cut", finish.cut);
    refuse_rest(d, "finish");
}

SimulationOptions options_from(const py::dict& wheel_given, const py::dict& given) {
    SimulationOptions o;
    o.process.wheel = wheel_from(wheel_given);
    py::dict d = copy_of(given);
    o.process.machine = machine_from(take(d, "machine", py::dict()));
    o.process.force_control = take(d, "force_control", o.process.force_control);
    o.process.force = take(d, "force", o.process.force);
    o.process.force_travel = take(d, "force_travel", o.process.force_travel);
    o.process.wheel_growth = take(d, "wheel_growth", o.process.wheel_growth);
    take_dynamics(take(d, "force_dynamics", py::dict()), o);
    o.process.robot_stiffness = take(d, "robot_stiffness", o.process.robot_stiffness);
    o.process.belt_speed = take(d, "belt_speed", o.process.belt_speed);
    o.process.belt_wear = take(d, "belt_wear", o.process.belt_wear);
    o.process.wear = wear_from(take(d, "wear", py::dict()));
    o.process.belt = belt_from(take(d, "belt", py::dict()));
    o.limits.heat = take(d, "heat_limit", o.limits.heat);
    o.limits.pressure = take(d, "pressure_limit", o.limits.pressure);
    o.limits.orientation_jump = take(d, "orientation_jump", o.limits.orientation_jump);
    o.limits.tilt = take(d, "tilt_limit", o.limits.tilt);
    const Eigen::ArrayXf limits = take(d, "lower_limits", Eigen::ArrayXf());
    o.limits.lower.assign(limits.begin(), limits.end());
    for (const auto& shifted : take(d, "shifted_laws", py::list())) {
        o.outputs.shifted_laws.push_back(law_from(shifted.cast<py::dict>()));
    }
    o.resolution.contact_spacing = take(d, "contact_spacing", o.resolution.contact_spacing);
    o.resolution.contact_tolerance = take(d, "contact_tolerance", o.resolution.contact_tolerance);
    o.resolution.max_travel = take(d, "max_travel", o.resolution.max_travel);
    o.resolution.max_angle = take(d, "max_angle", o.resolution.max_angle);
    o.outputs.trace = take(d, "trace", o.outputs.trace);
    o.outputs.influence = take(d, "influence", o.outputs.influence);
    o.outputs.force_influence = take(d, "force_influence", o.outputs.force_influence);
    o.outputs.first_motion = take(d, "first_motion", o.outputs.first_motion);
    take_heat(take(d, "heat", py::dict()), o.heat);
    take_finish(take(d, "finish", py::dict()), o.finish);
    o.must_touch = take(d, "must_touch", o.must_touch);
    refuse_rest(d, "options");
    return o;
}

template <class Scalar, class Get>
py::array_t<Scalar> column(const std::vector<StepRecord>& steps, Get get) {
    std::vector<Scalar> values;
    values.reserve(steps.size());
    for (const StepRecord& step : steps) values.push_back(get(step));
    return own(std::move(values));
}

py::dict pose_contact_to_dict(const PoseContact& contact) {
    py::dict d = contact_to_dict(contact.grid, contact.solution);
    d["approach"] = contact.placed + contact.solution.approach;
    d["beyond_placed"] = contact.solution.approach;
    d["commanded_force"] = contact.commanded;
    d["gap"] = cells(contact.grid, contact.gap);
    d["coverage"] = cells(contact.grid, contact.coverage);
    add_displaced(d, contact.grid, contact.solution, contact.coverage);
    d["model"] = contact.model;
    return d;
}

}  // namespace

namespace {

py::dict to_dict(const SimulationResult& result) {
    const py::list events = events_to_list(result.events);
    const auto& s = result.steps;
    py::dict steps;
    steps["time"] = column<double>(s, [](const StepRecord& r) { return r.time; });
    steps["pose"] = column<std::uint32_t>(s, [](const StepRecord& r) { return r.pose; });
    steps["duration"] = column<float>(s, [](const StepRecord& r) { return r.duration; });
    steps["feed"] = column<float>(s, [](const StepRecord& r) { return r.feed; });
    steps["force"] = column<float>(s, [](const StepRecord& r) { return r.force; });
    steps["approach"] = column<float>(s, [](const StepRecord& r) { return r.approach; });
    steps["deepest_approach"] =
        column<float>(s, [](const StepRecord& r) { return r.deepest_approach; });
    steps["contact_area"] = column<float>(s, [](const StepRecord& r) { return r.contact_area; });
    steps["peak_pressure"] = column<float>(s, [](const StepRecord& r) { return r.peak_pressure; });
    steps["removal_rate"] = column<float>(s, [](const StepRecord& r) { return r.removal_rate; });
    steps["segments"] = column<std::uint32_t>(s, [](const StepRecord& r) { return r.segments; });
    py::dict wall;
    wall["build"] = result.wall.build;
    wall["localise"] = result.wall.localise;
    wall["gap"] = result.wall.gap;
    wall["contact"] = result.wall.contact;
    wall["removal"] = result.wall.removal;
    wall["trace"] = result.wall.trace;
    wall["events"] = result.wall.events;
    if (result.wall.heat > 0.0) wall["heat"] = result.wall.heat;
    if (result.wall.finish > 0.0) wall["finish"] = result.wall.finish;
    py::dict d;
    d["events"] = events;
    d["steps"] = steps;
    py::dict belt;
    belt["work"] = result.belt.work;
    belt["volume"] = result.belt.volume;
    belt["time"] = result.belt.time;
    d["belt"] = belt;
    d["shifts"] = result.shifts;
    d["process_time"] = result.process_time;
    d["removed_volume"] = result.removed_volume;
    d["integrated_rate"] = result.integrated_rate;
    d["lost_volume"] = result.lost_volume();
    d["wall"] = wall;
    d["resumed"] = result.resumed;
    d["unchanged"] = result.unchanged;
    return d;
}

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Bools = py::array_t<bool, py::array::c_style | py::array::forcecast>;
using Ints = py::array_t<int, py::array::c_style | py::array::forcecast>;

TimeLaw time_law_from(const py::dict& given) {
    py::dict d = copy_of(given);
    TimeLaw law;
    law.timing = TimeLaw::timing_named(take<std::string>(d, "timing", "constant_feed"));
    law.acceleration = take(d, "acceleration", law.acceleration);
    law.angular_acceleration = take(d, "angular_acceleration", law.angular_acceleration);
    law.rotation_speed = take(d, "rotation_speed", law.rotation_speed);
    law.default_zone = take(d, "default_zone", law.default_zone);
    refuse_rest(d, "time_law");
    return law;
}

ToolPath path_from(const Doubles& frames, const Doubles& feeds, const Doubles& forces,
                   const Bools& rapid, const Ints& lines, const std::string& holding,
                   const Eigen::Matrix4d& base_from_work, const Eigen::Matrix4d& tcp_from_contact,
                   const Eigen::Matrix4d& tcp_from_work, const Eigen::Matrix4d& base_from_contact,
                   const std::optional<Doubles>& joints, const std::optional<Doubles>& zones,
                   const py::dict& time_law, const std::optional<Ints>& gaps) {
    const py::ssize_t n = frames.ndim() == 3 ? frames.shape(0) : -1;
    if (n < 0 || frames.shape(1) != 4 || frames.shape(2) != 4 || feeds.size() != n ||
        forces.size() != n || rapid.size() != n || lines.size() != n ||
        (joints && joints->size() != 6 * n) || (zones && zones->size() != n) ||
        (gaps && gaps->size() != n)) {
        throw InputError(
            "call.path",
            "a path needs frames of shape (n, 4, 4) and n feeds, forces, flags, lines, "
            "joints, zones, gaps");
    }
    CellFrames cell;
    cell.holding = holding_named(holding);
    cell.base_from_work = frame_from(base_from_work, "base_from_work");
    cell.tcp_from_contact = frame_from(tcp_from_contact, "tcp_from_contact");
    cell.tcp_from_work = frame_from(tcp_from_work, "tcp_from_work");
    cell.base_from_contact = frame_from(base_from_contact, "base_from_contact");
    std::vector<PathPose> poses(static_cast<std::size_t>(n));
    for (py::ssize_t i = 0; i < n; ++i) {
        PathPose& pose = poses[static_cast<std::size_t>(i)];
        pose.base_from_tcp.matrix() =
            Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(frames.data(i, 0, 0));
        pose.feed = feeds.data()[i];
        pose.force = forces.data()[i];
        pose.rapid = rapid.data()[i];
        pose.line = lines.data()[i];
        if (joints) {
            const Eigen::Map<const Eigen::Matrix<double, 6, 1>> row(joints->data() + 6 * i);
            if (row.allFinite()) pose.joints = row * (M_PI / 180.0);
        }
        if (zones) pose.zone = zones->data()[i];
    }
    return ToolPath(std::move(poses), cell, time_law_from(time_law));
}

}  // namespace

void bind_simulation(py::module_& m) {
    const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
    py::class_<ToolPath>(m, "ToolPath", "Programmed poses with the cell's frames.")
        .def(py::init(&path_from), py::arg("frames"), py::arg("feeds"), py::arg("forces"),
             py::arg("rapid"), py::arg("lines"), py::arg("holding") = "tool_in_hand",
             py::arg("base_from_work") = identity, py::arg("tcp_from_contact") = identity,
             py::arg("tcp_from_work") = identity, py::arg("base_from_contact") = identity,
             py::arg("joints") = py::none(), py::arg("zones") = py::none(),
             py::arg("time_law") = py::dict(), py::arg("gaps") = py::none(),
             "frames (n, 4, 4): base_from_tcp, mm; feeds (n,): mm/s; forces (n,): N, negative: the "
             "job's; rapid (n,): nothing is ground on the way; lines (n,): of the source; joints "
             "(n, 6): of a robot, degrees, NaN where unknown; zones (n,): mm, negative: the "
             "default; "
             "time_law: timing (constant_feed, trapezoidal), acceleration mm/s2, "
             "angular_acceleration rad/s2, rotation_speed rad/s, default_zone mm; gaps: as "
             "Program.path_arrays gives them, without effect here: behind a gap a pose is rapid.")
        .def("__len__", [](const ToolPath& path) { return path.poses().size(); })
        .def(
            "grinds",
            [](const ToolPath& path) {
                const auto& poses = path.poses();
                return std::any_of(poses.begin() + 1, poses.end(),
                                   [](const PathPose& pose) { return !pose.rapid; });
            },
            "Whether any motion is no rapid one.")
        .def(
            "lines",
            [](const ToolPath& path) {
                std::vector<int> lines;
                lines.reserve(path.poses().size());
                for (const PathPose& pose : path.poses()) lines.push_back(pose.line);
                return own(std::move(lines));
            },
            "(n,): of the source, 0 where unknown")
        .def(
            "forces",
            [](const ToolPath& path) {
                std::vector<double> forces;
                for (const PathPose& pose : path.poses()) forces.push_back(pose.force);
                return own(std::move(forces));
            },
            "(n,): N, negative: the job's")
        .def("duration", py::overload_cast<>(&ToolPath::duration, py::const_), "s")
        .def(
            "times",
            [](const ToolPath& path) {
                std::vector<double> times;
                for (std::size_t i = 0; i < path.poses().size(); ++i)
                    times.push_back((times.empty() ? 0.0 : times.back()) + path.duration(i));
                return own(std::move(times));
            },
            "(n,) s since the program's begin at which the poses are reached.")
        .def(
            "frame_at",
            [](const ToolPath& path, double time) {
                const ToolPath::Moment moment = path.at(time);
                return py::make_tuple(Eigen::Matrix4d(moment.base_from_tcp.matrix()), moment.pose);
            },
            py::arg("time"),
            "(base_from_tcp (4, 4) mm, number from 0 of the pose that the motion leads to), time s "
            "after the program's begin.")
        .def(
            "work_from_contact",
            [](const ToolPath& path) {
                const auto n = static_cast<py::ssize_t>(path.poses().size());
                py::array_t<double> frames({n, py::ssize_t{4}, py::ssize_t{4}});
                for (py::ssize_t i = 0; i < n; ++i) {
                    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(frames.mutable_data(
                        i, 0, 0)) = path.frames()
                                        .work_from_contact(
                                            path.poses()[static_cast<std::size_t>(i)].base_from_tcp)
                                        .matrix();
                }
                return frames;
            },
            "(n, 4, 4), mm");
    m.def(
        "belt_remaining",
        [](const py::dict& wear, const py::dict& belt) {
            return wear_from(wear).remaining(belt_from(belt));
        },
        py::arg("wear"), py::arg("belt"), "k_t, the share of a fresh belt's cut that remains.");
    py::class_<Checkpoints>(m, "Checkpoints",
                            "States of a simulation on its way, from which one along a path that "
                            "begins the same goes on; see simulation/checkpoints.h.")
        .def(py::init<std::size_t>(), py::arg("max_bytes"), "max_bytes: of all.")
        .def("within", &Checkpoints::within, py::arg("max_bytes"),
             "Others with the same states, which both share, as many as max_bytes hold.")
        .def("__len__", &Checkpoints::count)
        .def("steps", &Checkpoints::steps, "Planned steps before each.")
        .def_property_readonly("bytes", &Checkpoints::bytes);
    m.def(
        "simulate",
        [](HeightField& field, const ToolPath& path, const py::dict& wheel,
           const py::dict& compliance, const py::dict& law, const py::dict& options,
           const RunContext* context, Recording* recording, Checkpoints* checkpoints) {
            SimulationOptions o = options_from(wheel, options);
            o.outputs.recording = recording;
            o.outputs.checkpoints = checkpoints;
            const auto elastic = contact_from(compliance, o.process);
            const auto removal = law_from(law);
            SimulationResult result;
            {
                const py::gil_scoped_release release;
                result = simulate(field, path, *elastic, *removal, o,
                                  context != nullptr ? *context : RunContext());
            }
            py::dict d = to_dict(result);
            d["influence"] =
                o.outputs.influence ? py::cast(std::move(result.influence)) : py::none();
            d["force_influence"] = o.outputs.force_influence
                                       ? py::cast(std::move(result.force_influence))
                                       : py::none();
            d["compliance"] = result.model;
            d["law"] = removal->describe() + ", " + o.process.wear.describe();
            return d;
        },
        py::arg("field"), py::arg("path"), py::arg("wheel") = py::dict(),
        py::arg("compliance") = py::dict(), py::arg("law") = py::dict(),
        py::arg("options") = py::dict(), py::arg("context") = nullptr,
        py::arg("recording") = nullptr, py::arg("checkpoints") = nullptr,
        "Grinds field along path; see simulation/simulation.h for units. With the option machine, "
        "a "
        "dict of kind (free_belt, platen) and of what beltgrinding/belt_machine.h has (width, "
        "thickness, youngs_modulus, poissons_ratio, tension, surface_stiffness; length, position, "
        "tensioned; platen_length, layers, layer_surface_stiffness: mm, N/mm, MPa, MPa/mm), that "
        "belt is pressed in place of the wheel, and compliance is not looked at. A recording goes "
        "on with "
        "the path. With the options influence and force_influence: an Influence; else None. "
        "checkpoints: those of an earlier call with this field and these settings, to go on from "
        "as far as the paths are the same; they are this call's from then on. resumed: how many of "
        "the steps were taken from there; unchanged: all of them, and there were no more.");
    m.def(
        "contact_at",
        [](const HeightField& field, const ToolPath& path, std::size_t pose, const py::dict& wheel,
           const py::dict& compliance, const py::dict& options) {
            const SimulationOptions o = options_from(wheel, options);
            const auto elastic = contact_from(compliance, o.process);
            PoseContact contact;
            {
                const py::gil_scoped_release release;
                contact = contact_at(field, path, pose, *elastic, o.process, o.resolution);
            }
            return pose_contact_to_dict(contact);
        },
        py::arg("field"), py::arg("path"), py::arg("pose"), py::arg("wheel"), py::arg("compliance"),
        py::arg("options"),
        "The contact at pose number `pose` (from 0), nothing is ground: as single_contact, and gap "
        "(ny, nx) mm with the wheel `beyond_placed` mm short of where it stands, coverage (ny, "
        "nx); "
        "approach: mm along z from the programmed pose.");
    m.def(
        "contacts_at",
        [](const HeightField& field, const ToolPath& path, const std::vector<std::size_t>& poses,
           const py::dict& wheel, const py::dict& compliance, const py::dict& options,
           const RunContext* context) {
            const SimulationOptions o = options_from(wheel, options);
            const auto elastic = contact_from(compliance, o.process);
            std::vector<std::optional<PoseContact>> found;
            {
                const py::gil_scoped_release release;
                found = contacts_at(field, path, poses, *elastic, o.process, o.resolution,
                                    context != nullptr ? *context : RunContext());
            }
            py::list result;
            for (const auto& one : found) {
                if (one)
                    result.append(pose_contact_to_dict(*one));
                else
                    result.append(py::none());
            }
            return result;
        },
        py::arg("field"), py::arg("path"), py::arg("poses"), py::arg("wheel"),
        py::arg("compliance"), py::arg("options"), py::arg("context") = nullptr,
        "contact_at for several poses (numbers from 0), each by itself: a list, None where the "
        "wheel does not touch.");
}

}  // namespace beltgrinding::python
