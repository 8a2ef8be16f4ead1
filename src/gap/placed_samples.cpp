#include "gap/placed_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beltgrinding {
namespace {

// A face that faces the wheel less has been cut off where the wheel cuts the edge beside it.
constexpr double kLeastFacing = 0.05;
constexpr double kStraight = 0.3;  // tangent up to which a series gives the angle to 1e-9

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

/// Finds the four cells.
void put_on_grid(const ContactGrid& grid, Footprint& f) {
    // Beyond the outermost centres all weight goes to the outermost cell.
    const double u = f.s / grid.ds + 0.5 * (grid.nx - 1);
    const double v = f.y / grid.dy + 0.5 * (grid.ny - 1);
    const int i = std::clamp(static_cast<int>(u), 0, grid.nx - 2);
    const int j = std::clamp(static_cast<int>(v), 0, std::max(0, grid.ny - 2));
    f.cell = j * grid.nx + i;
    f.u = static_cast<float>(std::clamp(u - i, 0.0, 1.0));
    f.v = grid.ny > 1 ? static_cast<float>(std::clamp(v - j, 0.0, 1.0)) : 0.0f;
    f.slope_s *= static_cast<float>(grid.ds);
    f.slope_y *= static_cast<float>(grid.dy);
    f.gap += f.slope_s * (i - u) + f.slope_y * (j - v);
}

}  // namespace

void PlacedSamples::place(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
                          const Frame& work_from_contact, const ContactGrid& grid,
                          const Limits& limits) {
    pose_.move_to(work_from_contact);
    limits_ = limits;
    footprints_.clear();
    beside_.clear();
    const ContactWheel& wheel = pose_.wheel();
    const Frame& contact_from_work = pose_.contact_from_work();
    const double half_width = 0.5 * wheel.width, spacing = blocks.field().spacing;
    const Eigen::Matrix3d rotation = contact_from_work.linear();
    Placing placing{};
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(placing.rotation) =
        rotation.cast<float>();
    placing.radius = static_cast<float>(wheel.radius);
    placing.half_width = static_cast<float>(half_width);
    placing.reach = static_cast<float>(limits_.reach);
    placing.seen = static_cast<float>(limits_.seen);
    placing.width_limit = static_cast<float>(half_width + 0.5 * spacing + beside_.most());
    placing.side_limit = static_cast<float>(half_width - spacing);
    placing.ahead = static_cast<float>(limits_.ahead);
    placing.depth = static_cast<float>(blocks.field().depth);
    placing.crown = static_cast<float>(wheel.crown_radius);
    placing.profile = pose_.profile().data();
    placing.stretches = static_cast<int>(pose_.profile().size());
    placing.ds = static_cast<float>(grid.ds);
    placing.dy = static_cast<float>(grid.dy);
    placing.middle_row = static_cast<float>(0.5 * (grid.ny - 1));
    placing.last_row = std::max(0, grid.ny - 2);
    if (placed_.size() < hits.size()) placed_.resize(hits.size());
    placed_count_ = count_ = 0;
    alignas(64) float across[kBlockLanes];
    for (const std::uint32_t number : hits) {
        const SampleBlocks::Block& block = blocks.block(number);
        const Vec3f origin = (contact_from_work * block.origin).cast<float>();
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
                place_aside(blocks, grid, placed, lane, across[lane]);
        }
        count_ += static_cast<std::size_t>(std::popcount(placed.in_reach & placed.regular));
        if (placed.regular != 0) ++placed_count_;
    }
    for (const Footprint& f : footprints_)
        if (f.own_gap <= limits_.reach) ++count_;
}

