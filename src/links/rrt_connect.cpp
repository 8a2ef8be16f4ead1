#include "rrt_connect.h"

// The one file with OMPL.
#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <memory>

namespace beltgrinding {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kRange = 0.7;  // rad or m, the longest motion that is added to a tree

/// Of a state of a space with so many rows.
class Reading {
  public:
    explicit Reading(Eigen::Index size) : size_(size) {}
    Coordinates operator()(const ob::State* state) const {
        return Eigen::Map<const Eigen::VectorXd>(
            state->as<ob::RealVectorStateSpace::StateType>()->values, size_);
    }

  private:
    Eigen::Index size_;
};

class SeededSampler : public ob::RealVectorStateSampler {
  public:
    SeededSampler(const ob::StateSpace* space, std::uint32_t seed)
        : ob::RealVectorStateSampler(space) {
        rng_.setLocalSeed(seed);
    }
};

class Joined : public ob::MotionValidator {
  public:
    Joined(const ob::SpaceInformationPtr& information,
           const std::function<bool(const Coordinates&, const Coordinates&)>& joined,
           const Reading& reading)
        : ob::MotionValidator(information), joined_(joined), reading_(reading) {}
    bool checkMotion(const ob::State* a, const ob::State* b) const override {
        return joined_(reading_(a), reading_(b));
    }
    bool checkMotion(const ob::State* a, const ob::State* b,
                     std::pair<ob::State*, double>& last) const override {
        const bool whole = checkMotion(a, b);
        if (!whole) last.second = 0.0;
        return whole;
    }

  private:
    const std::function<bool(const Coordinates&, const Coordinates&)>& joined_;
    Reading reading_;
};

ob::ScopedState<ob::RealVectorStateSpace> state_of(const ob::StateSpacePtr& space,
                                                   const Coordinates& q) {
    ob::ScopedState<ob::RealVectorStateSpace> state(space);
    for (unsigned j = 0; j < q.size(); ++j) state[j] = q[j];
    return state;
}

}  // namespace

std::vector<Coordinates> rrt_connect(
    const Coordinates& lower, const Coordinates& upper, const Coordinates& from,
    const Coordinates& to, const std::function<bool(const Coordinates&)>& free,
    const std::function<bool(const Coordinates&, const Coordinates&)>& joined, std::uint32_t seed,
    std::size_t iterations, const RunContext& context) {
    ompl::msg::noOutputHandler();
    const auto size = static_cast<unsigned>(from.size());
    const Reading joints_of(from.size());
    auto space = std::make_shared<ob::RealVectorStateSpace>(size);
    ob::RealVectorBounds bounds(size);
    for (unsigned j = 0; j < size; ++j) {
        // The ends lie within by rounding.
        bounds.setLow(j, std::min({lower[j], from[j], to[j]}));
        bounds.setHigh(j, std::max({upper[j], from[j], to[j]}));
    }
    space->setBounds(bounds);
    space->setStateSamplerAllocator([seed](const ob::StateSpace* one) {
        return std::make_shared<SeededSampler>(one, seed == 0 ? 1 : seed);
    });
    auto information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker(
        [&](const ob::State* state) { return free(joints_of(state)); });
    information->setMotionValidator(std::make_shared<Joined>(information, joined, joints_of));
    information->setup();
    auto problem = std::make_shared<ob::ProblemDefinition>(information);
    problem->setStartAndGoalStates(state_of(space, from), state_of(space, to));
    og::RRTConnect planner(information);
    planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();  // others draw from OMPL's seed
    planner.setRange(kRange);
    planner.setProblemDefinition(problem);
    planner.setup();
    std::size_t asked = 0;
    const ob::PlannerStatus status = planner.solve(ob::PlannerTerminationCondition(
        [&] { return context.cancelled() || ++asked > iterations; }));
    context.throw_if_cancelled();
    std::vector<Coordinates> way;
    if (status != ob::PlannerStatus::EXACT_SOLUTION) return way;
    const auto* path = problem->getSolutionPath()->as<og::PathGeometric>();
    for (std::size_t n = 0; n < path->getStateCount(); ++n)
        way.push_back(joints_of(path->getState(static_cast<unsigned>(n))));
    way.front() = from;
    way.back() = to;
    return way;
}

}  // namespace beltgrinding
