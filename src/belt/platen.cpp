#include "belt/platen.h"
#include "belt/face_arc.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

#include "belt_loads.h"
#include "belt_path.h"
#include "belt_solver.h"
#include "contact/peak_pressure.h"
#include "layer_pressure.h"
#include "surface_under_belt.h"

namespace beltgrinding {
namespace {

// Radius of a rim that is flat: its layers' stiffness differs by thickness / radius.
constexpr double kFlat = 1000.0;          // mm
constexpr double kFlatThicknesses = 100;  // the same, in thicknesses
constexpr double kSeen = 1e-3;            // mm along a curved platen's path, that the work moves
constexpr int kMostSeen = 8;              // times that it is seen from there anew
constexpr double kSpring = 1.4;           // times the layers' stiffness under even pressure

/// The belt that touches nothing, and what of it lies over the layers.
struct OverPlate {
    BeltPath path;
    std::vector<int> cell;         // of the layers' grid along x, by column; -1: none
    std::vector<std::uint8_t> on;  // by column: the platen is there
    int cells = 0;                 // of the layers' grid along x
    /// MPa that the belt's tension presses on a curved platen with, by column; empty: a flat one.
    std::vector<double> bearing;
};

OverPlate over_plate(const AbrasiveBelt& belt, const BeltRun& run, const Platen& platen,
                     const ContactGrid& grid) {
    OverPlate over;
    const BeltArc middle = middle_arc(belt, platen);
    if (middle.flat()) {
        over.path = straight_path(run, grid.ds, grid.nx);
        over.cell = over.path.cell;
        over.cells = grid.nx;
        for (const double x : over.path.x)
            over.on.push_back(std::abs(x) < 0.5 * platen.length ? 1 : 0);
        return over;
    }
    BentPath bent = bent_path(run, middle, belt.thickness, grid.ds, grid.nx);
    for (const double turn : bent.path.turn) over.bearing.push_back(belt.tension * turn);
    over.path = std::move(bent.path);
    over.cell = std::move(bent.column);
    over.on = std::move(bent.on);
    over.cells = bent.fine;
    return over;
}

/// The layers under the belt. Their pressure is that of springs, about as stiff as the layers
/// are under even pressure, from where they are at rest under the pressure of all others; that is
/// followed until it is true.
class LayerBacking final : public BeltBacking {
  public:
    /// `layers`: none, the plate alone; `face`: MPa/mm between belt and layers.
    LayerBacking(ComplianceOperator* layers, double face, const OverPlate& over)
        : layers_(layers), face_(face), cell_(over.cell), on_(over.on), bearing_(over.bearing) {
        stiffness_ = face_;
        if (layers_ == nullptr) return;
        // Following converges while no pressure sinks in more than twice as far as the springs do.
        ones_.setOnes(layers_->grid().cells());
        layers_->apply(ones_, ones_, sunk_);
        stiffness_ = kSpring / (1.0 / face_ + sunk_.maxCoeff());
    }
    /// `pressure`: of the layers, MPa, to start from; empty: none.
    void start(Eigen::Index rows, const Eigen::ArrayXd& pressure) {
        rest_.resize(rows, static_cast<Eigen::Index>(cell_.size()));
        for (std::size_t i = 0; i < cell_.size(); ++i)
            rest_.col(static_cast<Eigen::Index>(i))
                .setConstant(on_[i] != 0 ? -borne(i) / stiffness_
                                         : std::numeric_limits<double>::infinity());
        if (layers_ == nullptr) return;
        pressure_.setZero(layers_->grid().cells());
        if (!bearing_.empty()) {
            // Where the belt lies that touches nothing, the layers have sunk in already.
            for_cells([&](Eigen::Index, Eigen::Index column,
                          int cell) { pressure_[cell] = borne(static_cast<std::size_t>(column)); },
                      layers_->grid().nx);
            layers_->apply(pressure_, ones_, sunk_at_rest_);
        }
        const bool known = pressure.size() == pressure_.size();
        if (known) pressure_ = pressure;
        if (known || !bearing_.empty()) follow_pressure();
    }
    const Eigen::ArrayXd& pressure() const { return pressure_; }
    double follow(const Eigen::ArrayXXd& deflection) override {
        if (layers_ == nullptr) return 0.0;
        const int nx = layers_->grid().nx;
        Eigen::ArrayXd now = Eigen::ArrayXd::Zero(pressure_.size());
        for_cells(
            [&](Eigen::Index row, Eigen::Index column, int cell) {
                now[cell] =
                    std::max(0.0, stiffness_ * (deflection(row, column) - rest_(row, column)));
            },
            nx);
        const double change = (now - pressure_).abs().sum() / std::max(now.sum(), 1e-300);
        pressure_ = mixing_.next(pressure_, now);
        follow_pressure();
        return change;
    }

