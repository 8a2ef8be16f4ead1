#include "gap/gap_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beltgrinding {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr int kGridQuantum = 8;  // grid lengths are multiples, so that warm starts mostly fit
constexpr double kLayer = 0.5;  // cells: samples further behind the nearest belong to another layer
constexpr double kFlatLayer = 2.0;  // the same under a belt, which wraps slopes of up to 60 degrees

ContactGrid grid_across(const ContactWheel& wheel, const Noses::Sides& sides) {
    ContactGrid grid;
    grid.ds = sides.along;
    grid.ny = std::max(1, static_cast<int>(std::lround(wheel.width / sides.across)));
    grid.dy = wheel.width / grid.ny;
    return grid;
}

}  // namespace

GapMap::GapMap(const ContactWheel& wheel, double spacing, double beside)
    : grid_(grid_across(wheel, {spacing, spacing})),
      noses_(spacing),
      sides_(noses_.widest()),
      placed_(wheel, beside),
      cells_(kLayer * std::max(grid_.ds, grid_.dy), true) {}

void GapMap::lie_flat(double from, double to, const BeltArc& face) {
    run_ = Run{from, to};
    face_ = face;
    // It bridges steps.
    cells_ = CellGaps(kFlatLayer * std::max(grid_.ds, grid_.dy), false);
}

double GapMap::lowest() const {
    if (cells_.gap().size() == 0) return kNothing;
    if (face_.flat()) return cells_.gap().minCoeff();
    double least = kNothing;
    for (int cell = 0; cell < grid_.cells(); ++cell)
        if (std::isfinite(cells_.gap()[cell]))
            least = std::min(least, cells_.gap()[cell] + face_.behind(grid_.s(cell % grid_.nx)));
    return least;
}

void GapMap::end_flat() {
    if (!run_) return;
    const int nx = grid_.nx;
    for (int i = 0; i < nx; ++i) {
        if (grid_.s(i) > run_->from && grid_.s(i) < run_->to) continue;
        for (int cell = i; cell < grid_.cells(); cell += nx) cells_.leave_out(cell);
    }
    const Eigen::ArrayXd& gap = cells_.gap();
    // The slope to the neighbours that there are.
    const auto slope = [&](int cell, int step, bool has_before, bool has_after) {
        const bool before = has_before && std::isfinite(gap[cell - step]);
        const bool after = has_after && std::isfinite(gap[cell + step]);
        const double rise =
            (after ? gap[cell + step] : gap[cell]) - (before ? gap[cell - step] : gap[cell]);
        return before && after ? 0.5 * rise : rise;
    };
    stretch_.setOnes(grid_.cells());
    for (int cell = 0; cell < grid_.cells(); ++cell) {
        if (!std::isfinite(gap[cell])) continue;
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
}

void GapMap::place(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
                   const Frame& work_from_contact, const PlacedSamples::Limits& limits) {
    placed_.place(blocks, hits, work_from_contact, grid_, limits);
    if (run_) return;
    const Noses::Sides widest = noses_.widest();
    const Noses::Sides wanted = noses_.sides(placed_, blocks);
    if (wanted != sides_) {
        sides_ = wanted;
        grid_ = grid_across(placed_.pose().wheel(), wanted);
        // Within the shorter side a nose falls off by so much.
        const double side =
            wanted == widest ? std::max(grid_.ds, grid_.dy) : std::min(grid_.ds, grid_.dy);
        cells_.set_layer(kLayer * side, wanted != widest);
        placed_.place(blocks, hits, work_from_contact, grid_, limits);
    }
    noses_.follow_the_ground(placed_, blocks, grid_);
}

void GapMap::update(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
                    const Frame& work_from_contact, double reach, double ahead, double pressable) {
    prepare(blocks);
    // Else the surface had edges where its gap is `reach`.
    const double seen = reach + behind();
    place(blocks, hits, work_from_contact, {reach, seen, ahead});
    removal_.start(placed_.regular().size());
    fit_grid(placed_.half_length());
    placed_.put_on(grid_);
    profiles_.clear();
    cells_.clear(grid_);
    cells_.map(placed_, blocks, grid_, pressable);
    end_flat();
}

void GapMap::look_at_all_edges(const SampleBlocks& blocks) {
    profiles_.clear();
    cells_.clear(grid_);
    cells_.map(placed_, blocks, grid_, EdgeCells::kAll);
    end_flat();
}

void GapMap::reach_beside(const DisplacedPressure& pressure) {
    placed_.beside().reach(pressure, grid_, placed_.footprints(), coverage(), gap(),
                           cells_.layer());
}

double GapMap::volume_rate(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside) const {
    if (run_) return (rate * coverage() * stretch_).sum() * grid_.cell_area();
    const double within = (rate * coverage()).sum() * grid_.cell_area();
    return within + placed_.beside().volume_rate(grid_, beside);
}

double GapMap::remove(SampleBlocks& blocks, const Eigen::ArrayXd& rate,
                      const Eigen::ArrayXd& beside, double duration, double approach) {
    const double volume = volume_rate(rate, beside) * duration;
    if (!(volume > 0.0)) return 0.0;
    return removal_.remove(placed_, blocks, grid_, {rate, beside, duration}, volume, approach);
}

void GapMap::raise(const DisplacedPressure& pressure, std::span<float> largest) const {
    const Bilinear* table = table_.fill(grid_, pressure.pressure, 1.0);
    for (const PlacedBlock& block : placed_.regular())
        raise_to(block, table, &largest[std::size_t{block.block} * kBlockLanes]);
    const auto footprints = placed_.footprints();
    const auto to = [&](const Footprint& f, double value) {
        largest[f.position] = std::max(largest[f.position], static_cast<float>(value));
    };
    for (const Footprint& f : footprints)
        if (f.nearest && f.inside > 0.0f) to(f, value_at(grid_, f, pressure.pressure));
    placed_.beside().for_reached(
        grid_, footprints, pressure.beside,
        [&](std::size_t footprint, double, double value) { to(footprints[footprint], value); });
}

GapMap::MeanSlope GapMap::slope_near(const SampleBlocks& blocks, double s, double y,
                                     double reach) const {
    MeanSlope mean{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    int count = 0;
    placed_.for_near(
        blocks, grid_, s, y, reach,
        [&](std::size_t position, const Eigen::Vector2d& place, const Eigen::Vector2d& slopes) {
            if (noses_.worn_through(blocks, position)) return;
            mean.place += place;
            mean.slope += slopes;
            ++count;
        });
    return {mean.place / count, mean.slope / count};
}

}  // namespace beltgrinding
