#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"
#include "removal/calibration.h"

namespace beltgrinding {
namespace {

using Column = Eigen::ArrayXd;

bool positive(const Column& column) {
    return column.allFinite() && (column > 0.0).all();
}
bool not_negative(const Column& column) {
    return column.allFinite() && (column >= 0.0).all();
}
void check_loading(const Column& loading, Eigen::Index n) {
    if (loading.size() == 0) return;
    if (loading.size() != n)
        throw InputError("calibration.lengths", "calibration: columns differ in length");
    if (!not_negative(loading) || (loading > 1.0).any())
        throw InputError("calibration.loading", "calibration: loadings must lie in [0, 1]");
}
/// NaN stands for what is not known.
bool positive_if_known(const Column& column) {
    return !(column <= 0.0).any() && !column.isInf().any();
}

}  // namespace

void MeasuredGrinds::validate() const {
    const Eigen::Index n = measured.size();
    for (const auto* column : {&force, &area, &speed, &feed, &time, &wear, &spread}) {
        if (column->size() != n)
            throw InputError("calibration.lengths", "calibration: columns differ in length");
    }
    for (const auto* column : {&force, &speed, &time, &measured}) {
        if (!positive(*column)) {
            throw InputError("calibration.not_positive",
                             "calibration: force, speed, time and removal must be positive");
        }
    }
    if (!not_negative(feed) || !not_negative(wear)) {
        throw InputError("calibration.negative",
                         "calibration: feed and wear must be zero or positive");
    }
    for (const auto* column : {&grit, &cut}) {
        if (column->size() == 0) continue;
        if (column->size() != n)
            throw InputError("calibration.lengths", "calibration: columns differ in length");
        if (!positive(*column)) {
            throw InputError("calibration.grain",
                             "calibration: grit and remaining cut must be positive");
        }
    }
    check_loading(loading, n);
    if (relative.size() > 0 &&
        (relative.rows() != n || !relative.allFinite() || (relative < 0.0).any() ||
         !(relative.rowwise().sum() > 0.0).all())) {
        throw InputError(
            "calibration.relative",
            "calibration: pressures over the mean must be zero or positive, a row each");
    }
    if (!positive(areas) || !positive_if_known(area) || !positive_if_known(spread)) {
        throw InputError("calibration.areas", "calibration: areas must be positive");
    }
    if (areas.size() == 0 && area.isNaN().any()) {
        throw InputError("calibration.area_unknown",
                         "calibration: an area is unknown, and what it can be as well");
    }
}

namespace {

constexpr double kLeastExcess = 1e-9;  // MPa above the threshold

/// ln of the mean of (q / p_ref)^alpha over the contact, q the pressure that cuts, and its
/// derivatives by alpha, the threshold and ln of the saturation.
struct MeanCut {
    double ln_mean = 0.0, by_exponent = 0.0, by_threshold = 0.0, by_saturation = 0.0;
};

MeanCut mean_cut(const GrindVector& x, double reference, const MeasuredGrinds& grinds,
                 Eigen::Index i, double mean) {
    const double alpha = x[kPressureExponent], saturation = std::exp(x[kLnSaturation]);
    const Eigen::Index shares = std::max<Eigen::Index>(1, grinds.relative.cols());
    MeanCut cut;
    double sum = 0.0;
    for (Eigen::Index j = 0; j < shares; ++j) {
        const double pressure = grinds.relative.size() > 0 ? grinds.relative(i, j) * mean : mean;
        const double excess = std::max(pressure - x[kPressureThreshold], kLeastExcess);
        const double ratio = std::isfinite(saturation) ? excess / saturation : 0.0;
        const double effective = ratio > 0.0 ? saturation * -std::expm1(-ratio) : excess;
        // d ln(1 - exp(-ratio)) / d ln(ratio), which goes to 1.
        const double steep = ratio > 0.0 ? ratio / std::expm1(ratio) : 1.0;
        const double ln_pressure = std::log(effective / reference);
        const double term = std::exp(alpha * ln_pressure);
        sum += term;
        cut.by_exponent += term * ln_pressure;
        if (excess > kLeastExcess) cut.by_threshold -= term * alpha * steep / excess;
        cut.by_saturation += term * alpha * (1.0 - steep);
    }
    cut.ln_mean = std::log(sum / static_cast<double>(shares));
    cut.by_exponent /= sum;
    cut.by_threshold /= sum;
    cut.by_saturation /= sum;
    return cut;
}

/// What is left of the part of the cut that wears, in one stage or in two, and its derivatives by
/// ln of the scale, the first stage's share and ln of its scale's ratio.
struct Decay {
    double left, by_scale, by_share, by_ratio;
};

Decay decay_of(const GrindVector& x, double worn) {
    const double share = x[kFirstShare], first = worn / std::exp(x[kLnFirstRatio]);
    const double early = std::exp(-first), late = std::exp(-worn);
    const double by_ratio = share * early * first;
    return {share * early + (1.0 - share) * late, by_ratio + (1.0 - share) * late * worn,
            early - late, by_ratio};
}

}  // namespace

double log_grind(const GrindVector& x, const GrindReferences& references,
                 const MeasuredGrinds& grinds, Eigen::Index i, double area, GrindVector* gradient) {
    const bool moving = grinds.feed[i] > 0.0;
    const MeanCut mean = mean_cut(x, references.pressure, grinds, i, grinds.force[i] / area);
    const double ln_speed = std::log(grinds.speed[i] / references.speed);
    const double ln_feed = moving ? std::log(grinds.feed[i] / references.feed) : 0.0;
    const double ln_time = moving ? 0.0 : std::log(grinds.time[i] / references.time);
    const double ln_area = std::log(area / references.area);
    const double worn = grinds.wear[i] / std::exp(x[kLnWearScale]);  // 0 for an infinite scale
    const double exponent = x[kWearExponent];
    const bool power = std::isfinite(exponent);
    const Decay decay = decay_of(x, worn);
    const double rest = x[kWearRest];
    const double ln_cut =
        power ? -exponent * std::log1p(worn) : std::log(rest + (1.0 - rest) * decay.left);
    const double ln_grit =
        grinds.grit.size() > 0 ? std::log(grinds.grit[i] / references.grit) : 0.0;
    const double ln_remaining = grinds.cut.size() > 0 ? std::log(grinds.cut[i]) : 0.0;
    const double loading = grinds.loading.size() > 0 ? grinds.loading[i] : 0.0;
    const double ln_free = std::log1p(-x[kLoadingShare] * loading);
    const double spread = std::isnan(grinds.spread[i]) ? area : grinds.spread[i];
    if (gradient) {
        GrindVector& g = *gradient;
        g[kLnCoefficient] = 1.0;
        g[kPressureExponent] = mean.by_exponent;
        g[kSpeedExponent] = ln_speed;
        g[kFeedExponent] = ln_feed;
        g[kTimeExponent] = ln_time;
        g[kAreaExponent] = ln_area;
        const double cut = std::exp(ln_cut);
        g[kLnWearScale] =
            power ? exponent * worn / (1.0 + worn) : (1.0 - rest) * decay.by_scale / cut;
        g[kWearRest] = power ? 0.0 : (1.0 - decay.left) / cut;
        g[kFirstShare] = power ? 0.0 : (1.0 - rest) * decay.by_share / cut;
        g[kLnFirstRatio] = power ? 0.0 : (1.0 - rest) * decay.by_ratio / cut;
        g[kWearExponent] = power ? -std::log1p(worn) : 0.0;
        g[kPressureThreshold] = mean.by_threshold;
        g[kLnSaturation] = mean.by_saturation;
        g[kGritExponent] = ln_grit;
        g[kCutExponent] = ln_remaining;
        g[kLoadingShare] = -loading * std::exp(-ln_free);
    }
    return x[kLnCoefficient] + ln_cut + std::log(references.speed) + x[kSpeedExponent] * ln_speed +
           std::log(references.pressure) + mean.ln_mean + x[kFeedExponent] * ln_feed +
           std::log(grinds.time[i]) + (x[kTimeExponent] - 1.0) * ln_time + std::log(area) +
           x[kAreaExponent] * ln_area + x[kGritExponent] * ln_grit +
           x[kCutExponent] * ln_remaining + ln_free - std::log(spread);
}

}  // namespace beltgrinding
