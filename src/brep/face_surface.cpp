#include "face_surface.h"

#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kFewestCells = 24;  // of the table, each way
constexpr std::size_t kMostCells = 512;   // each way; 0.1 s of evaluation at worst
constexpr double kCellsPerSample = 0.5;   // a finer table than the samples themselves is waste
constexpr double kPoleFloor = 1e-6;       // of the longest row: keeps rows at poles monotone
constexpr double kPoleLength = 1e-9;      // of the longest row: a pole's, whose length is rounding
constexpr double kSingularStep = 1e-6;    // of the parameter range, to step off a singular point
constexpr double kPreferEven = 0.9;       // v rows must be this much evener to be taken
constexpr double kSmallestVariance = 1e-6;
constexpr double kTableTurn = 0.2;  // rad, of the normal within a cell of the table
constexpr std::size_t kLines = 16;  // on which the surface's turning is looked at, each way
constexpr int kHalvings = 10;
constexpr double kGrading = 0.25;  // mm of spacing per mm of way

constexpr std::size_t kTableRows = 8;  // of the table, a task

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

SurfacePoint turned(const SplineSurface::Point& p, bool swap) {
    return {p.point, swap ? p.v : p.u, swap ? p.u : p.v, false};
}

}  // namespace

SurfacePoint FaceSurface::at(const GeomAdaptor_Surface& evaluator, double s, double t) const {
    if (spline) return turned(spline->at(swap ? t : s, swap ? s : t), swap);
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

SurfaceRow FaceSurface::row(const GeomAdaptor_Surface& evaluator, double t) const {
    return {*this, evaluator, t};
}

SurfaceRow::SurfaceRow(const FaceSurface& surface, const GeomAdaptor_Surface& evaluator, double t)
    : surface_(&surface), evaluator_(&evaluator), t_(t) {
    if (surface.spline) row_ = surface.spline->row(!surface.swap, t);
}

SurfacePoint SurfaceRow::at(double s) {
    if (row_) return turned(row_->at(s), surface_->swap);
    return surface_->at(*evaluator_, s, t_);
}

std::array<double, 2> FaceSurface::bend(const GeomAdaptor_Surface& evaluator, double s,
                                        double t) const {
    gp_Pnt p;
    gp_Vec u, v, uu, vv, uv;
    try {
        evaluator.D2(swap ? t : s, swap ? s : t, p, u, v, uu, vv, uv);
    } catch (const Standard_Failure&) {
        return {0.0, 0.0};
    }
    const gp_Vec normal = u.Crossed(v);
    const double size = normal.Magnitude();
    const auto along = [&](const gp_Vec& first, const gp_Vec& second) {
        const double bend = std::abs(normal.Dot(second)) / (size * first.SquareMagnitude());
        return std::isfinite(bend) ? bend : 0.0;
    };
    const double by_u = along(u, uu), by_v = along(v, vv);
    if (swap) return {by_v, by_u};
    return {by_u, by_v};
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

/// First derivatives at the nodes of a table, [t][s].
struct SurfaceMetric::Table {
    std::vector<double> length, across, jacobian;

    Table(const FaceSurface& surface, const std::vector<double>& s, const std::vector<double>& t)
        : length(s.size() * t.size()), across(length.size()), jacobian(length.size()) {
        parallel_blocks(t.size(), kTableRows, {}, [&](std::size_t begin, std::size_t end) {
            const GeomAdaptor_Surface evaluator = surface.evaluator();
            for (std::size_t j = begin; j < end; ++j) {
                SurfaceRow row = surface.row(evaluator, t[j]);
                for (std::size_t i = 0; i < s.size(); ++i) {
                    const SurfacePoint p = row.at(s[i]);
                    const std::size_t k = j * s.size() + i;
                    length[k] = p.ds.norm();
                    across[k] = p.dt.norm();
                    jacobian[k] = p.ds.cross(p.dt).norm();
                }
            }
        });
    }

    /// As if s and t were swapped; `ns` columns.
    void turn(std::size_t ns) {
        const std::size_t nt = length.size() / ns;
        const auto turned = [&](const std::vector<double>& values) {
            std::vector<double> result(values.size());
            for (std::size_t j = 0; j < nt; ++j)
                for (std::size_t i = 0; i < ns; ++i) result[i * nt + j] = values[j * ns + i];
            return result;
        };
        std::vector<double> along = turned(across);
        across = turned(length);
        length = std::move(along);
        jacobian = turned(jacobian);
    }
};

SurfaceMetric::SurfaceMetric(FaceSurface& surface, const SampleDensity& density) {
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
        const double wanted = kCellsPerSample * length / density.spacing;
        return static_cast<std::size_t>(
            std::clamp(std::isfinite(wanted) ? wanted : 0.0, double(kFewestCells), 200.0));
    };
    s_ = refine(surface.knots(true), cells(length_s));
    t_ = refine(surface.knots(false), cells(length_t));
    const std::size_t ns = s_.size(), nt = t_.size();
    Table table(surface, s_, t_);
    const double uneven_s = unevenness(table.length, table.jacobian, nt, ns, ns, 1);
    const double uneven_t = unevenness(table.across, table.jacobian, ns, nt, 1, ns);
    if (uneven_t + kSmallestVariance < kPreferEven * uneven_s) {
        surface.swap_parameters();
        table.turn(ns);
        s_.swap(t_);
    }
    if (density.active()) {
        refine_where_bent(surface, evaluator);
        table = Table(surface, s_, t_);
        stretch(surface, evaluator, density, table);
    }
    fill(table);
}

/// Halves the cells of the table in which the surface turns by more than kTableTurn, as far as
/// kLines lines each way show.
void SurfaceMetric::refine_where_bent(const FaceSurface& surface,
                                      const GeomAdaptor_Surface& evaluator) {
    const auto halve = [&](std::vector<double>& grid, const std::vector<double>& others,
                           bool along_s) {
        for (int round = 0; round < kHalvings && grid.size() < kMostCells; ++round) {
            std::vector<char> bent(grid.size(), 0);
            for (std::size_t line = 0; line <= kLines; ++line) {
                const double other = others[line * (others.size() - 1) / kLines];
                Vec3 before = Vec3::Zero();
                for (std::size_t i = 0; i < grid.size(); ++i) {
                    const SurfacePoint p = along_s ? surface.at(evaluator, grid[i], other)
                                                   : surface.at(evaluator, other, grid[i]);
                    const Vec3 normal = p.ds.cross(p.dt).normalized();
                    if (i > 0 && normal.dot(before) < std::cos(kTableTurn)) bent[i] = 1;
                    before = normal;
                }
            }
            std::vector<double> finer;
            for (std::size_t i = 0; i < grid.size(); ++i) {
                if (bent[i] && finer.size() < kMostCells)
                    finer.push_back(0.5 * (grid[i - 1] + grid[i]));
                finer.push_back(grid[i]);
            }
            if (finer.size() == grid.size()) break;
            grid = std::move(finer);
        }
    };
    halve(s_, t_, true);
    halve(t_, s_, false);
}

/// Finds by how much lengths are stretched, so that the spacing follows the curvature and changes
/// by kGrading a unit of length at most.
void SurfaceMetric::stretch(const FaceSurface& surface, const GeomAdaptor_Surface& evaluator,
                            const SampleDensity& density, const Table& table) {
    const std::size_t ns = s_.size(), nt = t_.size();
    std::vector<double> along(ns * nt), across(ns * nt);
    for (std::size_t j = 0; j < nt; ++j) {
        for (std::size_t i = 0; i < ns; ++i) {
            const auto [bend_s, bend_t] = surface.bend(evaluator, s_[i], t_[j]);
            along[j * ns + i] = density.at(bend_s);
            across[j * ns + i] = density.at(bend_t);
        }
    }
    const auto grade = [](std::vector<double>& wanted, std::size_t count, std::size_t first,
                          std::size_t step, const std::vector<double>& at,
                          const std::vector<double>& speed) {
        const auto limit = [&](std::size_t i, std::size_t neighbour, std::size_t cell) {
            const std::size_t k = first + i * step, n = first + neighbour * step;
            const double apart = 0.5 * (speed[k] + speed[n]) * (at[cell] - at[cell - 1]);
            wanted[k] = std::min(wanted[k], wanted[n] + kGrading * apart);
        };
        for (std::size_t i = 1; i < count; ++i) limit(i, i - 1, i);
        for (std::size_t i = count - 1; i-- > 0;) limit(i, i + 1, i + 1);
    };
    for (std::size_t j = 0; j < nt; ++j) grade(along, ns, j * ns, 1, s_, table.length);
    for (std::size_t i = 0; i < ns; ++i) grade(across, nt, i, ns, t_, table.across);
    stretch_s_.resize(ns * nt);
    stretch_t_.resize(nt);
    for (std::size_t k = 0; k < ns * nt; ++k) stretch_s_[k] = density.spacing / along[k];
    for (std::size_t j = 0; j < nt; ++j) {
        const auto row = across.begin() + static_cast<std::ptrdiff_t>(j * ns);
        stretch_t_[j] =
            density.spacing / *std::min_element(row, row + static_cast<std::ptrdiff_t>(ns));
    }
}

void SurfaceMetric::fill(const Table& table) {
    const auto& [length, across, jacobian] = table;
    const std::size_t columns = s_.size(), rows = t_.size();
    cumulative_.resize(columns * rows);
    std::vector<double> gap(rows), pole_gap(rows), plain(rows);  // plain: length, not stretched
    double area = 0;
    for (std::size_t j = 0; j < rows; ++j) {
        double sum = 0, row_area = 0, row_across = 0, stretched = 0;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::size_t k = j * columns + i;
            if (i > 0) {
                const double step = s_[i] - s_[i - 1];
                const double piece = 0.5 * (length[k] + length[k - 1]) * step;
                sum += piece;
                stretched +=
                    stretch_s_.empty() ? piece : piece * 0.5 * (stretch_s_[k] + stretch_s_[k - 1]);
                row_area += 0.5 * (jacobian[k] + jacobian[k - 1]) * step;
                row_across += 0.5 * (across[k] + across[k - 1]) * step;
            }
            cumulative_[k] = stretched;
        }
        const double range = s_.back() - s_.front();
        plain[j] = sum;
        pole_gap[j] = row_across / range;
        gap[j] = sum > 0 ? row_area / sum : 0.0;
        max_length_ = std::max(max_length_, stretched);
        if (!std::isfinite(sum + row_area)) max_length_ = sum + row_area;
        const double weight =
            (j > 0 ? t_[j] - t_[j - 1] : 0.0) + (j + 1 < rows ? t_[j + 1] - t_[j] : 0.0);
        area += 0.5 * weight * row_area;
        mean_length_ += 0.5 * weight * stretched / (t_.back() - t_.front());
    }
    const double pole = kPoleLength * *std::max_element(plain.begin(), plain.end());
    for (std::size_t j = 0; j < rows; ++j) {
        if (!(plain[j] > pole) || gap[j] <= 0) gap[j] = pole_gap[j];
        if (!stretch_t_.empty()) gap[j] *= stretch_t_[j];
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

Vec3 SurfaceMetric::stretched(const Vec3& offset, const SurfacePoint& at, double s,
                              double t) const {
    const double speed = at.ds.norm();
    if (!(speed > 0)) return offset;
    const Vec3 along = at.ds / speed;
    const Vec3 cross = at.dt - at.dt.dot(along) * along;
    const double size = cross.norm();
    if (!(size > 0)) return offset;
    const Vec3 across = cross / size;
    const auto [j, v] = bracket(t_.data(), t_.size(), t);
    const auto [i, w] = bracket(s_.data(), s_.size(), s);
    const double *a = &stretch_s_[j * s_.size()], *b = a + s_.size();
    const double by_s =
        (1 - v) * ((1 - w) * a[i] + w * a[i + 1]) + v * ((1 - w) * b[i] + w * b[i + 1]);
    const double by_t = (1 - v) * stretch_t_[j] + v * stretch_t_[j + 1];
    return {by_s * offset.dot(along), by_t * offset.dot(across), offset.dot(along.cross(across))};
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

double SurfaceMetric::s_of(const Row& row, double x, std::size_t& cell) const {
    const double wanted = x * row.total();
    const std::vector<double>& length = row.length;
    if (!(length[cell] <= wanted)) cell = bracket(length.data(), length.size(), wanted).first;
    while (cell + 2 < length.size() && length[cell + 1] <= wanted) ++cell;
    const double width = length[cell + 1] - length[cell];
    const double w = std::clamp(width > 0 ? (wanted - length[cell]) / width : 0.0, 0.0, 1.0);
    return (1 - w) * s_[cell] + w * s_[cell + 1];
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
