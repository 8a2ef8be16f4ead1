#include "trace_recorder.h"

#include <algorithm>
#include <utility>

#include "base/lanes.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

using namespace lanes;

/// A block's arrays.
struct Traced {
    std::uint32_t *first, *last, *dominant;
    float *dominant_depth, *removed;
};

BELTGRINDING_CLONES
void trace_block(const Traced& traced, const double* before, const double* height,
                 std::uint32_t motion) {
    const Ints now = Ints{} + static_cast<std::int32_t>(motion);
    const Ints never = Ints{} + static_cast<std::int32_t>(RemovalTrace::kNever);
    for (int k = 0; k < static_cast<int>(SampleBlocks::kLanes); k += kWide) {
        const Floats less =
            __builtin_convertvector(load_doubles(before + k) - load_doubles(height + k), Floats);
        const Ints some = less > 0.0f;  // else it is lost in rounding
        const Ints first = load(traced.first + k), last = load(traced.last + k);
        const Ints begins = some & (first == never);
        store(traced.first + k, begins ? now : first);
        store(traced.last + k, some ? now : last);
        const Floats so_far = load(traced.removed + k);
        const Floats removed = some ? so_far + less : so_far;
        store(traced.removed + k, removed);
        const Floats most = load(traced.dominant_depth + k);
        const Ints leads = some & (removed > most);
        store(traced.dominant + k, leads ? now : load(traced.dominant + k));
        store(traced.dominant_depth + k, leads ? removed : most);
    }
}

/// By position, with as many lanes in the last block as in others.
template <class T>
std::vector<T> by_position(const SampleBlocks& blocks, const std::vector<T>& by_sample, T none) {
    std::vector<T> values(std::size_t{blocks.count()} * SampleBlocks::kLanes, none);
    for (std::size_t k = 0; k < by_sample.size(); ++k) values[k] = by_sample[blocks.sample(k)];
    return values;
}

/// Has `values`, by position, by sample; `room` is room for as many, whose values do not matter.
template <class T>
void sort_by_sample(const SampleBlocks& blocks, std::vector<T>& values, std::vector<T>& room) {
    room.resize(blocks.samples().size());
    for (std::size_t k = 0; k < room.size(); ++k) room[blocks.sample(k)] = values[k];
    values.swap(room);
}

}  // namespace

TraceRecorder::TraceRecorder(const SampleBlocks& blocks)
    : Keeps(&PhaseTimes::trace), blocks_(blocks) {
    const HeightField& field = blocks.field();
    const RemovalTrace& before = field.trace;
    if (!before.empty() && before.first.size() != field.size()) {
        throw InputError("simulation.other_trace", "the field's removal trace is of another field");
    }
    trace_.first = by_position(blocks, before.first, RemovalTrace::kNever);
    trace_.last = by_position(blocks, before.last, RemovalTrace::kNever);
    trace_.dominant = by_position(blocks, before.dominant, RemovalTrace::kNever);
    trace_.dominant_depth = by_position(blocks, before.dominant_depth, 0.0F);
    trace_.peak_pressure = by_position(blocks, before.peak_pressure, 0.0F);
    its_place_.assign(blocks.count(), kNone);
}

TraceRecorder::Depths& TraceRecorder::removed_of(std::uint32_t block) {
    std::uint32_t& place = its_place_[block];
    if (place == kNone) {
        place = static_cast<std::uint32_t>(changed_.size());
        changed_.push_back(block);
        if (removed_.size() == place) removed_.emplace_back();
        removed_[place].fill(0.0F);
    }
    return removed_[place];
}

void TraceRecorder::pressed(const Press& press) {
    if (press.pressing.rigid()) return;  // it has no pressure
    press.pressing.map().raise(press.pressing.displaced_pressure(), trace_.peak_pressure);
}

void TraceRecorder::end_step(const StepEnd& end) {
    if (end.changes.empty()) return;
    if (end.motion != motion_) {
        for (const std::uint32_t block : changed_) its_place_[block] = kNone;
        changed_.clear();
        motion_ = end.motion;
    }
    for (const SampleBlocks::Change& change : end.changes) {
        const std::size_t at = std::size_t{change.block} * SampleBlocks::kLanes;
        trace_block({&trace_.first[at], &trace_.last[at], &trace_.dominant[at],
                     &trace_.dominant_depth[at], removed_of(change.block).data()},
                    blocks_.before(change).data(), blocks_.block(change.block).height.data(),
                    motion_);
    }
}

ByBlock<TracedBlock> TraceRecorder::take(std::span<const std::uint32_t> blocks) {
    return {blocks, [this](std::uint32_t number) {
                TracedBlock block;
                const std::size_t at = std::size_t{number} * SampleBlocks::kLanes;
                const auto copy = [at](const auto& from, auto& to) {
                    std::copy_n(&from[at], to.size(), to.begin());
                };
                copy(trace_.first, block.first);
                copy(trace_.last, block.last);
                copy(trace_.dominant, block.dominant);
                copy(trace_.dominant_depth, block.dominant_depth);
                copy(trace_.peak_pressure, block.peak_pressure);
                return block;
            }};
}

void TraceRecorder::put(std::span<const ByBlock<TracedBlock>* const> parts) {
    const auto restore = [this](std::uint32_t number, const TracedBlock& block) {
        const std::size_t at = std::size_t{number} * SampleBlocks::kLanes;
        const auto copy = [at](const auto& from, auto& to) {
            std::copy(from.begin(), from.end(), &to[at]);
        };
        copy(block.first, trace_.first);
        copy(block.last, trace_.last);
        copy(block.dominant, trace_.dominant);
        copy(block.dominant_depth, trace_.dominant_depth);
        copy(block.peak_pressure, trace_.peak_pressure);
    };
    for (const ByBlock<TracedBlock>* part : parts) part->each(restore);
}

void TraceRecorder::end() {
    removed_ = {};
    // One array at a time, so that the trace is never there twice.
    std::vector<std::uint32_t> numbers(trace_.first.size());
    for (auto* values : {&trace_.first, &trace_.last, &trace_.dominant})
        sort_by_sample(blocks_, *values, numbers);
    numbers = {};
    std::vector<float> lengths(trace_.peak_pressure.size());
    for (auto* values : {&trace_.dominant_depth, &trace_.peak_pressure})
        sort_by_sample(blocks_, *values, lengths);
}

void TraceRecorder::keep(HeightField& field, SimulationResult&) {
    field.trace = std::move(trace_);
}

}  // namespace beltgrinding
