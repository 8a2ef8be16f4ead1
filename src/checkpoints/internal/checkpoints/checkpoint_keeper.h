#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "checkpoints/checkpoints.h"
#include "engine/state.h"
#include "engine/step_queue.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// Takes checkpoints of a simulation on its way, and puts it back to the last that holds.
class CheckpointKeeper {
  public:
    /// `all`: what goes on from step to step; of them the first `ground` is what the others are
    /// made of. `kept` loses what does not fit the path's steps, and them; the steps go on behind
    /// the last that does, and the ground is as it was there. Null: none are taken, and all else
    /// does nothing. All must outlive it.
    CheckpointKeeper(Checkpoints* kept, StepQueue& steps, std::uint32_t blocks,
                     std::vector<Stateful*> all);

    /// Puts back the rest. From here on what changes is noted.
    void restore(StepLog& log);
    /// There is nothing left to do, as in the simulation that the checkpoints are of.
    bool unchanged() const { return unchanged_; }
    /// The blocks that may have changed since the last one, to be added to.
    BlockSet& changed() { return changed_; }

    /// Takes one before the step, if the motion that it begins is one to do so.
    void look();
    /// Takes one behind the last step.
    void end();

  private:
    /// Forgets what does not fit.
    void trim();
    void take(std::size_t planned);
    /// When the next one is due.
    void go_on();
    /// The kept ones' snapshots of what has that number.
    std::vector<const Snapshot*> parts(std::size_t number) const;

    Checkpoints* kept_;
    StepQueue& steps_;
    std::vector<Stateful*> all_;
    BlockSet changed_;
    bool unchanged_ = false, off_ = false;
    std::size_t due_ = 0;       // number of the step from which on the next is taken
    std::size_t last_ = 0;      // that of the last one
    std::uint32_t motion_ = 0;  // pose of the last step that was done
};

}  // namespace beltgrinding
