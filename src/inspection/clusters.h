#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "beltgrinding/verdict.h"

namespace beltgrinding {

/// The clusters of a verdict whose `zone` is known. `beyond[i]`: mm that sample i lies beyond its
/// limit, positive above, negative below, 0: in tolerance or missed. Fills `clusters`, `cluster`.
void find_clusters(const HeightField& field, const std::vector<double>& beyond,
                   const std::function<WorstPoint(std::uint32_t)>& judged, Verdict& verdict);

}  // namespace beltgrinding
