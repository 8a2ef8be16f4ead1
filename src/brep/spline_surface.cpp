#include "spline_surface.h"

#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

std::vector<double> values(const TColStd_Array1OfReal& array) {
    std::vector<double> result;
    for (int i = array.Lower(); i <= array.Upper(); ++i) result.push_back(array(i));
    return result;
}

/// Adds to `sums` (value, across, along; each `size` long) the poles of one row that a row's
/// splines weigh: `poles` has value and derivative across of each.
template <std::size_t kSize>
void sum_up(const double* poles, int degree, const SplineBasis::Values& value,
            const SplineBasis::Values& slope, double* sums) {
    std::array<double, 3 * kSize> sum{};
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i, poles += 2 * kSize) {
        for (std::size_t k = 0; k < 2 * kSize; ++k) sum[k] += value[i] * poles[k];
        for (std::size_t k = 0; k < kSize; ++k) sum[2 * kSize + k] += slope[i] * poles[k];
    }
    std::copy(sum.begin(), sum.end(), sums);
}

}  // namespace

SplineBasis::SplineBasis(std::vector<double> knots, int degree, double period)
    : knots_(std::move(knots)), degree_(degree), period_(period) {
    const std::size_t n = knots_.size();
    inverse_.assign(static_cast<std::size_t>(degree_) * n, 0.0);
    for (std::size_t order = 1; order <= static_cast<std::size_t>(degree_); ++order)
        for (std::size_t i = 0; i + order < n; ++i) {
            const double width = knots_[i + order] - knots_[i];
            if (width > 0) inverse_[(order - 1) * n + i] = 1.0 / width;
        }
}

std::size_t SplineBasis::span(double& parameter, std::size_t near) const {
    const auto degree = static_cast<std::size_t>(degree_);
    const std::size_t last = knots_.size() - degree - 1;  // the knot that ends the range
    if (period_ > 0 && (parameter < knots_[degree] || parameter > knots_[last]))
        parameter -= std::floor((parameter - knots_[degree]) / period_) * period_;
    if (near >= degree && near < last && knots_[near] <= parameter && parameter < knots_[near + 1])
        return near;
    // The first knot above; at or beyond the ends the polynomial there goes on.
    const auto begin = knots_.begin() + static_cast<std::ptrdiff_t>(degree) + 1;
    const auto end = knots_.begin() + static_cast<std::ptrdiff_t>(last);
    auto span = static_cast<std::size_t>(std::upper_bound(begin, end, parameter) - knots_.begin());
    --span;
    while (span > degree && !(knots_[span] < knots_[span + 1])) --span;
    while (span + 1 < last && !(knots_[span] < knots_[span + 1])) ++span;
    return span;
}

void SplineBasis::evaluate(std::size_t span, double parameter, Values& value, Values& slope) const {
    const std::size_t n = knots_.size();
    const auto degree = static_cast<std::size_t>(degree_);
    value[0] = 1.0;
    for (std::size_t order = 1; order <= degree; ++order) {
        const double* inverse = inverse_.data() + (order - 1) * n;
        const std::size_t first = span - order + 1;  // knot that the second spline of it begins at
        const bool top = order == degree;
        // Each spline of one order less goes into two of this one: falling in its own first half,
        // rising in its second.
        double carried = 0.0, carried_slope = 0.0;
        for (std::size_t i = 0; i < order; ++i) {
            const double share = value[i] * inverse[first + i];
            value[i] = carried + share * (knots_[first + i + order] - parameter);
            carried = share * (parameter - knots_[first + i]);
            if (top) {
                slope[i] = carried_slope - double(degree) * share;
                carried_slope = double(degree) * share;
            }
        }
        value[order] = carried;
        if (top) slope[order] = carried_slope;
    }
    if (degree == 0) slope[0] = 0.0;
}

std::shared_ptr<const SplineSurface> SplineSurface::of(const Handle(Geom_Surface) & surface) {
    if (surface.IsNull()) return nullptr;
    Handle(Geom_Surface) basis = surface;
    while (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(basis))
        basis = trimmed->BasisSurface();
    Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(basis);
    try {
        if (!Handle(Geom_BezierSurface)::DownCast(basis).IsNull())
            spline = GeomConvert::SurfaceToBSplineSurface(basis);
        if (spline.IsNull()) return nullptr;
        const double period_u = spline->IsUPeriodic() ? spline->UPeriod() : 0.0;
        const double period_v = spline->IsVPeriodic() ? spline->VPeriod() : 0.0;
        if (period_u > 0 || period_v > 0) {
            spline = Handle(Geom_BSplineSurface)::DownCast(spline->Copy());
            if (period_u > 0) spline->SetUNotPeriodic();
            if (period_v > 0) spline->SetVNotPeriodic();
        }
        if (std::max(spline->UDegree(), spline->VDegree()) > SplineBasis::kMostDegree)
            return nullptr;
        const std::shared_ptr<SplineSurface> made(new SplineSurface);
        made->u_ = SplineBasis(values(spline->UKnotSequence()), spline->UDegree(), period_u);
        made->v_ = SplineBasis(values(spline->VKnotSequence()), spline->VDegree(), period_v);
        made->rows_ = static_cast<std::size_t>(spline->NbUPoles());
        made->columns_ = static_cast<std::size_t>(spline->NbVPoles());
        const bool rational = spline->IsURational() || spline->IsVRational();
        made->size_ = rational ? 4 : 3;
        made->poles_.reserve(made->rows_ * made->columns_ * made->size_);
        for (int i = 1; i <= spline->NbUPoles(); ++i) {
            for (int j = 1; j <= spline->NbVPoles(); ++j) {
                const gp_Pnt p = spline->Pole(i, j);
                const double weight = rational ? spline->Weight(i, j) : 1.0;
                for (int k = 1; k <= 3; ++k) made->poles_.push_back(weight * p.Coord(k));
                if (rational) made->poles_.push_back(weight);
            }
        }
        return made;
    } catch (const Standard_Failure&) {
        return nullptr;  // OpenCASCADE has the word on what it does not take apart
    }
}

