#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "actuated_wheel.h"
#include "beltgrinding/simulation.h"
#include "finish_keeper.h"
#include "grinding.h"
#include "heat/conduction.h"
#include "heightfield/sample_blocks.h"
#include "influence_keeper.h"
#include "pressing.h"
#include "process_monitor.h"
#include "simulation/recording.h"
#include "step_queue.h"
#include "trace_keeper.h"

namespace beltgrinding {

/// A simulation's state before a step of the plan with which a motion begins: what it did since the
/// checkpoint before, or its start, and what goes on from here.
struct Checkpoint {
    std::size_t planned = 0;   // number of that step
    std::uint32_t motion = 0;  // of the step before it: its pose

    // Since the one before.
    std::vector<StepQueue::Seen> seen;
    std::vector<StepRecord> records;    // one for each that was not cut
    std::vector<std::uint8_t> touched;  // the same
    std::vector<SampleBlocks::Deepened> deepened;
    std::vector<std::uint32_t> blocks;  // that may have changed, ascending
    std::vector<SampleBlocks::Ground> ground;
    std::vector<TraceKeeper::Block> trace;    // empty: none is kept
    std::vector<FinishKeeper::Block> finish;  // of the blocks; empty: none is kept
    Eigen::ArrayXXd shifts;                   // of the blocks' positions; as Grinding::shifts
    InfluenceKeeper::Part influence;
    Grinding::Part grinding;
    Recording::Part recording;
    Conduction::Part heat;
    FinishKeeper::Part passes;

    // As of now.
    ProcessMonitor::State monitor;
    Pressing::Carried pressing;
    std::optional<ActuatedWheel::State> wheel;
    bool any_contact = false;  // so far

    std::size_t bytes() const;
};

/// The two in one, `next` being the one after `before`.
Checkpoint joined(const Checkpoint& before, const Checkpoint& next);

}  // namespace beltgrinding