  private:
    /// Where the springs are at rest under the layers' pressure.
    void follow_pressure() {
        const int nx = layers_->grid().nx;
        layers_->apply(pressure_, ones_, sunk_);
        for_cells(
            [&](Eigen::Index row, Eigen::Index column, int cell) {
                rest_(row, column) =
                    sunk_[cell] + pressure_[cell] * (1.0 / face_ - 1.0 / stiffness_);
                if (bearing_.empty()) return;
                rest_(row, column) -=
                    sunk_at_rest_[cell] + borne(static_cast<std::size_t>(column)) / face_;
            },
            nx);
    }
    /// MPa that the layers bear under a column that touches nothing.
    double borne(std::size_t column) const { return bearing_.empty() ? 0.0 : bearing_[column]; }
    template <class Visit>
    void for_cells(Visit visit, int nx) const {
        for (std::size_t i = 0; i < cell_.size(); ++i) {
            if (cell_[i] < 0 || on_[i] == 0) continue;
            for (Eigen::Index row = 0; row < rest_.rows(); ++row)
                visit(row, static_cast<Eigen::Index>(i), static_cast<int>(row) * nx + cell_[i]);
        }
    }

    ComplianceOperator* layers_;
    double face_;
    std::vector<int> cell_;         // of the grid along x, by column
    std::vector<std::uint8_t> on_;  // by column: the platen is there
    std::vector<double> bearing_;   // as `OverPlate::bearing`
    Eigen::ArrayXd pressure_, sunk_, ones_, sunk_at_rest_;
    // The springs come to rest by a constant share each time.
    PressureMixing mixing_;
};

class PreparedPlaten final : public PreparedContact {
  public:
    PreparedPlaten(const ContactGrid& grid, std::string description, const AbrasiveBelt& belt,
                   const BeltRun& run, const Platen& platen, const WheelRim* layers)
        : PreparedContact(grid, std::move(description)),
          belt_(belt),
          run_(run),
          platen_(platen),
          middle_(middle_arc(belt, platen)),
          over_(over_plate(belt, run, platen, grid)),
          solver_(belt, run, grid, BeltSolver::Sheet::kThick) {
        const auto rows = static_cast<int>(solver_.rows().size());
        if (layers == nullptr || rows == 0 || over_.cells == 0) return;
        double cell = grid.ds;  // on the layers, which the belt's face lies above
        if (!middle_.flat()) cell *= platen.radius / (platen.radius + belt.thickness);
        layers_ = layers->compliance({over_.cells, rows, cell, belt.width / rows});
    }

    std::shared_ptr<const ContactMemory> memory() const override {
        return std::make_shared<const Memory>(last_);
    }
    void remember(const std::shared_ptr<const ContactMemory>& memory) override {
        if (const auto* last = dynamic_cast<const Memory*>(memory.get())) last_ = last->last;
    }

  private:
    ContactSolution do_solve(const ContactProblem& problem, const Eigen::ArrayXd* start) override {
        ContactSolution solution;
        solution.pressure = Eigen::ArrayXd::Zero(grid().cells());
        solution.converged = !problem.force_control || problem.force == 0.0;
        solution.approach = problem.force_control ? 0.0 : problem.approach;
        if (problem.force_control && problem.force == 0.0) return solution;
        const SurfaceUnderBelt surface(grid(), problem, solver_.rows(), belt_.thickness);
        // Under a force, the work is lifted from where it touches.
        double depth = problem.approach;
        if (problem.force_control) {
            depth = std::numeric_limits<double>::infinity();
            for (const RidgePoint& p : surface.ridge())
                depth = std::min(depth, middle_.behind(p.x) - p.z);
            if (!std::isfinite(depth)) return solution;
        }
        BeltPath path = over_.path;
        LayerBacking backing(layers_.get(), face(), over_);
        const bool warm = start != nullptr && last_.pressure.size() == start->size() &&
                          (*start == last_.pressure).all();
        if (warm && problem.force_control) depth = last_.depth;
        BeltState before = warm ? std::move(last_.state) : BeltState{};
        backing.start(static_cast<Eigen::Index>(solver_.rows().size()),
                      warm ? last_.layers.next() : Eigen::ArrayXd{});
        std::vector<std::uint8_t> touching;
        if (start != nullptr && (*start > 0.0).any())
            touching = middle_.flat() ? pressed(path, *start)
                                      : pressed_columns(solver_, grid(), path, *start);
        BeltState state;
        for (int seen = 1, iterations = 0;; ++seen) {
            BeltGap gap = surface.seen_from(path, depth);
            // The contact frame's origin lies on the face as the platen has bent it.
            if (!middle_.flat()) gap.reach -= solver_.face_moved_by(1.0 / middle_.radius);
            BeltSolver::Request request;
            request.problem = &problem;
            request.gap = &gap;
            request.depth = depth;
            request.backing = &backing;
            request.touching = std::move(touching);
            if (before.deflection.size() > 0) request.before = &before;
            state = solver_.solve(std::move(path), std::move(request));
            iterations += state.iterations;
            state.iterations = iterations;
            // Where the path leans, lifting moves the work along it as well.
            if (std::abs(state.lift) * std::sin(middle_.end) <= kSeen || !state.converged) break;
            if (seen == kMostSeen) {
                state.converged = false;
                break;
            }
            depth += state.lift;
            path = over_.path;
            touching.clear();
            for (Eigen::Index k = 0; k < state.load.size(); ++k)
                touching.push_back(state.load.data()[k] > 0.0 ? 1 : 0);
            before = std::move(state);
        }
        if (middle_.flat())
            add_pressure(problem.coverage, state, solution.pressure);
        else
            solution.pressure =
                pressure_on_grid(solver_, grid(), problem.coverage, belt_.thickness, state);
        solution.approach = depth + state.lift;
        solution.force = (solution.pressure * problem.coverage).sum() * grid().cell_area();
        solution.area =
            (solution.pressure > 0.0).select(problem.coverage, 0.0).sum() * grid().cell_area();
        solution.peak_pressure = peak_pressure(grid(), solution.pressure, problem.coverage);
        solution.iterations = state.iterations;
        solution.converged = state.converged;
        LastLayers layers = warm ? std::move(last_.layers) : LastLayers{};
        layers.add(backing.pressure());
        last_ = {solution.pressure, std::move(state), std::move(layers), solution.approach};
        return solution;
    }
    /// Of a flat platen, whose columns are the grid's.
    void add_pressure(const Eigen::ArrayXd& coverage, const BeltState& state,
                      Eigen::ArrayXd& pressure) const {
        for (int i = 0; i < state.path.columns.count(); ++i) {
            const int column = state.path.cell[static_cast<std::size_t>(i)];
            if (column < 0) continue;
            for (std::size_t k = 0; k < solver_.rows().size(); ++k) {
                const int cell = solver_.rows()[k].row * grid().nx + column;
                if (coverage[cell] > 0.0)
                    pressure[cell] += state.load(static_cast<Eigen::Index>(k), i) /
                                      (grid().cell_area() * coverage[cell]);
            }
        }
    }
    double face() const {
        return platen_.layer_surface_stiffness > 0.0 ? platen_.layer_surface_stiffness
                                                     : belt_.face();
    }
    std::vector<std::uint8_t> pressed(const BeltPath& path, const Eigen::ArrayXd& start) const {
        std::vector<std::uint8_t> result;
        for (std::size_t i = 0; i < path.x.size(); ++i)
            for (const BeltRow& row : solver_.rows())
                result.push_back(
                    path.cell[i] >= 0 && start[row.row * grid().nx + path.cell[i]] > 0.0 ? 1 : 0);
        return result;
    }

