#include "elastic/half_space.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <utility>

#include "beltgrinding/error.h"
#include "convolution.h"

namespace beltgrinding {
namespace {

// The bonded layer's correction: S(x) - 1 is below 1e-12 of its value at 0 beyond kLastWave.
constexpr double kLastWave = 20.0;
constexpr int kWaves = 2400;           // Simpson's intervals up to it
constexpr double kReach = 12.0;        // thicknesses; farther away the layer does not move
constexpr int kTable = 480;            // intervals of the table up to kReach
constexpr double kPerThickness = 4.0;  // points of a cell's mean
constexpr double kSmallWave = 0.3;     // below it, differences of hyperbolic functions by series

double sinh_less_argument(double z) {
    const double z2 = z * z;
    return z * z2 / 6.0 *
           (1.0 + z2 / 20.0 * (1.0 + z2 / 42.0 * (1.0 + z2 / 72.0 * (1.0 + z2 / 110.0))));
}

/// Displacement at (x, y) from the middle of a rectangle under unit pressure, mm/MPa: the integral
/// of 1 / r over it, by its four corners.
double love(const ContactGrid& grid, double x, double y, const Elasticity& elasticity) {
    const auto corner = [](double u, double v) {
        const double r = std::hypot(u, v);
        return (u != 0.0 ? u * std::log(v + r) : 0.0) + (v != 0.0 ? v * std::log(u + r) : 0.0);
    };
    const double a = 0.5 * grid.ds, b = 0.5 * grid.dy;
    const double integral =
        corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b);
    return integral / (std::numbers::pi * elasticity.plane_strain_modulus());
}

class ConvolutionOperator final : public ComplianceOperator {
  public:
    using Spectra = std::function<std::shared_ptr<const ConvolutionModel::Spectrum>(int length)>;
    /// `rows`: of the padded grid; `spectra`: by its length.
    ConvolutionOperator(const ContactGrid& grid, std::string description, int rows, Spectra spectra)
        : ComplianceOperator(grid, std::move(description)),
          rows_(rows),
          spectra_(std::move(spectra)) {
        ConvolutionOperator::do_work_on_columns();
    }
    double diagonal() const override { return plan_->influence->influence[0]; }

  private:
    /// What a number of columns needs.
    struct Plan {
        std::shared_ptr<const ConvolutionModel::Spectrum> influence;
        RowTransform transform;
        std::vector<float> values;
        std::vector<std::complex<float>> narrow, spectrum;
    };

    bool by_columns() const override { return true; }
    void do_work_on_columns() override;
    void do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) override;

    int rows_;
    Spectra spectra_;
    std::map<int, Plan> plans_;
    Plan* plan_ = nullptr;
};

void ConvolutionOperator::do_work_on_columns() {
    const int nx = working().nx, ny = working().ny;
    auto at = plans_.find(nx);
    if (at == plans_.end()) {
        Plan plan;
        const int length = quick_fft_length(2 * nx - 1);
        plan.influence = spectra_(length);
        plan.transform = RowTransform(ny, nx, length);
        plan.values.resize(static_cast<std::size_t>(working().cells()));
        plan.narrow.resize(static_cast<std::size_t>(plan.transform.wavenumbers()) *
                           static_cast<std::size_t>(ny));
        plan.spectrum.resize(plan.influence->values.size());
        at = plans_.emplace(nx, std::move(plan)).first;
    }
    plan_ = &at->second;
}

void ConvolutionOperator::do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) {
    using Values = Eigen::Map<Eigen::ArrayXf>;
    auto& [influence, transform, values, narrow, spectrum] = *plan_;
    Values(values.data(), pressure.size()) = pressure.cast<float>();
    // Rows beyond the grid's are zero: the transform along the circumference skips them.
    const auto waves = static_cast<std::size_t>(transform.wavenumbers());
    const auto ny = static_cast<std::size_t>(grid().ny), rows = static_cast<std::size_t>(rows_);
    transform.forward(values.data(), narrow.data());
    for (std::size_t k = 0; k < waves; ++k) {
        std::complex<float>* row = spectrum.data() + k * rows;
        std::copy_n(narrow.data() + k * ny, ny, row);
        std::fill(row + ny, row + rows, std::complex<float>());
    }
    transform_rows(spectrum.data(), transform.wavenumbers(), rows_, true);
    for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= influence->values[i];
    transform_rows(spectrum.data(), transform.wavenumbers(), rows_, false);
    for (std::size_t k = 0; k < waves; ++k)
        std::copy_n(spectrum.data() + k * rows, ny, narrow.data() + k * ny);
    transform.backward(narrow.data(), values.data());
    displacement = Values(values.data(), pressure.size()).cast<double>();
}

}  // namespace

