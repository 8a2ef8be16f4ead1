#include "convolution.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include "base/lanes.h"

#define POCKETFFT_NO_MULTITHREADING
// The size must be a multiple of the alignment, as the sanitizers see to; pocketfft's is not.
#define aligned_alloc(alignment, size) \
    aligned_alloc(alignment, ((size) + (alignment)-1) / (alignment) * (alignment))
#include <pocketfft.hpp>
#undef aligned_alloc

// For what is made for several processors to be made so down to the library's last function.
#if defined(__GNUC__) && !defined(__clang__)
#define BELTGRINDING_FLAT __attribute__((flatten))
#else
#define BELTGRINDING_FLAT
#endif

namespace beltgrinding {

int quick_fft_length(int n) {
    for (int length = std::max(n + n % 2, 2);; length += 2) {
        int rest = length;
        for (const int factor : {2, 3, 5}) {
            while (rest % factor == 0) rest /= factor;
        }
        if (rest == 1) return length;
    }
}

namespace {

using namespace lanes;

// pocketfft's own interface takes four rows at a time, whatever the processor has, and most of its
// time for small grids is for memory, plans and strides.

/// Row by row to column by column.
BELTGRINDING_INLINE void turn(Floats* r) {
    for (int k = 0; k < kWide; k += 2) {
        const Floats a = r[k], b = r[k + 1];
        r[k] = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
        r[k + 1] = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (const int k : {0, 1, 4, 5}) {
        const Floats a = r[k], b = r[k + 2];
        r[k] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
        r[k + 2] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (int k = 0; k < kWide / 2; ++k) {
        const Floats a = r[k], b = r[k + 4];
        r[k] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
        r[k + 4] = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

using RealPlan = pocketfft::detail::rfftp<float>;

/// Up to eight rows of `used` numbers, padded to `length`, to their spectra (wavenumbers `apart`
/// numbers from one another). `work`: `length` eights.
BELTGRINDING_CLONES BELTGRINDING_FLAT void forward_eight(const RealPlan& plan, const float* values,
                                                         int rows, int used, int length,
                                                         Floats* work, std::complex<float>* to,
                                                         std::ptrdiff_t apart) {
    int i = 0;
    for (; rows == kWide && i + kWide <= used; i += kWide) {
        for (int j = 0; j < kWide; ++j) work[i + j] = load(values + j * used + i);
        turn(work + i);
    }
    for (; i < used; ++i) {
        work[i] = Floats{};
        for (int j = 0; j < rows; ++j) work[i][j] = values[j * used + i];
    }
    for (; i < length; ++i) work[i] = Floats{};
    plan.exec(work, 1.0F, true);
    // r0 r1 i1 r2 i2 ... r(n/2)
    for (int k = 0; 2 * k <= length; ++k, to += apart) {
        const Floats re = work[k == 0 ? 0 : 2 * k - 1];
        const Floats im = k == 0 || 2 * k == length ? Floats{} : work[2 * k];
        if (rows == kWide) {
            auto* numbers = reinterpret_cast<float*>(to);
            store(numbers, __builtin_shufflevector(re, im, 0, 8, 1, 9, 2, 10, 3, 11));
            store(numbers + kWide, __builtin_shufflevector(re, im, 4, 12, 5, 13, 6, 14, 7, 15));
        } else {
            for (int j = 0; j < rows; ++j) to[j] = {re[j], im[j]};
        }
    }
}

/// The way back, times `factor`; only the first `used` numbers of each row.
BELTGRINDING_CLONES BELTGRINDING_FLAT void backward_eight(const RealPlan& plan,
                                                          const std::complex<float>* from,
                                                          std::ptrdiff_t apart, int rows, int used,
                                                          int length, float factor, Floats* work,
                                                          float* values) {
    for (int k = 0; 2 * k <= length; ++k, from += apart) {
        Floats re{}, im{};
        if (rows == kWide) {
            const auto* numbers = reinterpret_cast<const float*>(from);
            const Floats a = load(numbers), b = load(numbers + kWide);
            re = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
            im = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
        } else {
            for (int j = 0; j < rows; ++j) {
                re[j] = from[j].real();
                im[j] = from[j].imag();
            }
        }
        work[k == 0 ? 0 : 2 * k - 1] = re;
        if (k != 0 && 2 * k != length) work[2 * k] = im;
    }
    plan.exec(work, factor, false);
    int i = 0;
    for (; rows == kWide && i + kWide <= used; i += kWide) {
        turn(work + i);
        for (int j = 0; j < kWide; ++j) store(values + j * used + i, work[i + j]);
    }
    for (; i < used; ++i)
        for (int j = 0; j < rows; ++j) values[j * used + i] = work[i][j];
}

}  // namespace

struct RowTransform::Plan {
    explicit Plan(int length) : real(static_cast<std::size_t>(length)) {}
    RealPlan real;  // of lengths without other factors than 2, 3 and 5
};

RowTransform::RowTransform(int rows, int used, int length)
    : rows_(rows),
      used_(used),
      length_(length),
      plan_(std::make_shared<Plan>(length)),
      padded_(static_cast<std::size_t>(length) * kWide + kWide) {}

float* RowTransform::eight_rows() {
    void* at = padded_.data();
    std::size_t room = padded_.size() * sizeof(float);
    return static_cast<float*>(std::align(sizeof(Floats), sizeof(Floats), at, room));
}

void RowTransform::forward(const float* values, std::complex<float>* spectrum) {
    auto* work = reinterpret_cast<Floats*>(eight_rows());
    for (int first = 0; first < rows_; first += kWide) {
        forward_eight(plan_->real, values + static_cast<std::ptrdiff_t>(first) * used_,
                      std::min(kWide, rows_ - first), used_, length_, work, spectrum + first,
                      rows_);
    }
}

void RowTransform::backward(const std::complex<float>* spectrum, float* values) {
    auto* work = reinterpret_cast<Floats*>(eight_rows());
    const float factor = 1.0F / static_cast<float>(length_);
    for (int first = 0; first < rows_; first += kWide) {
        backward_eight(plan_->real, spectrum + first, rows_, std::min(kWide, rows_ - first), used_,
                       length_, factor, work, values + static_cast<std::ptrdiff_t>(first) * used_);
    }
}

void transform_rows(std::complex<float>* spectrum, int wavenumbers, int rows, bool forward) {
    constexpr std::ptrdiff_t complex = sizeof(std::complex<float>);
    const pocketfft::shape_t shape{static_cast<std::size_t>(wavenumbers),
                                   static_cast<std::size_t>(rows)};
    const pocketfft::stride_t stride{rows * complex, complex};
    pocketfft::c2c(shape, stride, stride, {1}, forward, spectrum, spectrum, 1.0F);
}

}  // namespace beltgrinding
