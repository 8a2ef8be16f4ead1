#include "face_surface.h"

#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr std::size_t kFewestCells = 24;  // of the table, each way
constexpr std::size_t kMostCells = 512;   // each way; 0.1 s of evaluation at worst
constexpr double kCellsPerSample = 0.5;   // a finer table than the samples themselves is waste
constexpr double kPoleFloor = 1e-6;       // of the longest row: keeps rows at poles monotone
constexpr double kSingularStep = 1e-6;    // of the parameter range, to step off a singular point
constexpr double kPreferEven = 0.9;       // v rows must be this much evener to be taken
constexpr double kSmallestVariance = 1e-6;

Vec3 vec(const gp_XYZ& v) {
    return {v.X(), v.Y(), v.Z()};
}

/// Splits the spans between `knots` evenly to about `cells` cells, none across a knot.
std::vector<double> refine(const std::vector<double>& knots, std::size_t cells) {
    std::vector<double> result;
    if (knots.size() > kMostCells) {
        for (std::size_t i = 0; i <= kMostCells; ++i)
            result.push_back(knots.front() +
                             (knots.back() - knots.front()) * double(i) / double(kMostCells));
        return result;
    }
    const double width = knots.back() - knots.front();
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        const double share = (knots[k + 1] - knots[k]) / width;
        const auto parts = std::max<std::size_t>(1, std::llround(share * double(cells)));
        for (std::size_t i = 0; i < parts; ++i)
            result.push_back(knots[k] + (knots[k + 1] - knots[k]) * double(i) / double(parts));
    }
    result.push_back(knots.back());
    return result;
}

/// Index i and share w with value = (1 - w) grid[i] + w grid[i + 1]; clamped.
std::pair<std::size_t, double> bracket(const double* grid, std::size_t n, double value) {
    const double* upper = std::upper_bound(grid + 1, grid + n - 1, value);
    const auto i = static_cast<std::size_t>(upper - grid) - 1;
    const double width = grid[i + 1] - grid[i];
    const double w = width > 0 ? (value - grid[i]) / width : 0.0;
    return {i, std::clamp(w, 0.0, 1.0)};
}

/// Relative variance of `gap` within rows, weighted by area.
double unevenness(const std::vector<double>& length, const std::vector<double>& jacobian,
                  std::size_t rows, std::size_t columns, std::size_t row_step,
                  std::size_t column_step) {
    double sum = 0, weight = 0;
    for (std::size_t j = 0; j < rows; ++j) {
        double l = 0, a = 0, g2 = 0;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::size_t k = j * row_step + i * column_step;
            if (length[k] <= 0) continue;
            const double gap = jacobian[k] / length[k];
            l += length[k];
            a += jacobian[k];
            g2 += gap * gap * length[k];
        }
        if (l <= 0 || a <= 0) continue;
        const double mean = a / l;
        sum += a * std::max(0.0, g2 / l - mean * mean) / (mean * mean);
        weight += a;
    }
    return weight > 0 ? sum / weight : 0.0;
}

}  // namespace

SurfacePoint FaceSurface::at(const GeomAdaptor_Surface& evaluator, double s, double t) const {
    gp_Pnt p;
    gp_Vec u, v;
    SurfacePoint result;
    try {
        if (swap)
            evaluator.D1(t, s, p, u, v);
        else
            evaluator.D1(s, t, p, u, v);
    } catch (const Standard_Failure&) {
        // An offset surface has no derivative where its basis has no normal: step towards the
        // middle of the face.
        const double ds = (0.5 * (s0 + s1) - s) * kSingularStep;
        const double dt = (0.5 * (t0 + t1) - t) * kSingularStep;
        result.singular = true;
        if (swap)
            evaluator.D1(t + dt, s + ds, p, u, v);
        else
            evaluator.D1(s + ds, t + dt, p, u, v);
    }
    result.point = vec(p.XYZ());
    result.ds = vec(u.XYZ());
    result.dt = vec(v.XYZ());
    if (swap) std::swap(result.ds, result.dt);
    return result;
}

std::vector<double> FaceSurface::knots(bool along_s) const {
    const double low = along_s ? s0 : t0, high = along_s ? s1 : t1;
    std::vector<double> result{low};
    try {
        const GeomAdaptor_Surface adaptor(surface);
        const bool along_u = along_s != swap;
        const int count =
            along_u ? adaptor.NbUIntervals(GeomAbs_C2) : adaptor.NbVIntervals(GeomAbs_C2);
        TColStd_Array1OfReal at_knots(1, count + 1);
        if (along_u)
            adaptor.UIntervals(at_knots, GeomAbs_C2);
        else
            adaptor.VIntervals(at_knots, GeomAbs_C2);
        const double margin = 1e-9 * (high - low);
        for (int i = 1; i <= count + 1; ++i)
            if (at_knots(i) > low + margin && at_knots(i) < high - margin &&
                at_knots(i) > result.back() + margin)
                result.push_back(at_knots(i));
    } catch (const Standard_Failure&) {
        // No knots known: an even table will do.
    }
    result.push_back(high);
    return result;
}