void PlacedSamples::place_alone(const SampleBlocks& blocks, std::size_t position) {
    const HeightField& field = blocks.field();
    const SampleBlocks::Block& block =
        blocks.block(static_cast<std::uint32_t>(position / kBlockLanes));
    const std::size_t lane = position % kBlockLanes;
    const Vec3f design_normal = block.normal(lane);
    if (design_normal.isZero()) return;  // missed
    const ContactWheel& wheel = pose_.wheel();
    const Frame& contact_from_work = pose_.contact_from_work();
    const Eigen::Matrix3d rotation = contact_from_work.linear();
    const double radius = wheel.radius, half_width = 0.5 * wheel.width;
    const Vec3 top = contact_from_work * blocks.top_in_block(position);
    const double along = top.z() + radius;  // from the wheel's axis towards the work
    if (along <= 0.0 || std::abs(top.y()) > half_width + 0.5 * field.spacing + beside_.most())
        return;
    if (along < limits_.ahead) {
        const Vec3 bottom = contact_from_work * field.bottom(blocks.sample(position));
        if (bottom.z() + radius < limits_.ahead) return;
    }
    const double r = std::sqrt(top.x() * top.x() + along * along);
    const double y = std::clamp(top.y(), -half_width, half_width);
    const double gap = r - (radius - wheel.drop(y));
    if (gap > limits_.seen) return;
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
    f.slope_y = static_cast<float>(-normal.y() / n_radial + wheel.drop_slope(y));
    f.own_gap = static_cast<float>(gap);
    f.cosine = static_cast<float>(facing);
    f.facing = static_cast<float>(cosine);
    f.area = block.area[lane];
    f.inside = f.taken = 1.0f;
    keep(f, blocks);
}

void PlacedSamples::place_aside(const SampleBlocks& blocks, const ContactGrid& grid,
                                const PlacedBlock& placed, int lane, float across) {
    Footprint f = in_block(blocks, placed, lane);
    f.s = static_cast<float>(
        (static_cast<double>(placed.cell[lane]) + static_cast<double>(placed.u[lane])) * grid.ds);
    f.y = across;
    f.gap = f.own_gap;
    f.slope_s = placed.slope_s[lane] / static_cast<float>(grid.ds);
    f.slope_y = placed.slope_y[lane] / static_cast<float>(grid.dy);
    f.inside = f.taken = 1.0F;
    keep(f, blocks);
}

void PlacedSamples::keep(Footprint f, const SampleBlocks& blocks) {
    const double half_width = 0.5 * pose_.wheel().width;
    const auto y = static_cast<double>(f.y);
    if (std::abs(y) + blocks.field().spacing > half_width) {
        // A patch at the wheel's edge is a strip that the wheel covers in part.
        const Patch patch = patch_of(f, blocks);
        const double within = std::min(patch.y + patch.half_y, half_width) -
                              std::max(patch.y - patch.half_y, -half_width);
        const bool is_beside = std::abs(patch.y) - patch.half_y < half_width + beside_.most();
        if (!(within > 0.0) && !is_beside) return;
        f.inside = static_cast<float>(std::clamp(0.5 * within / patch.half_y, 0.0, 1.0));
        if (beside_.most() > 0.0) beside_.note(patch, footprints_.size());
    }
    footprints_.push_back(f);
}

double PlacedSamples::half_length() const {
    double half = 0.0;
    for (const PlacedBlock& placed : regular()) half = std::max<double>(half, placed.farthest);
    for (const Footprint& f : footprints_)
        if (f.inside > 0.0f && f.own_gap <= limits_.reach)
            half = std::max<double>(half, std::abs(f.s));
    return half;
}

double PlacedSamples::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for_gaps([&](std::size_t, float gap) { least = std::min<double>(least, gap); });
    return least;
}

void PlacedSamples::put_on(const ContactGrid& grid) {
    for (std::size_t k = 0; k < placed_count_; ++k)
        number_cells(placed_[k], grid.nx, (grid.nx - 1) / 2);
    for (Footprint& f : footprints_) put_on_grid(grid, f);
}

void PlacedSamples::begin_layers(const ContactGrid& grid) {
    for (Footprint& f : footprints_)
        f.on_grid = f.nearest = std::abs(f.s) <= 0.5 * (grid.nx - 1) * grid.ds;
}

