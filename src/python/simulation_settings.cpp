#include "simulation_settings.h"

#include <algorithm>
#include <array>
#include <optional>

#include "dict.h"

namespace beltgrinding::python {
namespace {

Curve curve_from(py::dict& d, const char* key) {
    return Curve(take(d, key, std::vector<Eigen::Vector2d>()), key);
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

}  // namespace

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
    machine.platen.radius = take(d, "platen_radius", machine.platen.radius);
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

std::unique_ptr<ContactModel> contact_from(const py::dict& compliance,
                                           const ProcessSettings& process) {
    if (process.machine.free_face()) return make_belt_contact(process.machine);
    return compliance_from(compliance, process.wheel, process.force);
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

}  // namespace beltgrinding::python
