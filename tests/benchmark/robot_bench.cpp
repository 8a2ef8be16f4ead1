// What following a robot costs: all solutions of a pose, and a linear motion step by step.
#include <benchmark/benchmark.h>

#include "robot/arms.h"
#include "robot/inverse_kinematics.h"
#include "robot/reach.h"

namespace beltgrinding {
namespace {

RobotModel model_of(long kind) {
    if (kind == 0) return testing::wrist_arm();
    return kind == 1 ? testing::parallel_arm() : testing::calibrated_arm();
}

Joints joints_of(long kind) {
    return kind == 0 ? testing::degrees(10, -70, 80, 20, 50, 30)
                     : testing::degrees(20, -70, 80, -100, 70, 10);
}

void all_solutions(benchmark::State& state) {
    const RobotArm arm(model_of(state.range(0)));
    const Joints q = joints_of(state.range(0));
    const Frame pose = arm.forward(q);
    for (auto _ : state) {
        benchmark::DoNotOptimize(inverse(arm, pose, q + Joints::Constant(0.02), false));
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(all_solutions)->ArgName("arm")->DenseRange(0, 2);

void follow(benchmark::State& state) {
    const RobotArm arm(model_of(state.range(0)));
    PathPose a, b;
    a.base_from_tcp = arm.forward(joints_of(state.range(0)));
    b.base_from_tcp = Eigen::Translation3d(60, 60, -60) * a.base_from_tcp;
    const ToolPath path({a, b}, {});
    std::size_t checks = 0;
    for (auto _ : state) checks += check_reach(path, arm, {}).checks;
    state.SetItemsProcessed(static_cast<long>(checks));
}
BENCHMARK(follow)->ArgName("arm")->DenseRange(0, 2);

}  // namespace
}  // namespace beltgrinding
