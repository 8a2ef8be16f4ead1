#include "contact/gap_map.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

// A surface steeper than this against the wheel is its flank or back, which the wheel cannot press.
// Samples stand for about as much area as the cells that they share; where a gouge's walls leave
// far less, no volume is squeezed out of what is left.
constexpr double kLargestScale = 1.5;
constexpr double kSteepest = 0.2;  // cosine of the angle between surface normal and wheel's radius
constexpr int kGridQuantum = 8;    // grid lengths are multiples, so that warm starts mostly fit
// Coverage from sums over samples carries their sampling noise; near full it is full.
constexpr double kFullCoverage = 0.85;
constexpr double kLeastCoverage = 0.05;
// At the surface's border a cell of less coverage is left out: the wheel yields under it as under a
// whole cell, so its pressure came out too high by 1 / coverage.
constexpr double kLeastAtBorder = 0.25;
constexpr double kOnEnvelope = 1e-5;  // mm: a sample as near to the wheel's envelope lies on it
constexpr int kMaxSecants = 20;
constexpr double kLayer = 0.5;  // cells: samples further behind the nearest belong to another layer

}  // namespace

GapMap::GapMap(const ContactWheel& wheel, double spacing) : wheel_(wheel) {
    grid_.ds = spacing;
    grid_.ny = std::max(1, static_cast<int>(std::lround(wheel.width / spacing)));
    grid_.dy = wheel.width / grid_.ny;
    const double half = 0.5 * wheel.width;
    for (const double y : {-half, half})
        steepest_flank_ = std::max(steepest_flank_, std::abs(wheel.drop_slope(y)));
    for (const Eigen::Vector2d& at : wheel.profile)
        steepest_flank_ =
            std::max(steepest_flank_, std::abs(wheel.drop_slope(std::clamp(at.x(), -half, half))));
}

void GapMap::fit_grid(double half_length) {
    const int half = static_cast<int>(std::ceil(half_length / grid_.ds)) + 1;
    grid_.nx = 2 * ((half + kGridQuantum - 1) / kGridQuantum * kGridQuantum) + 1;
    const Eigen::Index n = grid_.cells();
    nearest_ = Eigen::ArrayXd::Constant(n, kNone);
    gap_ = weight_ = Eigen::ArrayXd::Zero(n);
    coverage_ = Eigen::ArrayXd::Zero(n);
    at_boundary_.assign(static_cast<std::size_t>(n), 0);
}

void GapMap::put_on_grid(Footprint& f) const {
    // Beyond the outermost centres all weight goes to the outermost cell.
    const double u = f.s / grid_.ds + 0.5 * (grid_.nx - 1);
    const double v = f.y / grid_.dy + 0.5 * (grid_.ny - 1);
    const int i = std::clamp(static_cast<int>(u), 0, grid_.nx - 2);
    const int j = std::clamp(static_cast<int>(v), 0, std::max(0, grid_.ny - 2));
    f.cell = j * grid_.nx + i;
    f.u = static_cast<float>(std::clamp(u - i, 0.0, 1.0));
    f.v = grid_.ny > 1 ? static_cast<float>(std::clamp(v - j, 0.0, 1.0)) : 0.0f;
    f.slope_s *= grid_.ds;
    f.slope_y *= grid_.dy;
    f.gap += f.slope_s * (i - u) + f.slope_y * (j - v);
}

template <class Visit>
void GapMap::for_cells(const Footprint& f, Visit visit) const {
    const int above = f.cell + (grid_.ny > 1 ? grid_.nx : 0);
    visit(f.cell, (1.0f - f.u) * (1.0f - f.v), f.gap);
    visit(f.cell + 1, f.u * (1.0f - f.v), f.gap + f.slope_s);
    visit(above, (1.0f - f.u) * f.v, f.gap + f.slope_y);
    visit(above + 1, f.u * f.v, f.gap + f.slope_s + f.slope_y);
}

