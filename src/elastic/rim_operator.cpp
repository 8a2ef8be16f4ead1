#include "rim_operator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "contact/fit.h"

namespace beltgrinding {
namespace {

/// Eight numbers side by side, on machines without such registers, too.
using Eight = float __attribute__((vector_size(32)));
constexpr int kEight = 8;
constexpr int kMostEights = 5;  // whose sums stay in registers

/// `count` times eight numbers of y = A x, the last of them up to the end of y, the others from
/// `first` on. Each is summed in the order of x.
template <int count>
[[gnu::always_inline]] inline void multiply_eights(const float* matrix, int n, int first,
                                                   const float* x, float* y) {
    Eight re[count] = {}, im[count] = {};
    const auto at = [&](int b) { return std::min(first + b * kEight, n - kEight); };
    for (int j = 0; j < n; ++j) {
        const float* column = matrix + static_cast<std::ptrdiff_t>(j) * n;
        for (int b = 0; b < count; ++b) {
            Eight values;
            std::memcpy(&values, column + at(b), sizeof(values));
            re[b] += values * x[2 * j];
            im[b] += values * x[2 * j + 1];
        }
    }
    for (int b = 0; b < count; ++b) {
        for (int i = 0; i < kEight; ++i) {
            y[2 * (at(b) + i)] = re[b][i];
            y[2 * (at(b) + i) + 1] = im[b][i];
        }
    }
}

/// y = A x for complex x and y laid out as pairs: A is n x n, symmetric. The same to the last bit
/// with and without AVX2, which multiplies and adds one after the other.
// GCC's spelling of clones, which Clang does not read; and the sanitizers are not yet there when
// the loader chooses between them.
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
__attribute__((target_clones("avx2", "default")))
#endif
void multiply(const float* matrix, int n, const float* x, float* y) {
    if (n < kEight) {
        for (int i = 0; i < n; ++i) {
            float re = 0.0F, im = 0.0F;
            for (int j = 0; j < n; ++j) {
                re += matrix[i * n + j] * x[2 * j];
                im += matrix[i * n + j] * x[2 * j + 1];
            }
            y[2 * i] = re;
            y[2 * i + 1] = im;
        }
        return;
    }
    for (int first = 0; first < n; first += kMostEights * kEight) {
        switch (std::min((n - first + kEight - 1) / kEight, kMostEights)) {
            case 1:
                multiply_eights<1>(matrix, n, first, x, y);
                break;
            case 2:
                multiply_eights<2>(matrix, n, first, x, y);
                break;
            case 3:
                multiply_eights<3>(matrix, n, first, x, y);
                break;
            case 4:
                multiply_eights<4>(matrix, n, first, x, y);
                break;
            default:
                multiply_eights<kMostEights>(matrix, n, first, x, y);
        }
    }
}

}  // namespace

void RimOperator::do_work_on_columns() {
    const int nx = working().nx, rows = grid().ny + 2;
    auto at = plans_.find(nx);
    if (at == plans_.end()) {
        Plan plan;
        const int length = quick_fft_length(2 * nx - 1);
        plan.spectrum = spectra_(length);
        plan.transform = RowTransform(rows, nx, length);
        plan.values.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(rows));
        plan.waves.resize(static_cast<std::size_t>(plan.transform.wavenumbers()) *
                          static_cast<std::size_t>(rows));
        plan.image.resize(plan.waves.size());
        at = plans_.emplace(nx, std::move(plan)).first;
    }
    plan_ = &at->second;
}

void RimOperator::set_surface(const ContactProblem& problem) {
    sloped_ = false;
    if (!bulges_) return;
    const Eigen::ArrayXd slopes = axial_slopes(working(), problem);
    sloped_ = (slopes != 0.0).any();
    if (!sloped_) return;
    const int nx = working().nx;
    for (std::size_t m = 0; m < 2; ++m) {
        fit(slopes_[m], slopes.size());
        for (int j = 0; j < grid().ny; ++j) {
            slopes_[m].segment(j * nx, nx) =
                cells_[m][static_cast<std::size_t>(j)] * slopes.segment(j * nx, nx);
        }
    }
}

