#include "contact/gap_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/fit.h"

namespace beltgrinding {
namespace {

// A surface steeper than this against the wheel is its flank or back, which the wheel cannot press.
// Samples stand for about as much area as the cells that they share; where a gouge's walls leave
// far less, no volume is squeezed out of what is left.
constexpr double kLargestScale = 1.5;
constexpr double kSteepest = 0.2;  // cosine of the angle between surface normal and wheel's radius
// A face that faces the wheel less has been cut off where the wheel cuts the edge beside it.
constexpr double kLeastFacing = 0.05;
constexpr int kGridQuantum = 8;       // grid lengths are multiples, so that warm starts mostly fit
constexpr double kStraight = 0.3;     // tangent up to which a series gives the angle to 1e-9
constexpr double kOnEnvelope = 1e-5;  // mm: a sample as near to the wheel's envelope lies on it
constexpr int kMaxSecants = 20;
constexpr double kLayer = 0.5;  // cells: samples further behind the nearest belong to another layer

/// atan2(x, along) for `along` > 0, of the angles under a wheel mostly by its series.
double angle_of(double x, double along) {
    const double t = x / along, q = t * t;
    if (std::abs(t) > kStraight) return std::atan2(x, along);
    return t *
           (1.0 -
            q * (1.0 / 3 -
                 q * (1.0 / 5 -
                      q * (1.0 / 7 - q * (1.0 / 9 - q * (1.0 / 11 - q * (1.0 / 13 - q / 15)))))));
}

/// The normal of the surface at a sample whose ray leans to a sharp edge: of what lies between its
/// face's and the ray, the one that looks most `towards` the wheel. An edge is a round of all these
/// normals; a face beside it that is ground flat keeps its own.
Vec3 between(const Vec3& normal, const Vec3& ray, const Vec3& towards) {
    const Vec3 aside = ray - normal;  // square to the normal
    const double across = towards.dot(aside), along = towards.dot(normal);
    if (!(across > 0.0) || !(along > 0.0)) return normal;
    const double tangent = across / aside.squaredNorm() / along;
    return normal + std::min(tangent, 1.0) * aside;
}

}  // namespace

GapMap::GapMap(const ContactWheel& wheel, double spacing, double beside)
    : wheel_(wheel), beside_(beside) {
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
    nearest_.assign(static_cast<std::size_t>(n), kNone);
    farthest_.assign(static_cast<std::size_t>(n), -kNone);
    fit(gap_, n);
    fit(weight_, n);
    gap_.setZero();
    weight_.setZero();
    coverage_.clear(n);
    layer_ = kLayer * std::max(grid_.ds, grid_.dy);
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
    f.slope_s *= static_cast<float>(grid_.ds);
    f.slope_y *= static_cast<float>(grid_.dy);
    f.gap += f.slope_s * (i - u) + f.slope_y * (j - v);
}

void GapMap::update(const HeightField& field, std::span<const std::uint32_t> hits,
                    const Frame& work_from_contact, double reach) {
    find_borders(field);
    contact_from_work_ = work_from_contact.inverse();
    const Frame& contact_from_work = contact_from_work_;
    const Eigen::Matrix3d rotation = contact_from_work.linear();
    const double radius = wheel_.radius, half_width = 0.5 * wheel_.width;
    footprints_.clear();
    beside_patches_.clear();
    reach_.resize(0);
    double half_length = 0.0;
    for (const std::uint32_t sample : hits) {
        if ((field.flags[sample] & kMissed) != 0) continue;
        const Vec3 top = contact_from_work * field.top(sample);
        const double along = top.z() + radius;  // from the wheel's axis towards the work
        if (along <= 0.0) continue;
        const double r = std::sqrt(top.x() * top.x() + along * along);
        const double y = std::clamp(top.y(), -half_width, half_width);
        const double gap = r - (radius - wheel_.drop(y));
        if (gap > reach) continue;
        Vec3 normal = rotation * field.normal[sample].cast<double>();
        const double sine = top.x() / r;
        const double cosine = along / r;
        double n_radial = normal.x() * sine + normal.z() * cosine;
        const double facing = -n_radial;
        if (field.leans(sample) && facing > kLeastFacing) {
            const Vec3 ray = rotation * field.rays[sample].cast<double>();
            normal = between(normal, ray, Vec3(-sine, 0.0, -cosine));
            n_radial = (normal.x() * sine + normal.z() * cosine) / normal.norm();
            normal.normalize();
        }
        if (n_radial > -kSteepest) continue;
        const double n_tangential = normal.x() * cosine - normal.z() * sine;
        Footprint f;
        f.sample = sample;
        f.s = static_cast<float>(radius * angle_of(top.x(), along));
        f.y = static_cast<float>(top.y());
        f.gap = gap;
        f.slope_s = static_cast<float>(-n_tangential / n_radial * (r / radius));
        f.slope_y = static_cast<float>(-normal.y() / n_radial + wheel_.drop_slope(y));
        f.own_gap = static_cast<float>(gap);
        f.cosine = static_cast<float>(facing);
        f.facing = static_cast<float>(cosine);
        f.area = field.area[sample];
        f.inside = f.taken = 1.0f;
        f.nearest = true;
        if (std::abs(top.y()) + field.spacing > half_width) {
            // A patch at the wheel's edge is a strip that the wheel covers in part.
            const Patch patch = patch_of(f, field);
            const double within = std::min(patch.y + patch.half_y, half_width) -
                                  std::max(patch.y - patch.half_y, -half_width);
            const bool is_beside = std::abs(patch.y) - patch.half_y < half_width + beside_;
            if (!(within > 0.0) && !is_beside) continue;
            f.inside = static_cast<float>(std::clamp(0.5 * within / patch.half_y, 0.0, 1.0));
            if (beside_ > 0.0) note_beside(patch);
        }
        footprints_.push_back(f);
        if (f.inside <= 0.0f) continue;
        half_length = std::max(half_length, std::abs(static_cast<double>(f.s)));
    }
    fit_grid(half_length);
    for (Footprint& f : footprints_) {
        put_on_grid(f);
        if (f.inside <= 0.0f) continue;
        const bool right = f.u >= 0.5f, up = f.v >= 0.5f;
        const double carried = f.gap + (right ? f.slope_s : 0.0) + (up ? f.slope_y : 0.0);
        const auto own = static_cast<std::size_t>(own_cell(f));
        nearest_[own] = std::min(nearest_[own], carried);
        farthest_[own] = std::max(farthest_[own], carried);
    }
    mark_edges();
    cover(field);
    average_gap();
    coverage_.merge_slivers(grid_);
    share_cells();
    carry_to_middles();
}

double GapMap::at(const Footprint& f, const Eigen::ArrayXd& values) const {
    const int above = f.cell + (grid_.ny > 1 ? grid_.nx : 0);
    return f.shares[0] * values[f.cell] + f.shares[1] * values[f.cell + 1] +
           f.shares[2] * values[above] + f.shares[3] * values[above + 1];
}

double GapMap::down_to_envelope(const HeightField& field, const Footprint& f, double approach,
                                double wanted) const {
    // By the slopes at most, and by the curvature of the radius seen from z.
    const double overlap = approach * f.facing - f.own_gap;
    const double bent = approach * approach / wheel_.radius;
    const double way = field.leans(f.sample) ? wanted * field.rays[f.sample].norm() : wanted;
    if (overlap - bent >= (1.0 + steepest_flank_) * way) return wanted;
    const Vec3 ray = contact_from_work_.linear() * field.ray(f.sample).cast<double>();
    const Vec3 top = contact_from_work_ * field.top(f.sample);
    const auto gap = [&](double lowering) {
        const Vec3 at = top - lowering * ray;
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

double GapMap::remove(HeightField& field, const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                      double duration, double approach, std::vector<std::uint32_t>& changed) {
    const double volume = volume_rate(rate, beside) * duration;
    if (!(volume > 0.0)) return 0.0;
    sum_rates(rate, beside, lowering_);
    double unscaled = 0.0;
    for (std::size_t k = 0; k < footprints_.size(); ++k) {
        lowering_[k] *= duration;
        unscaled += lowering_[k] * footprints_[k].area;
    }
    if (!(unscaled > 0.0)) return 0.0;
    const double scale = scale_ = std::min(volume / unscaled, kLargestScale);
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
        double cosine = f.cosine;
        if (field.leans(f.sample)) {
            const Vec3 ray = contact_from_work_.linear() * field.rays[f.sample].cast<double>();
            const double angle = f.s / wheel_.radius;
            cosine = -(ray.x() * std::sin(angle) + ray.z() * std::cos(angle));
            cosine = std::max(cosine, kSteepest);
        }
        const double lowering = down_to_envelope(field, f, 0.0, -f.own_gap / cosine);
        if (lowering <= 0.0) continue;
        field.height[f.sample] -= lowering;
        volume += lowering * f.area;
        changed.push_back(f.sample);
    }
    return volume;
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

Eigen::ArrayXd profile_drop(const ContactWheel& wheel, const ContactGrid& grid) {
    Eigen::ArrayXd drop(grid.ny);
    for (int j = 0; j < grid.ny; ++j) drop[j] = wheel.drop(grid.y(j));
    if ((drop == drop[0]).all()) drop.resize(0);
    return drop;
}

}  // namespace beltgrinding
