#include "beltgrinding/belt_wear.h"

#include <cmath>
#include <sstream>

#include "beltgrinding/error.h"

namespace beltgrinding {

void BeltState::validate() const {
    for (const double value : {work, volume, time}) {
        if (!std::isfinite(value) || value < 0.0) {
            throw InputError("wear.belt",
                             "belt: its work, volume and time must be zero or positive");
        }
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
}

double BeltWear::variable(const BeltState& state) const {
    return parameters_.variable == Variable::kWork ? state.work : state.volume;
}

double BeltWear::remaining(const BeltState& state) const {
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
            return "no wear";
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
    return text.str();
}

}  // namespace beltgrinding