void RimOperator::forward(const Eigen::ArrayXd& pressure) {
    const int nx = working().nx;
    const auto root = std::sqrt(0.5);
    Rows rows = parts();
    const auto row = [&](const Eigen::ArrayXd& a, int j) { return a.segment(j * nx, nx); };
    Eigen::ArrayXd outwards = Eigen::ArrayXd::Zero(nx), along = outwards;
    for_pairs([&](int up, int down, int e, int o) {
        const Eigen::ArrayXd p = row(pressure, up);
        if (up == down) {
            rows.col(e) = p.cast<float>();
            if (sloped_) along += row(slopes_[1], up) * p;
            return;
        }
        const Eigen::ArrayXd q = row(pressure, down);
        rows.col(e) = (root * (p + q)).cast<float>();
        rows.col(o) = (root * (p - q)).cast<float>();
        if (!sloped_) return;
        outwards += row(slopes_[0], up) * p + row(slopes_[0], down) * q;
        along += row(slopes_[1], up) * p + row(slopes_[1], down) * q;
    });
    rows.col(even()) = outwards.cast<float>();
    rows.col(grid().ny + 1) = along.cast<float>();
    plan_->transform.forward(plan_->values.data(), plan_->waves.data());
}

void RimOperator::do_apply(const Eigen::ArrayXd& pressure, Eigen::ArrayXd& displacement) {
    const int nx = working().nx, ne = even() + 1, no = odd() + 1, n = ne + no;
    const auto root = std::sqrt(0.5);
    forward(pressure);
    const float* matrix = plan_->spectrum->matrices.data();
    for (int k = 0; k < plan_->transform.wavenumbers(); ++k) {
        const auto* x = reinterpret_cast<const float*>(plan_->waves.data() + k * n);
        auto* y = reinterpret_cast<float*>(plan_->image.data() + k * n);
        multiply(matrix, ne, x, y);
        multiply(matrix + ne * ne, no, x + 2 * ne, y + 2 * ne);
        matrix += ne * ne + no * no;
    }
    plan_->transform.backward(plan_->image.data(), plan_->values.data());
    const Rows rows = parts();
    const Eigen::ArrayXd outwards = rows.col(ne - 1).cast<double>();
    const Eigen::ArrayXd along = rows.col(n - 1).cast<double>();
    if (nx == grid().nx) {
        applied_ = pressure;
        moved_ = {outwards, along};
    }
    const auto row = [&](Eigen::ArrayXd& a, int j) { return a.segment(j * nx, nx); };
    const auto add_slope = [&](int j) {
        if (sloped_)
            row(displacement, j) += row(slopes_[0], j) * outwards + row(slopes_[1], j) * along;
    };
    for_pairs([&](int up, int down, int e, int o) {
        const Eigen::ArrayXd sum = rows.col(e).cast<double>();
        if (up == down) {
            row(displacement, up) = sum;
        } else {
            const Eigen::ArrayXd difference = rows.col(o).cast<double>();
            row(displacement, up) = root * (sum + difference);
            row(displacement, down) = root * (sum - difference);
            add_slope(down);
        }
        add_slope(up);
    });
}

Eigen::ArrayXXd RimOperator::side_displacement(const Eigen::ArrayXd& pressure) {
    const int nx = working().nx, ny = grid().ny, ne = even() + 1, no = odd() + 1, n = ne + no;
    if (!bulges_) return {};
    Eigen::ArrayXXd result(nx, ny + 1);
    const auto at_borders = [&](const Eigen::ArrayXd& outwards, const Eigen::ArrayXd& along) {
        for (int j = 0; j <= ny; ++j) {
            const auto border = static_cast<std::size_t>(j);
            result.col(j) = borders_[0][border] * outwards + borders_[1][border] * along;
        }
        return result;
    };
    if (applied_.size() == pressure.size() && (applied_ == pressure).all())
        return at_borders(moved_[0], moved_[1]);
    forward(pressure);
    const float* matrix = plan_->spectrum->matrices.data();
    std::fill(plan_->image.begin(), plan_->image.end(), std::complex<float>());
    for (int k = 0; k < plan_->transform.wavenumbers(); ++k) {
        const std::complex<float>* x = plan_->waves.data() + k * n;
        std::complex<float>* to = plan_->image.data() + k * n;
        for (int j = 0; j < ne; ++j) to[ne - 1] += matrix[(ne - 1) * ne + j] * x[j];
        matrix += ne * ne;
        for (int j = 0; j < no; ++j) to[n - 1] += matrix[(no - 1) * no + j] * x[ne + j];
        matrix += no * no;
    }
    plan_->transform.backward(plan_->image.data(), plan_->values.data());
    const Rows rows = parts();
    return at_borders(rows.col(ne - 1).cast<double>(), rows.col(n - 1).cast<double>());
}

}  // namespace beltgrinding
