#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "beltgrinding/tool_path.h"

namespace beltgrinding {

/// The steps that have been begun and not been cut, in order; the last one is the running one.
struct StepLog {
    std::vector<PathStep> steps;
    std::vector<std::size_t> planned;  // number of the planned step that each is or is a part of

    void add(const PathStep& step, std::size_t number) {
        steps.push_back(step);
        planned.push_back(number);
    }
};

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
    /// Share of the planned steps, from where it began, that are done.
    double progress() const;

    /// A step that has had its turn.
    struct Seen {
        PathStep step;
        int line;    ///< of the source, of its pose
        int cut;     ///< into so many parts; 0: it was simulated
        bool whole;  ///< as it was planned, no part
    };
    /// From here on steps that have had their turn are kept, for `take_seen`.
    void keep_seen() { keeps_ = true; }
    /// The step has been simulated.
    void done() { note(0); }
    /// Hands over what has had its turn since the last call.
    std::vector<Seen> take_seen() { return std::exchange(seen_, {}); }
    /// Goes on as the run did that saw `seen`, if this path has the same steps there, to the last
    /// bit; else returns false, somewhere among them.
    bool follow(const std::vector<Seen>& seen);
    /// Instead of the first one, the planned step number `planned` is the next. Before any `next`.
    void begin_at(std::size_t planned);
    /// The programmed pose that the step after this one leads to; none: it is the last.
    std::optional<std::uint32_t> next_pose() const {
        if (left_.empty()) return std::nullopt;
        return left_.back().step.pose;
    }

  private:
    static constexpr int kMostParts = 16;
    struct Item {
        PathStep step;
        int parts = 1;
    };
    /// Makes them the next ones, in their order.
    void put(const std::vector<PathStep>& steps, int parts);
    /// Cuts the step into so many parts.
    void part(int count);
    void note(int cut);
    int line() const { return path_.poses()[now_.step.pose].line; }

    const ToolPath& path_;
    std::vector<Item> left_;  // the next one last
    Item now_;
    std::size_t planned_ = 0, begun_ = 0, from_ = 0;
    bool keeps_ = false;
    std::vector<Seen> seen_;
};

}  // namespace beltgrinding
