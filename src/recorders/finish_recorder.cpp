#include "finish_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// Steps' travels without pressure after which a pass has ended: at its border a contact may miss a
// step.
constexpr double kSkippedSteps = 2.5;
constexpr double kSameTime = 1e-9;     // s
constexpr float kLeastAcross = 1e-3f;  // of a unit: what is left of a direction that leans too much
constexpr double kRoughest = 1e4;      // um: a law that tells more is asked beyond where it holds

template <class T>
void reorder(std::vector<T>& values, const SampleBlocks& blocks, bool to_positions) {
    std::vector<T> before(values.size());
    before.swap(values);
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (to_positions)
            values[k] = before[blocks.sample(k)];
        else
            values[blocks.sample(k)] = before[k];
    }
}

void reorder(FinishTrace& finish, const SampleBlocks& blocks, bool to_positions) {
    reorder(finish.settled, blocks, to_positions);
    reorder(finish.unknown, blocks, to_positions);
    reorder(finish.lay, blocks, to_positions);
    reorder(finish.crossing, blocks, to_positions);
    reorder(finish.passes, blocks, to_positions);
    reorder(finish.motion, blocks, to_positions);
    reorder(finish.outside, blocks, to_positions);
}

FinishTrace untouched(std::size_t n, double before) {
    const bool known = !std::isnan(before);
    FinishTrace finish;
    finish.settled.assign(n, known ? static_cast<float>(before) : 0.0f);
    finish.unknown.assign(n, known ? 0.0f : 1.0f);
    finish.lay.assign(n, Vec3f::Zero());
    finish.crossing.assign(n, std::numeric_limits<float>::quiet_NaN());
    finish.passes.assign(n, 0);
    finish.motion.assign(n, FinishTrace::kNever);
    finish.outside.assign(n, FinishTrace::kInside);
    return finish;
}

}  // namespace

FinishRecorder::FinishRecorder(const SampleBlocks& blocks, const FinishRequest& request,
                               double belt_speed, double max_travel)
    : Keeps(&PhaseTimes::finish),
      blocks_(blocks),
      request_(request),
      belt_speed_(belt_speed),
      most_apart_(kSkippedSteps * max_travel),
      finish_(blocks.field().finish),
      passes_(blocks.samples().size()) {
    const std::size_t n = blocks.samples().size();
    if (finish_.empty()) {
        finish_ = untouched(n, request.before);
    } else if (finish_.settled.size() != n) {
        throw InputError("finish.other_field", "the finish is of another height field");
    }
    reorder(finish_, blocks, true);
}

void FinishRecorder::begin_step(const StepTurn& turn) {
    const PathStep& step = turn.step;
    const double pause = step.time - 0.5 * step.duration - (now_.time + 0.5 * now_.duration);
    if (any_ && pause < kSameTime) {
        const double between = step.time - now_.time;
        advance_ = Vec3::Zero();
        if (between > 0.0)
            advance_ =
                (step.work_from_contact.translation() - now_.work_from_contact.translation()) /
                between;
    } else {  // the wheel was away
        travel_ += 2.0 * most_apart_;
        advance_ = Vec3::Zero();
    }
    any_ = true;
    now_ = step;
    motion_ = turn.motion;
    travel_ += step.feed * step.duration;
}

void FinishRecorder::pressed(const Press& press) {
    const FinishRequest& r = request_;
    FinishStep step;
    step.begins = static_cast<float>(travel_ - now_.feed * now_.duration);
    step.ends = static_cast<float>(travel_);
    step.motion = motion_;
    const Vec3 along = belt_speed_ * now_.work_from_contact.linear().col(0) + advance_;
    step.along = along.normalized().cast<float>();
    step.outside = FinishTrace::kInside;
    step.fresh = 0.0f;
    if (r.roughness > 0.0) {
        if (!r.speed.holds(belt_speed_)) {
            step.outside = FinishTrace::kBeltSpeed;
        } else if (!r.feed.holds(now_.feed) || !(now_.feed > 0.0)) {
            step.outside = FinishTrace::kFeed;
        } else if (!r.cut.holds(press.cut)) {
            step.outside = FinishTrace::kBeltWear;
        } else {
            step.fresh = static_cast<float>(
                r.roughness * std::pow(belt_speed_ / r.reference_speed, r.speed_exponent) *
                std::pow(now_.feed / r.reference_feed, r.feed_exponent) *
                std::pow(press.cut, r.cut_exponent));
        }
    }
    const auto number = static_cast<std::uint32_t>(steps_.size());
    const auto seconds = static_cast<float>(press.duration);
    bool pressed = false;
    steps_.push_back(step);  // a sample that also lies beyond a side face is met twice
    const Pressing& pressing = press.pressing;
    pressing.map().for_pressed(
        pressing.displaced_pressure(), [&](std::size_t position, double value) {
            FinishPass& pass = passes_[position];
            if (pass.time > 0.0f &&
                step.begins - steps_[pass.step].ends > static_cast<float>(most_apart_))
                end(position, pass);
            pass.impulse += static_cast<float>(value) * seconds;
            pass.time += seconds;
            pass.step = number;
            pressed = true;
        });
    if (!pressed) steps_.pop_back();
}

