// A belt's splines lie closer where a start bears pressure: what it is begun from must not show.
#include <gtest/gtest.h>

#include <memory>

#include "belt_case.h"

namespace beltgrinding {
namespace {

using namespace testing;

const ContactGrid kGrid{64, 64, 0.8, 0.8};

class BeltStart : public ::testing::TestWithParam<BeltMachine::Kind> {
  protected:
    std::unique_ptr<PreparedContact> contact() const {
        return make_belt_contact(reference_belt(GetParam(), BeltRun::Rollers::kTensioned))
            ->prepare(kGrid);
    }
    /// A sphere with its highest point there.
    static ContactProblem spot(double x, double y) {
        ContactProblem problem = problem_of(
            kGrid, [=](double px, double py) { return circle(40.0, std::hypot(px - x, py - y)); });
        problem.force = 10.0;
        return problem;
    }
    static void expect_same(const ContactSolution& a, const ContactSolution& b) {
        EXPECT_TRUE(a.converged);
        EXPECT_NEAR(a.approach, b.approach, 1e-3 * b.approach);
        EXPECT_LT((a.pressure - b.pressure).abs().sum(), 0.01 * b.pressure.sum());
    }
};

TEST_P(BeltStart, ASpotThatHasMovedAcrossIsThatOfAColdStart) {
    const auto belt = contact();
    ContactSolution last = belt->solve(spot(0.0, -14.0));
    for (const double y : {-12.0, 12.0, 24.0}) {
        const ContactProblem problem = spot(0.0, y);
        last = belt->solve(problem, &last.pressure);
        expect_same(last, contact()->solve(problem));
    }
}

TEST_P(BeltStart, AStartThatPressesElsewhereDoesNotMatter) {
    const ContactProblem problem = spot(3.0, 10.0);
    const ContactSolution truth = contact()->solve(problem);
    for (const double y : {-20.0, 8.5}) {
        Eigen::ArrayXd start = Eigen::ArrayXd::Zero(kGrid.cells());
        start[(static_cast<int>(y / kGrid.dy) + kGrid.ny / 2) * kGrid.nx + kGrid.nx / 2] = 0.1;
        expect_same(contact()->solve(problem, &start), truth);
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, BeltStart,
                         ::testing::Values(BeltMachine::Kind::kFreeBelt,
                                           BeltMachine::Kind::kPlaten),
                         [](const auto& one) {
                             return one.param == BeltMachine::Kind::kPlaten ? "Platen" : "FreeBelt";
                         });

}  // namespace
}  // namespace beltgrinding
