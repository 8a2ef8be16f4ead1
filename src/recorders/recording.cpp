#include "recorders/recording.h"

#include <algorithm>
#include <bit>
#include <span>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// A key frame sums up frames of this many changes: they are what a seek replays one by one, in some
// milliseconds.
constexpr std::size_t kKeyFrameChanges = std::size_t{1} << 21;

/// Heights by number, each the last one given; taken out in ascending order.
class Latest {
  public:
    explicit Latest(std::size_t numbers)
        : marked_((numbers + 63) / 64, 0), height_(numbers, 0.0f) {}
    void set(std::uint32_t number, float height) {
        marked_[number >> 6] |= std::uint64_t{1} << (number & 63);
        height_[number] = height;
    }
    /// Calls visit(number, height) for all that were given.
    template <class Visit>
    void take(Visit visit) {
        for (std::size_t w = 0; w < marked_.size(); ++w) {
            for (std::uint64_t bits = marked_[w]; bits != 0; bits &= bits - 1) {
                const auto number = static_cast<std::uint32_t>(64 * w) +
                                    static_cast<std::uint32_t>(std::countr_zero(bits));
                visit(number, height_[number]);
            }
            marked_[w] = 0;
        }
    }
    /// The same as a block of `log`.
    void take(ChangeLog& log) {
        log.begin_block();
        take([&](std::uint32_t number, float height) { log.add(number, height); });
        log.end_block();
    }

  private:
    std::vector<std::uint64_t> marked_;
    std::vector<float> height_;
};

}  // namespace

Recording::Recording(std::size_t max_bytes) : max_bytes_(max_bytes) {
    clear();
}

void Recording::clear() {
    start_.clear();
    order_.clear();
    log_ = keys_ = {};
    key_end_.clear();
    times_.assign(1, 0.0);
    steps_.assign(1, 0);
    stride_ = 1;
    duration_ = offset_ = 0.0;
    pending_.clear();
    pending_blocks_.clear();
    pending_steps_ = total_steps_ = 0;
}

void Recording::begin(const HeightField& field, double duration,
                      std::span<const std::uint32_t> order) {
    field.validate();
    if (start_.empty()) {
        start_.assign(field.height.begin(), field.height.end());
        order_.assign(order.begin(), order.end());
    } else if (start_.size() != field.size()) {
        throw InputError("recording.other_field",
                         "the recording has {recorded} samples, the height field {given}; record "
                         "each field on its own",
                         {{"recorded", start_.size()}, {"given", field.size()}});
    } else if (!std::equal(order.begin(), order.end(), order_.begin(), order_.end())) {
        throw InputError("recording.other_place",
                         "the recording's samples lie elsewhere than those of the height field; "
                         "record each field on its own");
    }
    offset_ = duration_;
    duration_ += duration;
}

void Recording::add_step(const SampleBlocks& blocks, std::span<const SampleBlocks::Change> changes,
                         double time) {
    pending_.resize(blocks.count(), 0);
    for (const SampleBlocks::Change& change : changes) {
        if (pending_[change.block] == 0) pending_blocks_.push_back(change.block);
        pending_[change.block] |= change.lanes;
    }
    pending_time_ = offset_ + time;
    ++total_steps_;
    if (++pending_steps_ >= stride_) close_frame(blocks);
}

void Recording::end(const SampleBlocks& blocks) {
    if (pending_steps_ > 0) close_frame(blocks);
    log_.shrink_to_fit();
    make_key_frames();
}

void Recording::close_frame(const SampleBlocks& blocks) {
    std::sort(pending_blocks_.begin(), pending_blocks_.end());
    log_.begin_block();
    for (const std::uint32_t number : pending_blocks_) {
        const auto& height = blocks.block(number).height;
        std::size_t lane = 0;
        for (std::uint64_t lanes = pending_[number]; lanes != 0;) {
            const auto skipped = static_cast<std::size_t>(std::countr_zero(lanes));
            lanes >>= skipped;
            lane += skipped;
            const auto count = static_cast<std::size_t>(std::countr_one(lanes));
            log_.add(static_cast<std::uint32_t>(number * SampleBlocks::kLanes + lane),
                     std::span(height).subspan(lane, count));
            lanes = count < SampleBlocks::kLanes ? lanes >> count : 0;
            lane += count;
        }
        pending_[number] = 0;
    }
    log_.end_block();
    times_.push_back(pending_time_);
    steps_.push_back(static_cast<std::uint32_t>(total_steps_));
    pending_blocks_.clear();
    pending_steps_ = 0;
    if (log_.bytes() > max_bytes_ && last() > 1) halve();
}

void Recording::Part::append(const Part& next) {
    if (next.whole) {
        *this = next;
        return;
    }
    log.append(next.log);
    times.insert(times.end(), next.times.begin(), next.times.end());
    steps.insert(steps.end(), next.steps.begin(), next.steps.end());
    stride = next.stride;
    pending_steps = next.pending_steps;
    total_steps = next.total_steps;
    pending_time = next.pending_time;
    pending = next.pending;
}

std::size_t Recording::Part::bytes() const {
    return log.bytes() + times.size() * (sizeof(double) + sizeof(std::uint32_t)) +
           pending.size() * sizeof(pending.front());
}

