#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "gap/beside_strip.h"
#include "gap/field_form.h"
#include "gap/footprint.h"
#include "gap/placed_block.h"
#include "gap/wheel_pose.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// The samples under a wheel: whole blocks of regular ones, and one by one those near edges and
/// steps, at the wheel's side faces, or with a ray that is not their normal.
class PlacedSamples {
  public:
    /// mm: gaps that are in reach, that are seen; as `GapMap::update`.
    struct Limits {
        double reach = 0.0, seen = 0.0, ahead = 0.0;
    };

    /// `beside`: as of `GapMap`.
    PlacedSamples(const ContactWheel& wheel, double beside)
        : pose_(wheel), beside_(0.5 * wheel.width, beside) {}

    FieldForm& form() { return form_; }
    const FieldForm& form() const { return form_; }
    const WheelPose& pose() const { return pose_; }
    BesideStrip& beside() { return beside_; }
    const BesideStrip& beside() const { return beside_; }

    /// Places the samples of the blocks `hits`; of the grid the cells count, and how many there are
    /// across.
    void place(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
               const Frame& work_from_contact, const ContactGrid& grid, const Limits& limits);
    /// mm, largest |s| of those in reach.
    double half_length() const;
    /// mm; +inf: there is none.
    double least_gap() const;
    /// Calls visit(position, mm that it is off the wheel) for each sample under the wheel.
    template <class Visit>
    void for_gaps(Visit visit) const {
        for (const PlacedBlock& block : regular())
            for (std::uint64_t lanes = block.regular; lanes != 0; lanes &= lanes - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
                visit(std::size_t{block.block} * kBlockLanes + lane, block.own_gap[lane]);
            }
        for (const Footprint& f : footprints_)
            if (f.inside > 0.0F) visit(f.position, f.own_gap);
    }
    /// Adds to the slopes of each sample in reach, before they are put on the grid, what
    /// more(position, s, gap; mm) gives: mm per mm round the wheel and along its axis.
    template <class More>
    void tilt(const ContactGrid& grid, More more) {
        for (std::size_t k = 0; k < placed_count_; ++k) {
            PlacedBlock& block = placed_[k];
            for (std::uint64_t lanes = block.in_reach; lanes != 0; lanes &= lanes - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
                const float u = block.u[lane], v = block.v[lane];
                const double s = (static_cast<double>(block.cell[lane]) + u) * grid.ds;
                const std::size_t position = std::size_t{block.block} * kBlockLanes + lane;
                const Eigen::Vector2d slopes = more(position, s, block.own_gap[lane]);
                const auto by_s = static_cast<float>(slopes.x() * grid.ds);
                const auto by_y = static_cast<float>(slopes.y() * grid.dy);
                block.slope_s[lane] += by_s;
                block.slope_y[lane] += by_y;
                block.gap[lane] -= u * by_s + v * by_y;
            }
        }
        for (Footprint& f : footprints_) {
            if (f.own_gap > limits_.reach) continue;
            const Eigen::Vector2d slopes = more(f.position, f.s, f.own_gap);
            f.slope_s += static_cast<float>(slopes.x());
            f.slope_y += static_cast<float>(slopes.y());
        }
    }
    /// Finds all samples' cells, now that the grid's length is known.
    void put_on(const ContactGrid& grid);
    /// All on the grid are taken for those of the nearest layer, until it is known.
    void begin_layers(const ContactGrid& grid);
    /// Regular samples in cells that `is` tells are placed by themselves from here on.
    template <class Is>
    void part(const SampleBlocks& blocks, const ContactGrid& grid, Is is) {
        for (std::size_t k = 0; k < placed_count_; ++k) {
            PlacedBlock& placed = placed_[k];
            for (std::uint64_t lanes = placed.regular; lanes != 0; lanes &= lanes - 1) {
                const int lane = std::countr_zero(lanes);
                const std::size_t own =
                    static_cast<std::size_t>(placed.cell[lane]) + (placed.u[lane] >= 0.5f ? 1 : 0) +
                    (placed.v[lane] >= 0.5f ? static_cast<std::size_t>(grid.nx) : 0);
                if (!is(own)) continue;
                placed.regular &= ~(std::uint64_t{1} << lane);
                footprints_.push_back(alone(blocks, grid, placed, lane));
            }
        }
    }

