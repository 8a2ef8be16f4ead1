#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/height_field.h"
#include "contact/belt_arc.h"
#include "contact/coverage.h"
#include "contact/displaced.h"
#include "contact/placed_block.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// The current surface seen from the wheel, on the wheel's own regular grid, and the way back from
/// the grid to the samples.
///
/// Each sample's top is put into the wheel's cylinder coordinates (arc length s = R theta, axial y,
/// radius r); its gap is r - (R - drop(y)), radial. The gap of a cell is the weighted mean over the
/// samples around it (cloud-in-cell weights), each carried to the cell's centre along its own
/// tangent plane, so that a plane is reproduced exactly whatever the sampling. Where several layers
/// of the surface lie over each other, only the one nearest to the wheel counts.
///
/// The cells must not be finer than the samples: `ContactGrid` spacing >= 1.5 x field spacing.
class GapMap {
  public:
    /// `spacing`: wanted cell, mm; the axial one is adjusted to divide the wheel's width. `beside`:
    /// mm beyond the wheel's side faces up to which samples are kept for what bulges out there.
    GapMap(const ContactWheel& wheel, double spacing, double beside = 0.0);

    /// The wheel, a very large one, stands for a belt, which is flat until it is pressed: its gap
    /// is the depth below a plane, far steeper slopes are of one layer, and there is nothing beyond
    /// its free run from `from` to `to`, mm along the travel. `face`: where its face lies.
    void lie_flat(double from, double to, const BeltArc& face = {});
    /// Looks once at the borders and steps of a field and the form of its samples' patches, which
    /// `update` does otherwise.
    void prepare(const SampleBlocks& blocks);

    /// Maps the samples of the blocks `hits` (ascending) for the wheel at `work_from_contact`,
    /// which faces the work by the part of it beyond `ahead` mm from its axis. Samples that face
    /// away or that were missed by the stock's rays are left out. The grid is as long as the
    /// samples within the gap `reach` (mm) lie; of the others in these blocks those that lie on it
    /// and go on with the same layer are mapped as well.
    ///
    /// Edges of what is mapped are looked at near cells with a gap up to `pressable` mm only:
    /// `holds_for` tells whether that was enough, `look_at_all_edges` does the rest.
    void update(const SampleBlocks& blocks, std::span<const std::uint32_t> hits,
                const Frame& work_from_contact, double reach, double ahead = 0.0,
                double pressable = kNone);
    /// No cell that an edge not looked at has to do with bears pressure (MPa, by cell).
    bool holds_for(const Eigen::ArrayXd& pressure) const;
    void look_at_all_edges(const SampleBlocks& blocks);

    /// Grid of the last update; its length follows the samples in reach.
    const ContactGrid& grid() const { return grid_; }
    const Eigen::ArrayXd& gap() const { return gap_; }  ///< mm; +inf: no surface
    /// As `Coverage::share`.
    const Eigen::ArrayXd& coverage() const { return coverage_.share; }
    bool empty() const { return samples_ == 0; }
    /// Samples in reach.
    std::size_t samples() const { return samples_; }
    /// Smallest gap, mm, of a belt that to where its face lies; +inf when empty.
    double lowest() const;

    /// What bears pressure beyond the side faces from now on, until the next update.
    void reach_beside(const DisplacedPressure& pressure);
    /// mm3/s of `rate`, mm/s per cell along the surface's normal, and of `beside`, mm/s as
    /// `DisplacedPressure::beside`.
    double volume_rate(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside) const;

    /// Lowers heights by the removal of `rate` (mm/s per cell), and of `beside` (mm/s, as
    /// `DisplacedPressure::beside`), over `duration` s: the rate
    /// is interpolated at each sample, then scaled so that the samples' volume equals the cells'
    /// (`volume_rate` x duration) to rounding. No sample falls below the envelope of
    /// the undeformed wheel, moved by `approach` (mm, along the contact frame's z) from where the
    /// map was taken; what that keeps back is taken from the others, as far as they stand above it.
    /// Returns the volume, mm3. `blocks`: those of the last update.
    double remove(SampleBlocks& blocks, const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                  double duration, double approach);

