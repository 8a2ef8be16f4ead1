#include "playback_recorder.h"

#include <sstream>

namespace beltgrinding {

PlaybackRecorder::PlaybackRecorder(const SampleBlocks& blocks, Recording& recording,
                                   double duration)
    : Keeps(&PhaseTimes::trace), blocks_(blocks), recording_(recording), guard_{recording} {
    recording.begin(blocks.field(), duration, blocks.samples());
    begun_ = recording.begun();
}

std::string PlaybackRecorder::kind() const {
    std::ostringstream told;
    told << "recording from " << std::hexfloat << begun_.offset;  // all of its bits
    for (const std::size_t one :
         {begun_.max_bytes, begun_.frames, begun_.steps_per_frame, begun_.steps})
        told << ' ' << one;
    return told.str();
}

void PlaybackRecorder::end_step(const StepEnd& end) {
    recording_.add_step(blocks_, end.changes, end.step.time + 0.5 * end.step.duration);
}

void PlaybackRecorder::end() {
    recording_.end(blocks_);
}

Recording::Part PlaybackRecorder::take(std::span<const std::uint32_t>) {
    Recording::Part part = recording_.part_since(frames_, stride_);
    frames_ = recording_.last();
    stride_ = recording_.steps_per_frame();
    return part;
}

void PlaybackRecorder::put(std::span<const Recording::Part* const> parts) {
    if (!parts.empty()) recording_.restore(blocks_, parts);
    frames_ = recording_.last();
    stride_ = recording_.steps_per_frame();
}

}  // namespace beltgrinding
