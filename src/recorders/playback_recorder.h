#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/recorder.h"
#include "recorders/recording.h"

namespace beltgrinding {

/// Keeps a simulation in a Recording, to be played; what it leaves when that fails is nothing.
class PlaybackRecorder final : public Keeps<Recording::Part, Recorder> {
  public:
    /// Begins a path of `duration` s in the recording. Both must outlive it.
    PlaybackRecorder(const SampleBlocks& blocks, Recording& recording, double duration);

    std::string kind() const override;
    void end_step(const StepEnd& end) override;
    void end() override;
    void keep(HeightField&, SimulationResult&) override { guard_.kept = true; }

  private:
    Recording::Part take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const Recording::Part* const> parts) override;

    struct Guard {
        ~Guard() {
            if (!kept) recording.clear();
        }
        Recording& recording;
        bool kept = false;
    };

    const SampleBlocks& blocks_;
    Recording& recording_;
    Guard guard_;
    Recording::Begin begun_;
    std::size_t frames_ = 0, stride_ = 1;  // of the last snapshot
};

}  // namespace beltgrinding
