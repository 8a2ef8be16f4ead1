#include "beltgrinding/removal_law.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// mm/s: a surface that recedes faster is ground as far as the tool reaches in any step.
constexpr double kFastest = 1e9;

double checked(double coefficient) {
    if (!std::isfinite(coefficient) || coefficient < 0.0) {
        throw InputError(
            "law.coefficient",
            "removal law: the coefficient is {coefficient:f} mm2/N; give zero or a positive one",
            {{"coefficient", coefficient}});
    }
    return coefficient;
}

std::string text(const char* name, double coefficient) {
    std::ostringstream out;
    out << name << ", K = " << coefficient << " mm2/N";
    return out.str();
}

}  // namespace

LocalLaw::LocalLaw(LocalLawParameters parameters) : parameters_(std::move(parameters)) {
    LocalLawParameters& p = parameters_;
    checked(p.coefficient);
    const auto require = [](bool holds, const char* code, const char* form) {
        if (!holds) throw InputError(code, form);
    };
    const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
    const auto not_negative = [](double value) { return std::isfinite(value) && value >= 0.0; };
    require(not_negative(p.pressure_threshold), "law.pressure_threshold",
            "removal law: the threshold pressure must not be negative");
    require(positive(p.pressure_exponent), "law.pressure_exponent",
            "removal law: the pressure's exponent must be positive");
    require(std::isfinite(p.speed_exponent) && std::isfinite(p.feed_exponent), "law.exponents",
            "removal law: the exponents of speed and feed must be finite");
    require(
        positive(p.reference_pressure) && positive(p.reference_speed) && positive(p.reference_feed),
        "law.references",
        "removal law: the references of pressure, speed and feed must be positive");
    require(not_negative(p.saturation_pressure), "law.saturation_pressure",
            "removal law: the saturation pressure must not be negative");
    require(p.land_share > 0.0 && p.land_share <= 1.0, "law.land_share",
            "removal law: the land share must lie in (0, 1]");
    if (!p.land_curve.empty()) serration_ = p.land_curve(p.land_share);
}

void LocalLaw::rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
                    Eigen::ArrayXd& rate) const {
    const LocalLawParameters& p = parameters_;
    double factor = p.coefficient * state.belt_wear * serration_ * p.land_share;
    factor *=
        p.reference_speed * (p.speed_curve.empty()
                                 ? std::pow(state.belt_speed / p.reference_speed, p.speed_exponent)
                                 : p.speed_curve(state.belt_speed));
    if (!p.feed_curve.empty()) {
        factor *= p.feed_curve(state.feed);
    } else if (p.feed_exponent != 0.0 && state.feed > 0.0) {
        factor *= std::pow(state.feed / p.reference_feed, p.feed_exponent);
    }
    if (!std::isfinite(factor)) {
        throw InputError(
            "law.beyond_numbers",
            "removal law: at a belt speed of {speed:.3g} m/s and a feed of {feed:.3g} "
            "mm/s it takes more than can be computed; check its coefficient, exponents "
            "and references",
            {{"speed", 1e-3 * state.belt_speed}, {"feed", state.feed}});
    }
    if (!p.pressure_curve.empty()) {
        // From no cut at no pressure to the first point in a straight line.
        const double first = p.pressure_curve.lower(), cut = p.pressure_curve(first);
        rate = pressure.unaryExpr([&](double at) {
            const double land = at / p.land_share;
            return land < first ? cut * land / first : p.pressure_curve(land);
        });
        rate = (rate * (factor * p.reference_pressure)).min(kFastest);
        return;
    }
    rate = (pressure / p.land_share - p.pressure_threshold).max(0.0);
    if (p.saturation_pressure > 0.0) {
        rate = p.saturation_pressure * (1.0 - (-rate / p.saturation_pressure).exp());
    }
    if (p.pressure_exponent != 1.0) {
        rate = (rate / p.reference_pressure).pow(p.pressure_exponent).min(kFastest);
        rate *= p.reference_pressure;
    }
    rate = (rate * factor).min(kFastest);
}

