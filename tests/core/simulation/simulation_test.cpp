#include "beltgrinding/simulation.h"
#include "elastic/half_space.h"
#include "elastic/wheel_rim.h"
#include "recorders/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "beltgrinding/error.h"
#include "support/hammann.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kCoefficient = 1e-4;  // mm2/N

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    o.process.belt_speed = 20000.0;
    return o;
}

/// Mean removal over the samples of the plate's middle third in x, on the lines |y - centre| <=
/// half.
double mean_removal(const HeightField& field, double centre, double half) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3& p = field.point[i];
        if (p.x() < 45.0 || p.x() > 75.0 || std::abs(p.y() - centre) > half) continue;
        sum += field.stock_height[i] - field.height[i];
        ++count;
    }
    return sum / count;
}

TEST(Simulation, APassOverAPlateRemovesHammannsDepthByBothLaws) {
    const double feed = 40.0;
    const ToolPath path({pressing_down(10, 30, 0.5, feed), pressing_down(110, 30, 0.5, feed)}, {});
    const double depth = testing::hammann_depth(kCoefficient, 1.0, 20000.0, 40.0, feed, 20.0);
    for (const double spacing : {0.3, 0.5, 0.8}) {
        for (const bool global : {false, true}) {
            HeightField field = testing::plate(120.0, 60.0, spacing, 0.5);
            ElasticFoundation foundation(0.5);
            const std::unique_ptr<RemovalLaw> law =
                global ? std::unique_ptr<RemovalLaw>(std::make_unique<HammannLaw>(kCoefficient))
                       : std::make_unique<LocalLaw>(LocalLawParameters{kCoefficient});
            const SimulationResult result = simulate(field, path, foundation, *law, options());
            EXPECT_NEAR(mean_removal(field, 30.0, 8.0), depth, 0.01 * depth) << spacing << global;
            EXPECT_NEAR(result.removed_volume, result.integrated_rate,
                        0.01 * result.removed_volume);
            const double whole = kCoefficient * 20000.0 * 40.0 * 100.0 / feed;  // K V_b F t
            EXPECT_NEAR(result.removed_volume, whole, 0.01 * whole);
        }
    }
}

TEST(Simulation, HalvingTheStepsChangesTheResultByLessThanOnePercent) {
    const double feed = 30.0;
    const ToolPath path(
        {pressing_down(5, 20, 0.4, feed, 0.5), pressing_down(30, 22, 0.4, feed, 0.2),
         pressing_down(50, 18, 0.4, feed, -0.3)},
        {});
    std::vector<HeightField> ground;
    for (const double travel : {1.0, 0.5}) {
        HeightField field = testing::plate(60.0, 40.0, 0.4, 0.4);
        ElasticFoundation foundation(0.5);
        SimulationOptions o = options();
        o.resolution.max_travel = travel;
        simulate(field, path, foundation, LocalLaw({kCoefficient}), o);
        ground.push_back(std::move(field));
    }
    double difference = 0.0, removed = 0.0;
    for (std::size_t i = 0; i < ground[0].size(); ++i) {
        difference += std::abs(ground[0].height[i] - ground[1].height[i]) * ground[0].area[i];
        removed += (0.4 - ground[1].height[i]) * ground[0].area[i];
    }
    EXPECT_LT(difference, 0.01 * removed);
}

TEST(Simulation, PositionControlStopsAtTheWheelsEnvelope) {
    // Standing still for long: the foundation relaxes, until the surface is the wheel's own.
    HeightField field = testing::plate(40.0, 40.0, 0.4, 0.3);
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.process.force_control = false;
    const ToolPath path({pressing_down(20, 20, 0.0, 1e-3), pressing_down(20.0, 20.001, 0.0, 1e-4)},
                        {});
    simulate(field, path, foundation, LocalLaw({1e-3}), o);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3& p = field.point[i];
        // A cell within the edge, where cells are covered in part.
        if (std::abs(p.y() - 20.0) > 8.5 || std::abs(p.x() - 20.0) > 4.0) continue;
        const double envelope = 60.0 - std::sqrt(3600.0 - std::pow(p.x() - 20.0, 2));
        EXPECT_NEAR(field.height[i], std::min(0.3, envelope), 0.01);
    }
}

