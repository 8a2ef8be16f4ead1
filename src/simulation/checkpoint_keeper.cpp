#include "checkpoint_keeper.h"

#include <algorithm>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "heat_keeper.h"

namespace beltgrinding {

CheckpointKeeper::CheckpointKeeper(Checkpoints& kept, StepQueue& steps, const SampleBlocks& blocks,
                                   const SimulationOptions& options)
    : kept_(kept), steps_(steps), changed_(blocks.count()) {
    const OutputRequest& outputs = options.outputs;
    const ProcessSettings& process = options.process;
    Checkpoints::Context context;
    context.samples = blocks.field().size();
    context.shifted_laws = outputs.shifted_laws.size();
    context.first_motion = outputs.first_motion;
    context.trace = outputs.trace;
    context.influence = outputs.influence;
    context.force_influence = outputs.force_influence;
    context.moves = process.force_control && !process.dynamics.ideal();
    if (outputs.recording != nullptr) context.recording = outputs.recording->begun();
    if (options.heat.part != nullptr) context.heat_nodes = options.heat.part->size();
    context.finish = options.finish.wanted;
    if (kept_.context_ != context) kept_.clear();
    kept_.context_ = context;

    StepQueue ahead = steps;
    std::size_t fit = 0;
    for (std::size_t k = 0; k < kept_.kept_.size(); ++k) {
        const Checkpoint& one = *kept_.kept_[k];
        if (!ahead.follow(one.seen)) break;
        // Where the motion goes on, what it has removed so far would be asked for.
        const auto next = ahead.next_pose();
        if (!next || *next > one.motion) fit = k + 1;
    }
    kept_.kept_.resize(fit);
    if (fit > 0) {
        last_ = kept_.kept_.back()->planned;
        steps.begin_at(last_);
        unchanged_ = last_ == kept_.end_ && last_ == steps.planned();
    }
    kept_.end_ = 0;
    steps.keep_seen();
}

void CheckpointKeeper::restore(SampleBlocks& blocks) const {
    for (const auto& one : kept_.kept_) {
        for (const SampleBlocks::Deepened& deepened : one->deepened) blocks.deepen(deepened);
        for (const SampleBlocks::Ground& ground : one->ground) blocks.restore(ground);
    }
}

void CheckpointKeeper::restore(const Parts& parts) {
    std::vector<const Recording::Part*> recorded;
    std::vector<const Conduction::Part*> heated;
    std::size_t planned = 0;
    for (const auto& one : kept_.kept_) {
        std::size_t record = 0;
        for (const StepQueue::Seen& seen : one->seen) {
            if (seen.whole) ++planned;
            if (seen.cut == 0)
                parts.monitor.restore(seen.step, planned - 1, one->touched[record++] != 0);
        }
        parts.records.insert(parts.records.end(), one->records.begin(), one->records.end());
        for (std::size_t k = 0; k < one->blocks.size() && parts.trace != nullptr; ++k)
            parts.trace->restore(one->blocks[k], one->trace[k]);
        if (parts.finish != nullptr) {
            for (std::size_t k = 0; k < one->blocks.size(); ++k)
                parts.finish->restore(one->blocks[k], one->finish[k]);
            parts.finish->restore(one->passes);
        }
        parts.grinding.restore_shifts(one->blocks, one->shifts);
        parts.grinding.restore(one->grinding);
        if (parts.influence != nullptr) parts.influence->restore(one->influence);
        recorded.push_back(&one->recording);
        heated.push_back(&one->heat);
    }
    if (!kept_.kept_.empty()) {
        const Checkpoint& now = *kept_.kept_.back();
        parts.monitor.restore(now.monitor);
        parts.pressing.carry(now.pressing);
        if (parts.wheel != nullptr) parts.wheel->restore(*now.wheel);
        if (parts.recording != nullptr) parts.recording->restore(parts.blocks, recorded);
        parts.touched = now.any_contact;
        motion_ = now.motion;
    }
    if (parts.heat != nullptr) parts.heat->restore(heated);
    go_on(parts);
    parts.grinding.watch(changed_);
}

void CheckpointKeeper::look(const Parts& parts) {
    const std::size_t number = steps_.number();
    const std::uint32_t pose = steps_.step().pose;
    if (!off_ && steps_.parts() == 1 && number > last_ && number >= due_ && pose > motion_)
        take(parts, number);
    motion_ = pose;
}

void CheckpointKeeper::end(const Parts& parts) {
    if (!off_ && steps_.planned() > last_) take(parts, steps_.planned());
    if (!kept_.kept_.empty()) kept_.end_ = steps_.planned();
}

void CheckpointKeeper::take(const Parts& parts, std::size_t planned) {
    const auto since = [](const auto& all, std::size_t from) {
        return std::span(all).subspan(from);
    };
    try {
        Checkpoint now;
        now.planned = planned;
        now.motion = motion_;
        now.seen = steps_.take_seen();
        const auto records = since(parts.records, records_);
        now.records.assign(records.begin(), records.end());
        now.touched = parts.monitor.touched(records_);
        const auto deepened = since(parts.blocks.deepened(), deepened_);
        now.deepened.assign(deepened.begin(), deepened.end());
        now.blocks = changed_.take();
        now.ground.reserve(now.blocks.size());
        for (const std::uint32_t block : now.blocks)
            now.ground.push_back(parts.blocks.ground(block));
        if (parts.trace != nullptr) {
            now.trace.reserve(now.blocks.size());
            for (const std::uint32_t block : now.blocks)
                now.trace.push_back(parts.trace->block(block));
        }
        if (parts.finish != nullptr) {
            now.finish.reserve(now.blocks.size());
            for (const std::uint32_t block : now.blocks)
                now.finish.push_back(parts.finish->block(block));
            now.passes = parts.finish->next_part();
        }
        if (parts.heat != nullptr) now.heat = parts.heat->next_part();
        now.shifts = parts.grinding.shifts(now.blocks);
        now.grinding = parts.grinding.next_part();
        if (parts.influence != nullptr) now.influence = parts.influence->next_part();
        if (parts.recording != nullptr)
            now.recording = parts.recording->part_since(frames_, stride_);
        now.monitor = parts.monitor.state();
        now.pressing = parts.pressing.carried();
        if (parts.wheel != nullptr) now.wheel = parts.wheel->state();
        now.any_contact = parts.touched;
        kept_.kept_.push_back(std::make_shared<const Checkpoint>(std::move(now)));
        kept_.thin();
    } catch (const std::bad_alloc&) {
        kept_.clear();  // the simulation itself goes on
    }
    if (kept_.kept_.empty()) {
        off_ = true;
        return;
    }
    last_ = planned;
    go_on(parts);
}

void CheckpointKeeper::go_on(const Parts& parts) {
    records_ = parts.records.size();
    deepened_ = parts.blocks.deepened().size();
    if (parts.recording != nullptr) {
        frames_ = parts.recording->last();
        stride_ = parts.recording->steps_per_frame();
    }
    // Evenly over the steps, which take about as long each.
    const std::size_t most = Checkpoints::kMost, all = steps_.planned();
    due_ = (last_ * most / all + 1) * all / most;
}

}  // namespace beltgrinding