std::optional<OutsideRange> LocalLaw::outside(double peak_pressure,
                                              const ProcessState& state) const {
    const LocalLawParameters& p = parameters_;
    std::optional<OutsideRange> found;
    const auto look = [&](const Curve& curve, double value, double unit, const char* name,
                          const char* code, const char* form) {
        if (curve.empty() || curve.measured(value) || found) return;
        const double limit = value > curve.upper() ? curve.upper() : curve.lower();
        const Arguments arguments = {{"value", value / unit},
                                     {"least", curve.lower() / unit},
                                     {"most", curve.upper() / unit}};
        found = OutsideRange{{code, form, arguments}, name, value / unit, limit / unit};
    };
    if (!p.pressure_curve.empty() && peak_pressure / p.land_share > p.pressure_curve.upper()) {
        look(p.pressure_curve, peak_pressure / p.land_share, 1.0, "MPa",
             "event.pressure_not_measured",
             "the peak pressure of {value:.3g} MPa lies outside the measured {least:.3g} to "
             "{most:.3g} MPa");
    }
    look(p.speed_curve, state.belt_speed, 1000.0, "m/s", "event.speed_not_measured",
         "the belt speed of {value:.3g} m/s lies outside the measured {least:.3g} to {most:.3g} "
         "m/s");
    look(p.feed_curve, state.feed, 1.0, "mm/s", "event.feed_not_measured",
         "the feed of {value:.3g} mm/s lies outside the measured {least:.3g} to {most:.3g} mm/s");
    look(p.land_curve, p.land_share, 1.0, "", "event.land_not_measured",
         "the land share of {value:.3g} lies outside the measured {least:.3g} to {most:.3g}");
    return found;
}

std::string LocalLaw::describe() const {
    const LocalLawParameters& p = parameters_;
    std::ostringstream out;
    out << text("local law", p.coefficient);
    if (!p.pressure_curve.empty()) {
        out << ", pressure by a curve";
    } else {
        if (p.pressure_exponent != 1.0) out << ", pressure^" << p.pressure_exponent;
        if (p.pressure_threshold > 0.0) out << " above " << p.pressure_threshold << " MPa";
        if (p.saturation_pressure > 0.0)
            out << ", saturating at " << p.saturation_pressure << " MPa";
    }
    if (!p.speed_curve.empty()) {
        out << ", speed by a curve";
    } else if (p.speed_exponent != 1.0) {
        out << ", speed^" << p.speed_exponent;
    }
    if (!p.feed_curve.empty()) {
        out << ", feed by a curve";
    } else if (p.feed_exponent != 0.0) {
        out << ", feed^" << p.feed_exponent;
    }
    if (p.land_share < 1.0) out << ", lands " << p.land_share;
    return out.str();
}

HammannLaw::HammannLaw(double coefficient) : coefficient_(checked(coefficient)) {}

void HammannLaw::rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
                      Eigen::ArrayXd& rate) const {
    const double mean = state.contact_area > 0.0 ? state.force / state.contact_area : 0.0;
    const double everywhere = coefficient_ * state.belt_wear * state.belt_speed * mean;
    rate =
        (pressure > 0.0)
            .select(Eigen::ArrayXd::Constant(pressure.size(), std::min(everywhere, kFastest)), 0.0);
}

std::string HammannLaw::describe() const {
    return text("Hammann's global law", coefficient_);
}

std::unique_ptr<RemovalLaw> make_removal_law(const std::string& name,
                                             const LocalLawParameters& parameters) {
    if (name == "local") return std::make_unique<LocalLaw>(parameters);
    if (name == "hammann") return std::make_unique<HammannLaw>(parameters.coefficient);
    throw InputError("call.law", "law: there is no model '{name}'; use local or hammann",
                     {{"name", name}});
}

}  // namespace beltgrinding
