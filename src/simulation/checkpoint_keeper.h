#pragma once

#include <cstddef>
#include <vector>

#include "checkpoint.h"
#include "simulation/checkpoints.h"

namespace beltgrinding {

/// Takes checkpoints of a simulation on its way, and puts it back to the last that holds.
class CheckpointKeeper {
  public:
    /// What of a simulation goes on from step to step.
    struct Parts {
        SampleBlocks& blocks;
        ProcessMonitor& monitor;
        Pressing& pressing;
        Grinding& grinding;
        TraceKeeper* trace;          // null: none is kept
        InfluenceKeeper* influence;  // the same
        HeatKeeper* heat;            // the same
        FinishKeeper* finish;        // the same
        ActuatedWheel* wheel;        // null: the force is met at every moment
        Recording* recording;        // null: there is none
        std::vector<StepRecord>& records;
        bool& touched;
    };

    /// `kept` loses what does not fit the path's steps, and the settings; the steps go on behind
    /// the last that does. The path is begun in the recording. All must outlive it.
    CheckpointKeeper(Checkpoints& kept, StepQueue& steps, const SampleBlocks& blocks,
                     const SimulationOptions& options);

    /// Puts the blocks back to what they were there.
    void restore(SampleBlocks& blocks) const;
    /// The rest; all are made of the blocks as they are then. From here on what changes is noted.
    void restore(const Parts& parts);
    /// There is nothing left to do, as in the simulation that the checkpoints are of.
    bool unchanged() const { return unchanged_; }

    /// Takes one before the step, if the motion that it begins is one to do so.
    void look(const Parts& parts);
    /// Takes one behind the last step.
    void end(const Parts& parts);

  private:
    void take(const Parts& parts, std::size_t planned);
    /// What comes from here on is the next one's.
    void go_on(const Parts& parts);

    Checkpoints& kept_;
    StepQueue& steps_;
    BlockSet changed_;
    bool unchanged_ = false, off_ = false;
    std::size_t due_ = 0;       // number of the step from which on the next is taken
    std::size_t last_ = 0;      // that of the last one
    std::uint32_t motion_ = 0;  // pose of the last step that was done
    // of the last one
    std::size_t records_ = 0, deepened_ = 0, frames_ = 0, stride_ = 1;
};

}  // namespace beltgrinding