TEST(Simulation, ForceIsHeldAndTimeIsTheRobots) {
    HeightField field = testing::cylinder(70.0, 80.0, 40.0, 0.5, 0.3);
    ElasticFoundation foundation(0.5);
    // Over the crown of the cylinder, 1 mm off the surface at the ends: the force control follows.
    const ToolPath path({pressing_down(-10, 20, 0.3, 20.0), pressing_down(10, 20, 0.3, 20.0)}, {});
    const SimulationResult result =
        simulate(field, path, foundation, LocalLaw({kCoefficient}), options());
    EXPECT_NEAR(result.process_time, 1.0, 1e-12);
    for (const StepRecord& step : result.steps) {
        EXPECT_NEAR(step.force, 40.0, 0.1);
        EXPECT_GT(step.contact_area, 20.0);
    }
    EXPECT_TRUE(result.events.empty());
}

TEST(Simulation, ForceBeyondTheTravelIsAnEvent) {
    HeightField field = testing::plate(40.0, 40.0, 0.5, 0.0);
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.process.force_travel = 0.2;
    const ToolPath path({pressing_down(10, 20, 0.15, 20.0), pressing_down(30, 20, 0.15, 20.0)}, {});
    const SimulationResult result = simulate(field, path, foundation, LocalLaw({1e-6}), o);
    ASSERT_EQ(result.events.size(), 1u);
    EXPECT_EQ(result.events[0].kind, "force_not_reached");
    EXPECT_LT(result.events[0].value, 40.0);
    EXPECT_NEAR(result.events[0].duration, 1.0, 1e-6);
}

TEST(Simulation, ASoftRobotGivesWayUnderPositionControl) {
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.process.force_control = false;
    const ToolPath path({pressing_down(15, 20, -0.5, 20.0), pressing_down(25, 20, -0.5, 20.0)}, {});
    std::vector<double> forces;
    for (const double stiffness : {0.0, 1e5, 100.0}) {
        HeightField field = testing::plate(40.0, 40.0, 0.5, 0.0);
        o.process.robot_stiffness = stiffness;
        const SimulationResult result = simulate(field, path, foundation, LocalLaw({1e-9}), o);
        forces.push_back(result.steps[5].force);
        if (stiffness > 0.0) {
            EXPECT_NEAR(result.steps[5].approach, -result.steps[5].force / stiffness, 1e-3);
        }
    }
    EXPECT_NEAR(forces[1], forces[0], 0.01 * forces[0]);
    EXPECT_LT(forces[2], 0.7 * forces[0]);
}

TEST(Simulation, NothingIsGroundBelowTheUnloadedWheel) {
    // Far too deep and far too eager a law: what remains is the wheel's envelope.
    HeightField field = testing::plate(40.0, 40.0, 0.5, 0.3);
    field.depth = 10.0;
    WheelRimDesign design;
    design.outer_radius = options().process.wheel.radius;
    design.width = options().process.wheel.width;
    design.layers = {{15.0, {5.0, 0.45}}};
    WheelRim rim(design);
    SimulationOptions o = options();
    o.process.force_control = false;
    const ToolPath path({pressing_down(18, 20, -5.0, 5.0), pressing_down(22, 20, -5.0, 5.0)}, {});
    simulate(field, path, rim, LocalLaw({1.0}), o);
    const double lowest = *std::min_element(field.height.begin(), field.height.end());
    EXPECT_LT(lowest, -4.5);
    EXPECT_GT(lowest, -5.5);  // the cells' interpolation to the samples
}

/// The pressure at a plate's end as theory has it: the wheel stands `overhang` mm beyond the end,
/// on cells of a quarter of a millimetre with the share that the plate truly covers.
class EndOfAPlate {
  public:
    EndOfAPlate(const ElasticModel& model, const ProcessSettings& process, double overhang)
        : radius_(process.wheel.radius), overhang_(overhang), contact_(model.prepare(kFine)) {
        ContactProblem problem;
        problem.force = process.force;
        problem.gap.resize(kFine.cells());
        problem.coverage.resize(kFine.cells());
        centre_ = std::sqrt(radius_ * radius_ - overhang * overhang);  // touches the end
        for (int k = 0; k < 20; ++k) {
            set_cells(problem);
            solution_ = contact_->solve(problem);
            centre_ -= solution_.approach;
            if (std::abs(solution_.approach) < 1e-3) break;
        }
        coverage_ = problem.coverage;
    }
    /// Where the cells' border at the arc length s lies on the plate, mm from its end.
    double place(double s) const { return centre_ * std::tan(s / radius_) - overhang_; }
    /// N/mm across the wheel, that the plate bears within `reach` mm of its end.
    double load(double reach) const {
        double sum = 0.0;
        for (int i = 0; i < kFine.nx; ++i) {
            const double a = std::max(place(kFine.s(i) - 0.5 * kFine.ds), 0.0);
            const double b = place(kFine.s(i) + 0.5 * kFine.ds);
            if (b <= a) continue;
            const double share = std::clamp((reach - a) / (b - a), 0.0, 1.0);
            for (int j = 0; j < kFine.ny; ++j) {
                const int c = j * kFine.nx + i;
                sum += share * solution_.pressure[c] * coverage_[c] * kFine.ds / kFine.ny;
            }
        }
        return sum;
    }