void GapMap::update(const HeightField& field, std::span<const std::uint32_t> hits,
                    const Frame& work_from_contact, double reach) {
    contact_from_work_ = work_from_contact.inverse();
    const Frame& contact_from_work = contact_from_work_;
    const Eigen::Matrix3d rotation = contact_from_work.linear();
    const double radius = wheel_.radius;
    footprints_.clear();
    double half_length = 0.0;
    for (const std::uint32_t sample : hits) {
        if ((field.flags[sample] & kMissed) != 0) continue;
        const Vec3 top = contact_from_work * field.top(sample);
        // A sample at the wheel's edge stands for a strip that the wheel covers in part.
        const double inside =
            std::clamp((0.5 * wheel_.width - std::abs(top.y())) / field.spacing + 0.5, 0.0, 1.0);
        if (inside <= 0.0) continue;
        const double along = top.z() + radius;  // from the wheel's axis towards the work
        const double r = std::hypot(top.x(), along);
        if (along <= 0.0) continue;
        const Vec3 normal = rotation * field.normal[sample].cast<double>();
        const double sine = top.x() / r;
        const double cosine = along / r;
        const double n_radial = normal.x() * sine + normal.z() * cosine;
        if (n_radial > -kSteepest) continue;
        const double y = std::clamp(top.y(), -0.5 * wheel_.width, 0.5 * wheel_.width);
        const double gap = r - (radius - wheel_.drop(y));
        if (gap > reach) continue;
        const double n_tangential = normal.x() * cosine - normal.z() * sine;
        Footprint f;
        f.sample = sample;
        f.s = radius * std::atan2(sine, cosine);
        f.y = top.y();
        f.gap = gap;
        f.slope_s = -n_tangential / n_radial * (r / radius);
        f.slope_y = -normal.y() / n_radial + wheel_.drop_slope(y);
        f.inside = inside;
        f.own_gap = static_cast<float>(gap);
        f.cosine = static_cast<float>(-n_radial);
        f.facing = static_cast<float>(cosine);
        f.area = field.area[sample];
        f.projected_area = static_cast<float>(-n_radial * inside * field.area[sample] * radius / r);
        f.boundary = (field.flags[sample] & kOnBoundary) != 0;
        footprints_.push_back(f);
        half_length = std::max(half_length, std::abs(f.s));
    }
    fit_grid(half_length);

    for (Footprint& f : footprints_) {
        put_on_grid(f);
        for_cells(f, [&](int cell, float weight, double carried) {
            if (weight > 0.0f) nearest_[cell] = std::min(nearest_[cell], carried);
        });
    }
    const double layer = kLayer * std::max(grid_.ds, grid_.dy);
    for (Footprint& f : footprints_) {
        double behind = 0.0;
        for_cells(f, [&](int cell, float weight, double carried) {
            if (weight > 0.0f) behind += weight * std::min(carried - nearest_[cell], 2.0 * layer);
        });
        f.nearest = behind <= layer;
        if (!f.nearest) continue;
        for_cells(f, [&](int cell, float share, double carried) {
            const double weight = static_cast<double>(share) * f.projected_area;
            gap_[cell] += weight * carried;
            weight_[cell] += weight;
            if (f.boundary && share > 0.0f) at_boundary_[static_cast<std::size_t>(cell)] = 1;
        });
    }
    for (Eigen::Index cell = 0; cell < gap_.size(); ++cell) {
        double share = weight_[cell] / grid_.cell_area();
        const bool at_border = at_boundary_[static_cast<std::size_t>(cell)] != 0;
        if (share < (at_border ? kLeastAtBorder : kLeastCoverage)) {
            gap_[cell] = kNone;
            continue;
        }
        if (!at_border || share > kFullCoverage) share = 1.0;
        gap_[cell] /= weight_[cell];
        coverage_[cell] = share;
    }
}

double GapMap::down_to_envelope(const HeightField& field, const Footprint& f, double approach,
                                double wanted) const {
    // By the slopes at most, and by the curvature of the radius seen from z.
    const double overlap = approach * f.facing - f.own_gap;
    const double bent = approach * approach / wheel_.radius;
    if (overlap - bent >= (1.0 + steepest_flank_) * wanted) return wanted;
    const Vec3 top = contact_from_work_ * field.top(f.sample);
    const Vec3 normal = contact_from_work_.linear() * field.normal[f.sample].cast<double>();
    const auto gap = [&](double lowering) {
        const Vec3 at = top - lowering * normal;
        const double y = std::clamp(at.y(), -0.5 * wheel_.width, 0.5 * wheel_.width);
        return std::hypot(at.x(), at.z() - approach + wheel_.radius) -
               (wheel_.radius - wheel_.drop(y));
    };
    double at_low = gap(0.0);
    if (at_low >= 0.0) return 0.0;
    double at_high = gap(wanted);
    if (at_high <= kOnEnvelope) return wanted;
    // Regula falsi. The radius is convex in the lowering, so that it comes from within.
    double low = 0.0, high = wanted;
    for (int k = 0; k < kMaxSecants && at_low < -kOnEnvelope; ++k) {
        const double between = low + (high - low) * at_low / (at_low - at_high);
        const double found = gap(between);
        (found <= 0.0 ? low : high) = between;
        (found <= 0.0 ? at_low : at_high) = found;
    }
    return low;
}

