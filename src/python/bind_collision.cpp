#include "collision/collision_check.h"
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

py::dict collisions(const ToolPath& path, const py::list& given, double clearance,
                    double resolution, const ArmInCell* arm, const RunContext* context) {
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
    CollisionResult result;
    {
        const py::gil_scoped_release release;
        result = check_collisions(path, bodies, {clearance, resolution},
                                  context != nullptr ? *context : RunContext(), arm);
    }
    py::list pairs;
    for (const PairClearance& pair : result.pairs) {
        py::dict d;
        d["bodies"] = py::make_tuple(bodies[pair.first].name, bodies[pair.second].name);
        d["distance"] = pair.distance;
        d["pose"] = pair.pose;
        d["time"] = pair.time;
        d["points"] = py::make_tuple(pair.on_first, pair.on_second);
        pairs.append(d);
    }
    py::dict found;
    found["events"] = events_to_list(result.events);
    found["pairs"] = pairs;
    return found;
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
        "frame).");
}

}  // namespace beltgrinding::python