    std::span<const PlacedBlock> regular() const { return {placed_.data(), placed_count_}; }
    std::span<const Footprint> footprints() const { return footprints_; }
    std::span<Footprint> footprints() { return footprints_; }
    /// Samples in reach.
    std::size_t count() const { return count_; }
    void set_count(std::size_t count) { count_ = count; }

    /// Before the footprint is put on the grid.
    Patch patch_of(const Footprint& f, const SampleBlocks& blocks) const;
    /// Of a regular lane, what the envelope needs to know.
    static Footprint in_block(const SampleBlocks& blocks, const PlacedBlock& placed, int lane);
    /// Position of the sample of the nearest layer that lies nearest to (s, y), mm.
    std::optional<std::size_t> nearest_to(const ContactGrid& grid, double s, double y) const;
    /// Calls visit(position, place (s, y; mm), slopes of the design's gap, mm per mm) for the
    /// samples of the nearest layer within `reach` mm of (s, y).
    template <class Visit>
    void for_near(const SampleBlocks& blocks, const ContactGrid& grid, double s, double y,
                  double reach, Visit visit) const {
        const auto column = static_cast<float>(s / grid.ds + 0.5 * (grid.nx - 1));
        const auto row = static_cast<float>(y / grid.dy + 0.5 * (grid.ny - 1));
        for (const PlacedBlock& placed : regular()) {
            std::uint64_t lanes =
                lanes_near(placed, grid.nx, column, row, static_cast<float>(grid.ds),
                           static_cast<float>(grid.dy), static_cast<float>(reach));
            for (; lanes != 0; lanes &= lanes - 1) {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
                // Beyond the outermost cells' centres, weights do not tell how far.
                const std::size_t position = std::size_t{placed.block} * kBlockLanes + lane;
                const double across =
                    (pose_.contact_from_work() * blocks.top_in_block(position)).y();
                visit_design(blocks, position, {place_of(grid, placed, lane).x(), across},
                             placed.own_gap[lane], visit);
            }
        }
        for (const Footprint& f : footprints_)
            if (f.nearest && (f.s - s) * (f.s - s) + (f.y - y) * (f.y - y) <= reach * reach)
                visit_design(blocks, f.position, {f.s, f.y}, f.own_gap, visit);
    }

  private:
    /// Visits a sample that lies `at`, for `for_near`.
    template <class Visit>
    void visit_design(const SampleBlocks& blocks, std::size_t position, const Eigen::Vector2d& at,
                      double gap, Visit visit) const {
        const Vec3 normal = blocks.field().normal[blocks.sample(position)].cast<double>();
        const double half = 0.5 * pose_.wheel().width;
        Eigen::Vector2d slopes = pose_.slopes(normal, at.x(), gap);
        slopes.y() += pose_.wheel().drop_slope(std::clamp(at.y(), -half, half));
        visit(position, at, slopes);
    }
    /// Places a sample by itself, if the wheel can press it: where its ray leans, or far round the
    /// wheel.
    void place_alone(const SampleBlocks& blocks, std::size_t position);
    /// The same of a lane at the wheel's side faces, `across` mm along the axis.
    void place_aside(const SampleBlocks& blocks, const ContactGrid& grid, const PlacedBlock& placed,
                     int lane, float across);
    /// Keeps a footprint, not yet on the grid, if the wheel can press what it stands for.
    void keep(Footprint f, const SampleBlocks& blocks);
    /// Of a regular lane on the grid.
    Footprint alone(const SampleBlocks& blocks, const ContactGrid& grid, const PlacedBlock& placed,
                    int lane) const;
    /// Of the regular lane of a placed block, mm: where it lies.
    static Eigen::Vector2d place_of(const ContactGrid& grid, const PlacedBlock& placed,
                                    std::uint32_t lane);

    WheelPose pose_;
    FieldForm form_;
    BesideStrip beside_;
    Limits limits_;
    std::vector<PlacedBlock> placed_;  // `placed_count_` of them are in use
    std::size_t placed_count_ = 0, count_ = 0;
    std::vector<Footprint> footprints_;
};

}  // namespace beltgrinding