  private:
    static constexpr ContactGrid kFine{225, 20, 0.25, 1.0};

    void set_cells(ContactProblem& problem) const {
        for (int c = 0; c < kFine.cells(); ++c) {
            const double s = kFine.s(c % kFine.nx);
            const double low = place(s - 0.5 * kFine.ds), high = place(s + 0.5 * kFine.ds);
            const double share = std::clamp(high / (high - low), 0.0, 1.0);
            const double middle = s + 0.5 * (1.0 - share) * kFine.ds;  // of what is covered
            problem.coverage[c] = share;
            problem.gap[c] = share > 0.0 ? centre_ / std::cos(middle / radius_) - radius_
                                         : std::numeric_limits<double>::infinity();
        }
    }

    double radius_, overhang_, centre_ = 0.0;
    std::unique_ptr<PreparedContact> contact_;
    ContactSolution solution_;
    Eigen::ArrayXd coverage_;
};

// A sharp end is pressed the harder the farther the wheel stands beyond it: its outer millimetre 3
// times (0 mm beyond) to 6 times (12 mm beyond) as hard as the middle of the plate. The cells there
// must bear that load and no other, the last two of them together. A rim yields under a sliver of a
// cell as under a whole one, so that a sliver, which takes a whole cell's load, came out at 75
// times the pressure amid the plate: no cell bears any that is covered by less than a quarter.
TEST(Simulation, TheEndOfAPlateBearsItsTrueLoad) {
    WheelRimDesign design;
    design.outer_radius = options().process.wheel.radius;
    design.width = options().process.wheel.width;
    design.layers = {{15.0, {5.0, 0.45}}};
    const WheelRim rim(design);
    const ProcessSettings process = options().process;
    for (const double overhang : {0.0, 1.3, 2.6, 3.9, 5.2, 6.5, 7.8, 9.1, 10.4, 11.7}) {
        const EndOfAPlate truth(rim, process, overhang);
        for (const double length : {60.0, 60.2, 60.4}) {
            const HeightField field = testing::plate(length, 40.0, 0.6, 0.2);
            const ToolPath path({pressing_down(-overhang, 20, 0.2, 30.0),
                                 pressing_down(length + overhang, 20, 0.2, 30.0)},
                                {});
            for (const bool far : {false, true}) {
                SCOPED_TRACE(::testing::Message() << overhang << " mm beyond " << length << " mm");
                const PoseContact end = contact_at(field, path, far ? 1 : 0, rim, process);
                const ContactGrid& grid = end.grid;
                double load = 0.0;
                for (int k = 0, columns = 0; columns < 2 && k < grid.nx; ++k) {
                    const int i = far ? grid.nx - 1 - k : k;  // from the end inwards
                    double column = 0.0, width = grid.ds;
                    for (int j = 0; j < grid.ny; ++j) {
                        const int c = j * grid.nx + i;
                        if (end.solution.pressure[c] > 0.0) {
                            EXPECT_GE(end.coverage[c], 0.25);
                        }
                        column += end.solution.pressure[c] * end.coverage[c] * grid.ds / grid.ny;
                        width = std::max(width, end.coverage[c] * grid.ds);
                    }
                    if (column <= 0.0) continue;
                    ++columns;
                    load += column;
                    const double inner = truth.place(std::abs(grid.s(i)) + 0.5 * grid.ds);
                    if (columns == 1) {  // in part, it may take a whole one's; or a sliver's, too
                        EXPECT_LT(load, 1.15 * truth.load(std::max(inner, width)));
                    } else {
                        EXPECT_NEAR(load, truth.load(inner), 0.15 * truth.load(inner));
                    }
                }
            }
        }
    }
}

TEST(Simulation, ARigidToolLeavesItsEnvelope) {
    HeightField field = testing::plate(40.0, 40.0, 0.5, 0.3);
    Geometric tool;
    SimulationOptions o = options();
    const ToolPath path({pressing_down(10, 20, 0.1, 20.0), pressing_down(30, 20, 0.1, 20.0)}, {});
    EXPECT_THROW(simulate(field, path, tool, LocalLaw({1e-4}), o), InputError);
    o.process.force_control = false;
    const SimulationResult result = simulate(field, path, tool, LocalLaw({1e-4}), o);
    EXPECT_TRUE(result.events.empty());
    EXPECT_NEAR(result.integrated_rate, result.removed_volume, 0.01 * result.removed_volume);
    for (std::size_t i = 0; i < field.size(); ++i) {
        const Vec3& p = field.point[i];
        if (std::abs(p.x() - 20.0) < 9.0 && std::abs(p.y() - 20.0) < 8.0) {
            EXPECT_NEAR(field.height[i], 0.1, 0.005);
        }
        if (std::abs(p.y() - 20.0) > 12.0) {
            EXPECT_EQ(field.height[i], 0.3);
        }
    }
}

