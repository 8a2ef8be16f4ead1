#include "elastic/wheel_rim.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "convolution.h"
#include "rim_operator.h"

namespace beltgrinding {
namespace {

constexpr int kWaves = 24;          // sampled wavenumbers
constexpr double kFirstWave = 0.3;  // times 1 / thickness
constexpr double kAliases = 4.0;    // the sum along the circumference ends at 2 pi / ds times this
constexpr double kPi = std::numbers::pi;
constexpr double kBeside = 0.05;  // of the thickness: a side face bulges that far at most
constexpr double kSame = 1e-9;    // relative: of two computations, by another library perhaps
constexpr int kReadable = 6, kExact = 17;  // digits: for the report; that tell two doubles apart

/// The sampled wavenumbers: 0 to `last` (1/mm), close together where waves are long.
struct WaveScale {
    double first, growth;

    WaveScale(double thickness, double last)
        : first(kFirstWave / thickness), growth(std::log1p(last / first) / (kWaves - 1)) {}
    double wave(int m) const { return first * std::expm1(growth * m); }
    /// Where a wavenumber lies between the sampled ones, from 0 to kWaves - 1.
    double place(double k) const { return std::min(std::log1p(k / first) / growth, kWaves - 1.0); }
};

/// Weights of natural cubic spline interpolation on unit intervals: row t, column m is the weight
/// of value m at the place `at[t]`.
Eigen::MatrixXd spline_weights(const std::vector<double>& at, int count) {
    // Second derivatives from values: tridiagonal, 1 4 1.
    Eigen::MatrixXd left = Eigen::MatrixXd::Identity(count, count);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, count);
    for (int i = 1; i + 1 < count; ++i) {
        left.row(i).segment(i - 1, 3) << 1.0, 4.0, 1.0;
        right.row(i).segment(i - 1, 3) << 6.0, -12.0, 6.0;
    }
    const Eigen::MatrixXd second = left.partialPivLu().solve(right);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(at.size()), count);
    for (std::size_t t = 0; t < at.size(); ++t) {
        const int i = std::clamp(static_cast<int>(at[t]), 0, count - 2);
        const double f = at[t] - i, g = 1.0 - f;
        const auto row = static_cast<Eigen::Index>(t);
        weights(row, i) += g;
        weights(row, i + 1) += f;
        weights.row(row) +=
            ((g * g * g - g) * second.row(i) + (f * f * f - f) * second.row(i + 1)) / 6.0;
    }
    return weights;
}

/// -d2/dy2 of cell values with free ends, for `cells` cells of width dy, 1/mm2.
Eigen::MatrixXd second_difference(int cells, double dy) {
    Eigen::MatrixXd l = Eigen::MatrixXd::Zero(cells, cells);
    for (int i = 0; i + 1 < cells; ++i) {
        l.block<2, 2>(i, i) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished() / (dy * dy);
    }
    return l;
}

/// Orthonormal even (true) or odd combinations of cells, from the middle outwards, as columns.
Eigen::MatrixXd combinations(int cells, bool even) {
    const int count = even ? (cells + 1) / 2 : cells / 2;
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(cells, count);
    const int first = cells % 2 == 1 && !even ? 1 : 0;
    for (int a = 0; a < count; ++a) {
        const int up = cells / 2 + a + first, down = cells - 1 - up;
        if (up == down) {
            basis(up, a) = 1.0;
        } else {
            basis(up, a) = std::sqrt(0.5);
            basis(down, a) = even ? std::sqrt(0.5) : -std::sqrt(0.5);
        }
    }
    return basis;
}

/// Whether the samples, which may come from any cache, are of as many wavenumbers and cells.
bool fits(const RimSamples& samples, int cells) {
    const auto all = [](const std::vector<Eigen::MatrixXd>& matrices, int size) {
        return matrices.size() == kWaves &&
               std::all_of(matrices.begin(), matrices.end(), [&](const Eigen::MatrixXd& m) {
                   return m.rows() == size && m.cols() == size && m.allFinite();
               });
    };
    return all(samples.even, (cells + 1) / 2 + 1) && all(samples.odd, cells / 2 + 1);
}

}  // namespace

WheelRim::WheelRim(WheelRimDesign design, BeltPlate belt, std::shared_ptr<RimCache> cache)
    : design_(std::move(design)), belt_(belt), cache_(std::move(cache)) {
    design_.validate();
    if (!(belt_.tension >= 0.0) || !(belt_.bending >= 0.0)) {
        throw InputError(
            "rim.belt", "wheel rim: the belt's tension and bending stiffness must not be negative");
    }
}