    AbrasiveBelt belt_;
    BeltRun run_;
    Platen platen_;
    BeltArc middle_;  // how the belt's middle surface lies that touches nothing
    OverPlate over_;
    BeltSolver solver_;
    std::unique_ptr<ComplianceOperator> layers_;
    // Of the last solution: its stress and its layers' pressure, and the one before's, for one that
    // starts from it.
    struct Last {
        Eigen::ArrayXd pressure;
        BeltState state;
        LastLayers layers;
        double depth = 0.0;
    } last_;
    struct Memory final : ContactMemory {
        explicit Memory(const Last& given) : last(given) {}
        std::size_t bytes() const override {
            return static_cast<std::size_t>(last.pressure.size()) * sizeof(double) +
                   last.layers.bytes() + last.state.bytes();
        }
        Last last;
    };
};

}  // namespace

PlatenBelt::PlatenBelt(const AbrasiveBelt& belt, const BeltRun& run, const Platen& platen,
                       std::shared_ptr<RimCache> cache)
    : belt_(belt), run_(run), platen_(platen) {
    belt_.validate();
    run_.validate();
    platen_.validate();
    if (platen_.layers.empty()) return;
    WheelRimDesign design;
    design.width = belt_.width;
    for (const auto& layer : platen_.layers)
        design.layers.push_back({layer.thickness, {layer.youngs_modulus, layer.poissons_ratio}});
    design.outer_radius = platen_.radius > 0.0
                              ? platen_.radius
                              : std::max(kFlat, kFlatThicknesses * design.thickness());
    layers_ = std::make_unique<WheelRim>(std::move(design), BeltPlate{}, std::move(cache));
}

double PlatenBelt::thickness() const {
    return layers_ ? layers_->thickness() : std::numeric_limits<double>::infinity();
}

std::string PlatenBelt::describe() const {
    std::ostringstream text;
    text << "platen, " << platen_.length << " mm long";
    if (platen_.radius > 0.0) text << ", R " << platen_.radius << " mm";
    for (const auto& layer : platen_.layers)
        text << ", " << layer.thickness << " mm of E " << layer.youngs_modulus << " MPa, nu "
             << layer.poissons_ratio;
    text << "; belt " << belt_.width << " mm wide, " << belt_.thickness << " mm thick, E "
         << belt_.youngs_modulus << " MPa, " << belt_.tension << " N/mm";
    return text.str();
}

std::unique_ptr<PreparedContact> PlatenBelt::do_prepare(const ContactGrid& grid) const {
    return std::make_unique<PreparedPlaten>(grid, describe(), belt_, run_, platen_, layers_.get());
}

}  // namespace beltgrinding
