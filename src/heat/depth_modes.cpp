#include "heat/depth_modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <mutex>

namespace beltgrinding {
namespace {

constexpr int kModes = DepthModes::kModes;
constexpr int kDecaying = kModes - 1;
constexpr double kLeast = 1.0, kMost = 20.0;         // mm2/s, of steels
constexpr double kSpacings = 6.0;                    // 1/mm
constexpr double kSlowest = 0.008, kFastest = 20.0;  // 1/mm, of z
constexpr int kTimes = 140;                          // that a plate is fitted at
constexpr int kThicknesses = 97;                     // of the table
constexpr double kRidge = 0.01;  // keeps the fit's weights near the half-space's

using Row = Eigen::Array<double, kModes, 1>;  // the decaying modes, then what is faster

double spread() {  // of ln z from one to the next
    return std::log(kFastest / kSlowest) / (kDecaying - 1);
}

std::array<double, kDecaying> wave_numbers() {
    std::array<double, kDecaying> z{};
    for (int j = 0; j < kDecaying; ++j) z[j] = kSlowest * std::exp(spread() * j);
    return z;
}

double fastest_part() {  // mm, D of a half-space
    return 2.0 / M_PI / (kFastest * std::exp(0.5 * spread()));
}

/// Integral of erfc from x on.
double ierfc(double x) {
    return std::exp(-x * x) / std::sqrt(M_PI) - x * std::erfc(x);
}

/// mm: what a constant flux does until tau (mm2), at the surface that it enters or at the other.
double response(double tau, double d, bool opposite) {
    double sum = 0.0;
    if (tau < 0.3 * d * d) {  // images
        const double root = std::sqrt(tau);
        for (int m = 0; m < 6; ++m) {
            if (opposite) sum += 2.0 * ierfc((m + 0.5) * d / root);
            if (!opposite) sum += (m == 0 ? 1.0 : 2.0) * ierfc(m * d / root);
        }
        return 2.0 * root * sum;
    }
    for (int n = 1; n < 6; ++n) {
        const double rate = std::pow(n * M_PI / d, 2);
        sum += (opposite && n % 2 == 1 ? -1.0 : 1.0) * std::exp(-rate * tau) / rate;
    }
    return tau / d + (opposite ? -d / 6.0 : d / 3.0) - 2.0 / d * sum;
}

DepthModes::Weights half_space() {
    DepthModes::Weights weights;
    const auto z = wave_numbers();
    weights.modes[0] = static_cast<float>(2.0 / M_PI * kSlowest * std::exp(-0.5 * spread()));
    for (int j = 0; j < kDecaying; ++j)
        weights.modes[j + 1] = static_cast<float>(2.0 / M_PI * spread() * z[j]);
    weights.direct = static_cast<float>(fastest_part());
    return weights;
}

/// Least squares in the temperature after times of constant flux, relative to the heated side's.
DepthModes::Weights fitted(double d, bool opposite) {
    const auto z = wave_numbers();
    Row scale, prior = Row::Zero();
    for (int j = 0; j < kDecaying; ++j) {
        scale[j] = 2.0 / M_PI * spread() * z[j];
        if (!opposite && z[j] > M_PI / d) prior[j] = 1.0;
    }
    scale[kDecaying] = fastest_part();
    if (!opposite) prior[kDecaying] = std::min(1.0, d / 3.0 / fastest_part());
    using Square = Eigen::Matrix<double, kModes, kModes>;
    Square normal = kRidge * kRidge * Square::Identity();
    Eigen::Matrix<double, kModes, 1> right = kRidge * kRidge * prior.matrix();
    const double first = 2.0 / (kFastest * kFastest), last = 3.0 / (kSlowest * kSlowest);
    for (int k = 0; k < kTimes; ++k) {
        const double tau = first * std::pow(last / first, k / (kTimes - 1.0));
        const double weight = 1.0 / response(tau, d, false);
        Eigen::Matrix<double, kModes, 1> row;
        for (int j = 0; j < kDecaying; ++j) {
            const double rate = z[j] * z[j];
            row[j] = weight * scale[j] * -std::expm1(-rate * tau) / rate;
        }
        row[kDecaying] = weight * scale[kDecaying];
        normal += row * row.transpose();
        right += weight * (response(tau, d, opposite) - tau / d) * row;
    }
    const Row found = scale * normal.ldlt().solve(right).array();
    DepthModes::Weights weights;
    weights.modes[0] = static_cast<float>(1.0 / d);
    for (int j = 0; j < kDecaying; ++j) weights.modes[j + 1] = static_cast<float>(found[j]);
    weights.direct = static_cast<float>(found[kDecaying]);
    return weights;
}

double thickness_of(int k) {
    return DepthModes::kThin *
           std::pow(DepthModes::kThick / DepthModes::kThin, k / (kThicknesses - 1.0));
}

/// The table's entry, fitted when it is first asked for, which few of them are.
const DepthModes::Weights& fitted_at(int k, bool opposite) {
    struct Entry {
        std::once_flag made;
        DepthModes::Weights weights;
    };
    static std::array<Entry, 2 * kThicknesses> table;
    Entry& entry = table[static_cast<std::size_t>(2 * k + (opposite ? 1 : 0))];
    std::call_once(entry.made, [&] { entry.weights = fitted(thickness_of(k), opposite); });
    return entry.weights;
}

DepthModes::Weights thin(double d, bool opposite) {
    DepthModes::Weights weights;
    weights.modes[0] = static_cast<float>(1.0 / d);
    weights.direct = static_cast<float>(opposite ? -d / 6.0 : d / 3.0);
    return weights;
}

DepthModes::Weights interpolated(double d, bool opposite) {
    if (d < DepthModes::kThin) return thin(d, opposite);
    const double at = std::log(d / DepthModes::kThin) /
                      std::log(DepthModes::kThick / DepthModes::kThin) * (kThicknesses - 1);
    const int k = std::clamp(static_cast<int>(at), 0, kThicknesses - 2);
    const auto u = static_cast<float>(at - k);
    const DepthModes::Weights &a = fitted_at(k, opposite), &b = fitted_at(k + 1, opposite);
    DepthModes::Weights weights;
    for (int j = 0; j < kModes; ++j) weights.modes[j] = (1 - u) * a.modes[j] + u * b.modes[j];
    weights.modes[0] = static_cast<float>(1.0 / d);  // what is stored in the section, exactly
    weights.direct = (1 - u) * a.direct + u * b.direct;
    return weights;
}

DepthModes::Weights lengthened(DepthModes::Weights weights, double longer) {
    for (float& weight : weights.modes) weight = static_cast<float>(weight / longer);
    weights.direct = static_cast<float>(weights.direct * longer);
    return weights;
}

}  // namespace

const std::array<double, kModes>& DepthModes::rates() {
    static const auto all = [] {
        std::array<double, kModes> rates{};
        const auto z = wave_numbers();
        for (int j = 0; j < kDecaying; ++j) rates[j + 1] = z[j] * z[j];
        return rates;
    }();
    return all;
}

double DepthModes::longer(double diffusivity, double spacing) {
    const double ways = std::sqrt(diffusivity / std::clamp(diffusivity, kLeast, kMost));
    return std::min(ways, std::max(kSpacings * spacing, 1.0));
}

DepthModes::Weights DepthModes::own(double thickness, double longer) {
    static const Weights thick = half_space();
    const double d = thickness / longer;
    return lengthened(d < kThick ? interpolated(d, false) : thick, longer);
}

DepthModes::Weights DepthModes::opposite(double thickness, double longer) {
    const double d = thickness / longer;
    return lengthened(d < kThick ? interpolated(d, true) : Weights{}, longer);
}

}  // namespace beltgrinding