TEST(Simulation, LimitsAndOutputsChangeNothingThatIsGround) {
    const ToolPath path({pressing_down(10, 20, 0.1, 20.0), pressing_down(30, 22, 0.1, 20.0)}, {});
    const ElasticFoundation foundation(0.5);
    const LocalLaw law({kCoefficient});
    HeightField bare = testing::plate(40.0, 40.0, 0.5, 0.3), full = bare;
    SimulationOptions o = options();
    o.outputs.trace = o.outputs.cell_errors = false;
    const SimulationResult without = simulate(bare, path, foundation, law, o);
    EXPECT_TRUE(without.events.empty());
    EXPECT_TRUE(bare.trace.empty());
    EXPECT_TRUE(without.unresolved.empty());
    Recording recording;
    o.limits = {1.0, 1e-3, 1e-4, 1e-4, {0.2f}};
    o.outputs = {true, 7, &recording, {{std::make_shared<LocalLaw>(LocalLawParameters{1e-6})}}};
    const SimulationResult with = simulate(full, path, foundation, law, o);
    EXPECT_GE(with.events.size(), 3u);
    EXPECT_EQ(recording.samples(), full.size());
    EXPECT_EQ(with.unresolved.size(), full.size());
    EXPECT_EQ(bare.height, full.height);
    EXPECT_EQ(without.removed_volume, with.removed_volume);
    ASSERT_EQ(without.steps.size(), with.steps.size());
    for (std::size_t i = 0; i < with.steps.size(); ++i) {
        EXPECT_EQ(without.steps[i].force, with.steps[i].force);
        EXPECT_EQ(without.steps[i].peak_pressure, with.steps[i].peak_pressure);
        EXPECT_EQ(without.steps[i].removal_rate, with.steps[i].removal_rate);
    }
    for (const double phase :
         {with.wall.build, with.wall.localise, with.wall.gap, with.wall.contact, with.wall.removal,
          with.wall.trace, with.wall.events}) {
        EXPECT_GT(phase, 0.0);
    }
    EXPECT_EQ(without.wall.trace, 0.0);
}

TEST(Simulation, TheEndStopHoldsWithinAStep) {
    // Pressed again within a step, the wheel went on beyond the stop.
    for (const double force : {300.0, 1e9}) {
        HeightField field = testing::plate(60.0, 40.0, 1.0, 0.3);
        const ElasticFoundation foundation(0.5);
        SimulationOptions o = options();
        o.process.force = force;
        o.process.force_travel = 0.7;
        const ToolPath path({pressing_down(10, 20, 0.3, 5.0), pressing_down(50, 20, 0.3, 5.0)}, {});
        const SimulationResult result = simulate(field, path, foundation, LocalLaw({1e-2}), o);
        EXPECT_GE(*std::min_element(field.height.begin(), field.height.end()), -0.4 - 1e-6);
        for (const StepRecord& step : result.steps) EXPECT_LE(step.approach, 0.7f);
    }
}

TEST(Simulation, AStepThatTakesMoreThanTheIndentationIsCut) {
    const ToolPath path({pressing_down(10, 20, 0.3, 20.0), pressing_down(50, 20, 0.3, 20.0)}, {});
    const ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.resolution.max_travel = 4.0;
    o.process.force_travel = 100.0;
    std::size_t last = 0;
    for (const double coefficient : {1e-4, 2e-3, 10.0}) {
        HeightField field = testing::plate(60.0, 40.0, 1.0, 0.3);
        Recording recording;
        o.outputs.recording = &recording;
        const SimulationResult result =
            simulate(field, path, foundation, LocalLaw({coefficient}), o);
        if (coefficient == 2e-3) {
            EXPECT_GT(result.steps.size(), last);
        }
        last = result.steps.size();
        double time = 0.0, volume = 0.0;
        for (const StepRecord& step : result.steps) {
            EXPECT_NEAR(step.time, time + 0.5 * step.duration, 1e-6);
            time += step.duration;
            volume += static_cast<double>(step.removal_rate) * step.duration;
        }
        EXPECT_NEAR(time, 2.0, 1e-5);
        EXPECT_NEAR(volume, result.removed_volume, 1e-5 * volume);
        EXPECT_NEAR(result.belt.volume, result.removed_volume, 1e-9 * volume);
        const bool told =
            std::any_of(result.events.begin(), result.events.end(),
                        [](const Event& event) { return event.kind == "step_too_coarse"; });
        EXPECT_EQ(told, coefficient == 10.0);
        if (coefficient == 1e-4) {
            EXPECT_EQ(last, 10u);
        }
        EXPECT_LE(last, 160u);
    }
}