std::unique_ptr<ComplianceOperator> WheelRim::make_operator(const ContactGrid& grid) const {
    const auto samples = samples_.get(grid, 0, [&] { return sample(grid); });
    auto spectra = [cache = spectra_, design = design_, samples, grid](int length) {
        return cache->get(grid, length, [&] { return build(design, grid, *samples, length); });
    };
    const double width = grid.ny * grid.dy;
    const auto mode = [&](bool outwards) {
        return SideMode(width, design_.thickness(), grid.ny, outwards);
    };
    // A belt is far stiffer along the axis than the rubber, and its own edges do not bulge.
    return std::make_unique<RimOperator>(grid, samples->description, std::move(spectra),
                                         std::array{mode(true), mode(false)}, !has_belt());
}

WheelRim::Samples WheelRim::sample(const ContactGrid& grid) const {
    Samples samples;
    samples.description = describe();
    const WaveScale scale(design_.thickness(), 2.0 * kPi / grid.ds);
    samples.waves.resize(kWaves);
    for (int m = 0; m < kWaves; ++m) samples.waves[static_cast<std::size_t>(m)] = scale.wave(m);
    if (cache_ == nullptr) {
        samples.compliance = compute(grid, samples.waves);
        return samples;
    }
    std::ostringstream text;
    text.precision(kExact);
    text << describe_design(kExact) << "; cells " << grid.ny << " x " << grid.dy << " mm, "
         << grid.ds << " mm; waves " << kWaves << " from " << scale.first << "; sides\n";
    const std::string key = text.str();
    samples.description += " (cached as " + rim_cache_name(key) + ")";
    if (auto kept = cache_->read(key);
        kept && fits(*kept, grid.ny) && holds(grid, samples.waves, *kept)) {
        samples.compliance = std::move(*kept);
    } else {
        samples.compliance = compute(grid, samples.waves);
        cache_->write(key, samples.compliance);
    }
    return samples;
}

RimSamples WheelRim::compute(const ContactGrid& grid, const std::vector<double>& waves) const {
    WheelRimDesign design = design_;
    design.width = grid.ny * grid.dy;
    const RimSection section(design, grid.ny, grid.ds);
    RimSamples samples;
    samples.even.assign(waves.size(), {});
    samples.odd.assign(waves.size(), {});
    parallel_blocks(waves.size(), 1, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m)
            section.compliance(waves[m], samples.even[m], samples.odd[m]);
    });
    if (has_belt()) {
        const Eigen::MatrixXd across = second_difference(grid.ny, grid.dy);
        for (std::size_t m = 0; m < waves.size(); ++m) {
            const double k2 = waves[m] * waves[m];
            const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(grid.ny, grid.ny);
            const Eigen::MatrixXd bend = k2 * one + across;
            const Eigen::MatrixXd plate = belt_.tension * k2 * one + belt_.bending * bend * bend;
            for (const bool even : {true, false}) {
                const Eigen::MatrixXd basis = combinations(grid.ny, even);
                Eigen::MatrixXd& all = even ? samples.even[m] : samples.odd[m];
                const Eigen::Index count = basis.cols();
                const Eigen::MatrixXd rubber = all.topLeftCorner(count, count);
                all.setZero();
                if (count == 0) continue;
                all.topLeftCorner(count, count) =
                    (rubber.inverse() + basis.transpose() * plate * basis).inverse();
            }
        }
    }
    return samples;
}

/// Computes one of them anew, another each time: a file that somebody made for this key, with a sum
/// that fits it, is not believed either.
bool WheelRim::holds(const ContactGrid& grid, const std::vector<double>& waves,
                     const RimSamples& kept) const {
    const std::size_t m = std::random_device()() % waves.size();
    const RimSamples anew = compute(grid, {waves[m]});
    const auto same = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
        return a.size() == b.size() && (a.size() == 0 || (a - b).norm() <= kSame * b.norm());
    };
    return same(kept.even[m], anew.even[0]) && same(kept.odd[m], anew.odd[0]);
}

