#include "beltgrinding/belt_wear.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr double kLeastUse = 1e-12;  // of the loading's scale: less is rounding

}  // namespace

void BeltState::validate() const {
    for (const double value : {work, volume, time}) {
        if (!std::isfinite(value) || value < 0.0) {
            throw InputError("wear.belt",
                             "belt: its work, volume and time must be zero or positive");
        }
    }
    if (!(loading >= 0.0 && loading <= 1.0)) {
        throw InputError("wear.belt_loading", "belt: its loading is {loading:g}; give 0 to 1",
                         {{"loading", loading}});
    }
}

BeltWear::Model BeltWear::model_named(const std::string& name) {
    if (name == "none") return Model::kNone;
    if (name == "exponential") return Model::kExponential;
    if (name == "two_stage") return Model::kTwoStage;
    if (name == "power") return Model::kPower;
    if (name == "curve") return Model::kCurve;
    throw InputError("call.wear",
                     "wear: there is no model '{name}'; use none, exponential, two_stage, power or "
                     "curve",
                     {{"name", name}});
}

BeltWear::Variable BeltWear::variable_named(const std::string& name) {
    if (name == "work") return Variable::kWork;
    if (name == "volume") return Variable::kVolume;
    throw InputError("call.wear_variable", "wear: the variable is work or volume, not '{name}'",
                     {{"name", name}});
}

BeltWear::BeltWear(Parameters parameters) : parameters_(std::move(parameters)) {
    const Parameters& p = parameters_;
    const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
    const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
    if (p.model == Model::kCurve && p.curve.empty()) {
        throw InputError("wear.no_curve", "wear: the model curve needs a curve");
    }
    if (p.model == Model::kExponential || p.model == Model::kTwoStage) {
        if (!positive(p.scale) || !share(p.rest)) {
            throw InputError("wear.scale",
                             "wear: the scale must be positive and the rest lie in [0, 1]");
        }
    }
    if (p.model == Model::kPower &&
        (!positive(p.scale) || !std::isfinite(p.exponent) || p.exponent < 0.0)) {
        throw InputError("wear.power",
                         "wear: the scale must be positive and the exponent zero or positive");
    }
    if (p.model == Model::kTwoStage &&
        (!positive(p.first_scale) || !share(p.first_share) || p.rest + p.first_share > 1.0)) {
        throw InputError("wear.first_stage",
                         "wear: the first stage's scale must be positive, and rest and first share "
                         "together at most 1");
    }
    if (!share(p.loading_share) || !positive(p.loading_scale) ||
        !std::isfinite(p.loading_recovery) || p.loading_recovery < 0.0) {
        throw InputError("wear.loading",
                         "wear: the loading's share must lie in [0, 1], its scale be positive and "
                         "its recovery zero (none) or positive");
    }
}

double BeltWear::variable(const BeltState& state) const {
    return parameters_.variable == Variable::kWork ? state.work : state.volume;
}

double BeltWear::remaining(const BeltState& state) const {
    const double worn = this->worn(state);
    return loads() ? worn * (1.0 - parameters_.loading_share * state.loading) : worn;
}

double BeltWear::loaded(double loading, double work, double volume) const {
    const double use = parameters_.variable == Variable::kWork ? work : volume;
    return loading - (1.0 - loading) * std::expm1(-use / parameters_.loading_scale);
}

double BeltWear::mean_loading(double loading, double work, double volume) const {
    const Parameters& p = parameters_;
    const double free = 1.0 - loading;
    if (p.variable == Variable::kWork) {
        const double x = work / p.loading_scale;
        return x > kLeastUse ? 1.0 + free * std::expm1(-x) / x : loading;
    }
    // dV/dt = R (a + b exp(-V / scale)), the volume of an unloaded belt R t.
    const double x = volume / p.loading_scale;
    if (!(x > kLeastUse) || !loads()) return loading;
    const double a = 1.0 - p.loading_share, b = p.loading_share * free;
    double removed = 0.0;  // V / scale
    if (a * x > 1.0) {
        removed = a * x + std::log((a + b - b * std::exp(-a * x)) / a);
    } else {
        removed = std::log1p((a + b) * (a > 0.0 ? std::expm1(a * x) / a : x));
    }
    return std::clamp((1.0 - removed / x) / p.loading_share, loading, 1.0);
}

double BeltWear::recovered(double loading, double seconds) const {
    const double recovery = parameters_.loading_recovery;
    return recovery > 0.0 ? loading * std::exp(-seconds / recovery) : loading;
}

double BeltWear::worn(const BeltState& state) const {
    const Parameters& p = parameters_;
    const double w = variable(state);
    switch (p.model) {
        case Model::kNone:
            return 1.0;
        case Model::kExponential:
            return p.rest + (1.0 - p.rest) * std::exp(-w / p.scale);
        case Model::kTwoStage:
            return p.rest + p.first_share * std::exp(-w / p.first_scale) +
                   (1.0 - p.rest - p.first_share) * std::exp(-w / p.scale);
        case Model::kPower:
            return std::pow(1.0 + w / p.scale, -p.exponent);
        case Model::kCurve:
            return p.curve(w);
    }
    return 1.0;
}

bool BeltWear::measured(const BeltState& state) const {
    return parameters_.model != Model::kCurve || variable(state) <= parameters_.curve.upper();
}

std::string BeltWear::describe() const {
    const Parameters& p = parameters_;
    const char* unit = p.variable == Variable::kWork ? " J" : " mm3";
    std::ostringstream text;
    switch (p.model) {
        case Model::kNone:
            text << "no wear";
            break;
        case Model::kExponential:
            text << "wear exponential over " << p.scale << unit << " to " << p.rest;
            break;
        case Model::kTwoStage:
            text << "wear in two stages over " << p.first_scale << " and " << p.scale << unit
                 << " to " << p.rest;
            break;
        case Model::kPower:
            text << "wear as (1 + W / " << p.scale << unit << ")^-" << p.exponent;
            break;
        case Model::kCurve:
            text << "wear by a curve to " << p.curve.upper() << unit;
            break;
    }
    if (loads()) {
        text << ", loading takes " << p.loading_share << " over " << p.loading_scale << unit;
        if (p.loading_recovery > 0.0) text << ", given back in " << p.loading_recovery << " s";
    }
    return text.str();
}

}  // namespace beltgrinding