Patch PlacedSamples::patch_of(const Footprint& f, const SampleBlocks& blocks) const {
    const ContactWheel& wheel = pose_.wheel();
    const Frame& contact_from_work = pose_.contact_from_work();
    const double y = std::clamp<double>(f.y, -0.5 * wheel.width, 0.5 * wheel.width);
    // Lengths round the wheel are told at its radius.
    const double round = wheel.radius / (f.own_gap + wheel.radius - wheel.drop(y));
    const double slope_s = f.slope_s * round, slope_y = f.slope_y - wheel.drop_slope(y);
    const double side = std::sqrt(static_cast<double>(f.area));
    Patch patch{f.s, f.y, 0.5 * side, 0.5 * side};
    const auto& block = blocks.block(static_cast<std::uint32_t>(f.position / kBlockLanes));
    const bool on_border = (block.border >> (f.position % kBlockLanes) & 1U) != 0;
    if (const FieldForm::Border* border = on_border ? form_.border(f.sample) : nullptr) {
        const Vec3 middle = contact_from_work.linear() * border->middle.cast<double>();
        const double angle = f.s / wheel.radius;
        const double to_s = middle.x() * std::cos(angle) - middle.z() * std::sin(angle);
        const double to_y = middle.y(), square = to_s * to_s + to_y * to_y;
        if (square > 0.0) {
            // As long as the samples are apart along the border, narrower across it.
            const double narrow = border->along > 0.0f
                                      ? side / border->along
                                      : std::min(side / blocks.field().spacing, 1.0);
            const double aspect = std::pow(narrow, (to_y * to_y - to_s * to_s) / square);
            patch.half_s /= aspect;
            patch.half_y *= aspect;
        }
        patch.s += round * to_s;
        patch.y += to_y;
    } else if (const Vec3f* way = form_.longer(f.sample)) {
        const Vec3 longer = contact_from_work.linear() * way->cast<double>();
        const double angle = f.s / wheel.radius;
        const double to_s = longer.x() * std::cos(angle) - longer.z() * std::sin(angle);
        const double to_y = longer.y(), square = to_s * to_s + to_y * to_y;
        if (square > 0.0) {
            const double aspect =
                std::pow(longer.norm(), 0.5 * (to_y * to_y - to_s * to_s) / square);
            patch.half_s /= aspect;
            patch.half_y *= aspect;
        }
    }
    patch.half_s *= round / std::sqrt(1.0 + slope_s * slope_s);
    patch.half_y /= std::sqrt(1.0 + slope_y * slope_y);
    return patch;
}

Footprint PlacedSamples::alone(const SampleBlocks& blocks, const ContactGrid& grid,
                               const PlacedBlock& placed, int lane) const {
    Footprint f = in_block(blocks, placed, lane);
    const Eigen::Vector2d at = place_of(grid, placed, static_cast<std::uint32_t>(lane));
    f.gap = placed.gap[lane];
    f.cell = placed.cell[lane];
    f.s = static_cast<float>(at.x());
    // Beyond the outermost cells' centres, weights do not tell how far.
    f.y = static_cast<float>((pose_.contact_from_work() * blocks.top_in_block(f.position)).y());
    f.slope_s = placed.slope_s[lane];
    f.slope_y = placed.slope_y[lane];
    f.u = placed.u[lane];
    f.v = placed.v[lane];
    f.inside = f.taken = 1.0F;
    f.on_grid = f.nearest = true;
    return f;
}

Footprint PlacedSamples::in_block(const SampleBlocks& blocks, const PlacedBlock& placed, int lane) {
    Footprint f{};
    f.position = std::size_t{placed.block} * kBlockLanes + static_cast<std::size_t>(lane);
    f.sample = blocks.sample(f.position);
    f.own_gap = placed.own_gap[lane];
    f.facing = placed.facing[lane];
    f.area = blocks.block(placed.block).area[static_cast<std::size_t>(lane)];
    f.cosine = f.area > 0.0f ? placed.weight[lane] / f.area : 1.0f;
    return f;
}

Eigen::Vector2d PlacedSamples::place_of(const ContactGrid& grid, const PlacedBlock& placed,
                                        std::uint32_t lane) {
    const int cell = placed.cell[lane];
    const int i = cell % grid.nx, j = cell / grid.nx;
    return {grid.s(i) + static_cast<double>(placed.u[lane]) * grid.ds,
            grid.y(j) + static_cast<double>(placed.v[lane]) * grid.dy};
}

std::optional<std::size_t> PlacedSamples::nearest_to(const ContactGrid& grid, double s,
                                                     double y) const {
    std::optional<std::size_t> found;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](std::size_t position, double at_s, double at_y) {
        const double away = (at_s - s) * (at_s - s) + (at_y - y) * (at_y - y);
        if (away >= least) return;
        least = away;
        found = position;
    };
    for (const PlacedBlock& placed : regular()) {
        for (std::uint64_t lanes = placed.regular; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
            const Eigen::Vector2d at = place_of(grid, placed, lane);
            look(std::size_t{placed.block} * kBlockLanes + lane, at.x(), at.y());
        }
    }
    for (const Footprint& f : footprints_)
        if (f.nearest) look(f.position, f.s, f.y);
    return found;
}

}  // namespace beltgrinding
