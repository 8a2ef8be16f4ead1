#include "contact/gap_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "contact/fit.h"

namespace beltgrinding {
namespace {

// A face that faces the wheel less has been cut off where the wheel cuts the edge beside it.
constexpr double kLeastFacing = 0.05;
constexpr int kGridQuantum = 8;    // grid lengths are multiples, so that warm starts mostly fit
constexpr double kStraight = 0.3;  // tangent up to which a series gives the angle to 1e-9
constexpr double kLayer = 0.5;  // cells: samples further behind the nearest belong to another layer
constexpr double kFlatLayer = 2.0;  // the same under a belt, which wraps slopes of up to 60 degrees

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
    layer_ = whole_layer_ = kLayer * std::max(grid_.ds, grid_.dy);
    const double half = 0.5 * wheel.width;
    for (const double y : {-half, half})
        steepest_flank_ = std::max(steepest_flank_, std::abs(wheel.drop_slope(y)));
    for (const Eigen::Vector2d& at : wheel.profile)
        steepest_flank_ =
            std::max(steepest_flank_, std::abs(wheel.drop_slope(std::clamp(at.x(), -half, half))));
    for (std::size_t k = 1; k < wheel.profile.size(); ++k) {
        const Eigen::Vector2d &from = wheel.profile[k - 1], &to = wheel.profile[k];
        const double slope = (to.y() - from.y()) / (to.x() - from.x());
        profile_.push_back({static_cast<float>(to.x()),
                            static_cast<float>(from.y() - slope * from.x()),
                            static_cast<float>(slope)});
    }
}

void GapMap::lie_flat(double from, double to, const BeltArc& face) {
    run_ = Run{from, to};
    face_ = face;
    layer_ = whole_layer_ = kFlatLayer * std::max(grid_.ds, grid_.dy);
}

double GapMap::lowest() const {
    if (gap_.size() == 0) return kNone;
    if (face_.flat()) return gap_.minCoeff();
    double least = kNone;
    for (int cell = 0; cell < grid_.cells(); ++cell)
        if (std::isfinite(gap_[cell]))
            least = std::min(least, gap_[cell] + face_.behind(grid_.s(cell % grid_.nx)));
    return least;
}

void GapMap::end_flat() {
    if (!run_) return;
    const int nx = grid_.nx;
    for (int i = 0; i < nx; ++i) {
        if (grid_.s(i) > run_->from && grid_.s(i) < run_->to) continue;
        for (int cell = i; cell < grid_.cells(); cell += nx) {
            gap_[cell] = kNone;
            coverage_.share[cell] = 0.0;
        }
    }
    // The slope to the neighbours that there are.
    const auto slope = [&](int cell, int step, bool has_before, bool has_after) {
        const bool before = has_before && std::isfinite(gap_[cell - step]);
        const bool after = has_after && std::isfinite(gap_[cell + step]);
        const double rise =
            (after ? gap_[cell + step] : gap_[cell]) - (before ? gap_[cell - step] : gap_[cell]);
        return before && after ? 0.5 * rise : rise;
    };
    stretch_.setOnes(grid_.cells());
    for (int cell = 0; cell < grid_.cells(); ++cell) {
        if (!std::isfinite(gap_[cell])) continue;
        const int i = cell % nx, j = cell / nx;
        const double along = slope(cell, 1, i > 0, i + 1 < nx) / grid_.ds;
        const double across = slope(cell, nx, j > 0, j + 1 < grid_.ny) / grid_.dy;
        const double most = 1.0 / static_cast<double>(kSteepest);
        stretch_[cell] = std::min(std::sqrt(1.0 + along * along + across * across), most);
    }
}

void GapMap::fit_grid(double half_length) {
    if (run_) half_length = std::min(half_length, std::max(-run_->from, run_->to));
    const int half = static_cast<int>(std::ceil(half_length / grid_.ds)) + 1;
    grid_.nx = 2 * ((half + kGridQuantum - 1) / kGridQuantum * kGridQuantum) + 1;
    clear_grid();
}

void GapMap::clear_grid() {
    const Eigen::Index n = grid_.cells();
    fit(gap_, n);
    fit(weight_, n);
    gap_.setZero();
    weight_.setZero();
    coverage_.clear(n);
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

void GapMap::prepare(const SampleBlocks& blocks) {
    const HeightField& field = blocks.field();
    if (prepared_for_ == &field && prepared_size_ == field.size()) return;
    prepared_for_ = &field;
    prepared_size_ = field.size();
    find_borders(field);
    find_steps(blocks);
}

void GapMap::update(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
                    const Frame& work_from_contact, double reach, double ahead, double pressable) {
    prepare(blocks);
    contact_from_work_ = work_from_contact.inverse();
    reach_gap_ = reach;
    seen_gap_ = reach + whole_layer_;  // else the surface had edges where its gap is `reach`
    ahead_ = ahead;
    footprints_.clear();
    beside_patches_.clear();
    reach_.resize(0);
    place(blocks, hits);
    double half_length = 0.0;
    for (std::size_t k = 0; k < placed_count_; ++k)
        half_length = std::max<double>(half_length, placed_[k].farthest);
    for (const Footprint& f : footprints_)
        if (f.inside > 0.0f && f.own_gap <= reach)
            half_length = std::max<double>(half_length, std::abs(f.s));
    fit_grid(half_length);
    for (std::size_t k = 0; k < placed_count_; ++k)
        number_cells(placed_[k], grid_.nx, (grid_.nx - 1) / 2);
    for (Footprint& f : footprints_) put_on_grid(f);
    map(blocks, pressable);
}

void GapMap::place(const SampleBlocks& blocks, std::span<const std::uint32_t> hits) {
    const double half_width = 0.5 * wheel_.width, spacing = blocks.field().spacing;
    const Eigen::Matrix3d rotation = contact_from_work_.linear();
    Placing placing{};
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(placing.rotation) =
        rotation.cast<float>();
    placing.radius = static_cast<float>(wheel_.radius);
    placing.half_width = static_cast<float>(half_width);
    placing.reach = static_cast<float>(reach_gap_);
    placing.seen = static_cast<float>(seen_gap_);
    placing.width_limit = static_cast<float>(half_width + 0.5 * spacing + beside_);
    placing.side_limit = static_cast<float>(half_width - spacing);
    placing.ahead = static_cast<float>(ahead_);
    placing.depth = static_cast<float>(blocks.field().depth);
    placing.crown = static_cast<float>(wheel_.crown_radius);
    placing.profile = profile_.data();
    placing.stretches = static_cast<int>(profile_.size());
    placing.ds = static_cast<float>(grid_.ds);
    placing.dy = static_cast<float>(grid_.dy);
    placing.middle_row = static_cast<float>(0.5 * (grid_.ny - 1));
    placing.last_row = std::max(0, grid_.ny - 2);
    if (placed_.size() < hits.size()) placed_.resize(hits.size());
    placed_count_ = samples_ = 0;
    alignas(64) float across[kBlockLanes];
    for (const std::uint32_t number : hits) {
        const SampleBlocks::Block& block = blocks.block(number);
        const Vec3f origin = (contact_from_work_ * block.origin).cast<float>();
        PlacedBlock& placed = placed_[placed_count_];
        place_block(placing,
                    {block.height.data(),
                     block.x.data(),
                     block.y.data(),
                     block.z.data(),
                     block.nx.data(),
                     block.ny.data(),
                     block.nz.data(),
                     block.area.data(),
                     {origin.x(), origin.y(), origin.z()}},
                    placed, across);
        placed.regular &= ~block.leaning;
        placed.block = number;
        const std::uint64_t alone = placed.special | block.leaning;
        for (std::uint64_t lanes = placed.aside | alone; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            if ((alone >> lane & 1U) != 0)
                place_alone(blocks,
                            std::size_t{number} * kBlockLanes + static_cast<std::size_t>(lane));
            else
                place_aside(blocks, placed, lane, across[lane]);
        }
        samples_ += static_cast<std::size_t>(std::popcount(placed.in_reach & placed.regular));
        if (placed.regular != 0) ++placed_count_;
    }
    for (const Footprint& f : footprints_)
        if (f.own_gap <= reach_gap_) ++samples_;
    has_taken_.assign(placed_count_, 0);
}

void GapMap::place_alone(const SampleBlocks& blocks, std::size_t position) {
    const HeightField& field = blocks.field();
    const SampleBlocks::Block& block =
        blocks.block(static_cast<std::uint32_t>(position / kBlockLanes));
    const std::size_t lane = position % kBlockLanes;
    const Vec3f design_normal = block.normal(lane);
    if (design_normal.isZero()) return;  // missed
    const Eigen::Matrix3d rotation = contact_from_work_.linear();
    const double radius = wheel_.radius, half_width = 0.5 * wheel_.width;
    const Vec3 top = contact_from_work_ * blocks.top_in_block(position);
    const double along = top.z() + radius;  // from the wheel's axis towards the work
    if (along <= 0.0 || std::abs(top.y()) > half_width + 0.5 * field.spacing + beside_) return;
    if (along < ahead_) {
        const Vec3 bottom = contact_from_work_ * field.bottom(blocks.sample(position));
        if (bottom.z() + radius < ahead_) return;
    }
    const double r = std::sqrt(top.x() * top.x() + along * along);
    const double y = std::clamp(top.y(), -half_width, half_width);
    const double gap = r - (radius - wheel_.drop(y));
    if (gap > seen_gap_) return;
    Vec3 normal = rotation * design_normal.cast<double>();
    const double sine = top.x() / r;
    const double cosine = along / r;
    double n_radial = normal.x() * sine + normal.z() * cosine;
    const double facing = -n_radial;
    if ((block.leaning >> lane & 1U) != 0 && facing > kLeastFacing) {
        const Vec3 ray = rotation * field.rays[blocks.sample(position)].cast<double>();
        normal = between(normal, ray, Vec3(-sine, 0.0, -cosine));
        n_radial = (normal.x() * sine + normal.z() * cosine) / normal.norm();
        normal.normalize();
    }
    if (n_radial > -kSteepest) return;
    const double n_tangential = normal.x() * cosine - normal.z() * sine;
    Footprint f{};
    f.position = position;
    f.sample = blocks.sample(position);
    f.s = static_cast<float>(radius * angle_of(top.x(), along));
    f.y = static_cast<float>(top.y());
    f.gap = gap;
    f.slope_s = static_cast<float>(-n_tangential / n_radial * (r / radius));
    f.slope_y = static_cast<float>(-normal.y() / n_radial + wheel_.drop_slope(y));
    f.own_gap = static_cast<float>(gap);
    f.cosine = static_cast<float>(facing);
    f.facing = static_cast<float>(cosine);
    f.area = block.area[lane];
    f.inside = f.taken = 1.0f;
    keep(f, blocks);
}

void GapMap::place_aside(const SampleBlocks& blocks, const PlacedBlock& placed, int lane,
                         float across) {
    Footprint f = footprint_of(blocks, placed, lane);
    f.s = static_cast<float>(
        (static_cast<double>(placed.cell[lane]) + static_cast<double>(placed.u[lane])) * grid_.ds);
    f.y = across;
    f.gap = f.own_gap;
    f.slope_s = placed.slope_s[lane] / static_cast<float>(grid_.ds);
    f.slope_y = placed.slope_y[lane] / static_cast<float>(grid_.dy);
    f.inside = f.taken = 1.0F;
    keep(f, blocks);
}

void GapMap::keep(Footprint f, const SampleBlocks& blocks) {
    const double half_width = 0.5 * wheel_.width;
    const auto y = static_cast<double>(f.y);
    if (std::abs(y) + blocks.field().spacing > half_width) {
        // A patch at the wheel's edge is a strip that the wheel covers in part.
        const Patch patch = patch_of(f, blocks);
        const double within = std::min(patch.y + patch.half_y, half_width) -
                              std::max(patch.y - patch.half_y, -half_width);
        const bool is_beside = std::abs(patch.y) - patch.half_y < half_width + beside_;
        if (!(within > 0.0) && !is_beside) return;
        f.inside = static_cast<float>(std::clamp(0.5 * within / patch.half_y, 0.0, 1.0));
        if (beside_ > 0.0) note_beside(patch);
    }
    footprints_.push_back(f);
}

void GapMap::map(const SampleBlocks& blocks, double pressable) {
    for (Footprint& f : footprints_)
        f.on_grid = f.nearest = std::abs(f.s) <= 0.5 * (grid_.nx - 1) * grid_.ds;
    if (map_smooth(blocks, pressable)) {
        end_flat();
        return;
    }
    gap_.setZero();
    weight_.setZero();
    nearest_.assign(static_cast<std::size_t>(grid_.cells()), kNone);
    farthest_.assign(nearest_.size(), -kNone);
    const int above = grid_.ny > 1 ? grid_.nx : 0;
    for (std::size_t k = 0; k < placed_count_; ++k)
        range_cells(placed_[k], above, nearest_.data(), farthest_.data());
    for (const Footprint& f : footprints_) {
        if (f.inside <= 0.0f || !f.on_grid) continue;
        const bool right = f.u >= 0.5f, up = f.v >= 0.5f;
        const double carried = f.gap + (right ? f.slope_s : 0.0) + (up ? f.slope_y : 0.0);
        const auto own = static_cast<std::size_t>(own_cell(f));
        nearest_[own] = std::min(nearest_[own], carried);
        farthest_[own] = std::max(farthest_[own], carried);
    }
    mark_edges(pressable);
    part_edges(blocks);
    cover(blocks);
    average_gap();
    coverage_.merge_slivers(grid_);
    share_cells();
    carry_to_middles();
    end_flat();
}

bool GapMap::holds_for(const Eigen::ArrayXd& pressure) const {
    if (pressable_.empty()) return true;
    for (std::size_t k = 0; k < pressable_.size(); ++k)
        if (pressable_[k] == 0 && pressure[static_cast<Eigen::Index>(k)] > 0.0) return false;
    return true;
}

void GapMap::look_at_all_edges(const SampleBlocks& blocks) {
    clear_grid();
    map(blocks, kNone);
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

Eigen::ArrayXd tilt_by_approach(const ContactWheel& wheel, const ContactGrid& grid,
                                const Eigen::ArrayXd& gap) {
    Eigen::ArrayXd tilt = Eigen::ArrayXd::Zero(grid.cells());
    for (int i = 0; i < grid.nx; ++i) {
        const double angle = grid.s(i) / wheel.radius;
        const double sine = std::sin(angle), less = 1.0 - std::cos(angle);
        for (int j = 0; j < grid.ny; ++j) {
            const int cell = j * grid.nx + i;
            if (!std::isfinite(gap[cell])) continue;
            const bool left = i > 0 && std::isfinite(gap[cell - 1]);
            const bool right = i + 1 < grid.nx && std::isfinite(gap[cell + 1]);
            const double rise =
                (right ? gap[cell + 1] : gap[cell]) - (left ? gap[cell - 1] : gap[cell]);
            const int steps = (left ? 1 : 0) + (right ? 1 : 0);
            tilt[cell] = less - (steps > 0 ? sine * rise / (steps * grid.ds) : 0.0);
        }
    }
    return tilt;
}

Eigen::ArrayXd profile_drop(const ContactWheel& wheel, const ContactGrid& grid) {
    Eigen::ArrayXd drop(grid.ny);
    for (int j = 0; j < grid.ny; ++j) drop[j] = wheel.drop(grid.y(j));
    if ((drop == drop[0]).all()) drop.resize(0);
    return drop;
}

}  // namespace beltgrinding
