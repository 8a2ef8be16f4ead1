// Materials, feeds, steps and spacings at random, against Green's function of a rectangle's plate
// with insulated edges, which is integrated here by itself: Carslaw & Jaeger, 2nd ed., 10.4, 14.10.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "beltgrinding/error.h"
#include "plate.h"

namespace beltgrinding {
namespace {

/// A rectangle of constant flux that runs along x in steps, stands still, or both.
struct Grind {
    HeatMaterial material;
    double spacing = 1.0;              // mm
    int along = 0, across = 0;         // nodes
    double thickness = HUGE_VAL;       // mm
    double half = 0.0, wide = 0.0;     // mm, halves of the rectangle
    double flux = 0.0;                 // N/(mm s)
    std::vector<double> middle, time;  // mm, of each step; s, when it ends
    std::string text;

    double length() const { return (along - 1) * spacing; }
    double width() const { return (across - 1) * spacing; }
};

/// Of a unit on [from, to] of an insulated [0, length], what is at x after tau = alpha t mm2.
double spread(double x, double from, double to, double length, double tau) {
    if (tau > 0.1 * length * length) {
        double sum = (to - from) / length;
        for (int n = 1; n < 12; ++n) {
            const double k = n * M_PI / length;
            sum += 2.0 / (n * M_PI) * (std::sin(k * to) - std::sin(k * from)) * std::cos(k * x) *
                   std::exp(-k * k * tau);
        }
        return sum;
    }
    const double reach = 2.0 * std::sqrt(tau);
    double sum = 0.0;
    for (int n = -1; n <= 1; ++n)
        for (const double at : {2.0 * n * length + x, 2.0 * n * length - x})
            sum += 0.5 * (std::erf((to - at) / reach) - std::erf((from - at) / reach));
    return sum;
}

/// 1/mm, into the depth: at the heated surface.
double depth_kernel(double tau, double d) {
    if (!std::isfinite(d)) return 1.0 / std::sqrt(M_PI * tau);
    double sum = 0.0;
    if (tau < 0.2 * d * d) {
        for (int n = 1; n < 4; ++n) sum += std::exp(-n * n * d * d / tau);
        return (1.0 + 2.0 * sum) / std::sqrt(M_PI * tau);
    }
    for (int n = 1; n < 6; ++n) sum += std::exp(-n * n * M_PI * M_PI * tau / (d * d));
    return (1.0 + 2.0 * sum) / d;
}

/// K, at (x, y) at the end of step `last`.
double exact(const Grind& run, std::size_t last, double x, double y) {
    const double alpha = run.material.diffusivity(), now = run.time[last];
    double sum = 0.0;
    for (std::size_t i = 0; i <= last; ++i) {
        const double begin = i == 0 ? 0.0 : run.time[i - 1];
        // In the root of the time since, in parts that are in proportion to it: the kernels are
        // smooth in its logarithm.
        double high = std::sqrt(alpha * (now - begin));
        const double low = std::sqrt(alpha * (now - run.time[i])), least = 0.02 * run.spacing;
        while (high > low) {
            const double to = high < least ? low : std::max(low, high / 1.15);
            for (const double at : {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}) {  // Gauss
                const double v = 0.5 * (high + to) + 0.5 * at * (high - to), tau = v * v;
                sum += 0.5 * (high - to) * (at == 0.0 ? 8.0 / 9.0 : 5.0 / 9.0) * 2.0 * v *
                       depth_kernel(tau, run.thickness) *
                       spread(x, run.middle[i] - run.half, run.middle[i] + run.half, run.length(),
                              tau) *
                       spread(y, 0.5 * run.width() - run.wide, 0.5 * run.width() + run.wide,
                              run.width(), tau);
            }
            high = to;
        }
    }
    return run.flux * sum / (alpha * run.material.capacity());
}

/// K, never exceeded: neither flux nor power has ever been greater. What came tau ago is spread
/// over 4 pi alpha tau at least, a quarter of it in a corner.
double jaeger(const Grind& run) {
    const double alpha = run.material.diffusivity(), power = 4.0 * run.half * run.wide * run.flux;
    double sum = 0.0, tau = 0.0;
    const double all = alpha * run.time.back();
    for (double next = 1e-6 * all; tau < all; next = std::min(1.2 * next, all)) {
        for (int k = 0; k < 20; ++k) {
            const double at = tau + (k + 0.5) * (next - tau) / 20.0;
            const double one = 1.0 / std::sqrt(M_PI * at);
            const double flux =
                std::min(run.flux, power * (one + 1.0 / run.length()) * (one + 1.0 / run.width()));
            sum += (next - tau) / 20.0 * flux * depth_kernel(at, run.thickness);
        }
        tau = next;
    }
    return sum / (alpha * run.material.capacity());
}

struct Found {
    double greatest = 0.0, most = 0.0, worst = 0.0;  // K, found and sought; of the greatest
    double least = 0.0;                              // K
};

void heat(Conduction& conduction, const Grind& run, const PartHeat& part, std::size_t step) {
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const Vec3& p = part.nodes().point[k];
        const auto share = [h = run.spacing](double at, double half) {
            return std::clamp((std::min(at + 0.5 * h, half) - std::max(at - 0.5 * h, -half)) / h,
                              0.0, 1.0);
        };
        conduction.add(k, run.flux * run.spacing * run.spacing *
                              share(p.x() - run.middle[step], run.half) *
                              share(p.y() - 0.5 * run.width(), run.wide));
    }
    conduction.advance(run.time[step] - (step == 0 ? 0.0 : run.time[step - 1]), 0);
}

Found conduct(const Grind& run) {
    const HeightField field = plate(run.along, run.across, run.spacing);
    PartHeat part(field, 0.999 * run.spacing, run.material);  // a node on each, whatever is rounded
    if (std::isfinite(run.thickness))
        part.set_thickness(std::vector<float>(part.size(), static_cast<float>(run.thickness)));
    Conduction conduction(part);
    for (std::size_t step = 0; step < run.time.size(); ++step) heat(conduction, run, part, step);
    Found found;
    const std::size_t last = run.time.size() - 1;
    std::vector<std::pair<double, double>> both;
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const Vec3& p = part.nodes().point[k];
        const double rise = conduction.rise(k);
        found.least = std::min(found.least, rise);
        const int i = static_cast<int>(std::lround(p.x() / run.spacing)),
                  j = static_cast<int>(std::lround(p.y() / run.spacing));
        if (j != run.across / 2 || i % 2 != 0) continue;
        // Where the flux jumps a node's temperature is uncertain.
        const double x = p.x() - run.middle[last];
        if (std::abs(std::abs(x) - run.half) < 1.5 * run.spacing) continue;
        both.emplace_back(rise, exact(run, last, p.x(), p.y()));
    }
    for (const auto& [rise, sought] : both) {
        found.most = std::max(found.most, sought);
        found.greatest = std::max(found.greatest, rise);
    }
    for (const auto& [rise, sought] : both)
        found.worst = std::max(found.worst, std::abs(rise - sought) / found.most);
    // Heat that was made or lost is an error of its own.
    conduction.settle();
    return found;
}