void Elasticity::validate(double largest_ratio) const {
    if (!std::isfinite(youngs_modulus) || youngs_modulus <= 0.0) {
        throw InputError("contact.youngs_modulus",
                         "Young's modulus is {modulus:f} MPa; give a positive one",
                         {{"modulus", youngs_modulus}});
    }
    if (!(poissons_ratio >= 0.0) || poissons_ratio > largest_ratio) {
        throw InputError("contact.poissons_ratio",
                         "Poisson's ratio is {ratio:g}; give one from 0 to {largest:g}",
                         {{"ratio", poissons_ratio}, {"largest", largest_ratio}});
    }
}

double Elasticity::plane_strain_modulus() const {
    return youngs_modulus / (1.0 - poissons_ratio * poissons_ratio);
}

ConvolutionModel::Spectrum ConvolutionModel::build(
    int length, int rows, const std::function<float(int, int)>& influence) {
    Spectrum result;
    // The influence function wrapped around the padded grid; even, so that its spectrum is real.
    std::vector<float> kernel(static_cast<std::size_t>(rows) * static_cast<std::size_t>(length));
    for (int j = 0; j <= rows / 2; ++j) {
        for (int i = 0; i <= length / 2; ++i) {
            const float value = influence(i, j);
            result.influence.push_back(value);
            for (const int jj : {j, (rows - j) % rows}) {
                for (const int ii : {i, (length - i) % length}) {
                    kernel[static_cast<std::size_t>(jj) * static_cast<std::size_t>(length) +
                           static_cast<std::size_t>(ii)] = value;
                }
            }
        }
    }
    RowTransform whole(rows, length, length);
    std::vector<std::complex<float>> spectrum(static_cast<std::size_t>(whole.wavenumbers()) *
                                              static_cast<std::size_t>(rows));
    whole.forward(kernel.data(), spectrum.data());
    transform_rows(spectrum.data(), whole.wavenumbers(), rows, true);
    result.values.resize(spectrum.size());
    const float scale = 1.0F / static_cast<float>(rows);
    std::transform(spectrum.begin(), spectrum.end(), result.values.begin(),
                   [&](std::complex<float> c) { return c.real() * scale; });
    return result;
}

std::unique_ptr<ComplianceOperator> ConvolutionModel::make_operator(const ContactGrid& grid) const {
    const int length = quick_fft_length(2 * grid.nx - 1);
    const int rows = quick_fft_length(2 * grid.ny - 1);
    auto whole = spectra_->get(grid, length, [&] {
        return build(length, rows, [&](int i, int j) {
            return static_cast<float>(influence(grid, i * grid.ds, j * grid.dy));
        });
    });
    // Fewer columns see part of the same function.
    auto spectra = [cache = spectra_, whole, grid, length, rows](int shorter) {
        if (shorter == length) return whole;
        return cache->get(grid, shorter, [&] {
            return build(shorter, rows, [&](int i, int j) {
                return whole->influence[static_cast<std::size_t>(j * (length / 2 + 1) + i)];
            });
        });
    };
    return std::make_unique<ConvolutionOperator>(grid, describe(), rows, std::move(spectra));
}

HalfSpace::HalfSpace(Elasticity elasticity) : elasticity_(elasticity) {
    elasticity_.validate(0.5);
}

double HalfSpace::influence(const ContactGrid& grid, double x, double y) const {
    return love(grid, x, y, elasticity_);
}

