#include "convolution.h"

#include <algorithm>

#define POCKETFFT_NO_MULTITHREADING
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define POCKETFFT_NO_VECTORS  // its aligned_alloc takes sizes that the sanitizer forbids
#endif
#include <pocketfft.hpp>

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

RowTransform::RowTransform(int rows, int used, int length)
    : rows_(rows),
      used_(used),
      length_(length),
      padded_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(length)) {}

void RowTransform::forward(const float* values, std::complex<float>* spectrum) {
    for (int j = 0; j < rows_; ++j) {
        float* row = padded_.data() + static_cast<std::ptrdiff_t>(j) * length_;
        std::copy_n(values + static_cast<std::ptrdiff_t>(j) * used_, used_, row);
        std::fill(row + used_, row + length_, 0.0F);
    }
    constexpr std::ptrdiff_t real = sizeof(float), complex = sizeof(std::complex<float>);
    const pocketfft::shape_t shape{static_cast<std::size_t>(rows_),
                                   static_cast<std::size_t>(length_)};
    pocketfft::r2c(shape, {length_ * real, real}, {complex, rows_ * complex}, 1, true,
                   padded_.data(), spectrum, 1.0F);
}

void RowTransform::backward(const std::complex<float>* spectrum, float* values) {
    constexpr std::ptrdiff_t real = sizeof(float), complex = sizeof(std::complex<float>);
    const pocketfft::shape_t shape{static_cast<std::size_t>(rows_),
                                   static_cast<std::size_t>(length_)};
    pocketfft::c2r(shape, {complex, rows_ * complex}, {length_ * real, real}, 1, false, spectrum,
                   padded_.data(), 1.0F / static_cast<float>(length_));
    for (int j = 0; j < rows_; ++j) {
        std::copy_n(padded_.data() + static_cast<std::ptrdiff_t>(j) * length_, used_,
                    values + static_cast<std::ptrdiff_t>(j) * used_);
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
