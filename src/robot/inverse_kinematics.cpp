#include "robot/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "subproblem.h"

namespace beltgrinding {
namespace {

constexpr double kPositionTolerance = 1e-6;  // mm, of a solution
constexpr double kAngleTolerance = 1e-7;     // rad, of a solution
constexpr double kPositionGoal = 1e-9;       // mm, where the iteration ends
constexpr double kAngleGoal = 1e-12;         // rad
constexpr double kSingular = 1e-8;           // sine below which an angle is left to the reference
constexpr double kStill = 1e-9;              // rad, or of the error: the iteration has ended
constexpr int kIterations = 100;
constexpr int kSeeds = 96;              // of a numeric search over the joints' ranges
constexpr double kSameSolution = 1e-4;  // rad
constexpr double kMostOfTurn = 2.0;     // rad, the longest step of a joint in an iteration

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Position (mm) and rotation vector (rad) from where the flange is to where it should be.
Vector6 error_of(const Frame& is, const Frame& target) {
    Vector6 e;
    const Eigen::AngleAxisd turn(target.linear() * is.linear().transpose());
    e << target.translation() - is.translation(), turn.angle() * turn.axis();
    return e;
}

bool within(const Vector6& e, double position, double angle) {
    return e.head<3>().norm() <= position && e.tail<3>().norm() <= angle;
}

bool solves(const NearestReach& end) {
    return end.position_error <= kPositionTolerance && end.angle_error <= kAngleTolerance;
}

/// Of `first` the angle to use: the reference's where it is free.
double chosen(const Angles& angles, int i, double reference) {
    return angles.free ? reference : angles.angle[i];
}

Eigen::Matrix3d turn(const Vec3& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Angle of a rotation that is known to be about `axis`.
double angle_about(const Vec3& axis, const Eigen::Matrix3d& r) {
    const Vec3 side = axis.unitOrthogonal();
    return turn_to(axis, side, r * side).angle[0];
}

class ClosedForm {
  public:
    ClosedForm(const RobotArm& arm, const Frame& target, const Joints& near)
        : arm_(arm), near_(arm.geometric(near)), e_(target * arm.home().inverse()) {}

    /// Geometric angles and branches; not yet checked.
    std::vector<ArmSolution> solve() {
        // Joint 1: the wrist's offset along axis 2 does not change with joints 2 and 3 (and 4).
        const Vec3 wrist = e_ * arm_.wrist() - arm_.point(0);
        const Angles first = turn_to_plane(-arm_.axis(0), wrist, arm_.axis(1),
                                           arm_.axis(1).dot(arm_.wrist() - arm_.point(0)));
        for (int i = 0; i < first.count; ++i) {
            theta_[0] = chosen(first, i, near_[0]);
            Frame back = Frame::Identity();  // of joint 1
            back.linear() = turn(arm_.axis(0), -theta_[0]);
            back.translation() = arm_.point(0) - back.linear() * arm_.point(0);
            rest_ = back * e_;
            if (arm_.structure() == RobotArm::Structure::kSphericalWrist) {
                elbow(rest_ * arm_.wrist(), arm_.wrist(), 4 * i);
            } else {
                parallel_wrist(4 * i);
            }
        }
        return std::move(found_);
    }

  private:
    /// Joints 2 and 3 take the point `from` (at angles 0) to `to`.
    void elbow(const Vec3& to, const Vec3& from, int branch) {
        const Vec3 p2 = arm_.point(1), p3 = arm_.point(2);
        const Angles third = turn_to_distance(arm_.axis(2), from - p3, p2 - p3, (to - p2).norm());
        for (int i = 0; i < third.count; ++i) {
            theta_[2] = chosen(third, i, near_[2]);
            const Vec3 bent = p3 + rotated(arm_.axis(2), theta_[2], from - p3) - p2;
            theta_[1] = chosen(turn_to(arm_.axis(1), bent, to - p2), 0, near_[1]);
            if (arm_.structure() == RobotArm::Structure::kSphericalWrist) {
                spherical_wrist(branch + 2 * i);
            } else {
                // Of the parallel axes, the sum of the angles is known.
                const double sign3 = arm_.axis(2).dot(arm_.axis(1)) > 0.0 ? 1.0 : -1.0;
                const double sign4 = arm_.axis(3).dot(arm_.axis(1)) > 0.0 ? 1.0 : -1.0;
                theta_[3] = sign4 * (sum_ - theta_[1] - sign3 * theta_[2]);
                found_.push_back({theta_, branch + 2 * i});
            }
        }
    }

    void spherical_wrist(int branch) {
        const Eigen::Matrix3d wrist =
            (turn(arm_.axis(1), theta_[1]) * turn(arm_.axis(2), theta_[2])).transpose() *
            rest_.linear();
        const Vec3 h4 = arm_.axis(3), h5 = arm_.axis(4), h6 = arm_.axis(5);
        const Vec3 last = wrist * h6;
        const Angles fifth = turn_to_plane(h5, h6, h4, h4.dot(last));
        for (int i = 0; i < fifth.count; ++i) {
            theta_[4] = chosen(fifth, i, near_[4]);
            const Vec3 bent = rotated(h5, theta_[4], h6);
            const bool aligned = h4.cross(bent).norm() < kSingular;
            theta_[3] = aligned ? near_[3] : chosen(turn_to(h4, bent, last), 0, near_[3]);
            theta_[5] =
                angle_about(h6, (turn(h4, theta_[3]) * turn(h5, theta_[4])).transpose() * wrist);
            found_.push_back({theta_, branch + i});
        }
    }

    void parallel_wrist(int branch) {
        const Vec3 h2 = arm_.axis(1), h5 = arm_.axis(4), h6 = arm_.axis(5);
        const Vec3 last = rest_.linear() * h6;
        const Angles fifth = turn_to_plane(h5, h6, h2, h2.dot(last));
        for (int i = 0; i < fifth.count; ++i) {
            theta_[4] = chosen(fifth, i, near_[4]);
            const Vec3 bent = rotated(h5, theta_[4], h6);
            const Eigen::Matrix3d r5 = turn(h5, theta_[4]);
            if (h2.cross(bent).norm() < kSingular) {
                theta_[5] = near_[5];
                sum_ = angle_about(h2, rest_.linear() * (r5 * turn(h6, theta_[5])).transpose());
            } else {
                sum_ = turn_to(h2, bent, last).angle[0];
                theta_[5] = angle_about(h6, (turn(h2, sum_) * r5).transpose() * rest_.linear());
            }
            // Joints 2 and 3 must take a point of axis 4 to where the rest of the chain wants it.
            const Vec3 c = arm_.wrist(), p4 = arm_.point(3);
            const Vec3 back = c + turn(h6, -theta_[5]) * (turn(h5, -theta_[4]) * (p4 - c));
            elbow(rest_ * back, p4, branch + i);
        }
    }

    const RobotArm& arm_;
    const Joints near_;
    const Frame e_;     // what all six joints together do
    Frame rest_;        // what joints 2 to 6 do
    double sum_ = 0.0;  // about axis 2, of joints 2 to 4
    Joints theta_ = Joints::Zero();
    std::vector<ArmSolution> found_;
};

void turn_near(Joints& q, const Joints& near) {
    for (int i = 0; i < 6; ++i) q[i] = nearest_turn(q[i], near[i]);
}

bool known(const std::vector<ArmSolution>& found, const Joints& q) {
    return std::any_of(found.begin(), found.end(), [&](const ArmSolution& s) {
        Joints d = s.q - q;
        for (int i = 0; i < 6; ++i) d[i] = nearest_turn(d[i], 0.0);
        return d.cwiseAbs().maxCoeff() < kSameSolution;
    });
}

/// Number `index` of the Halton sequence of a prime base, in [0, 1).
double halton(int index, int base) {
    double value = 0.0, share = 1.0;
    for (; index > 0; index /= base) {
        share /= base;
        value += share * (index % base);
    }
    return value;
}

std::vector<ArmSolution> numeric(const RobotArm& arm, const Frame& target, const Joints& near,
                                 bool search) {
    constexpr int kPrimes[6] = {2, 3, 5, 7, 11, 13};
    std::vector<ArmSolution> found;
    for (int seed = 0; seed <= (search ? kSeeds : 0); ++seed) {
        Joints from = near;
        if (seed > 0) {
            for (int i = 0; i < 6; ++i) {
                from[i] =
                    arm.lower()[i] + halton(seed, kPrimes[i]) * (arm.upper()[i] - arm.lower()[i]);
            }
        }
        const NearestReach end = approach(arm, target, from);
        if (!solves(end)) continue;
        Joints q = end.q;
        turn_near(q, near);
        if (!known(found, q)) found.push_back({q, -1});
    }
    return found;
}

}  // namespace

double nearest_turn(double angle, double near) {
    return angle + 2.0 * M_PI * std::round((near - angle) / (2.0 * M_PI));
}

NearestReach approach(const RobotArm& arm, const Frame& target, const Joints& seed) {
    // Lengths and angles weigh alike where an arm's length turned by an angle does.
    Vector6 weight;
    weight << Vec3::Ones(), Vec3::Constant(arm.length());
    NearestReach best{seed, 0.0, 0.0};
    Vector6 raw = error_of(arm.forward(seed), target);
    Vector6 e = weight.cwiseProduct(raw);
    double damping = 1e-4;
    for (int k = 0; k < kIterations; ++k) {
        if (within(raw, kPositionGoal, kAngleGoal)) break;
        const Matrix6 j = weight.asDiagonal() * arm.jacobian(best.q);
        Matrix6 normal = j.transpose() * j;
        normal.diagonal().array() += damping * normal.trace() / 6.0;
        Joints step = normal.ldlt().solve(j.transpose() * e);
        if (!step.allFinite()) break;
        step *= std::min(1.0, kMostOfTurn / step.cwiseAbs().maxCoeff());
        const Joints q = best.q + step;
        const Vector6 next_raw = error_of(arm.forward(q), target);
        const Vector6 next = weight.cwiseProduct(next_raw);
        if (next.squaredNorm() < e.squaredNorm()) {
            const bool still = step.cwiseAbs().maxCoeff() < kStill ||
                               e.squaredNorm() - next.squaredNorm() < kStill * e.squaredNorm();
            best.q = q;
            raw = next_raw;
            e = next;
            damping = std::max(1e-14, damping * 0.1);
            if (still) break;
        } else {
            damping *= 10.0;
            if (damping > 1e8) break;
        }
    }
    best.position_error = raw.head<3>().norm();
    best.angle_error = raw.tail<3>().norm();
    return best;
}

std::vector<ArmSolution> inverse(const RobotArm& arm, const Frame& target, const Joints& near,
                                 bool search) {
    if (arm.structure() == RobotArm::Structure::kGeneral) {
        return numeric(arm, target, near, search);
    }
    std::vector<ArmSolution> found = ClosedForm(arm, target, near).solve();
    std::size_t kept = 0;
    for (ArmSolution& s : found) {
        s.q = arm.shown(s.q);
        turn_near(s.q, near);
        if (!within(error_of(arm.forward(s.q), target), kPositionTolerance, kAngleTolerance)) {
            // By rounding at the border of a branch; what lies beyond it is no solution.
            const NearestReach mended = approach(arm, target, s.q);
            if (!solves(mended)) continue;
            s.q = mended.q;
        }
        found[kept++] = s;
    }
    found.resize(kept);
    return found;
}

}  // namespace beltgrinding
