#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "cost.h"
#include "posture/posture.h"

namespace beltgrinding {

/// Samples of what is free: whole numbers of the spacing, from `low` to `high`.
struct Window {
    std::array<int, kFreedoms> low{}, high{};
    int count(std::size_t k) const { return high[k] - low[k] + 1; }
    std::size_t size() const {
        std::size_t all = 1;
        for (std::size_t k = 0; k < kFreedoms; ++k) all *= static_cast<std::size_t>(count(k));
        return all;
    }
    std::size_t number(const std::array<int, kFreedoms>& sample) const;
    std::array<int, kFreedoms> sample(std::size_t number) const;
};

enum class Seen : std::uint8_t { kNot, kFree, kNear, kMet };

/// Joint angles that do a sample, within the limits.
struct Vertex {
    Coordinates q = Joints::Zero();
    double place = 0.0;          ///< s, what being there costs, with bodies that were met
    double cost = 0.0;           ///< s, of the cheapest way to it
    std::uint32_t sample = 0;    ///< in the rung's window
    std::int32_t before = -1;    ///< the vertex of the rung before
    std::int32_t cut_from = -1;  ///< of this rung, where the pass is cut here; -1: it is not
    std::int8_t branch = -1;
    Seen seen = Seen::kNot;
    std::uint32_t first = 0, second = 0;  ///< bodies that meet
};

struct Rung {
    Window window;
    std::vector<Vertex> vertices;        ///< in the order of their samples
    std::vector<std::uint32_t> begins;   ///< of each sample's vertices, and the end
    std::vector<std::uint8_t> seen;      ///< of each sample: what goes with the tool was looked at
    std::array<int, kFreedoms> steps{};  ///< samples that may lie between it and the rung before
    bool begins_pass = false;
    bool torn = false;    ///< no way leads here from the rung before
    bool solved = false;  ///< there are joint angles, perhaps beyond the limits
};

/// The rungs of all poses for windows of samples; and the cheapest way through them.
class Ladder {
  public:
    Ladder(const ArmScene& scene, const std::vector<PassPose>& poses,
           const PostureOptions& options);

    /// Makes the rungs anew. `spacing`: as `Free`; `most_steps`: samples between neighbours.
    void build(const std::vector<Window>& windows, const std::array<double, kFreedoms>& spacing,
               int most_steps, const RunContext& context);
    /// One vertex for each pose, -1: none; searched until no body is met that was not known.
    struct Step {
        std::size_t rung;
        std::int32_t vertex;
        bool cut;
    };
    std::vector<Step> search(const RunContext& context);

    const Rung& rung(std::size_t i) const { return rungs_[i]; }
    Free free(std::size_t rung, std::uint32_t sample) const;
    /// What may lie between two neighbouring poses, so that the straight way stays on the pass.
    const std::vector<Free>& bounds() const { return bounds_; }

  private:
    void fill(std::size_t i);
    void forward(std::size_t i);
    void link(std::size_t i, const Rung* before);
    void follow(std::size_t i);
    void follow_from(const Rung& before, std::size_t sample, double duration, Vertex& vertex) const;
    void cut(std::size_t i);
    std::vector<Step> backward() const;
    bool look(const std::vector<Step>& way, const RunContext& context);
    bool look_at(std::size_t i, Vertex& vertex);
    bool look_at_tool(std::size_t i, const Vertex& vertex);
    bool look_at_arm(std::size_t i, Vertex& vertex);
    double near_cost(std::size_t i, const Coordinates& q, ArmScene::Pairs pairs) const;

    const ArmScene& scene_;
    const std::vector<PassPose>& poses_;
    const PostureOptions& options_;
    Cost cost_;
    std::vector<double> times_;
    std::vector<Free> bounds_;
    std::array<double, kFreedoms> spacing_{};
    std::vector<Rung> rungs_;
};

/// Joints with external axes at what is free.
Coordinates with_axes(const ArmScene& scene, const Joints& q, const Free& free);

/// All ways to write a solution with whole turns within the limits, those nearest to `near` first,
/// at most `most`.
std::vector<Joints> turns_within(const RobotArm& arm, const Joints& q, const Joints& near,
                                 std::size_t most);

}  // namespace beltgrinding
