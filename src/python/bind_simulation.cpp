#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "beltgrinding/simulation.h"
#include "beltgrinding/tool_path.h"
#include "checkpoints/checkpoints.h"
#include "dict.h"
#include "recorders/recording.h"
#include "simulation_settings.h"

namespace beltgrinding::python {
namespace {

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
    belt["loading"] = result.belt.loading;
    d["belt"] = belt;
    d["shifts"] = result.shifts;
    d["unresolved"] = own(std::vector<float>(result.unresolved));
    d["process_time"] = result.process_time;
    d["removed_volume"] = result.removed_volume;
    d["integrated_rate"] = result.integrated_rate;
    d["lost_volume"] = result.lost_volume();
    d["wall"] = wall;
    d["resumed"] = result.resumed;
    d["touched"] = result.touched;
    d["unchanged"] = result.unchanged;
    return d;
}

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
             "(n, 6): of a robot, degrees, NaN where unknown; zones (n,): mm, -1: the "
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
            "greatest_speeds",
            [](const ToolPath& path) {
                constexpr int kParts = 32;
                const auto& poses = path.poses();
                std::vector<double> speeds(poses.size(), 0.0);
                for (std::size_t i = 1; i < poses.size(); ++i) {
                    const double way = (poses[i].base_from_tcp.translation() -
                                        poses[i - 1].base_from_tcp.translation())
                                           .norm();
                    for (int k = 0; k < kParts && way > 0.0; ++k) {
                        const double begin = k / static_cast<double>(kParts);
                        const double end = (k + 1.0) / kParts;
                        const double seconds = path.elapsed(i, end) - path.elapsed(i, begin);
                        if (seconds > 0.0)
                            speeds[i] = std::max(speeds[i], way * (end - begin) / seconds);
                    }
                }
                return own(std::move(speeds));
            },
            "(n,) mm/s: the greatest speed of the tool centre point on the way to each pose, on "
            "the "
            "mean of a thirty-second of it; 0 where there is no way.")
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
        [](const py::object& wear, const py::dict& belt) {
            return wear_from(Record(wear)).remaining(belt_from(belt));
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
        [](HeightField& field, const ToolPath& path, const py::object& given,
           const RunContext* context, Recording* recording, Checkpoints* checkpoints) {
            const Record input(given);
            SimulationOptions o = options_from(input);
            o.outputs.recording = recording;
            o.outputs.checkpoints = checkpoints;
            const auto elastic = contact_from(input, o.process);
            const auto removal = law_from(input.in("law"));
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
        py::arg("field"), py::arg("path"), py::arg("input"), py::arg("context") = nullptr,
        py::arg("recording") = nullptr, py::arg("checkpoints") = nullptr,
        "Grinds field along path. input: an EngineInput of a job "
        "(beltgrinding/job/engine_input.py). "
        "A recording goes on with the path. With the input's influence and force_influence: an "
        "Influence; else None. checkpoints: those of an earlier call with this field and this "
        "input, to go on from as far as the paths are the same; they are this call's from then on. "
        "resumed: how many of the steps were taken from there; unchanged: all of them, and there "
        "were no more.");
    m.def(
        "contact_at",
        [](const HeightField& field, const ToolPath& path, std::size_t pose,
           const py::object& given) {
            const Record input(given);
            const SimulationOptions o = options_from(input);
            const auto elastic = contact_from(input, o.process);
            PoseContact contact;
            {
                const py::gil_scoped_release release;
                contact = contact_at(field, path, pose, *elastic, o.process, o.resolution);
            }
            return pose_contact_to_dict(contact);
        },
        py::arg("field"), py::arg("path"), py::arg("pose"), py::arg("input"),
        "The contact at pose number `pose` (from 0), nothing is ground: as single_contact, and gap "
        "(ny, nx) mm with the wheel `beyond_placed` mm short of where it stands, coverage (ny, "
        "nx); "
        "approach: mm along z from the programmed pose.");
    m.def(
        "contacts_at",
        [](const HeightField& field, const ToolPath& path, const std::vector<std::size_t>& poses,
           const py::object& given, const RunContext* context) {
            const Record input(given);
            const SimulationOptions o = options_from(input);
            const auto elastic = contact_from(input, o.process);
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
        py::arg("field"), py::arg("path"), py::arg("poses"), py::arg("input"),
        py::arg("context") = nullptr,
        "contact_at for several poses (numbers from 0), each by itself: a list, None where the "
        "wheel does not touch.");
}

}  // namespace beltgrinding::python