SplineSurface::Point SplineSurface::projected(const double* sums) const {
    const auto vector = [&](std::size_t k) { return Vec3(sums[k], sums[k + 1], sums[k + 2]); };
    if (size_ == 3) return {vector(0), vector(6), vector(3)};
    const double inverse = 1.0 / sums[3];
    Point result;
    result.point = vector(0) * inverse;
    result.v = (vector(4) - sums[7] * result.point) * inverse;
    result.u = (vector(8) - sums[11] * result.point) * inverse;
    return result;
}

SplineSurface::Row SplineSurface::row(bool along_u, double across) const {
    Row made;
    made.surface_ = this;
    made.along_u_ = along_u;
    const SplineBasis& basis = along_u ? v_ : u_;
    const std::size_t count = along_u ? rows_ : columns_;
    const std::size_t step = along_u ? size_ : columns_ * size_;  // between poles across the row
    const std::size_t next = along_u ? columns_ * size_ : size_;  // between poles along it
    SplineBasis::Values value{}, slope{};
    const std::size_t span = basis.span(across, 0);
    basis.evaluate(span, across, value, slope);
    const auto degree = static_cast<std::size_t>(basis.degree());
    made.poles_.resize(2 * size_ * count);
    for (std::size_t i = 0; i < count; ++i) {
        const double* pole = poles_.data() + i * next + (span - degree) * step;
        double* out = made.poles_.data() + 2 * size_ * i;
        for (std::size_t j = 0; j <= degree; ++j, pole += step) {
            for (std::size_t k = 0; k < size_; ++k) {
                out[k] += value[j] * pole[k];
                out[size_ + k] += slope[j] * pole[k];
            }
        }
    }
    return made;
}

SplineSurface::Point SplineSurface::Row::at(double parameter) {
    const SplineBasis& basis = along_u_ ? surface_->u_ : surface_->v_;
    SplineBasis::Values value, slope;  // as far as the degree goes, evaluate fills them
    near_ = basis.span(parameter, near_);
    basis.evaluate(near_, parameter, value, slope);
    const int degree = basis.degree();
    const std::size_t size = surface_->size_;
    const double* poles = poles_.data() + 2 * size * (near_ - static_cast<std::size_t>(degree));
    std::array<double, 12> sums;
    if (size == 3)
        sum_up<3>(poles, degree, value, slope, sums.data());
    else
        sum_up<4>(poles, degree, value, slope, sums.data());
    Point result = surface_->projected(sums.data());
    if (!along_u_) std::swap(result.u, result.v);
    return result;
}

SplineSurface::Point SplineSurface::at(double u, double v) const {
    SplineBasis::Values value_u, slope_u, value_v, slope_v;
    const std::size_t span_u = u_.span(u, 0), span_v = v_.span(v, 0);
    u_.evaluate(span_u, u, value_u, slope_u);
    v_.evaluate(span_v, v, value_v, slope_v);
    const auto degree_u = static_cast<std::size_t>(u_.degree());
    const auto degree_v = static_cast<std::size_t>(v_.degree());
    std::array<double, 12> sums{};
    for (std::size_t i = 0; i <= degree_u; ++i) {
        const double* pole =
            poles_.data() + ((span_u - degree_u + i) * columns_ + span_v - degree_v) * size_;
        std::array<double, 8> row{};  // as a Row's pole
        for (std::size_t j = 0; j <= degree_v; ++j, pole += size_) {
            for (std::size_t k = 0; k < size_; ++k) {
                row[k] += value_v[j] * pole[k];
                row[size_ + k] += slope_v[j] * pole[k];
            }
        }
        for (std::size_t k = 0; k < 2 * size_; ++k) sums[k] += value_u[i] * row[k];
        for (std::size_t k = 0; k < size_; ++k) sums[2 * size_ + k] += slope_u[i] * row[k];
    }
    return projected(sums.data());
}

}  // namespace beltgrinding