Recording::Part Recording::part_since(std::size_t frames, std::size_t stride) const {
    Part part;
    part.whole = stride != stride_;
    const std::size_t from = part.whole ? 0 : frames;
    part.log.append(log_, from);
    const auto after = static_cast<std::ptrdiff_t>(from + 1);  // the time of no frame is the first
    part.times.assign(times_.begin() + after, times_.end());
    part.steps.assign(steps_.begin() + after, steps_.end());
    part.stride = stride_;
    part.pending_steps = pending_steps_;
    part.total_steps = total_steps_;
    part.pending_time = pending_time_;
    for (const std::uint32_t block : pending_blocks_)
        part.pending.emplace_back(block, pending_[block]);
    return part;
}

void Recording::restore(const SampleBlocks& blocks, std::span<const Part* const> parts) {
    for (const Part* part : parts) {
        if (part->whole) {
            log_ = {};
            times_.assign(1, 0.0);
            steps_.assign(1, 0);
        }
        log_.append(part->log);
        times_.insert(times_.end(), part->times.begin(), part->times.end());
        steps_.insert(steps_.end(), part->steps.begin(), part->steps.end());
    }
    if (parts.empty()) return;
    const Part& last = *parts.back();
    stride_ = last.stride;
    pending_steps_ = last.pending_steps;
    total_steps_ = last.total_steps;
    pending_time_ = last.pending_time;
    pending_.assign(blocks.count(), 0);
    pending_blocks_.clear();
    for (const auto& [block, lanes] : last.pending) {
        pending_blocks_.push_back(block);
        pending_[block] = lanes;
    }
    keys_ = {};
    key_end_.clear();
}

void Recording::make_key_frames() {
    std::size_t begun = key_end_.empty() ? 0 : key_end_.back();
    const std::size_t made = key_end_.size();
    std::size_t changes = 0;
    std::vector<std::size_t> begins;
    for (std::size_t frame = begun; frame < last(); ++frame) {
        changes += log_.changes(frame);
        if (changes < kKeyFrameChanges) continue;
        begins.push_back(begun);
        begun = frame + 1;
        key_end_.push_back(static_cast<std::uint32_t>(begun));
        changes = 0;
    }
    std::vector<ChangeLog> keys(begins.size());
    parallel_blocks(keys.size(), 1, {}, [&](std::size_t key, std::size_t) {
        Latest latest(samples());
        for (std::size_t frame = begins[key]; frame < key_end_[made + key]; ++frame)
            log_.visit(frame, [&](std::uint32_t s, float h) { latest.set(s, h); });
        latest.take(keys[key]);
        keys[key].shrink_to_fit();
    });
    for (const ChangeLog& key : keys) keys_.append(key);
}

void Recording::halve() {
    ChangeLog log;
    std::vector<double> times(1, 0.0);
    std::vector<std::uint32_t> steps(1, 0);
    Latest latest(samples());
    for (std::size_t k = 0; k < last(); k += 2) {
        const std::size_t next = std::min(k + 2, last());
        for (std::size_t i = k; i < next; ++i) {
            log_.visit(i, [&](std::uint32_t s, float h) { latest.set(s, h); });
        }
        log_.forget_before(next);
        latest.take(log);
        times.push_back(times_[next]);
        steps.push_back(steps_[next]);
    }
    log_ = std::move(log);
    times_ = std::move(times);
    steps_ = std::move(steps);
    stride_ *= 2;
    keys_ = {};
    key_end_.clear();
}

std::size_t Recording::frame_at(double time) const {
    const auto after = std::upper_bound(times_.begin() + 1, times_.end(), time);
    return static_cast<std::size_t>(after - times_.begin()) - 1;
}

std::size_t Recording::bytes() const {
    return start_.size() * sizeof(float) + order_.size() * sizeof(std::uint32_t) + log_.bytes() +
           keys_.bytes() + times_.size() * (sizeof(double) + sizeof(std::uint32_t)) +
           key_end_.size() * sizeof(std::uint32_t);
}

void Recording::check_frame(std::size_t frame) const {
    if (frame > last()) {
        throw InputError("recording.no_such_frame",
                         "there is no frame {frame}; the recording has {last}",
                         {{"frame", frame}, {"last", last()}});
    }
}

template <class Visit>
void Recording::visit(std::size_t from, std::size_t to, Visit&& visit) const {
    for (std::size_t k = from; k < to;) {
        const auto after = std::upper_bound(key_end_.begin(), key_end_.end(), k);
        const auto key = static_cast<std::size_t>(after - key_end_.begin());
        const std::size_t begun = key == 0 ? 0 : key_end_[key - 1];
        if (after != key_end_.end() && begun == k && *after <= to) {
            keys_.visit(key, visit);
            k = *after;
        } else {
            log_.visit(k, visit);
            ++k;
        }
    }
}

std::vector<float> Recording::heights_at(std::size_t frame) const {
    check_frame(frame);
    std::vector<float> height = start_;
    visit(0, frame, [&](std::uint32_t p, float h) { height[sample_at(p)] = h; });
    return height;
}

Recording::Changes Recording::advance(std::size_t from, std::size_t to) const {
    check_frame(from);
    check_frame(to);
    Latest latest(samples());
    visit(std::min(from, to), std::max(from, to),
          [&](std::uint32_t p, float h) { latest.set(sample_at(p), h); });
    Changes changes;
    latest.take([&](std::uint32_t sample, float height) {
        changes.sample.push_back(sample);
        changes.height.push_back(height);
    });
    if (to < from && !changes.sample.empty()) {
        const std::vector<float> height = heights_at(to);
        std::transform(changes.sample.begin(), changes.sample.end(), changes.height.begin(),
                       [&](std::uint32_t s) { return height[s]; });
    }
    return changes;
}

}  // namespace beltgrinding