std::string HalfSpace::describe() const {
    std::ostringstream text;
    text << "elastic half-space, E " << elasticity_.youngs_modulus << " MPa, nu "
         << elasticity_.poissons_ratio;
    return text.str();
}

double BondedLayer::shape(double x, double nu) {
    if (x <= 0.0) return 0.0;
    const double c = 3.0 - 4.0 * nu;
    const double d = 5.0 - 12.0 * nu + 8.0 * nu * nu;
    if (x < kSmallWave) {
        return (c * sinh_less_argument(2.0 * x) + 4.0 * x * (1.0 - 2.0 * nu)) /
               (c * std::cosh(2.0 * x) + 2.0 * x * x + d);
    }
    const double e2 = std::exp(-2.0 * x), e4 = e2 * e2;
    return (0.5 * c * (1.0 - e4) - 2.0 * x * e2) / (0.5 * c * (1.0 + e4) + (2.0 * x * x + d) * e2);
}

BondedLayer::BondedLayer(Elasticity elasticity, double thickness)
    : elasticity_(elasticity), thickness_(thickness), table_(kTable + 1) {
    elasticity_.validate(0.5);
    if (!std::isfinite(thickness) || thickness <= 0.0) {
        throw InputError("contact.layer_thickness",
                         "bonded layer: the thickness is {thickness:f} mm; give a positive one",
                         {{"thickness", thickness}});
    }
    // Inverse Hankel transform of 2 (S - 1) / (E* q).
    const double step = kLastWave / kWaves;
    std::vector<double> integrand(kWaves + 1);
    for (int i = 0; i <= kWaves; ++i) {
        const double simpson = i == 0 || i == kWaves ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        integrand[static_cast<std::size_t>(i)] =
            simpson / 3.0 * step * (shape(i * step, elasticity_.poissons_ratio) - 1.0);
    }
    table_step_ = kReach * thickness_ / kTable;
    for (int t = 0; t <= kTable; ++t) {
        double sum = 0.0;
        for (int i = 0; i <= kWaves; ++i) {
            sum += integrand[static_cast<std::size_t>(i)] *
                   std::cyl_bessel_j(0.0, i * step * t * table_step_ / thickness_);
        }
        table_[static_cast<std::size_t>(t)] =
            sum / (std::numbers::pi * elasticity_.plane_strain_modulus() * thickness_);
    }
}

double BondedLayer::correction(double r) const {
    const double at = r / table_step_;
    if (at >= kTable) return -1.0 / (std::numbers::pi * elasticity_.plane_strain_modulus() * r);
    const auto i = static_cast<std::size_t>(at);
    const double f = at - static_cast<double>(i);
    // Cubic through the four values around (even at 0).
    const double b = table_[i], c = table_[i + 1];
    const double a = i > 0 ? table_[i - 1] : table_[1];
    const double d = i + 2 < table_.size() ? table_[i + 2] : 2.0 * c - b;
    return b +
           0.5 * f * (c - a + f * (2.0 * a - 5.0 * b + 4.0 * c - d + f * (3.0 * (b - c) + d - a)));
}

double BondedLayer::influence(const ContactGrid& grid, double x, double y) const {
    const double r = std::hypot(x, y);
    if (r > kReach * thickness_) return 0.0;
    // The correction's mean over the cell; it changes over a thickness.
    const auto points = [&](double size) {
        return std::clamp(static_cast<int>(std::ceil(kPerThickness * size / thickness_)), 1, 16);
    };
    const int across = points(grid.ds), along = points(grid.dy);
    double sum = 0.0;
    for (int i = 0; i < across; ++i) {
        for (int j = 0; j < along; ++j) {
            sum += correction(std::hypot(x + ((i + 0.5) / across - 0.5) * grid.ds,
                                         y + ((j + 0.5) / along - 0.5) * grid.dy));
        }
    }
    return love(grid, x, y, elasticity_) + sum / (across * along) * grid.cell_area();
}

std::string BondedLayer::describe() const {
    std::ostringstream text;
    text << "bonded layer, " << thickness_ << " mm, E " << elasticity_.youngs_modulus << " MPa, nu "
         << elasticity_.poissons_ratio;
    return text.str();
}

}  // namespace beltgrinding
