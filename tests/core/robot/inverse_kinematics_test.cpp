#include "robot/inverse_kinematics.h"

#include <gtest/gtest.h>

#include "beltgrinding/error.h"
#include "robot/arms.h"
#include "subproblem.h"

namespace beltgrinding {
namespace {

using testing::degrees;

double position_error(const Frame& a, const Frame& b) {
    return (a.translation() - b.translation()).norm();
}

double angle_error(const Frame& a, const Frame& b) {
    return (a.linear() - b.linear()).cwiseAbs().maxCoeff();
}

double difference(const Joints& a, const Joints& b) {
    Joints d = a - b;
    for (int i = 0; i < 6; ++i) d[i] = nearest_turn(d[i], 0.0);
    return d.cwiseAbs().maxCoeff();
}

TEST(Subproblem, AnglesDoWhatTheyAreFoundFor) {
    const Vec3 k = Vec3(1, -2, 0.5).normalized(), p(3, 1, -2), h = Vec3(0.3, 1, 1).normalized();
    const Vec3 q = rotated(k, 0.7, p);
    EXPECT_NEAR(turn_to(k, p, q).angle[0], 0.7, 1e-12);
    const Angles plane = turn_to_plane(k, p, h, h.dot(q));
    ASSERT_EQ(plane.count, 2);
    for (const double a : plane.angle) EXPECT_NEAR(h.dot(rotated(k, a, p)), h.dot(q), 1e-12);
    EXPECT_GT(std::abs(plane.angle[0] - plane.angle[1]), 0.1);
    const Vec3 far(4, 4, 4);
    const Angles at = turn_to_distance(k, p, far, (q - far).norm());
    ASSERT_EQ(at.count, 2);
    for (const double a : at.angle)
        EXPECT_NEAR((rotated(k, a, p) - far).norm(), (q - far).norm(), 1e-12);
    EXPECT_EQ(turn_to_plane(k, p, h, 10.0).count, 0);
    EXPECT_TRUE(turn_to(k, 2.0 * k, 3.0 * k).free);
}

TEST(RobotArm, KnowsWhatIsParallelAndWhatMeets) {
    EXPECT_EQ(RobotArm(testing::wrist_arm()).structure(), RobotArm::Structure::kSphericalWrist);
    EXPECT_EQ(RobotArm(testing::parallel_arm()).structure(), RobotArm::Structure::kParallelElbow);
    EXPECT_EQ(RobotArm(testing::calibrated_arm()).structure(), RobotArm::Structure::kGeneral);
}

TEST(RobotArm, StandsWhereItsDimensionsPutIt) {
    // Upper arm straight up, forearm horizontal: 25 + 420 + 80 forward, 400 + 455 + 35 high.
    const RobotArm arm(testing::wrist_arm());
    const Frame home = arm.forward(degrees(0, -90, 90, 0, 0, 0));
    EXPECT_NEAR(position_error(home, Frame(Eigen::Translation3d(525, 0, 890))), 0.0, 1e-9);
    EXPECT_NEAR((home.linear() * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0.0, 1e-12);
    // A1 turns clockwise seen from above.
    EXPECT_LT(arm.forward(degrees(90, -90, 90, 0, 0, 0)).translation().y(), -500.0);
    // Universal Robots: stretched out along -x at zero.
    const Vec3 zero = RobotArm(testing::parallel_arm()).forward(Joints::Zero()).translation();
    EXPECT_NEAR((zero - Vec3(-817.2, -232.9, 62.8)).norm(), 0.0, 1e-9);
}

TEST(RobotArm, ModifiedAndStandardTablesOfOneArmAgree) {
    // The PUMA 560 in both: J. J. Craig, Introduction to Robotics (modified); the same with the
    // links' parameters one row later (standard), which differs by a turn of the base only.
    const double h = M_PI / 2;
    const RobotArm modified(model_from_dh(
        {{{0, 0, 0}, {0, -h, 0}, {431.8, 0, 149.09}, {20.32, -h, 433.07}, {0, h, 0}, {0, -h, 0}}},
        DhConvention::kModified));
    const RobotArm standard(model_from_dh(
        {{{0, -h, 0}, {431.8, 0, 0}, {20.32, -h, 149.09}, {0, h, 433.07}, {0, -h, 0}, {0, 0, 0}}},
        DhConvention::kStandard));
    std::mt19937 random(3);
    for (int k = 0; k < 20; ++k) {
        const Joints q = testing::random_joints(modified, random);
        EXPECT_TRUE(modified.forward(q).isApprox(standard.forward(q), 1e-12));
    }
    EXPECT_EQ(modified.structure(), RobotArm::Structure::kSphericalWrist);
}

TEST(RobotArm, OffsetsAndDirectionsAreHeeded) {
    std::array<DhRow, 6> rows = {
        {{0, 1.5, 100}, {300, 0, 0}, {0, 1.5, 20}, {0, -1.5, 300}, {0, 1.5, 0}, {}}};
    const RobotArm plain(model_from_dh(rows, DhConvention::kStandard));
    rows[1].offset = 0.4;
    rows[3].direction = -1.0;
    const RobotArm other(model_from_dh(rows, DhConvention::kStandard));
    Joints q, same;
    q << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
    same << 0.1, 0.6, 0.3, -0.4, 0.5, 0.6;
    EXPECT_TRUE(other.forward(q).isApprox(plain.forward(same), 1e-12));
}

TEST(RobotArm, JacobianIsTheDerivative) {
    RobotModel model = testing::wrist_arm();
    model.coupling = 1.0;
    const RobotArm arm(model);
    const Joints q = degrees(20, -70, 60, 30, 40, 50);
    const auto jacobian = arm.jacobian(q);
    const double step = 1e-6;
    for (int i = 0; i < 6; ++i) {
        Joints a = q, b = q;
        a[i] -= step;
        b[i] += step;
        const Frame fa = arm.forward(a), fb = arm.forward(b);
        const Eigen::AngleAxisd turn(fb.linear() * fa.linear().transpose());
        Eigen::Matrix<double, 6, 1> column;
        column << fb.translation() - fa.translation(), turn.angle() * turn.axis();
        EXPECT_NEAR((column / (2 * step) - jacobian.col(i)).norm(), 0.0, 1e-4) << i;
    }
}

void round_trip(const RobotModel& model, std::size_t at_least) {
    const RobotArm arm(model);
    std::mt19937 random(7);
    std::size_t most = 0;
    for (int k = 0; k < 300; ++k) {
        const Joints q = testing::random_joints(arm, random);
        const Frame pose = arm.forward(q);
        const auto found = inverse(arm, pose, Joints::Zero());
        most = std::max(most, found.size());
        bool there = false;
        for (const ArmSolution& s : found) {
            EXPECT_LT(position_error(arm.forward(s.q), pose), 1e-6);
            EXPECT_LT(angle_error(arm.forward(s.q), pose), 1e-7);
            EXPECT_LE(s.q.cwiseAbs().maxCoeff(), M_PI + 1e-9);
            there = there || difference(s.q, q) < 1e-6;
        }
        EXPECT_TRUE(there) << q.transpose();
    }
    EXPECT_GE(most, at_least);
}

TEST(Inverse, SphericalWristFindsAllEight) {
    round_trip(testing::wrist_arm(), 8);
}
TEST(Inverse, ParallelElbowFindsAllEight) {
    round_trip(testing::parallel_arm(), 8);
}
TEST(Inverse, CoupledJointsToo) {
    RobotModel model = testing::wrist_arm();
    model.coupling = 1.0;
    round_trip(model, 8);
}

// The closed form of the exact arm gives the numeric search on the same arm all that there is.
TEST(Inverse, ClosedFormAndLeastSquaresAgree) {
    for (const RobotModel& model : {testing::wrist_arm(), testing::parallel_arm()}) {
        const RobotArm arm(model);
        std::mt19937 random(11);
        int checked = 0;
        for (int k = 0; k < 100; ++k) {
            const Joints q = testing::random_joints(arm, random);
            const SingularDistance d = singular_distance(arm, q);
            if (std::min({d.wrist, d.elbow, d.shoulder}) < 0.05) continue;
            const Frame pose = arm.forward(q);
            const NearestReach numeric = approach(arm, pose, q + Joints::Constant(0.02));
            if (numeric.position_error > 1e-6) continue;
            ++checked;
            bool there = false;
            for (const ArmSolution& s : inverse(arm, pose, q))
                there = there || difference(s.q, numeric.q) < 1e-6;
            EXPECT_TRUE(there);
        }
        EXPECT_GT(checked, 70);
    }
}

TEST(Inverse, AnArmWithoutStructureIsSolvedByLeastSquares) {
    const RobotArm arm(testing::calibrated_arm());
    std::mt19937 random(5);
    int solved = 0;
    for (int k = 0; k < 30; ++k) {
        const Joints q = testing::random_joints(arm, random);
        const Frame pose = arm.forward(q);
        const auto found = inverse(arm, pose, Joints::Zero());
        for (const ArmSolution& s : found) EXPECT_LT(position_error(arm.forward(s.q), pose), 1e-6);
        if (found.size() >= 2) ++solved;
        // From nearby, the very solution.
        const auto follow = inverse(arm, pose, q + Joints::Constant(0.01), false);
        if (singular_distance(arm, q).general > 0.1) {
            ASSERT_EQ(follow.size(), 1u);
            EXPECT_LT(difference(follow[0].q, q), 1e-6);
        }
    }
    EXPECT_EQ(solved, 30);
}

TEST(Inverse, AtSingularitiesTheReferenceDecides) {
    const RobotArm arm(testing::wrist_arm());
    const Joints aligned = degrees(10, -80, 70, 33, 0, 21);
    bool there = false;
    for (const ArmSolution& s : inverse(arm, arm.forward(aligned), aligned))
        there = there || difference(s.q, aligned) < 1e-6;
    EXPECT_TRUE(there);
    const RobotArm parallel(testing::parallel_arm());
    const Joints flat = degrees(10, -80, 70, 33, 0, 21);
    there = false;
    for (const ArmSolution& s : inverse(parallel, parallel.forward(flat), flat))
        there = there || difference(s.q, flat) < 1e-6;
    EXPECT_TRUE(there);
    const Joints straight = degrees(0, -45, 4.763642, 0, 50, 0);  // atan(35 / 420): stretched
    EXPECT_FALSE(inverse(arm, arm.forward(straight), straight).empty());
    EXPECT_LT(singular_distance(arm, straight).elbow, 1e-6);
}

TEST(Inverse, SaysWhatIsOutOfReachAndByHowMuch) {
    const RobotArm arm(testing::wrist_arm());
    Frame far = arm.forward(degrees(0, -45, 60, 0, 40, 0));
    const Vec3 wrist = far.translation() - 80.0 * far.linear().col(2);
    const Vec3 shoulder(25, 0, 400);
    const double reach = 455.0 + std::hypot(420.0, 35.0);
    far.translation() +=
        (wrist - shoulder).normalized() * (reach - (wrist - shoulder).norm() + 10.0);
    EXPECT_TRUE(inverse(arm, far, Joints::Zero()).empty());
    const NearestReach end = approach(arm, far, degrees(0, -45, 60, 0, 40, 0));
    EXPECT_GT(end.position_error + arm.length() * end.angle_error, 5.0);
    EXPECT_LT(end.position_error, 11.0);
}

TEST(SingularDistance, IsZeroWhereTheJacobianIsSingular) {
    const RobotArm arm(testing::wrist_arm());
    const Joints wrist = degrees(10, -80, 70, 33, 0, 21);
    EXPECT_NEAR(singular_distance(arm, wrist).wrist, 0.0, 1e-9);
    EXPECT_NEAR(singular_distance(arm, degrees(10, -80, 70, 33, 7, 21)).wrist, 7 * testing::kDegree,
                1e-9);
    EXPECT_NEAR(arm.jacobian(wrist).jacobiSvd().singularValues()[5], 0.0, 1e-9);
    // The wrist over axis 1: 25 + 455 sin(b) + ... is zero for the forearm bent back by the law of
    // cosines; found here by bisection on joint 2.
    double low = -150 * testing::kDegree, high = -60 * testing::kDegree;
    const auto forward = [&](double b) {
        Joints q = degrees(0, 0, 60, 0, 40, 0);
        q[1] = b;
        return arm.placed(q).wrist.x();
    };
    for (int k = 0; k < 80; ++k) {
        const double middle = 0.5 * (low + high);
        (forward(middle) * forward(low) <= 0.0 ? high : low) = middle;
    }
    Joints over = degrees(0, 0, 60, 0, 40, 0);
    over[1] = low;
    EXPECT_NEAR(singular_distance(arm, over).shoulder, 0.0, 1e-9);
    EXPECT_NEAR(arm.jacobian(over).jacobiSvd().singularValues()[5], 0.0, 1e-6);
    const RobotArm parallel(testing::parallel_arm());
    for (const Joints& q : {degrees(10, -80, 0, 33, 50, 21), degrees(10, -80, 60, 33, 0, 21)}) {
        const SingularDistance d = singular_distance(parallel, q);
        EXPECT_NEAR(std::min({d.wrist, d.elbow, d.shoulder}), 0.0, 1e-9);
        EXPECT_NEAR(parallel.jacobian(q).jacobiSvd().singularValues()[5], 0.0, 1e-9);
    }
}

TEST(RobotArm, NamesTheWrongJoint) {
    const auto error_of = [](const RobotModel& model) -> std::string {
        try {
            const RobotArm arm(model);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    RobotModel bad = testing::wrist_arm();
    bad.joints[3].axis = Vec3::Zero();
    EXPECT_NE(error_of(bad).find("joint 4"), std::string::npos);
    bad = testing::wrist_arm();
    bad.joints[1].lower = 9.0;
    EXPECT_NE(error_of(bad).find("joint 2"), std::string::npos);
    bad = testing::wrist_arm();
    bad.coupling = 0.5;
    EXPECT_NE(error_of(bad).find("coupling"), std::string::npos);
    for (RobotJoint& joint : bad.joints) joint.parent_from_joint = Frame::Identity();
    bad.coupling = 0.0;
    EXPECT_NE(error_of(bad).find("no length"), std::string::npos);
}

}  // namespace
}  // namespace beltgrinding