SurfaceMetric::SurfaceMetric(FaceSurface& surface, double spacing) {
    const GeomAdaptor_Surface evaluator = surface.evaluator();
    // A first look at the size says how fine the table should be.
    double length_s = 0, length_t = 0;
    constexpr int kLook = 8;
    for (int i = 0; i <= kLook; ++i) {
        for (int j = 0; j <= kLook; ++j) {
            const SurfacePoint p =
                surface.at(evaluator, surface.s0 + (surface.s1 - surface.s0) * i / kLook,
                           surface.t0 + (surface.t1 - surface.t0) * j / kLook);
            length_s = std::max(length_s, p.ds.norm() * (surface.s1 - surface.s0));
            length_t = std::max(length_t, p.dt.norm() * (surface.t1 - surface.t0));
        }
    }
    const auto cells = [&](double length) {
        const double wanted = kCellsPerSample * length / spacing;
        return static_cast<std::size_t>(
            std::clamp(std::isfinite(wanted) ? wanted : 0.0, double(kFewestCells), 200.0));
    };
    s_ = refine(surface.knots(true), cells(length_s));
    t_ = refine(surface.knots(false), cells(length_t));
    const std::size_t ns = s_.size(), nt = t_.size();
    std::vector<double> length(ns * nt), across(ns * nt), jacobian(ns * nt);
    for (std::size_t j = 0; j < nt; ++j) {
        for (std::size_t i = 0; i < ns; ++i) {
            const SurfacePoint p = surface.at(evaluator, s_[i], t_[j]);
            length[j * ns + i] = p.ds.norm();
            across[j * ns + i] = p.dt.norm();
            jacobian[j * ns + i] = p.ds.cross(p.dt).norm();
        }
    }
    const double uneven_s = unevenness(length, jacobian, nt, ns, ns, 1);
    const double uneven_t = unevenness(across, jacobian, ns, nt, 1, ns);
    if (uneven_t + kSmallestVariance < kPreferEven * uneven_s) {
        surface.swap_parameters();
        std::vector<double> turned(ns * nt), turned_across(ns * nt), turned_jacobian(ns * nt);
        for (std::size_t j = 0; j < nt; ++j) {
            for (std::size_t i = 0; i < ns; ++i) {
                turned[i * nt + j] = across[j * ns + i];
                turned_across[i * nt + j] = length[j * ns + i];
                turned_jacobian[i * nt + j] = jacobian[j * ns + i];
            }
        }
        length.swap(turned);
        across.swap(turned_across);
        jacobian.swap(turned_jacobian);
        s_.swap(t_);
    }

    const std::size_t columns = s_.size(), rows = t_.size();
    cumulative_.resize(columns * rows);
    std::vector<double> gap(rows);
    double area = 0;
    for (std::size_t j = 0; j < rows; ++j) {
        double sum = 0, row_area = 0, row_across = 0;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::size_t k = j * columns + i;
            if (i > 0) {
                const double step = s_[i] - s_[i - 1];
                sum += 0.5 * (length[k] + length[k - 1]) * step;
                row_area += 0.5 * (jacobian[k] + jacobian[k - 1]) * step;
                row_across += 0.5 * (across[k] + across[k - 1]) * step;
            }
            cumulative_[k] = sum;
        }
        const double range = s_.back() - s_.front();
        gap[j] = sum > 0 ? row_area / sum : row_across / range;
        if (gap[j] <= 0) gap[j] = row_across / range;
        max_length_ = std::max(max_length_, sum);
        if (!std::isfinite(sum + row_area)) max_length_ = sum + row_area;
        const double weight =
            (j > 0 ? t_[j] - t_[j - 1] : 0.0) + (j + 1 < rows ? t_[j + 1] - t_[j] : 0.0);
        area += 0.5 * weight * row_area;
        mean_length_ += 0.5 * weight * sum / (t_.back() - t_.front());
    }
    mean_jacobian_ = area / ((t_.back() - t_.front()) * (s_.back() - s_.front()));
    const double floor = kPoleFloor * std::max(max_length_, 1e-300);
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i)
            cumulative_[j * columns + i] += floor * (s_[i] - s_.front()) / (s_.back() - s_.front());
    const double least = 1e-9 * *std::max_element(gap.begin(), gap.end());
    y_.assign(rows, 0.0);
    for (std::size_t j = 1; j < rows; ++j)
        y_[j] = y_[j - 1] + (0.5 * (gap[j] + gap[j - 1]) + least) * (t_[j] - t_[j - 1]);
}

double SurfaceMetric::y_of(double t) const {
    const auto [i, w] = bracket(t_.data(), t_.size(), t);
    return (1 - w) * y_[i] + w * y_[i + 1];
}

double SurfaceMetric::t_of(double y) const {
    const auto [i, w] = bracket(y_.data(), y_.size(), y);
    return (1 - w) * t_[i] + w * t_[i + 1];
}

SurfaceMetric::Row SurfaceMetric::row(double t) const {
    const auto [j, w] = bracket(t_.data(), t_.size(), t);
    const double *a = &cumulative_[j * s_.size()], *b = a + s_.size();
    Row result;
    result.length.resize(s_.size());
    for (std::size_t i = 0; i < s_.size(); ++i) result.length[i] = (1 - w) * a[i] + w * b[i];
    return result;
}

double SurfaceMetric::x_of(const Row& row, double s) const {
    const auto [i, w] = bracket(s_.data(), s_.size(), s);
    return ((1 - w) * row.length[i] + w * row.length[i + 1]) / row.total();
}

double SurfaceMetric::s_of(const Row& row, double x) const {
    const auto [i, w] = bracket(row.length.data(), row.length.size(), x * row.total());
    return (1 - w) * s_[i] + w * s_[i + 1];
}

double SurfaceMetric::x_of(double s, double t) const {
    const auto [j, v] = bracket(t_.data(), t_.size(), t);
    const auto [i, w] = bracket(s_.data(), s_.size(), s);
    const double *a = &cumulative_[j * s_.size()], *b = a + s_.size();
    const double along =
        (1 - v) * ((1 - w) * a[i] + w * a[i + 1]) + v * ((1 - w) * b[i] + w * b[i + 1]);
    const double total = (1 - v) * a[s_.size() - 1] + v * b[s_.size() - 1];
    return along / total;
}

}  // namespace beltgrinding
