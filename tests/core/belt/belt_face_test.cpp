// The belt's face: what it deflects by, and the same turned round.
#include "belt_face.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "belt_springs.h"

namespace beltgrinding {
namespace {

constexpr double kShear = 0.15;  // mm2
constexpr int kRows = 29;

class Face : public ::testing::Test {
  protected:
    static std::vector<BeltRow> rows() {
        std::vector<BeltRow> result;
        for (int k = 0; k < kRows; ++k) result.push_back({k, 0.9 * (k - 14), 0.9});
        return result;
    }
    const BeltColumns columns = BeltColumns::of({0.0, 4.0, 6.0, 7.0, 8.0, 9.5, 13.0});
    const BeltSpline spline{30.0, 2.0, 1.0};
    const BeltFace face{spline, rows(), kShear};
    const int m = spline.count(), n = columns.count();
};

TEST_F(Face, DeflectsByTheSheetLessItsCurvatures) {
    const Eigen::MatrixXd c = Eigen::MatrixXd::Random(m, n);
    const Eigen::ArrayXXd u = face.deflection(columns, c);
    for (int i = 0; i < n; ++i) {
        const auto along = columns.curvature(i);
        for (int k = 0; k < kRows; ++k) {
            const auto local = spline.at(rows()[static_cast<std::size_t>(k)].y);
            double value = 0.0, across = 0.0, curved = 0.0;
            for (std::size_t r = 0; r < BeltSpline::kLocal; ++r) {
                const int s = local.first + static_cast<int>(r);
                value += local.value[r] * c(s, i);
                across += local.curvature[r] * c(s, i);
                if (i == 0 || i + 1 == n) continue;
                curved += local.value[r] *
                          (along[0] * c(s, i - 1) + along[1] * c(s, i) + along[2] * c(s, i + 1));
            }
            EXPECT_NEAR(u(k, i), value - kShear * (across + curved), 1e-12);
        }
    }
}

TEST_F(Face, ForcesPushAsFarAsTheyMove) {
    const Eigen::MatrixXd c = Eigen::MatrixXd::Random(m, n);
    Eigen::ArrayXXd forces = Eigen::ArrayXXd::Random(kRows, n);
    forces.col(2).setZero();
    Eigen::MatrixXd pushed = Eigen::MatrixXd::Zero(m, n);
    face.push(columns, forces, pushed);
    EXPECT_NEAR(pushed.cwiseProduct(c).sum(), (forces * face.deflection(columns, c)).sum(), 1e-10);
}

TEST_F(Face, SpringsStiffenByWhatTheyPushWith) {
    const Eigen::MatrixXd c = Eigen::MatrixXd::Random(m, n);
    const Eigen::ArrayXXd springs = Eigen::ArrayXXd::Random(kRows, n).max(0.0);
    BeltBands bands(n, m);
    face.stiffen(columns, springs, bands);
    Eigen::MatrixXd pushed = Eigen::MatrixXd::Zero(m, n);
    face.push(columns, springs * face.deflection(columns, c), pushed);
    EXPECT_LT((bands.times(c) - pushed).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_F(Face, OneCellsFormIsItsRow) {
    const Eigen::MatrixXd c = Eigen::MatrixXd::Random(m, n);
    const Eigen::ArrayXXd u = face.deflection(columns, c);
    for (const int i : {0, 3, n - 1}) {
        for (int k = 0; k < kRows; k += 7) {
            const BeltFace::Form form = face.form(columns, static_cast<std::size_t>(k), i);
            double sum = 0.0;
            for (int p = form.first; p <= form.last; ++p)
                for (int r = 0; r < BeltFace::kLocal; ++r)
                    sum += form.values[static_cast<std::size_t>(p)][static_cast<std::size_t>(r)] *
                           c(form.spline + r, i - 1 + p);
            EXPECT_NEAR(sum, u(k, i), 1e-12);
        }
    }
}

TEST(BeltSprings, PushOnlyWhereTheyArePressedIn) {
    constexpr int kCount = 13;
    const Eigen::ArrayXd from = Eigen::ArrayXd::Random(kCount), to = Eigen::ArrayXd::Random(kCount);
    const Eigen::ArrayXd stiffness = Eigen::ArrayXd::LinSpaced(kCount, 0.0, 3.0);
    Eigen::ArrayXd forces(kCount);
    std::vector<std::uint8_t> on(kCount, 0);
    const double raised = 0.1;
    EXPECT_FALSE(press_springs(kCount, from.data(), raised, to.data(), stiffness.data(),
                               forces.data(), on.data()));
    for (int k = 0; k < kCount; ++k) {
        const double in = from[k] + raised - to[k];
        EXPECT_EQ(on[static_cast<std::size_t>(k)], in > 0.0 ? 1 : 0);
        EXPECT_DOUBLE_EQ(forces[k], in > 0.0 ? stiffness[k] * in : 0.0);
    }
    EXPECT_TRUE(press_springs(kCount, from.data(), raised, to.data(), stiffness.data(),
                              forces.data(), on.data()));
    EXPECT_NEAR(sum_apart(kCount, forces.data()), forces.sum(), 1e-12);
}

}  // namespace
}  // namespace beltgrinding
