#include "trace_keeper.h"

#include "beltgrinding/error.h"

namespace beltgrinding {

TraceKeeper::TraceKeeper(const HeightField& field)
    : trace_(field.trace), height_(field.height), removed_(field.size(), 0.0F) {
    if (trace_.empty()) trace_.reset(field.size());
    if (trace_.first.size() != field.size()) {
        throw InputError("simulation.other_trace", "the field's removal trace is of another field");
    }
}

void TraceKeeper::press(const GapMap& map, const DisplacedPressure& pressure) {
    map.raise(pressure, trace_.peak_pressure);
}

void TraceKeeper::remove(const HeightField& field, std::span<const std::uint32_t> changed,
                         std::uint32_t motion) {
    for (const std::uint32_t s : changed) {
        const double removed = height_[s] - field.height[s];
        if (!(removed > 0.0)) continue;  // lost in rounding
        height_[s] = field.height[s];
        if (trace_.first[s] == RemovalTrace::kNever) trace_.first[s] = motion;
        if (trace_.last[s] != motion) {
            trace_.last[s] = motion;
            removed_[s] = 0.0F;
        }
        removed_[s] += static_cast<float>(removed);
        if (removed_[s] > trace_.dominant_depth[s]) {
            trace_.dominant[s] = motion;
            trace_.dominant_depth[s] = removed_[s];
        }
    }
}

}  // namespace beltgrinding
