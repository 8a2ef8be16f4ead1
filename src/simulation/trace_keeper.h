#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "beltgrinding/height_field.h"
#include "contact/gap_map.h"

namespace beltgrinding {

/// Keeps a removal trace during a simulation: beside the field, which gets it in the end. The
/// dominant motion is exact, because the steps of a motion follow one another: a sum per sample of
/// what the running motion removed is all that it takes.
class TraceKeeper {
  public:
    /// Goes on with the field's trace, if it has one.
    explicit TraceKeeper(const HeightField& field);

    /// The wheel presses with `pressure` (MPa per cell of the map).
    void press(const GapMap& map, const DisplacedPressure& pressure);
    /// The motion number `motion` has lowered the samples `changed` (each named once) to the
    /// heights that they have now. Motions come one after the other.
    void remove(const HeightField& field, std::span<const std::uint32_t> changed,
                std::uint32_t motion);
    /// Hands the trace over to the field.
    void keep(HeightField& field) { field.trace = std::move(trace_); }

  private:
    RemovalTrace trace_;
    std::vector<double> height_;  // mm, as of the last `remove`
    std::vector<float> removed_;  // mm, by the sample's last motion so far
};

}  // namespace beltgrinding
