// What stresses in the belt's plane resist with, against their energy.
#include "belt_stress.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace beltgrinding {
namespace {

class Stress : public ::testing::Test {
  protected:
    Stress() {
        path.columns = BeltColumns::of({0.0, 5.0, 8.0, 9.0, 10.0, 11.0, 12.5, 15.0, 21.0});
        const auto n = static_cast<std::size_t>(path.columns.count());
        path.angle.assign(n, 0.0);
        path.turn.assign(n, 0.0);
        path.turn[3] = -0.02;
        path.turn[4] = -0.03;
        compliance = BeltStress::Compliance(terms, path.columns);
    }
    /// Of the strains and of the pull along the path itself, mm N.
    double energy(const Eigen::MatrixXd& c) const {
        BeltModes strain = stress.product(stress.shape(c), stress.shape(c));
        const BeltModes turned = stress.turned(c);
        strain.function += turned.function;
        strain.mean += turned.mean;
        strain.lean += turned.lean;
        const BeltModes s = stress.stress(strain);
        return 0.5 * (s.function.cwiseProduct(strain.function).sum() + s.mean * strain.mean +
                      s.lean * strain.lean) +
               kResting * strain.mean;
    }
    static constexpr double kResting = 3.0, kStretching = 1.2, kRun = 21.0;

    const AbrasiveBelt belt{};
    const BeltSpline spline{belt.width, 4.0, 2.0};
    const BeltTerms terms{belt.width, spline};
    BeltPath path;
    BeltStress::Compliance compliance;
    const BeltStress stress{belt, terms, path, compliance, kResting, kStretching, kRun};
};

TEST_F(Stress, ResistsByWhatItsEnergyRises) {
    const Eigen::MatrixXd c = 0.2 * Eigen::MatrixXd::Random(spline.count(), path.columns.count());
    const BeltStress::Shape shape = stress.shape(c);
    BeltModes strain = stress.product(shape, shape);
    const BeltModes turned = stress.turned(c);
    strain.function += turned.function;
    strain.mean += turned.mean;
    strain.lean += turned.lean;
    const Eigen::MatrixXd resistance = stress.resistance(shape, stress.stress(strain));
    const double most = resistance.cwiseAbs().maxCoeff();
    ASSERT_GT(most, 0.1);
    constexpr double kStep = 1e-5;  // mm
    for (Eigen::Index i = 0; i < c.cols(); ++i) {
        for (Eigen::Index s = 0; s < c.rows(); s += 2) {
            Eigen::MatrixXd more = c, less = c;
            more(s, i) += kStep;
            less(s, i) -= kStep;
            EXPECT_NEAR(resistance(s, i), (energy(more) - energy(less)) / (2.0 * kStep),
                        1e-6 * most);
        }
    }
}

}  // namespace
}  // namespace beltgrinding
