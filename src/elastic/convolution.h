#pragma once

#include <complex>
#include <memory>
#include <vector>

namespace beltgrinding {

/// Smallest length >= n whose only prime factors are 2, 3 and 5, and which is even: quick to
/// transform.
int quick_fft_length(int n);

/// Real Fourier transforms of `rows` rows of `length` numbers, single precision, zero-padded from
/// `used` numbers a row (pocketfft, Reinecke). The spectrum is laid out wavenumber by wavenumber:
/// index k * rows + row, k from 0 to length / 2.
class RowTransform {
  public:
    RowTransform() = default;
    RowTransform(int rows, int used, int length);

    int length() const { return length_; }
    int wavenumbers() const { return length_ / 2 + 1; }
    /// `values`: rows x used, row by row.
    void forward(const float* values, std::complex<float>* spectrum);
    /// The first `used` numbers of every row, scaled so that it undoes `forward`.
    void backward(const std::complex<float>* spectrum, float* values);

  private:
    struct Plan;
    /// Aligned, eight numbers at each of `length_` places.
    float* eight_rows();

    int rows_ = 0, used_ = 0, length_ = 0;
    std::shared_ptr<const Plan> plan_;
    std::vector<float> padded_;
};

/// In-place complex transform of `count` groups along the rows of a spectrum as `RowTransform` lays
/// it out: turns index (k, row) into (k, wavenumber of the row direction). Unscaled.
void transform_rows(std::complex<float>* spectrum, int wavenumbers, int rows, bool forward);

}  // namespace beltgrinding
