#include "beltgrinding/tool_path.h"

namespace beltgrinding {

double angle_between(const Frame& a, const Frame& b) {
    return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

Frame interpolate(const Frame& a, const Frame& b, double t) {
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(a.linear()).slerp(t, Eigen::Quaterniond(b.linear()));
    Frame f = Frame::Identity();
    f.linear() = q.normalized().toRotationMatrix();
    f.translation() = (1.0 - t) * a.translation() + t * b.translation();
    return f;
}

}  // namespace beltgrinding
