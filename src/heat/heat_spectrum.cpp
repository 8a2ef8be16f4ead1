#include "heat/heat_spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr auto kModes = static_cast<Eigen::Index>(DepthModes::kModes);

/// Numbers of the connected part of each node.
std::vector<std::uint32_t> connected(const HeatLayer::Grid& grid, std::uint32_t& count) {
    constexpr std::uint32_t kNone = 0xFFFFFFFF;
    std::vector<std::uint32_t> part(grid.area.size(), kNone), list;
    count = 0;
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        if (part[k] != kNone) continue;
        list.assign(1, k);
        part[k] = count;
        while (!list.empty()) {
            const std::uint32_t node = list.back();
            list.pop_back();
            for (std::uint32_t e = grid.first[node]; e < grid.first[node + 1]; ++e) {
                const std::uint32_t other = grid.neighbour[e];
                if (part[other] != kNone) continue;
                part[other] = count;
                list.push_back(other);
            }
        }
        ++count;
    }
    return part;
}

}  // namespace

HeatSpectrum::HeatSpectrum(const HeatLayer::Grid& grid) {
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> part = connected(grid, count);
    parts_.resize(count);
    std::vector<std::uint32_t> place(part.size());
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        place[k] = static_cast<std::uint32_t>(parts_[part[k]].nodes.size());
        parts_[part[k]].nodes.push_back(k);
    }
    for (const Part& one : parts_) possible_ = possible_ && one.nodes.size() <= kMost;
    if (!possible_) return;
    for (Part& one : parts_) {
        const auto n = static_cast<Eigen::Index>(one.nodes.size());
        for (const bool first : {false, true}) {
            Waves& waves = first ? one.first : one.faster;
            waves.root.resize(n);
            Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n, n);
            for (Eigen::Index i = 0; i < n; ++i) {
                const std::uint32_t k = one.nodes[static_cast<std::size_t>(i)];
                waves.root[i] = std::sqrt(grid.area[k] * (first ? grid.depth[k] : 1.0));
            }
            for (Eigen::Index i = 0; i < n; ++i) {
                const std::uint32_t k = one.nodes[static_cast<std::size_t>(i)];
                for (std::uint32_t e = grid.first[k]; e < grid.first[k + 1]; ++e) {
                    const auto j = static_cast<Eigen::Index>(place[grid.neighbour[e]]);
                    const double way = first ? grid.sectional[e] : grid.conductance[e];
                    square(i, j) += way / (waves.root[i] * waves.root[j]);
                    square(i, i) -= way / (waves.root[i] * waves.root[i]);
                }
            }
            const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(square);
            waves.shapes = solver.eigenvectors();
            // The greatest is 0: what is even stays.
            waves.decay = solver.eigenvalues().cwiseMin(0.0);
            waves.decay[n - 1] = 0.0;
            waves.decay -= grid.dispersion * waves.decay.cwiseAbs2();
        }
    }
}

void HeatSpectrum::conduct(double spread, float* rows) const {
    Eigen::MatrixXd values;
    for (const Part& part : parts_) {
        const auto n = static_cast<Eigen::Index>(part.nodes.size());
        values.resize(n, kModes);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < kModes; ++j)
                values(i, j) = rows[kModes * part.nodes[static_cast<std::size_t>(i)] + j];
        const auto conducted = [spread](const Waves& waves, const Eigen::MatrixXd& before) {
            Eigen::MatrixXd share = waves.shapes.transpose() * (waves.root.asDiagonal() * before);
            share = ((spread * waves.decay).array().exp().matrix().asDiagonal() * share).eval();
            return Eigen::MatrixXd(waves.root.cwiseInverse().asDiagonal() * (waves.shapes * share));
        };
        values.col(0) = conducted(part.first, values.col(0)).eval();
        values.rightCols(kModes - 1) = conducted(part.faster, values.rightCols(kModes - 1)).eval();
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < kModes; ++j)
                rows[kModes * part.nodes[static_cast<std::size_t>(i)] + j] =
                    static_cast<float>(values(i, j));
    }
}

}  // namespace beltgrinding