double GapMap::remove(HeightField& field, const Eigen::ArrayXd& rate, double duration,
                      double approach, std::vector<std::uint32_t>& changed) {
    const double volume = (rate * coverage_).sum() * grid_.cell_area() * duration;
    if (!(volume > 0.0)) return 0.0;
    lowering_.assign(footprints_.size(), 0.0);
    double unscaled = 0.0;
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        const Footprint& f = footprints_[k];
        if (!f.nearest) continue;
        double lowering = 0.0;
        for_cells(f, [&](int cell, float weight, double) { lowering += weight * rate[cell]; });
        lowering_[k] = f.inside * lowering * duration;
        unscaled += lowering_[k] * f.area;
    }
    if (!(unscaled > 0.0)) return 0.0;
    const double scale = std::min(volume / unscaled, kLargestScale);
    double kept = 0.0, free = 0.0;  // mm3, of the samples on the envelope, of the others
    bool held = false;
    room_.assign(footprints_.size(), 0.0);
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        if (lowering_[k] <= 0.0) continue;
        const Footprint& f = footprints_[k];
        // Room enough for what the others keep back as well.
        room_[k] = down_to_envelope(field, f, approach, kLargestScale * lowering_[k]);
        const double most = std::min(room_[k], scale * lowering_[k]);
        const bool holds = most < scale * lowering_[k];
        held = held || holds;
        (holds ? kept : free) += most * f.area;
    }
    const double wanted = scale * unscaled;
    double more = 1.0;
    if (held && free > 0.0) more = std::clamp((wanted - kept) / free, 1.0, kLargestScale / scale);
    double removed = 0.0;
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        if (lowering_[k] <= 0.0) continue;
        const double lowering = std::min(room_[k], more * scale * lowering_[k]);
        if (held) footprints_[k].taken = static_cast<float>(lowering / (scale * lowering_[k]));
        if (lowering <= 0.0) continue;
        field.height[footprints_[k].sample] -= lowering;
        changed.push_back(footprints_[k].sample);
        removed += lowering * footprints_[k].area;
    }
    return held ? removed : wanted;
}

double GapMap::cut(HeightField& field, std::vector<std::uint32_t>& changed) const {
    double volume = 0.0;
    for (const Footprint& f : footprints_) {
        if (f.own_gap >= 0.0f || f.inside < 0.5) continue;  // its middle lies beside the wheel
        const double lowering = down_to_envelope(field, f, 0.0, -f.own_gap / f.cosine);
        if (lowering <= 0.0) continue;
        field.height[f.sample] -= lowering;
        volume += lowering * f.area;
        changed.push_back(f.sample);
    }
    return volume;
}

void GapMap::spread(const Eigen::ArrayXd& rate, double duration,
                    Eigen::Ref<Eigen::ArrayXd> amounts) const {
    for (const Footprint& f : footprints_) {
        if (!f.nearest) continue;
        double amount = 0.0;
        for_cells(f, [&](int cell, float weight, double) { amount += weight * rate[cell]; });
        amounts[f.sample] += f.taken * f.inside * amount * duration;
    }
}

void GapMap::raise(const Eigen::ArrayXd& values, std::span<float> largest) const {
    for (const Footprint& f : footprints_) {
        if (!f.nearest) continue;
        double value = 0.0;
        for_cells(f, [&](int cell, float weight, double) { value += weight * values[cell]; });
        largest[f.sample] = std::max(largest[f.sample], static_cast<float>(value));
    }
}

std::optional<std::uint32_t> GapMap::sample_near(double s, double y) const {
    std::optional<std::uint32_t> found;
    double least = kNone;
    for (const Footprint& f : footprints_) {
        const double away = std::hypot(f.s - s, f.y - y);
        if (!f.nearest || away >= least) continue;
        least = away;
        found = f.sample;
    }
    return found;
}

Eigen::Vector2d GapMap::slope_near(double s, double y, double reach) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int count = 0;
    for (const Footprint& f : footprints_) {
        if (!f.nearest || std::hypot(f.s - s, f.y - y) > reach) continue;
        sum += Eigen::Vector2d(f.slope_s / grid_.ds, f.slope_y / grid_.dy);
        ++count;
    }
    return sum / count;
}

Eigen::ArrayXd recentre(const Eigen::ArrayXd& values, const ContactGrid& from,
                        const ContactGrid& to) {
    if (from == to) return values;
    Eigen::ArrayXd result = Eigen::ArrayXd::Zero(to.cells());
    if (values.size() != from.cells() || from.ny != to.ny) return result;
    const int shift = (to.nx - from.nx) / 2;
    for (int j = 0; j < to.ny; ++j) {
        for (int i = std::max(0, shift); i < std::min(to.nx, from.nx + shift); ++i) {
            result[j * to.nx + i] = values[j * from.nx + i - shift];
        }
    }
    return result;
}

}  // namespace beltgrinding