TEST(Simulation, AnAbsurdForceIsHeldAtTheRimsThickness) {
    HeightField field = testing::plate(60.0, 40.0, 1.0, 0.3);
    const BondedLayer layer({5.0, 0.45}, 10.0);
    SimulationOptions o = options();
    o.process.force = 1e9;
    o.process.force_travel = 1e4;
    const ToolPath path({pressing_down(25, 20, 0.3, 20.0), pressing_down(30, 20, 0.3, 20.0)}, {});
    const SimulationResult result = simulate(field, path, layer, LocalLaw({1e-12}), o);
    ASSERT_FALSE(result.events.empty());
    EXPECT_TRUE(std::any_of(result.events.begin(), result.events.end(), [](const Event& event) {
        return event.kind == "over_compressed" && event.limit == 10.0;
    }));
    for (const StepRecord& step : result.steps) {
        EXPECT_NEAR(step.approach, 10.0, 0.1);
        EXPECT_GT(step.force, 0.0);
    }
}

TEST(Simulation, ComingToTheSurfaceAndLeavingItIsNoEvent) {
    HeightField field = testing::plate(40.0, 40.0, 0.5, 0.0);
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.process.force_travel = 2.0;
    // The force falls below the commanded one for a while after the travel has ended.
    const ToolPath path({pressing_down(8, 20, 20.0, 20.0), pressing_down(10, 20, 0.1, 20.0),
                         pressing_down(30, 20, 0.1, 20.0), pressing_down(32, 20, 20.0, 20.0)},
                        {});
    const SimulationResult result = simulate(field, path, foundation, LocalLaw({1e-6}), o);
    EXPECT_TRUE(result.events.empty());
}

TEST(Simulation, RunningOffTheEdgeIsLossOfForceAndNotOfConvergence) {
    HeightField field = testing::plate(40.0, 40.0, 0.5, 0.1);
    ElasticFoundation foundation(0.5);
    SimulationOptions o = options();
    o.process.force_travel = 0.5;
    const ToolPath path({pressing_down(20, 20, 0.1, 20.0), pressing_down(70, 31, 0.1, 20.0),
                         pressing_down(20, 20, 0.1, 20.0)},
                        {});
    const SimulationResult result = simulate(field, path, foundation, LocalLaw({1e-6}), o);
    ASSERT_FALSE(result.events.empty());
    for (const Event& event : result.events) EXPECT_EQ(event.kind, "force_not_reached");
}

TEST(Simulation, RefusesAPathThatNeverTouchesAndLeavesTheField) {
    HeightField field = testing::plate(20.0, 20.0, 0.5, 0.3);
    const std::vector<double> before = field.height;
    ElasticFoundation foundation(0.5);
    const ToolPath far({pressing_down(0, 0, 100.0, 20.0), pressing_down(9, 0, 100.0, 20.0)}, {});
    EXPECT_THROW(simulate(field, far, foundation, LocalLaw({1e-4}), options()), InputError);
    EXPECT_EQ(field.height, before);
    EXPECT_THROW(simulate(field, ToolPath({pressing_down(0, 0, 0, 1)}, {}), foundation,
                          LocalLaw({1e-4}), options()),
                 InputError);
}

TEST(Simulation, CancelLeavesTheFieldAsItWas) {
    HeightField field = testing::plate(100.0, 60.0, 0.4, 0.4);
    const std::vector<double> before = field.height;
    ElasticFoundation foundation(0.5);
    const ToolPath path({pressing_down(10, 30, 0.4, 0.1), pressing_down(90, 30, 0.4, 0.1)}, {});
    SimulationOptions o = options();
    o.resolution.max_travel = 0.001;
    const RunContext context;
    std::thread other([&] {
        while (context.progress() <= 0.0) std::this_thread::yield();
        context.cancel();
    });
    EXPECT_THROW(simulate(field, path, foundation, LocalLaw({kCoefficient}), o, context),
                 Cancelled);
    other.join();
    EXPECT_EQ(field.height, before);
}

}  // namespace
}  // namespace beltgrinding
