#include "checkpoint.h"

#include <utility>

#include "checkpoints/checkpoints.h"

namespace beltgrinding {

std::size_t Checkpoint::bytes() const {
    std::size_t bytes = sizeof(Checkpoint) + bytes_of(seen);
    for (const auto& part : parts) bytes += part->bytes();
    return bytes;
}

Checkpoint joined(const Checkpoint& before, const Checkpoint& next) {
    Checkpoint both{next.planned, next.motion, before.seen, {}};
    append<StepQueue::Seen>(both.seen, next.seen);
    for (std::size_t k = 0; k < next.parts.size(); ++k)
        both.parts.push_back(before.parts[k]->joined(*next.parts[k]));
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
