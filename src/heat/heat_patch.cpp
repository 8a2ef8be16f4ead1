#include "heat/heat_patch.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr double kLeastStiff = 1e-3;
constexpr double kCoarser = 1.1;         // from one stiffness that is computed to the next
constexpr double kOther = 1.02;          // the same of errors, to the nearest
constexpr double kTolerance = 0.02;      // of what is left out, at waves from node to node
constexpr std::size_t kFewest = 2;       // terms
constexpr std::size_t kMostKept = 1024;  // series

/// Terms of Chebyshev's series of exp(z - error z^2), z from -`stiff` to 0. The square is what
/// finite volumes conduct too little at short waves.
std::vector<double> series(double stiff, double error) {
    const auto points = 16 + static_cast<std::size_t>(4.0 * std::sqrt(stiff));
    const double scale = 2.0 / static_cast<double>(points);
    std::vector<double> terms(points, 0.0);
    for (std::size_t i = 0; i < points; ++i) {
        const double x =
            std::cos(M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(points));
        const double z = 0.5 * stiff * (x - 1.0);
        const double value = scale * std::exp(z - error * z * z);
        double before = x, now = 1.0;  // Chebyshev's polynomials, from the one before the first
        for (double& term : terms) {
            term += value * now;
            const double next = 2.0 * x * now - before;
            before = now;
            now = next;
        }
    }
    terms[0] *= 0.5;
    double left = 0.0;
    while (terms.size() > kFewest && left + std::abs(terms.back()) < kTolerance) {
        left += std::abs(terms.back());
        terms.pop_back();
    }
    // At 0 the value 1, or heat would be made, and the slope 1, by the last two terms.
    double value = 1.0, slope = 0.5 * stiff;
    for (std::size_t k = 0; k < terms.size(); ++k) {
        value -= terms[k];
        slope -= static_cast<double>(k * k) * terms[k];
    }
    const auto n = static_cast<double>(terms.size() - 1);
    const double last = (slope - (n - 1.0) * (n - 1.0) * value) / (2.0 * n - 1.0);
    terms[terms.size() - 1] += last;
    terms[terms.size() - 2] += value - last;
    return terms;
}

}  // namespace

void HeatPatch::clear() {
    nodes.clear();
    first.clear();
    ways.clear();
    slow.clear();
    most = 0.0;
}

const std::vector<double>& RowConductor::terms(double& stiff, double error) {
    const double power = std::ceil(std::log(std::max(stiff, kLeastStiff)) / std::log(kCoarser));
    stiff = std::pow(kCoarser, power);
    const double other = std::round(std::log(error) / std::log(kOther));
    error = std::pow(kOther, other);
    if (known_.size() > kMostKept) known_.clear();
    auto& found = known_[{power, other}];
    if (found.empty()) found = series(stiff, error);
    return found;
}

void RowConductor::conduct(const HeatPatch& patch, double duration, double error,
                           std::vector<float>& rows) {
    const HeatWays ways{patch.slow.size(), patch.first.data(), patch.ways.data(),
                        patch.slow.data()};
    double stiff = 2.0 * duration * patch.most;
    const std::vector<double>& series = terms(stiff, error);
    const double share = 2.0 * duration / stiff;
    for (auto& stage : stages_)
        if (stage.size() < rows.size()) stage.resize(rows.size());
    // Clenshaw's recurrence, whose first step is a multiple of the rows. The last one may take
    // their place, but where it is the first.
    const std::size_t last = series.size() - 1;
    const float *now = rows.data(), *before = rows.data();
    for (std::size_t k = last; k-- > 0;) {
        const double twice = k == 0 ? 1.0 : 2.0;
        HeatStage stage{twice, -1.0, series[k], twice * share};
        if (k + 1 == last)
            stage = {twice * series[last] + series[k], 0.0, 0.0, twice * share * series[last]};
        if (k + 2 == last) stage = {twice, 0.0, series[k] - series[last], twice * share};
        float* const next = k == 0 && last > 1 ? rows.data() : stages_[k % 2].data();
        conduct_stage(ways, stage, now, before, rows.data(), next);
        before = now;
        now = next;
    }
    if (last == 1) std::copy_n(stages_[0].data(), ways.nodes * kModes, rows.data());
}

void RowConductor::conduct(const HeatPatch& patch, double duration, double error,
                           std::vector<float>& rows, std::vector<float>& sums) {
    conduct(patch, duration, error, rows);
    sums.resize(patch.slow.size());
    sum_rows(rows.data(), sums.size(), sums.data());
}

}  // namespace beltgrinding
