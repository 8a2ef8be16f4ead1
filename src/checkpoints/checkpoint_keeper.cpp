#include "checkpoints/checkpoint_keeper.h"

#include <memory>
#include <new>
#include <string>
#include <utility>

#include "checkpoint.h"

namespace beltgrinding {

CheckpointKeeper::CheckpointKeeper(Checkpoints* kept, StepQueue& steps, std::uint32_t blocks,
                                   std::vector<Stateful*> all)
    : kept_(kept), steps_(steps), all_(std::move(all)), changed_(blocks), off_(kept == nullptr) {
    if (off_) return;
    trim();
    steps.keep_seen();
    all_.front()->restore(parts(0));
}

void CheckpointKeeper::trim() {
    std::vector<std::string> kinds;
    for (const Stateful* one : all_) kinds.push_back(one->kind());
    if (kept_->kinds_ != kinds) kept_->clear();
    kept_->kinds_ = std::move(kinds);

    StepQueue ahead = steps_;
    std::size_t fit = 0;
    for (std::size_t k = 0; k < kept_->kept_.size(); ++k) {
        const Checkpoint& one = *kept_->kept_[k];
        if (!ahead.follow(one.seen)) break;
        // Where the motion goes on, what it has removed so far would be asked for.
        const auto next = ahead.next_pose();
        if (!next || *next > one.motion) fit = k + 1;
    }
    kept_->kept_.resize(fit);
    if (fit > 0) {
        last_ = kept_->kept_.back()->planned;
        motion_ = kept_->kept_.back()->motion;
        steps_.begin_at(last_);
        unchanged_ = last_ == kept_->end_ && last_ == steps_.planned();
    }
    kept_->end_ = 0;
}

std::vector<const Snapshot*> CheckpointKeeper::parts(std::size_t number) const {
    std::vector<const Snapshot*> parts;
    for (const auto& one : kept_->kept_) parts.push_back(one->parts[number].get());
    return parts;
}

void CheckpointKeeper::restore(StepLog& log) {
    if (off_) return;
    std::size_t planned = 0;
    for (const auto& one : kept_->kept_) {
        for (const StepQueue::Seen& seen : one->seen) {
            if (seen.whole) ++planned;
            if (seen.cut == 0) log.add(seen.step, planned - 1);
        }
    }
    for (std::size_t k = 1; k < all_.size(); ++k) all_[k]->restore(parts(k));
    go_on();
}

void CheckpointKeeper::look() {
    if (off_) return;
    const std::size_t number = steps_.number();
    const std::uint32_t pose = steps_.step().pose;
    if (steps_.parts() == 1 && number > last_ && number >= due_ && pose > motion_) take(number);
    motion_ = pose;
}

void CheckpointKeeper::end() {
    if (kept_ == nullptr) return;
    if (!off_ && steps_.planned() > last_) take(steps_.planned());
    if (!kept_->kept_.empty()) kept_->end_ = steps_.planned();
}

void CheckpointKeeper::take(std::size_t planned) {
    try {
        Checkpoint now{planned, motion_, steps_.take_seen(), {}};
        const std::vector<std::uint32_t> blocks = changed_.take();
        for (Stateful* one : all_) now.parts.push_back(one->snapshot(blocks));
        kept_->kept_.push_back(std::make_shared<const Checkpoint>(std::move(now)));
        kept_->thin();
    } catch (const std::bad_alloc&) {
        kept_->clear();  // the simulation itself goes on
    }
    off_ = kept_->kept_.empty();
    if (off_) return;
    last_ = planned;
    go_on();
}

void CheckpointKeeper::go_on() {
    // Evenly over the steps, which take about as long each.
    const std::size_t most = Checkpoints::kMost, all = steps_.planned();
    due_ = (last_ * most / all + 1) * all / most;
}

}  // namespace beltgrinding