Grind any_run(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto any = [&random](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    const auto by_decades = [&any](double low, double high) {
        return low * std::pow(high / low, any(0.0, 1.0));
    };
    Grind run;
    const double capacity = by_decades(1e3, 1e7);  // J/(m3 K)
    run.material = {by_decades(6.0, 400.0), 500.0, capacity / 500.0};
    run.spacing = by_decades(0.25, 1.0);
    const double feed = by_decades(1.0, 50.0), travel = by_decades(0.25, 2.0);
    run.half = run.spacing * std::round(any(3.0, 5.0));
    run.wide = run.spacing * (std::round(any(3.0, 6.0)) + 0.5);
    run.along = 41 + 2 * static_cast<int>(any(0.0, 20.0));
    run.across = 21 + 2 * static_cast<int>(any(0.0, 10.0));
    const double thickness = by_decades(0.3, 30.0);
    const bool thin = any(0.0, 1.0) < 0.5;
    run.flux = 1000.0;
    const double begin = run.half + 2.0 * run.spacing;
    const double way = std::max(run.length() - 2.0 * begin, travel);
    const int steps = std::clamp(static_cast<int>(way / travel), 1, 40);
    double time = 0.0;
    const double dwell = any(0.0, 1.0) < 0.3 ? by_decades(0.1, 30.0) : 0.0;
    for (int k = 0; k < steps; ++k) {
        run.middle.push_back(begin + (k + 0.5) * travel);
        run.time.push_back(time += travel / feed + (k == steps / 2 ? dwell : 0.0));
    }
    // Parts are not as deep as heat gets in the others.
    if (thin || run.material.diffusivity() * time > 1e4) run.thickness = thickness;
    char text[300];
    std::snprintf(text, sizeof text,
                  "seed %u: k %.3g W/(m K), rho c %.3g J/(m3 K), %.3g mm/s, steps %.3g mm (%d), "
                  "dwell %.3g s, spacing %.3g mm, %d x %d, half %.3g, d %.3g",
                  seed, run.material.conductivity, capacity, feed, travel, steps, dwell,
                  run.spacing, run.along, run.across, run.half, run.thickness);
    run.text = text;
    return run;
}

TEST(AnyMaterial, TheTemperaturesAreGreensFunctionsWhateverTheStep) {
    const char* asked = std::getenv("BELTGRINDING_HEAT_RUNS");
    const char* from = std::getenv("BELTGRINDING_HEAT_SEED");
    const int count = asked != nullptr ? std::atoi(asked) : 40;
    const int first = from != nullptr ? std::atoi(from) : 1;
    for (int k = first; k < first + count; ++k) {
        const Grind run = any_run(static_cast<std::uint32_t>(k));
        SCOPED_TRACE(run.text);
        const Found found = conduct(run);
        if (std::getenv("BELTGRINDING_HEAT_TELL") != nullptr)
            std::printf("%6.4f %7.4f %7.3f %8.3f | %7.4f %s\n", found.worst,
                        found.greatest / found.most - 1.0, found.least / found.most,
                        found.most / jaeger(run), found.most, run.text.c_str());
        EXPECT_LT(found.worst, 0.03);
        EXPECT_NEAR(found.greatest, found.most, 0.02 * found.most);
        EXPECT_LT(found.greatest, jaeger(run));
        EXPECT_GT(found.least, -0.01 * found.most);
    }
}

}  // namespace
}  // namespace beltgrinding
