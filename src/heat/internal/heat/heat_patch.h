#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "heat/depth_modes.h"
#include "heat/heat_rows.h"

namespace beltgrinding {

/// Some nodes and the ways between them.
struct HeatPatch {
    std::vector<std::uint32_t> nodes;  ///< ascending; none if only their rows are known
    std::vector<std::uint32_t> first;  ///< (nodes + 1), of `ways`
    std::vector<HeatWay> ways;         ///< to numbers of nodes; there may be more behind the last
    std::vector<std::uint8_t> slow;    ///< by node: nothing is left of its faster modes
    double most = 0.0;                 ///< greatest sum of a node's rates

    void clear();
};

/// Conducts rows of modes along the surface: the exponential of the patch's rates by Chebyshev's
/// series (Tal-Ezer & Kosloff, J. Chem. Phys. 81, 1984), without what finite volumes err by in the
/// fourth derivative.
class RowConductor {
  public:
    static constexpr std::size_t kModes = DepthModes::kModes;

    /// `rows` (nodes, modes) become what they are after `duration` (of the patch's rates); those
    /// behind them stay. `error`: the nodes' dispersion over the diffusivity times the time.
    void conduct(const HeatPatch& patch, double duration, double error, std::vector<float>& rows);
    /// `sums` (nodes) become the rows' sums besides.
    void conduct(const HeatPatch& patch, double duration, double error, std::vector<float>& rows,
                 std::vector<float>& sums);

  private:
    const std::vector<double>& terms(double& stiff, double error);

    std::array<std::vector<float>, 2> stages_;
    std::map<std::pair<double, double>, std::vector<double>> known_;
};

}  // namespace beltgrinding