void FinishRecorder::end(std::size_t position, FinishPass& pass) {
    const FinishStep& last = steps_[pass.step];
    const double mean = pass.impulse / pass.time;
    pass = {};
    const FinishRequest& r = request_;
    std::uint8_t outside = last.outside;
    const double own = last.fresh * std::pow(mean / r.reference_pressure, r.pressure_exponent);
    if (r.roughness > 0.0 && outside == FinishTrace::kInside &&
        !(r.pressure.holds(mean) && own <= kRoughest)) {
        // The light border of a pass, over what one before has finished, leaves that.
        const bool finished =
            finish_.passes[position] > 0 && finish_.outside[position] == FinishTrace::kInside;
        if (mean < r.pressure.low && finished) return;
        outside = FinishTrace::kPressure;
    }
    const auto rest = static_cast<float>(r.rest);
    float& settled = finish_.settled[position];
    float& unknown = finish_.unknown[position];
    settled *= rest;
    unknown *= rest;
    if (r.roughness > 0.0 && outside == FinishTrace::kInside) {
        settled += (1.0f - rest) * static_cast<float>(own);
    } else {
        unknown = std::min(unknown + (1.0f - rest), 1.0f);
    }
    const Vec3f& normal = blocks_.field().normal[blocks_.sample(position)];
    Vec3f lay = last.along - last.along.dot(normal) * normal;
    const float across = lay.norm();
    lay = across > kLeastAcross ? Vec3f(lay / across) : Vec3f(Vec3f::Zero());
    Vec3f& before = finish_.lay[position];
    finish_.crossing[position] = std::numeric_limits<float>::quiet_NaN();
    if (!lay.isZero() && !before.isZero())
        finish_.crossing[position] = std::acos(std::min(std::abs(lay.dot(before)), 1.0f));
    before = lay;
    finish_.passes[position] += 1;
    finish_.motion[position] = last.motion;
    finish_.outside[position] = outside;
}

// Calls visit(lane, position).
template <class Visit>
void FinishRecorder::for_lanes(std::uint32_t block, Visit visit) const {
    const std::size_t first = std::size_t{block} * SampleBlocks::kLanes;
    const std::size_t count = std::min<std::size_t>(SampleBlocks::kLanes, passes_.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane) visit(lane, first + lane);
}

FinishBlock FinishRecorder::block(std::uint32_t number) const {
    FinishBlock block{};
    for_lanes(number, [&](std::size_t lane, std::size_t position) {
        block.pass[lane] = passes_[position];
        block.settled[lane] = finish_.settled[position];
        block.unknown[lane] = finish_.unknown[position];
        block.lay[lane] = finish_.lay[position];
        block.crossing[lane] = finish_.crossing[position];
        block.passes[lane] = finish_.passes[position];
        block.motion[lane] = finish_.motion[position];
        block.outside[lane] = finish_.outside[position];
    });
    return block;
}

void FinishRecorder::set_block(std::uint32_t number, const FinishBlock& block) {
    for_lanes(number, [&](std::size_t lane, std::size_t position) {
        passes_[position] = block.pass[lane];
        finish_.settled[position] = block.settled[lane];
        finish_.unknown[position] = block.unknown[lane];
        finish_.lay[position] = block.lay[lane];
        finish_.crossing[position] = block.crossing[lane];
        finish_.passes[position] = block.passes[lane];
        finish_.motion[position] = block.motion[lane];
        finish_.outside[position] = block.outside[lane];
    });
}

void FinishPart::append(const FinishPart& next) {
    FinishPart both = next;
    both.blocks = std::move(blocks);
    both.blocks.append(next.blocks);
    both.steps = std::move(steps);
    both.steps.append(next.steps);
    *this = std::move(both);
}

FinishPart FinishRecorder::take(std::span<const std::uint32_t> blocks) {
    const auto from = steps_.begin() + static_cast<std::ptrdiff_t>(noted_);
    noted_ = steps_.size();
    return {{blocks, [this](std::uint32_t number) { return block(number); }},
            {{from, steps_.end()}},
            any_,
            now_,
            motion_,
            travel_,
            advance_};
}

void FinishRecorder::put(std::span<const FinishPart* const> parts) {
    for (const FinishPart* part : parts) {
        part->blocks.each(
            [this](std::uint32_t number, const FinishBlock& block) { set_block(number, block); });
        append<FinishStep>(steps_, part->steps.values);
        any_ = part->any;
        now_ = part->now;
        motion_ = part->motion;
        travel_ = part->travel;
        advance_ = part->advance;
    }
    noted_ = steps_.size();
}

void FinishRecorder::end() {
    for (std::size_t position = 0; position < passes_.size(); ++position)
        if (passes_[position].time > 0.0f) end(position, passes_[position]);
    reorder(finish_, blocks_, false);
}

void FinishRecorder::keep(HeightField& field, SimulationResult&) {
    field.finish = std::move(finish_);
}

}  // namespace beltgrinding
