#include "simulation/recording.h"

#include <algorithm>
#include <string>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// A key frame sums up frames of this many changes: they are what a seek replays one by one, in some
// milliseconds.
constexpr std::size_t kKeyFrameChanges = std::size_t{1} << 21;

/// Heights of samples, each the last one given; taken out in ascending order.
class Latest {
  public:
    explicit Latest(std::size_t samples)
        : marked_((samples + 63) / 64, 0), height_(samples, 0.0f) {}
    void set(std::uint32_t sample, float height) {
        marked_[sample >> 6] |= std::uint64_t{1} << (sample & 63);
        height_[sample] = height;
    }
    Recording::Changes take() {
        Recording::Changes changes;
        for (std::size_t w = 0; w < marked_.size(); ++w) {
            for (std::uint64_t bits = marked_[w]; bits != 0; bits &= bits - 1) {
                const auto sample = static_cast<std::uint32_t>(
                    64 * w + static_cast<std::size_t>(__builtin_ctzll(bits)));
                changes.sample.push_back(sample);
                changes.height.push_back(height_[sample]);
            }
            marked_[w] = 0;
        }
        return changes;
    }

  private:
    std::vector<std::uint64_t> marked_;
    std::vector<float> height_;
};

}  // namespace

std::size_t ChangeLog::bytes() const {
    return runs_.size() * sizeof(Run) + height_.size() * sizeof(float) + ends_.size() * sizeof(End);
}

void ChangeLog::shrink_to_fit() {
    runs_.shrink_to_fit();
    height_.shrink_to_fit();
    ends_.shrink_to_fit();
}

void ChangeLog::append(std::span<const std::uint32_t> samples, std::span<const float> heights) {
    const std::size_t first = runs_.size();
    for (const std::uint32_t sample : samples) {
        if (runs_.size() > first && runs_.back().first + runs_.back().count == sample) {
            ++runs_.back().count;
        } else {
            runs_.push_back({sample, 1});
        }
    }
    height_.insert(height_.end(), heights.begin(), heights.end());
    ends_.push_back({runs_.size(), height_.size()});
}

Recording::Recording(std::size_t max_bytes) : max_bytes_(max_bytes) {
    clear();
}

void Recording::clear() {
    start_.clear();
    log_ = keys_ = {};
    key_end_.clear();
    open_changes_ = 0;
    times_.assign(1, 0.0);
    steps_.assign(1, 0);
    stride_ = 1;
    duration_ = offset_ = 0.0;
    pending_.clear();
    pending_steps_ = total_steps_ = 0;
}

void Recording::begin(const HeightField& field, double duration) {
    if (start_.empty()) {
        start_.assign(field.height.begin(), field.height.end());
    } else if (start_.size() != field.size()) {
        throw InputError("recording.other_field",
                         "the recording has {recorded} samples, the height field {given}; record "
                         "each field on its own",
                         {{"recorded", start_.size()}, {"given", field.size()}});
    }
    offset_ = duration_;
    duration_ += duration;
}

void Recording::add_step(const HeightField& field, std::span<const std::uint32_t> changed,
                         double time) {
    pending_.insert(pending_.end(), changed.begin(), changed.end());
    pending_time_ = offset_ + time;
    ++total_steps_;
    if (++pending_steps_ >= stride_) close_frame(field);
}

void Recording::end(const HeightField& field) {
    if (pending_steps_ > 0) close_frame(field);
    log_.shrink_to_fit();
    keys_.shrink_to_fit();
}

void Recording::close_frame(const HeightField& field) {
    if (stride_ > 1) {
        std::sort(pending_.begin(), pending_.end());
        pending_.erase(std::unique(pending_.begin(), pending_.end()), pending_.end());
    }
    std::vector<float> heights(pending_.size());
    std::transform(pending_.begin(), pending_.end(), heights.begin(),
                   [&](std::uint32_t s) { return static_cast<float>(field.height[s]); });
    log_.append(pending_, heights);
    times_.push_back(pending_time_);
    steps_.push_back(static_cast<std::uint32_t>(total_steps_));
    pending_.clear();
    pending_steps_ = 0;
    if (log_.bytes() > max_bytes_ && last() > 1) {
        halve();
    } else {
        count_frame(last());
    }
}

void Recording::count_frame(std::size_t frame) {
    open_changes_ += log_.changes(frame - 1);
    if (open_changes_ >= kKeyFrameChanges) close_key_frame(frame);
}

void Recording::close_key_frame(std::size_t frame) {
    Latest latest(samples());
    for (std::size_t k = key_end_.empty() ? 0 : key_end_.back(); k < frame; ++k) {
        log_.visit(k, [&](std::uint32_t s, float h) { latest.set(s, h); });
    }
    const Changes sum = latest.take();
    keys_.append(sum.sample, sum.height);
    key_end_.push_back(static_cast<std::uint32_t>(frame));
    open_changes_ = 0;
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
        const Changes sum = latest.take();
        log.append(sum.sample, sum.height);
        times.push_back(times_[next]);
        steps.push_back(steps_[next]);
    }
    log_ = std::move(log);
    times_ = std::move(times);
    steps_ = std::move(steps);
    stride_ *= 2;
    keys_ = {};
    key_end_.clear();
    open_changes_ = 0;
    for (std::size_t frame = 1; frame <= last(); ++frame) count_frame(frame);
}

std::size_t Recording::frame_at(double time) const {
    const auto after = std::upper_bound(times_.begin() + 1, times_.end(), time);
    return static_cast<std::size_t>(after - times_.begin()) - 1;
}

std::size_t Recording::bytes() const {
    return start_.size() * sizeof(float) + log_.bytes() + keys_.bytes() +
           times_.size() * (sizeof(double) + sizeof(std::uint32_t)) +
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
    visit(0, frame, [&](std::uint32_t s, float h) { height[s] = h; });
    return height;
}

Recording::Changes Recording::advance(std::size_t from, std::size_t to) const {
    check_frame(from);
    check_frame(to);
    Latest latest(samples());
    visit(std::min(from, to), std::max(from, to),
          [&](std::uint32_t s, float h) { latest.set(s, h); });
    Changes changes = latest.take();
    if (to < from && !changes.sample.empty()) {
        const std::vector<float> height = heights_at(to);
        std::transform(changes.sample.begin(), changes.sample.end(), changes.height.begin(),
                       [&](std::uint32_t s) { return height[s]; });
    }
    return changes;
}

}  // namespace beltgrinding