WheelRim::Spectrum WheelRim::build(const WheelRimDesign& design, const ContactGrid& grid,
                                   const Samples& samples, int length) {
    // The influence function along the circumference, of the wheel's whole numbers of waves, as
    // weights of the sampled matrices.
    const auto& [even, odd] = samples.compliance;
    const double radius = design.outer_radius, ds = grid.ds;
    const double offset = 1.0 / design.thickness();
    const double last = samples.waves.back();
    const WaveScale scale(design.thickness(), last);
    const int terms = static_cast<int>(kAliases * 2.0 * kPi / ds * radius);
    std::vector<double> place(static_cast<std::size_t>(terms) + 1);
    for (int n = 0; n <= terms; ++n) {
        place[static_cast<std::size_t>(n)] = scale.place(n / radius);
    }
    Eigen::MatrixXd weights = spline_weights(place, kWaves);
    for (int n = 0; n <= terms; ++n) {
        const double k = n / radius, x = 0.5 * k * ds;
        const double sinc = x > 0.0 ? std::sin(x) / x : 1.0;
        const double known = std::min(k, last);
        const double beyond = k > last ? last / k : 1.0;  // as on a half-space
        weights.row(n) *= (n == 0 ? 1.0 : 2.0) * sinc * sinc * beyond * ds / (2.0 * kPi * radius);
        for (int m = 0; m < kWaves; ++m) {  // C (k + 1/h) is what is smooth
            weights(n, m) *=
                (samples.waves[static_cast<std::size_t>(m)] + offset) / (known + offset);
        }
    }
    const int half = length / 2;
    Eigen::MatrixXd cosines(half + 1, terms + 1);
    for (int n = 0; n <= terms; ++n) {
        // cos(n d ds / R) for d = 0, 1, ... by the recurrence of Chebyshev.
        const double step = std::cos(n * ds / radius);
        cosines(0, n) = 1.0;
        if (half >= 1) cosines(1, n) = step;
        for (int d = 2; d <= half; ++d) {
            cosines(d, n) = 2.0 * step * cosines(d - 1, n) - cosines(d - 2, n);
        }
    }
    const Eigen::MatrixXd influence = cosines * weights;  // by distance, of the sampled matrices
    Eigen::MatrixXd transform(half + 1, half + 1);
    for (int k = 0; k <= half; ++k) {
        for (int d = 0; d <= half; ++d) {
            transform(k, d) = (d == 0 || d == half ? 1.0 : 2.0) *
                              std::cos(2.0 * kPi * static_cast<double>(k) * d / length);
        }
    }
    const Eigen::MatrixXd symbol = transform * influence;
    Spectrum result;
    result.diagonal = 0.0;
    for (int m = 0; m < kWaves; ++m) {
        const auto i = static_cast<std::size_t>(m);
        const auto cells = [](const Eigen::MatrixXd& c) {
            return c.diagonal().head(c.rows() - 1).sum();
        };
        result.diagonal += influence(0, m) * (cells(even[i]) + cells(odd[i])) / grid.ny;
    }
    const Eigen::Index ne = even[0].size(), no = odd[0].size();
    result.matrices.resize(static_cast<std::size_t>((half + 1) * (ne + no)));
    float* to = result.matrices.data();
    for (int k = 0; k <= half; ++k) {
        for (const auto* matrices : {&even, &odd}) {
            const Eigen::Index n = (*matrices)[0].rows();
            Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
            for (int m = 0; m < kWaves; ++m) {
                sum += symbol(k, m) * (*matrices)[static_cast<std::size_t>(m)];
            }
            Eigen::Map<Eigen::MatrixXf>(to, n, n) = sum.cast<float>();
            to += n * n;
        }
    }
    return result;
}

double WheelRim::thickness() const {
    return design_.thickness();
}

double WheelRim::beside() const {
    return has_belt() ? 0.0 : kBeside * design_.thickness();
}

std::string WheelRim::describe() const {
    return describe_design(kReadable);
}

std::string WheelRim::describe_design(int digits) const {
    std::ostringstream text;
    text.precision(digits);
    text << "wheel rim, R " << design_.outer_radius << " mm, width " << design_.width << " mm";
    for (const RimLayer& layer : design_.layers) {
        text << ", " << layer.thickness << " mm of E " << layer.elasticity.youngs_modulus
             << " MPa, nu " << layer.elasticity.poissons_ratio;
    }
    if (!design_.drop.empty()) {
        text << ", turned to a profile";
        if (digits == kExact)
            for (const double drop : design_.drop) text << ' ' << drop;
    }
    if (has_belt()) {
        text << ", belt of " << belt_.tension << " N/mm tension, " << belt_.bending
             << " N mm bending stiffness";
    }
    return text.str();
}

}  // namespace beltgrinding