    /// Lowers every sample that reaches into the wheel's envelope onto it, along its own normal: a
    /// rigid tool. Returns the volume, mm3.
    double cut(SampleBlocks& blocks) const;

    /// What `rate` and `beside` (as in `remove`) take from each sample in `duration` s, without
    /// touching it: as little as the last `remove` took where the envelope kept some back, and not
    /// scaled. Calls visit(position, mm) for those that are not 0.
    template <class Visit>
    void for_samples(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside, double duration,
                     Visit visit) const {
        tabulate(rate, duration);
        float values[kBlockLanes];
        for (std::size_t k = 0; k < placed_count_; ++k) {
            const PlacedBlock& placed = placed_[k];
            const float any = -std::numeric_limits<float>::infinity();
            if (!interpolate(placed, table_.data(), any, values)) continue;
            const float* taken = taken_of(k);
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                if (values[lane] == 0.0f) continue;
                const double share = taken != nullptr ? taken[lane] : 1.0;
                visit(std::size_t{placed.block} * kBlockLanes + lane, share * values[lane]);
            }
        }
        sum_rates(rate, beside, sums_);
        for (std::size_t k = 0; k < footprints_.size(); ++k) {
            const Footprint& f = footprints_[k];
            if (sums_[k] != 0.0) visit(f.position, f.taken * sums_[k] * duration);
        }
    }
    /// What the last `remove` scaled the samples' volume by.
    double scale() const { return scale_; }
    /// What is known from the last `update` and `remove` on where the next ones are left out.
    struct Carried {
        std::size_t samples = 0;
        double scale = 1.0;
    };
    Carried carried() const { return {samples_, scale_}; }
    void carry(const Carried& carried) {
        samples_ = carried.samples;
        scale_ = carried.scale;
    }

    /// Raises `largest` (one per position, of whole blocks) to the pressure at each sample, where
    /// that is more.
    void raise(const DisplacedPressure& pressure, std::span<float> largest) const;

    /// Calls visit(position, MPa) for the pressure at each sample, where there is some.
    template <class Visit>
    void for_pressed(const DisplacedPressure& pressure, Visit visit) const {
        const auto visit_block = [&visit](std::size_t first, const float* values) {
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane)
                if (values[lane] > 0.0f) visit(first + lane, values[lane]);
        };
        for_pressed_blocks(pressure, visit_block, visit);
    }
    /// The same, with visit_block(first position, values) for the positions of a whole block, some
    /// of which have none.
    template <class VisitBlock, class Visit>
    void for_pressed_blocks(const DisplacedPressure& pressure, VisitBlock visit_block,
                            Visit visit) const {
        tabulate(pressure.pressure, 1.0);
        float values[kBlockLanes];
        for (std::size_t k = 0; k < placed_count_; ++k) {
            if (interpolate(placed_[k], table_.data(), 0.0f, values))
                visit_block(std::size_t{placed_[k].block} * kBlockLanes, values);
        }
        for (const Footprint& f : footprints_) {
            if (!f.nearest || !(f.inside > 0.0f)) continue;
            if (const double value = at(f, pressure.pressure); value > 0.0)
                visit(f.position, value);
        }
        for (const BesidePatch& patch : beside_patches_) {
            if (!(patch.share > 0.0)) continue;
            const double value = beside_at(patch, pressure.beside);
            if (value > 0.0) visit(footprints_[patch.footprint].position, value);
        }
    }

    /// Position of the sample of the nearest layer that lies nearest to (s, y), mm; none if the map
    /// is empty.
    std::optional<std::size_t> sample_near(double s, double y) const;

    /// Of the samples near a place: the mean of where they lie (s, y; mm), which at the surface's
    /// border is not that place, and of the slopes of the design surface's gap along s and y.
    struct MeanSlope {
        Eigen::Vector2d place, slope;
    };
    /// Over the samples within `reach` mm of (s, y); NaN where there is none. By the samples' own
    /// normals: grinding does not change them. `blocks`: those of the last update.
    MeanSlope slope_near(const SampleBlocks& blocks, double s, double y, double reach) const;

  private:
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    /// A sample on the grid, shared by four cells, that is placed by itself: near an edge or a
    /// step, at the wheel's side faces, or with a ray that is not its normal.
    struct Footprint {
        double gap;  // mm, at (s, y); once on the grid, carried to the first cell's centre
        std::size_t position;
        std::uint32_t sample;
        int cell;                // the first of the four: lower s, lower y
        float s, y;              // mm
        float slope_s, slope_y;  // once on the grid, by a cell
        float u, v;              // weights of the cells of higher s, of higher y
        float shares[4];         // of the four cells in what is true at the sample; sum 1, or all 0
        float inside;            // share of its patch that lies within the wheel's width
        float own_gap;           // mm, radial, at the sample itself
        float cosine;            // of its normal against the wheel's radius
        float facing;            // cosine of the wheel's radius there against the contact's z
        float area;              // mm2, of the design surface
        float taken;             // share of what the cells' rate asked for that the envelope let go
        bool on_grid;            // else it is beyond what is in reach
        bool nearest;            // belongs to the layer nearest to the wheel
    };
    /// What a sample stands for, as a rectangle: middle and half its sides, mm.
    struct Patch {
        double s, y, half_s, half_y;
    };
    /// One near an edge, in cells, from the middle of the outermost cell of lower s and y.
    struct EdgePatch {
        std::size_t footprint;
        std::size_t end;  // of its cells in `covered_`
        float s, y, half_s, half_y;
    };
    /// What of a cell the patch of a sample near an edge covers.
    struct PatchCell {
        int cell;
        double share, along, across;  // of the cell; the middle of that from the cell's, in cells
        double carried;               // mm, the sample's gap at the cell's centre
    };
    /// Where the patch of a sample on a border has its middle, from the sample: in the work frame.
    struct BorderPatch {
        std::uint32_t sample;
        Vec3f middle;  // mm
        float along;   // mm, how far samples are apart on the border; 0: as everywhere
    };
    /// A sample whose patch reaches beyond a side face: from there outwards, mm.
    struct BesidePatch {
        std::size_t footprint;
        int side;         // 0: at -y, 1: at +y
        double from, to;  // of the patch
        double whole;     // its side along y
        double share;     // of the patch that is reached
    };
    /// What `values` (two per column, as `DisplacedPressure::beside`) are at the patch.
    double beside_at(const BesidePatch& patch, const Eigen::ArrayXd& values) const;
    /// mm that each footprint is lowered by in 1 s, if nothing holds it.
    void sum_rates(const Eigen::ArrayXd& rate, const Eigen::ArrayXd& beside,
                   std::vector<double>& sums) const;
    /// `table_` of `values` (one per cell), times `factor`.
    void tabulate(const Eigen::ArrayXd& values, double factor) const;
    /// By lane; null: all of it.
    const float* taken_of(std::size_t placed) const {
        return has_taken_[placed] != 0 ? &taken_[placed * kBlockLanes] : nullptr;
    }
    void place(const SampleBlocks& blocks, std::span<const std::uint32_t> hits);
    /// Places a sample by itself, if the wheel can press it: where its ray leans, or far round the
    /// wheel.
    void place_alone(const SampleBlocks& blocks, std::size_t position);
    /// The same of a lane at the wheel's side faces, `across` mm along the axis.
    void place_aside(const SampleBlocks& blocks, const PlacedBlock& placed, int lane, float across);
    /// Keeps a footprint, not yet on the grid, if the wheel can press what it stands for.
    void keep(Footprint f, const SampleBlocks& blocks);
    /// The rest of `update`, once all samples are placed.
    void map(const SampleBlocks& blocks, double pressable);
    /// The same where no edge, step or second layer is near what may bear pressure; false, with
    /// nothing of use done, where one may be.
    bool map_smooth(const SampleBlocks& blocks, double pressable);
    /// True where the surface steps, near what may bear pressure, by less than `whole_layer_`:
    /// `layer_` is half of the lowest such step then, else `whole_layer_`. By `low_`, `high_` and
    /// `matters_`.
    bool find_low_steps(const SampleBlocks& blocks);
    /// Which cells may bear pressure, their gaps (`nearest`, mm, by cell) being up to `pressable`.
    template <class Nearest>
    void find_pressable(const Nearest* nearest, double pressable);
    /// Regular samples near edges are placed by themselves from here on.
    void part_edges(const SampleBlocks& blocks);
    /// Keeps the footprint's patch if that reaches beyond the side faces.
    void note_beside(const Patch& patch);
    void find_borders(const HeightField& field);
    /// The samples at which the surface may step.
    void find_steps(const SampleBlocks& blocks);
    /// The patches' forms, where samples do not lie evenly.
    void find_forms(const HeightField& field);
    /// Null if the sample lies on no border.
    const BorderPatch* border_patch(std::uint32_t sample) const;
    /// Before the footprint is put on the grid.
    Patch patch_of(const Footprint& f, const SampleBlocks& blocks) const;
    /// Of a regular lane on the grid.
    Footprint footprint_at(const SampleBlocks& blocks, const PlacedBlock& placed, int lane) const;
    /// Of a regular lane, what the envelope needs to know.
    static Footprint footprint_of(const SampleBlocks& blocks, const PlacedBlock& placed, int lane);
    /// Of a belt: what lies beyond its free run is no surface; `stretch_` of the others.
    void end_flat();
    /// Finds the four cells.
    void put_on_grid(Footprint& f) const;
    /// Of the regular lane of a placed block, mm: where it lies.
    Eigen::Vector2d place_of(const PlacedBlock& placed, std::uint32_t lane) const;
    /// The one of the four that the sample lies in.
    int own_cell(const Footprint& f) const;
    /// Calls visit(cell, weight, gap carried to its centre) for each of the four.
    template <class Visit>
    void for_cells(const Footprint& f, Visit visit) const;
    /// Calls visit(PatchCell) for each cell that the patch lies on.
    template <class Visit>
    void for_patch(const EdgePatch& patch, Visit visit) const;
    void fit_grid(double half_length);
    /// For `map` to fill.
    void clear_grid();
    /// Cells beside which there is nothing, or another layer, are `kEdge`; those up to two further
    /// are `kNearEdge`. Only where cells with gaps up to `pressable` may have to do with it.
    void mark_edges(double pressable);
    /// Edge cells are covered as far as patches of their nearest layer lie on them, the others
    /// wholly.
    void cover(const SampleBlocks& blocks);
    /// The gap of each cell, at its centre.
    void average_gap();
    /// The four cells' shares in each sample: those of its layer, by how much of them is covered.
    void share_cells();
    /// The gap of cells that are covered in part, carried to the middle of that part.
    void carry_to_middles();
    /// What `values` (one per cell) are at the sample.
    double at(const Footprint& f, const Eigen::ArrayXd& values) const;
    /// How far of `wanted` mm the sample may be lowered until it lies on the envelope of the wheel,
    /// moved by `approach` mm along z.
    double down_to_envelope(const SampleBlocks& blocks, const Footprint& f, double approach,
                            double wanted) const;
    double lower_regular(SampleBlocks& blocks, double factor);

    ContactWheel wheel_;
    double steepest_flank_ = 0.0;  // of the wheel's profile, mm per mm of width
    struct Run {
        double from, to;  // mm
    };
    std::optional<Run> run_;  // of a belt
    BeltArc face_;            // the same: how its face lies
    Eigen::ArrayXd stretch_;  // of a belt: mm2 of surface by mm2 of its cells' plane; else empty
    Frame contact_from_work_ = Frame::Identity();
    ContactGrid grid_;
    double whole_layer_ = 0.0;  // mm: steps as high are told without looking for them
    double layer_ = 0.0;        // mm: what lies further behind the nearest belongs to another layer
    Coverage coverage_;
    Eigen::ArrayXd gap_, weight_;
    std::vector<double> nearest_, farthest_;  // mm, of the samples in a cell
    enum : std::uint8_t { kWhole, kNearEdge, kEdge };
    std::vector<std::uint8_t> kind_, wider_;
    std::vector<Footprint> footprints_;
    std::vector<EdgePatch> patches_;
    std::vector<PatchCell> covered_;    // by all patches, one after the other
    std::vector<BorderPatch> borders_;  // by sample
    // Along what is longer of each sample's patch, by how much more; empty: samples lie evenly.
    std::vector<Vec3f> longer_;
    double beside_ = 0.0;  // mm
    std::vector<BesidePatch> beside_patches_;
    Eigen::ArrayXd reach_;  // mm, of what bulges; empty: nothing does
    const HeightField* prepared_for_ = nullptr;
    std::size_t prepared_size_ = 0;     // samples that it had
    std::vector<std::uint64_t> steps_;  // by block: lanes beside which the surface may step
    double scale_ = 1.0;                // of the last `remove`, so that volumes are equal

    std::vector<PlacedBlock> placed_;  // `placed_count_` of them are in use
    std::size_t placed_count_ = 0, samples_ = 0;
    std::vector<ProfileStretch> profile_;
    double reach_gap_ = 0.0, seen_gap_ = 0.0, ahead_ = 0.0;  // mm
    std::vector<std::uint8_t> pressable_;  // by cell; empty: all edges were looked at
    std::vector<std::uint8_t> matters_;  // by cell: so near to a pressable one that an edge counts
    std::vector<FourCells> four_cells_;
    std::vector<float> low_, high_;        // mm, by cell, of what is in its mean
    std::vector<std::uint8_t> inhabited_;  // by cell: a sample lies in it
    /// A sample near a cell that may be stepped, in cells, and its gap there carried to the cell.
    struct NearStep {
        std::uint32_t cell;
        float carried, own;  // mm, to the cell's centre, at the sample
        std::uint32_t sample;
        float s, y;              // cells
        float slope_s, slope_y;  // mm by a cell
    };
    double step_between(const HeightField& field, std::span<NearStep> samples) const;
    std::vector<NearStep> near_steps_;
    std::vector<std::uint8_t> stepped_;    // by cell: it may be
    std::vector<float> limit_;             // mm, by cell: what lies deeper is another layer's
    mutable std::vector<Bilinear> table_;  // by cell
    std::vector<float> lowering_;          // mm, of regular lanes
    std::vector<double> volumes_;          // mm3 of that, by placed block
    std::vector<float> taken_;             // share of what the rate asked for, of regular lanes
    std::vector<std::uint8_t> has_taken_;  // by placed block; else all of it
    std::vector<std::uint8_t> active_;     // by placed block: something is taken
    std::vector<std::uint64_t> free_;      // by placed block: lanes that nothing holds
    std::vector<std::pair<std::size_t, double>> limited_;  // of `lowering_`: room, mm
    std::vector<double> asked_, room_;                     // mm, by footprint
    mutable std::vector<double> sums_;                     // mm/s, by footprint
};

/// `ContactProblem::drop` of a wheel.
Eigen::ArrayXd profile_drop(const ContactWheel& wheel, const ContactGrid& grid);

/// By how much a gap (mm, by cell) grows with an approach along the contact frame's z beyond
/// growing less by just that, mm per mm, to first order: a surface point under a wheel of radius R
/// at the arc length s comes nearer by cos(s / R) and moves along by sin(s / R). 0 where there is
/// no gap.
Eigen::ArrayXd tilt_by_approach(const ContactWheel& wheel, const ContactGrid& grid,
                                const Eigen::ArrayXd& gap);

/// Carries a pressure field from one grid to another of the same cells and another length (both are
/// centred); cells without a counterpart get 0.
Eigen::ArrayXd recentre(const Eigen::ArrayXd& values, const ContactGrid& from,
                        const ContactGrid& to);

}  // namespace beltgrinding
