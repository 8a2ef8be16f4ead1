#include "engine/step_queue.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace beltgrinding {
namespace {

using StepBits = std::array<std::uint64_t, 30>;

/// The bits of all numbers of a step; does not compile where a step has got more.
StepBits bits(const PathStep& step) {
    static_assert(sizeof(Frame) == 16 * sizeof(double));
    const auto& [work_from_contact, time, duration, feed, force, pose, plunging, begin, end, moved,
                 turned] = step;
    StepBits values{};
    std::memcpy(values.data(), work_from_contact.data(), sizeof(Frame));
    const std::array<double, 14> rest = {time,
                                         duration,
                                         feed,
                                         force,
                                         static_cast<double>(pose),
                                         plunging ? 1.0 : 0.0,
                                         begin,
                                         end,
                                         moved.x(),
                                         moved.y(),
                                         moved.z(),
                                         turned.x(),
                                         turned.y(),
                                         turned.z()};
    std::transform(rest.begin(), rest.end(), values.begin() + 16,
                   [](double value) { return std::bit_cast<std::uint64_t>(value); });
    return values;
}

/// To the last bit: what is simulated must not tell them apart.
bool same(const PathStep& a, const PathStep& b) {
    return bits(a) == bits(b);
}

}  // namespace

StepQueue::StepQueue(const ToolPath& path, const SteppingOptions& options) : path_(path) {
    const std::vector<PathStep> steps = path.steps(options);
    planned_ = steps.size();
    left_.reserve(planned_);
    put(steps, 1);
}

bool StepQueue::next() {
    if (left_.empty()) return false;
    now_ = left_.back();
    left_.pop_back();
    if (now_.parts == 1) ++begun_;
    return true;
}

void StepQueue::cut(double parts) {
    const int most = kMostParts / now_.parts;
    const int count = parts < most ? std::max(2, static_cast<int>(std::ceil(parts))) : most;
    part(count);
}

void StepQueue::part(int count) {
    note(count);
    put(path_.cut(now_.step, count), count * now_.parts);
}

void StepQueue::note(int cut) {
    if (keeps_) seen_.push_back({now_.step, line(), cut, now_.parts == 1});
}

bool StepQueue::follow(const std::vector<Seen>& seen) {
    for (const Seen& before : seen) {
        if (!next() || !same(now_.step, before.step) || line() != before.line) return false;
        if (before.cut > 0) part(before.cut);
    }
    return true;
}

void StepQueue::begin_at(std::size_t planned) {
    left_.resize(planned_ - planned);
    begun_ = from_ = planned;
}

void StepQueue::put(const std::vector<PathStep>& steps, int parts) {
    std::transform(steps.rbegin(), steps.rend(), std::back_inserter(left_),
                   [parts](const PathStep& step) {
                       return Item{step, parts};
                   });
}

double StepQueue::progress() const {
    if (begun_ == from_) return 0.0;
    return static_cast<double>(begun_ - 1 - from_) / static_cast<double>(planned_ - from_);
}

}  // namespace beltgrinding
