#include <algorithm>
#include <optional>

#include "bodies.h"
#include "collision/standing.h"
#include "collision/touching_links.h"
#include "dict.h"

namespace beltgrinding::python {
namespace {

Carrier carrier_from(const std::string& name) {
    if (name == "base") return Carrier::kBase;
    if (name == "tool") return Carrier::kTool;
    if (name == "wheel") return Carrier::kWheel;
    if (name == "part") return Carrier::kPart;
    if (name == "link") return Carrier::kLink;
    throw InputError("call.carrier",
                     "a body goes with base, tool, wheel, part or link, not with '{name}'",
                     {{"name", name}});
}

}  // namespace

std::vector<CollisionBody> bodies_from(const py::list& given) {
    std::vector<CollisionBody> bodies;
    for (const auto& one : given) {
        py::dict d = copy_of(one.cast<py::dict>());
        CollisionBody body;
        body.name = take(d, "name", std::string());
        body.carrier = carrier_from(take(d, "frame", std::string("base")));
        body.mesh = take(d, "mesh", TriangleMesh());
        body.margin = take(d, "margin", 0.0);
        body.link = take(d, "link", std::size_t{0});
        refuse_rest(d, "body");
        bodies.push_back(std::move(body));
    }
    return bodies;
}

namespace {

/// What a check has found, for any path that goes the same way.
struct CollisionFindings {
    CollisionResult result;
    std::vector<std::string> names;  ///< of the bodies
};

CollisionFindings find(const ToolPath& path, const py::list& given, double clearance,
                       double resolution, const ArmInCell* arm, const RunContext* context,
                       const Joints& home) {
    const std::vector<CollisionBody> bodies = bodies_from(given);
    std::optional<ArmInCell> at_home;
    if (arm != nullptr) {
        at_home = *arm;
        at_home->home = home;
    }
    CollisionFindings found;
    for (const CollisionBody& body : bodies) found.names.push_back(body.name);
    const py::gil_scoped_release release;
    found.result = check_collisions(path, bodies, {clearance, resolution},
                                    context != nullptr ? *context : RunContext(),
                                    at_home ? &*at_home : nullptr);
    return found;
}

py::dict told(const CollisionFindings& found, const ToolPath& path, const ArmInCell* arm) {
    const auto of_arm = [](const CollisionPlaces& places) { return places.of_arm; };
    if ((arm == nullptr || arm->way.empty()) &&
        std::any_of(found.result.pair_places.begin(), found.result.pair_places.end(), of_arm)) {
        throw InputError("call.collision_arm", "the arm along the path is missing");
    }
    CollisionResult result = found.result;
    tell_times(result, path, arm);
    py::list pairs;
    for (const PairClearance& pair : result.pairs) {
        py::dict d;
        d["bodies"] = py::make_tuple(found.names[pair.first], found.names[pair.second]);
        d["distance"] = pair.distance;
        d["pose"] = pair.pose;
        d["time"] = pair.time;
        d["points"] = py::make_tuple(pair.on_first, pair.on_second);
        pairs.append(d);
    }
    py::dict all;
    all["events"] = events_to_list(result.events);
    all["pairs"] = pairs;
    py::list touching;
    for (const auto& pair : result.touching) touching.append(found.names[pair.first]);
    all["touching"] = touching;
    return all;
}

py::dict collisions(const ToolPath& path, const py::list& given, double clearance,
                    double resolution, const ArmInCell* arm, const RunContext* context) {
    return told(find(path, given, clearance, resolution, arm, context, Joints::Zero()), path, arm);
}

py::array_t<std::int32_t> standing(const std::vector<CollisionMesh>& held,
                                   const std::vector<std::pair<CollisionMesh, double>>& given,
                                   const Doubles& frames, const RunContext* context) {
    const std::vector<Frame> poses = poses_from(frames);
    std::vector<FixedBody> fixed;
    fixed.reserve(given.size());
    for (const auto& [mesh, margin] : given) fixed.push_back({mesh, margin});
    std::vector<std::int32_t> met;
    {
        const py::gil_scoped_release release;
        met = first_met(held, fixed, poses, context != nullptr ? *context : RunContext());
    }
    return own(std::move(met));
}

}  // namespace

void bind_collision(py::module_& m) {
    m.def(
        "check_collisions", &collisions, py::arg("path"), py::arg("bodies"),
        py::arg("clearance") = CollisionOptions().clearance,
        py::arg("resolution") = CollisionOptions().resolution, py::arg("arm") = nullptr,
        py::arg("context") = nullptr,
        "Follows bodies along a ToolPath; see collision/collision_check.h. bodies: dicts of name, "
        "frame (base, tool, wheel, part, or link with its number link), mesh (TriangleMesh in that "
        "frame, mm), margin (mm). arm: what RobotArm.reach gave as arm, for links. "
        "dict(events; pairs: dicts of bodies, distance mm, pose, time s, points in the work "
        "frame; touching: names of bodies at the flange that are not looked at against link 5).");
    py::class_<CollisionFindings>(m, "CollisionFindings",
                                  "What check_collisions found along a way, at whatever feeds.")
        .def("__len__",
             [](const CollisionFindings& found) {
                 return found.result.events.size() + found.result.pairs.size();
             })
        .def("told", &told, py::arg("path"), py::arg("arm") = nullptr,
             "The dict of check_collisions for a ToolPath that goes the same way as the one that "
             "was "
             "checked, and the arm along it.");
    m.def("find_collisions", &find, py::arg("path"), py::arg("bodies"),
          py::arg("clearance") = CollisionOptions().clearance,
          py::arg("resolution") = CollisionOptions().resolution, py::arg("arm") = nullptr,
          py::arg("context") = nullptr, py::arg("home") = Joints(Joints::Zero()),
          "check_collisions, as CollisionFindings. home: (6,) rad, where bodies at the flange that "
          "touch link 5 do so as they are built.");
    m.def(
        "touching_links",
        [](const RobotArm& arm, const py::list& given) {
            const std::vector<CollisionBody> bodies = bodies_from(given);
            std::vector<std::pair<std::size_t, std::size_t>> pairs;
            {
                const py::gil_scoped_release release;
                pairs = touching_links(arm, bodies);
            }
            for (auto& [a, b] : pairs) {
                a = bodies[a].link;
                b = bodies[b].link;
            }
            return pairs;
        },
        py::arg("arm"), py::arg("bodies"),
        "[(number, number)] of links of a RobotArm that are not looked at against each other, as "
        "their bodies touch nearly always; bodies: as check_collisions takes them.");
    py::class_<CollisionMesh>(m, "CollisionMesh", "A mesh as first_met takes it.")
        .def(py::init([](const TriangleMesh& mesh, const RunContext* context) {
                 const py::gil_scoped_release release;
                 return CollisionMesh(mesh, context != nullptr ? *context : RunContext());
             }),
             py::arg("mesh"), py::arg("context") = nullptr,
             "From a TriangleMesh, mm. Raises InputError, Cancelled.");
    m.def("first_met", &standing, py::arg("held"), py::arg("fixed"), py::arg("work_from_contact"),
          py::arg("context") = nullptr,
          "For each pose (n, 4, 4) the number of the first of held, CollisionMesh in the contact "
          "frame, that touches one of fixed, (CollisionMesh in the work frame, margin mm), or lies "
          "within it, or it within that; -1: none. (n,) int32.");
}

}  // namespace beltgrinding::python
