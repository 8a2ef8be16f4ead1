#include "simulation_settings.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "beltgrinding/contact_factory.h"
#include "dict.h"

namespace beltgrinding::python {
namespace {

constexpr double kMmPerM = 1000.0;
constexpr double kSecondsPerHour = 3600.0;
constexpr double kTonnesPerKg = 1e-3;
constexpr double kRadPerDegree = M_PI / 180.0;

/// `unit`: of the curve's x.
Curve curve_from(const Record& law, const char* key, double unit = 1.0) {
    auto points = law.get<std::vector<Eigen::Vector2d>>(key);
    for (Eigen::Vector2d& point : points) point.x() *= unit;
    return Curve(points, key);
}

ContactModelParameters::Layer layer_from(const Record& given, double factor = 1.0) {
    ContactModelParameters::Layer layer;
    layer.thickness = given.get<double>("thickness_mm");
    layer.youngs_modulus = factor * given.get<double>("youngs_modulus_MPa");
    layer.poissons_ratio = given.get<double>("poissons_ratio");
    return layer;
}

void take_dynamics(const Record& given, SimulationOptions& o) {
    ForceDynamics& dynamics = o.process.dynamics;
    const auto model = given.get<std::string>("model");
    if (model != "ideal") dynamics.lag = given.get<double>("lag_s");
    if (model == "actuator") {
        dynamics.mass = kTonnesPerKg * given.get<double>("moving_mass_kg");
        dynamics.damping = given.get<double>("damping_N_s_per_mm");
        dynamics.speed_limit = given.get<double>("speed_limit_mm_s");
    }
    o.limits.overshoot = given.get<double>("overshoot_limit");
    o.limits.bounce = given.get<double>("bounce_s");
}

void take_heat(const Record& given, HeatRequest& heat) {
    if (given.is_none()) return;
    heat.part = given.get<PartHeat*>("part");
    heat.friction = given.get<double>("friction");
    heat.partition = given.get<double>("partition");
    heat.low = given.get<double>("low");
    heat.high = given.get<double>("high");
    heat.start = given.get<double>("start");
    heat.burn = given.get<double>("burn");
}

void take_range(const Record& given, const char* key, Range& range) {
    if (!given.has(key)) return;
    const auto ends = given.get<std::array<double, 2>>(key);
    range = {ends[0], ends[1]};
}

void take_finish(const Record& given, FinishRequest& finish) {
    if (given.is_none()) return;
    finish.wanted = true;
    given.take("before", finish.before);
    given.take("rest", finish.rest);
    given.take("roughness", finish.roughness);
    given.take("pressure_exponent", finish.pressure_exponent);
    given.take("speed_exponent", finish.speed_exponent);
    given.take("feed_exponent", finish.feed_exponent);
    given.take("cut_exponent", finish.cut_exponent);
    given.take("reference_pressure", finish.reference_pressure);
    given.take("reference_speed", finish.reference_speed);
    given.take("reference_feed", finish.reference_feed);
    take_range(given, "pressure", finish.pressure);
    take_range(given, "speed", finish.speed);
    take_range(given, "feed", finish.feed);
    take_range(given, "cut", finish.cut);
}

BeltState belt_of(const Record& belt) {
    BeltState state;
    state.work = belt.get<double>("work_J");
    state.volume = belt.get<double>("removed_mm3");
    state.time = kSecondsPerHour * belt.get<double>("hours");
    state.loading = belt.get<double>("loading");
    return state;
}

/// Where solved rims are kept: $XDG_CACHE_HOME/beltgrinding, or ~/.cache/beltgrinding; empty if the
/// user has no such place.
std::filesystem::path user_cache() {
    const auto in = [](const char* variable, const char* folder) -> std::filesystem::path {
        const char* place = std::getenv(variable);
        if (place == nullptr || *place == '\0') return {};
        return std::filesystem::path(place) / folder;
    };
    const std::filesystem::path cache = in("XDG_CACHE_HOME", "beltgrinding");
    return cache.empty() ? in("HOME", ".cache/beltgrinding") : cache;
}

}  // namespace

ContactWheel wheel_from(const Record& given) {
    ContactWheel wheel;
    wheel.radius = given.get<double>("radius_mm");
    wheel.width = given.get<double>("width_mm");
    wheel.crown_radius = given.get<double>("crown_radius_mm");
    given.take("profile_mm", wheel.profile);
    return wheel;
}

BeltMachine machine_from(const Record& given) {
    BeltMachine machine;
    std::string kind = "contact_wheel";
    given.take("kind", kind);
    if (kind == "contact_wheel" || kind == "small_wheel") return machine;
    if (kind == "free_belt") {
        machine.kind = BeltMachine::Kind::kFreeBelt;
    } else if (kind == "platen") {
        machine.kind = BeltMachine::Kind::kPlaten;
    } else {
        throw InputError("call.belt_machine",
                         "machine: there is no kind '{name}'; use contact_wheel, free_belt or "
                         "platen",
                         {{"name", kind}});
    }
    const Record run = given.in("free_run");
    AbrasiveBelt& belt = machine.belt;
    belt.width = run.get<double>("width_mm");
    belt.thickness = run.get<double>("thickness_mm");
    belt.youngs_modulus = run.get<double>("youngs_modulus_MPa");
    belt.poissons_ratio = run.get<double>("poissons_ratio");
    belt.tension = run.get<double>("tension_N_per_mm");
    belt.surface_stiffness = run.get<double>("surface_stiffness_MPa_per_mm");
    machine.run.length = run.get<double>("length_mm");
    machine.run.position = run.get<double>("position_mm");
    if (run.get<std::string>("rollers") == "tensioned")
        machine.run.rollers = BeltRun::Rollers::kTensioned;
    if (machine.kind != BeltMachine::Kind::kPlaten) return machine;
    const Record platen = given.in("platen");
    machine.platen.length = platen.get<double>("length_mm");
    machine.platen.radius = platen.get<double>("radius_mm");
    machine.platen.layer_surface_stiffness = platen.get<double>("surface_stiffness_MPa_per_mm");
    for (const Record& layer : platen.each("layers"))
        machine.platen.layers.push_back(layer_from(layer));
    return machine;
}

std::unique_ptr<RemovalLaw> law_from(const Record& law) {
    LocalLawParameters p;
    p.coefficient = law.get<double>("coefficient_mm2_per_N");
    const auto model = law.get<std::string>("model");
    if (model == "hammann") return make_removal_law(model, p);
    if (model == "local") {
        p.pressure_threshold = law.get<double>("pressure_threshold_MPa");
        p.pressure_exponent = law.get<double>("pressure_exponent");
        p.reference_pressure = law.get<double>("reference_pressure_MPa");
        p.saturation_pressure = law.get<double>("saturation_pressure_MPa");
        p.speed_exponent = law.get<double>("speed_exponent");
        p.reference_speed = kMmPerM * law.get<double>("reference_speed_m_s");
        p.feed_exponent = law.get<double>("feed_exponent");
        p.reference_feed = law.get<double>("reference_feed_mm_s");
        p.land_share = law.get<double>("land_share");
        p.pressure_curve = curve_from(law, "pressure_curve");
        p.speed_curve = curve_from(law, "speed_curve", kMmPerM);
        p.feed_curve = curve_from(law, "feed_curve");
        p.land_curve = curve_from(law, "land_curve");
    }
    return make_removal_law("local", p);
}

BeltWear wear_from(const Record& wear) {
    BeltWear::Parameters p;
    p.model = BeltWear::model_named(wear.get<std::string>("model"));
    p.variable = BeltWear::variable_named(wear.get<std::string>("variable"));
    p.scale = wear.get<double>("scale");
    p.rest = wear.get<double>("rest");
    p.first_share = wear.get<double>("first_share");
    p.first_scale = wear.get<double>("first_scale");
    p.exponent = wear.get<double>("exponent");
    p.loading_share = wear.get<double>("loading_share");
    p.loading_scale = wear.get<double>("loading_scale");
    p.loading_recovery = wear.get<double>("loading_recovery_s");
    p.curve = curve_from(wear, "curve");
    return BeltWear(p);
}

BeltState belt_from(const py::dict& given) {
    py::dict d = copy_of(given);
    BeltState belt;
    belt.work = take(d, "work", 0.0);
    belt.volume = take(d, "volume", 0.0);
    belt.time = take(d, "time", 0.0);
    belt.loading = take(d, "loading", 0.0);
    refuse_rest(d, "belt");
    return belt;
}

std::unique_ptr<ContactModel> compliance_from(const Record& given, const ContactWheel& wheel,
                                              double force) {
    ContactModelParameters p;
    p.model = given.get<std::string>("model");
    p.cache_folder = user_cache();
    if (p.model == "surrogate") {
        p.name = given.get<std::string>("name");
        p.cell = given.get<double>("cell");
        p.rim_thickness = given.get<double>("rim_thickness");
        p.regression = std::make_shared<const TrainedRegression>(
            regression_from(given.get<py::dict>("regression")));
    } else if (p.model != "geometric") {
        const double factor = given.get<double>("dynamic_modulus_factor");
        p.youngs_modulus = factor * given.get<double>("youngs_modulus_MPa");
        p.poissons_ratio = given.get<double>("poissons_ratio");
        p.rim_thickness = given.get<double>("rim_thickness_mm");
        p.stiffness = factor * given.get<double>("stiffness_MPa_per_mm");
        p.belt_tension = given.get<double>("belt_tension_N_per_mm");
        p.belt_bending = given.get<double>("belt_bending_N_mm");
        for (const Record& layer : given.each("layers"))
            p.layers.push_back(layer_from(layer, factor));
    }
    return make_contact_model(p, wheel, force);
}

std::unique_ptr<ContactModel> contact_from(const Record& input, const ProcessSettings& process) {
    if (process.machine.free_face()) return make_belt_contact(process.machine);
    return compliance_from(input.in("elasticity"), process.wheel, process.force);
}

SimulationOptions options_from(const Record& input) {
    SimulationOptions o;
    const Record machine = input.in("machine");
    o.process.wheel = wheel_from(machine.in("wheel"));
    o.process.machine = machine_from(machine);
    o.process.force_control = machine.get<std::string>("control") == "force";
    o.process.force = machine.get<double>("force_N");
    o.process.force_travel = machine.get<double>("force_travel_mm");
    o.process.robot_stiffness = machine.get<double>("robot_stiffness_N_per_mm");
    take_dynamics(machine.in("force_dynamics"), o);
    o.process.wheel_growth = input.get<double>("wheel_growth");
    o.process.belt_speed = kMmPerM * machine.get<double>("belt_speed_m_s");
    o.process.belt_wear = machine.get<double>("belt_wear");
    o.process.belt =
        input.has("belt") ? belt_from(input.get<py::dict>("belt")) : belt_of(machine.in("belt"));
    o.process.pause = input.get<double>("pause_s");
    const Record law = input.in("law");
    o.process.wear = wear_from(law.in("wear"));
    o.limits.heat = kMmPerM * law.get<double>("heat_limit_MPa_m_s");
    o.limits.pressure = law.get<double>("pressure_limit_MPa");
    for (const Record& shifted : input.each("shifted_laws"))
        o.outputs.shifted_laws.push_back({law_from(shifted), wear_from(shifted.in("wear"))});
    const Record steps = input.in("simulation");
    o.limits.orientation_jump = steps.get<double>("orientation_jump_deg") * kRadPerDegree;
    o.limits.tilt = steps.get<double>("tilt_limit_deg") * kRadPerDegree;
    o.resolution.max_travel = steps.get<double>("max_travel_mm");
    o.resolution.max_angle = steps.get<double>("max_angle_deg") * kRadPerDegree;
    input.take("max_angle", o.resolution.max_angle);
    o.resolution.contact_spacing = machine.get<double>("contact_spacing_mm");
    o.resolution.contact_tolerance = machine.get<double>("contact_tolerance");
    if (input.has("lower_limits")) {
        const auto limits = input.get<Eigen::ArrayXf>("lower_limits");
        o.limits.lower.assign(limits.begin(), limits.end());
    }
    o.outputs.trace = input.get<bool>("trace");
    o.outputs.cell_errors = input.get<bool>("cell_errors");
    o.outputs.influence = input.get<bool>("influence");
    o.outputs.force_influence = input.get<bool>("force_influence");
    o.outputs.first_motion = input.get<std::uint32_t>("first_motion");
    take_heat(input.in("heat"), o.heat);
    take_finish(input.in("finish"), o.finish);
    o.must_touch = input.get<bool>("must_touch");
    return o;
}

}  // namespace beltgrinding::python
