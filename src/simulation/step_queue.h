#pragma once

#include <cstddef>
#include <vector>

#include "beltgrinding/tool_path.h"

namespace beltgrinding {

/// A path's steps in order, of which one may be cut smaller when its turn has come.
class StepQueue {
  public:
    /// The path must outlive it.
    StepQueue(const ToolPath& path, const SteppingOptions& options);

    /// Steps that the path was planned with.
    std::size_t planned() const { return planned_; }
    /// Goes on to the next step; false when there is none.
    bool next();
    const PathStep& step() const { return now_.step; }
    /// Number of the planned step that it is or is a part of.
    std::size_t number() const { return begun_ - 1; }
    /// Share of a planned step that it is.
    double share() const { return 1.0 / now_.parts; }
    /// Parts that the planned step has been cut into.
    int parts() const { return now_.parts; }
    /// Whether `cut(parts)` may be called: there is a bound to the parts of a planned step. One
    /// that needs more is not cut at all, which would cost much and not be enough.
    bool divisible(double parts) const {
        return 2 * now_.parts <= kMostParts && parts * now_.parts <= kMostParts;
    }
    bool divisible() const { return 2 * now_.parts <= kMostParts; }
    /// Puts `parts` smaller steps, or as many as may be, in the step's place; `next` gives the
    /// first.
    void cut(double parts);
    /// Share of the planned steps that are done.
    double progress() const;

  private:
    static constexpr int kMostParts = 16;
    struct Item {
        PathStep step;
        int parts = 1;
    };
    /// Makes them the next ones, in their order.
    void put(const std::vector<PathStep>& steps, int parts);

    const ToolPath& path_;
    std::vector<Item> left_;  // the next one last
    Item now_;
    std::size_t planned_ = 0, begun_ = 0;
};

}  // namespace beltgrinding
