#pragma once

#include <array>

#include "beltgrinding/heat.h"
#include "heat/depth_modes.h"

namespace beltgrinding {

/// What a material's modes do in some time. Durations come again and again: some are known.
class DepthFactors {
  public:
    using Row = DepthModes::Row;
    struct Factors {
        double duration = -1.0;  // s
        Row decay{}, gain{};     // the latter: K of a flux of 1 N/(mm s) and a weight of 1 / mm
    };

    /// `longer`: the ways of `DepthModes`. `decays`: whether the modes do.
    DepthFactors(const HeatMaterial& material, double longer, bool decays)
        : material_(material), longer_(longer), decays_(decays) {}

    /// Of `duration` s. Holds until it is asked for another one.
    const Factors& operator()(double duration);

  private:
    HeatMaterial material_;
    double longer_;
    bool decays_;
    std::array<Factors, 64> known_;  // by their duration
};

}  // namespace beltgrinding
