#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "heat/heat_layer.h"

namespace beltgrinding {

/// Conducts the heat of few nodes for any time at once: by the eigenvectors of what lies between
/// them, each connected part by itself. For the coarsest level, whose heat would need ever more
/// terms of a series, though it has long become even.
class HeatSpectrum {
  public:
    /// One of more nodes would cost too much.
    static constexpr std::size_t kMost = 400;

    explicit HeatSpectrum(const HeatLayer::Grid& grid);
    /// Whether no connected part has too many nodes.
    bool possible() const { return possible_; }
    /// `rows`: K, (nodes, modes), become what they are after `spread` = alpha t mm2.
    void conduct(double spread, float* rows) const;

  private:
    struct Waves {
        Eigen::VectorXd root;    // of the nodes' mass
        Eigen::VectorXd decay;   // 1/mm2, with what finite volumes conduct too little
        Eigen::MatrixXd shapes;  // (nodes, waves), orthonormal
    };
    struct Part {
        std::vector<std::uint32_t> nodes;
        Waves faster, first;  // of all modes; but for the first one, which sections share
    };
    std::vector<Part> parts_;
    bool possible_ = true;
};

}  // namespace beltgrinding
