#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/state.h"
#include "engine/step_queue.h"

namespace beltgrinding {

/// A simulation's state before a step of the plan with which a motion begins: what it did since the
/// checkpoint before, or its start, and what goes on from here.
struct Checkpoint {
    std::size_t planned = 0;                             // number of that step
    std::uint32_t motion = 0;                            // of the step before it: its pose
    std::vector<StepQueue::Seen> seen;                   // since the one before
    std::vector<std::shared_ptr<const Snapshot>> parts;  // of all that is stateful, in its order

    std::size_t bytes() const;
};

/// The two in one, `next` being the one after `before`.
Checkpoint joined(const Checkpoint& before, const Checkpoint& next);

}  // namespace beltgrinding
