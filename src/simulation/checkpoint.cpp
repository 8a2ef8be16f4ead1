#include "checkpoint.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "simulation/checkpoints.h"

namespace beltgrinding {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

std::size_t bytes_of(const EventLog::State& events) {
    constexpr std::size_t kFact = 256;  // with its arguments, about
    std::size_t bytes = events.open.size() * sizeof(EventLog::Open);
    for (const Event& event : events.events) bytes += sizeof(Event) + kFact * event.facts.size();
    return bytes;
}

}  // namespace

std::size_t Checkpoint::bytes() const {
    const ContactSolution& contact = pressing.solution;
    return sizeof(Checkpoint) + bytes_of(seen) + bytes_of(records) + bytes_of(touched) +
           bytes_of(deepened) + bytes_of(blocks) + bytes_of(ground) + bytes_of(trace) +
           bytes_of(finish) + heat.bytes() + passes.bytes() +
           static_cast<std::size_t>(shifts.size()) * sizeof(double) + influence.bytes() +
           grinding.force_influence.bytes() + recording.bytes() + bytes_of(monitor.events) +
           static_cast<std::size_t>(contact.pressure.size() + contact.axial.size()) *
               sizeof(double) +
           bytes_of(pressing.hits) + pressing.near.bytes() +
           (pressing.memory ? pressing.memory->bytes() : 0);
}

Checkpoint joined(const Checkpoint& before, const Checkpoint& next) {
    Checkpoint both = before;
    both.planned = next.planned;
    both.motion = next.motion;
    append(both.seen, next.seen);
    append(both.records, next.records);
    append(both.touched, next.touched);
    append(both.deepened, next.deepened);
    both.blocks.clear();
    std::set_union(before.blocks.begin(), before.blocks.end(), next.blocks.begin(),
                   next.blocks.end(), std::back_inserter(both.blocks));
    both.ground.clear();
    both.trace.clear();
    both.finish.clear();
    const Eigen::Index laws = next.shifts.cols();
    constexpr Eigen::Index kLanes = SampleBlocks::kLanes;
    both.shifts.resize(static_cast<Eigen::Index>(both.blocks.size()) * kLanes, laws);
    for (std::size_t k = 0; k < both.blocks.size(); ++k) {
        // The later one of a block.
        const auto place = [&](const Checkpoint& one) {
            const auto at = std::lower_bound(one.blocks.begin(), one.blocks.end(), both.blocks[k]);
            return at != one.blocks.end() && *at == both.blocks[k]
                       ? std::optional(static_cast<std::size_t>(at - one.blocks.begin()))
                       : std::nullopt;
        };
        const auto later = place(next);
        const Checkpoint& from = later ? next : before;
        const std::size_t at = later ? *later : *place(before);
        both.ground.push_back(from.ground[at]);
        if (!from.trace.empty()) both.trace.push_back(from.trace[at]);
        if (!from.finish.empty()) both.finish.push_back(from.finish[at]);
        both.shifts.middleRows(static_cast<Eigen::Index>(k) * kLanes, kLanes) =
            from.shifts.middleRows(static_cast<Eigen::Index>(at) * kLanes, kLanes);
    }
    both.influence.append(next.influence);
    both.grinding.belt = next.grinding.belt;
    both.grinding.integrated_rate = next.grinding.integrated_rate;
    both.grinding.force_influence.append(next.grinding.force_influence);
    both.recording.append(next.recording);
    both.heat.append(next.heat);
    both.passes.append(next.passes);
    both.monitor = next.monitor;
    both.pressing = next.pressing;
    both.wheel = next.wheel;
    both.any_contact = next.any_contact;
    return both;
}

std::vector<std::size_t> Checkpoints::steps() const {
    std::vector<std::size_t> steps;
    for (const auto& one : kept_) steps.push_back(one->planned);
    return steps;
}

std::size_t Checkpoints::bytes() const {
    std::size_t bytes = 0;
    for (const auto& one : kept_) bytes += one->bytes();
    return bytes;
}

Checkpoints Checkpoints::within(std::size_t max_bytes) const {
    Checkpoints others = *this;
    others.max_bytes_ = max_bytes;
    others.thin();
    return others;
}

void Checkpoints::clear() {
    kept_.clear();
    end_ = 0;
}

void Checkpoints::thin() {
    while (kept_.size() > kMost || bytes() > max_bytes_) {
        if (kept_.size() < 2) {
            clear();
            return;
        }
        // The two that begin and end nearest to one another.
        std::size_t least = 0, span = 0;
        for (std::size_t k = 0; k + 1 < kept_.size(); ++k) {
            const std::size_t from = k > 0 ? kept_[k - 1]->planned : 0;
            const std::size_t steps = kept_[k + 1]->planned - from;
            if (k > 0 && steps >= span) continue;
            least = k;
            span = steps;
        }
        kept_[least + 1] =
            std::make_shared<const Checkpoint>(joined(*kept_[least], *kept_[least + 1]));
        kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(least));
    }
}

}  // namespace beltgrinding
