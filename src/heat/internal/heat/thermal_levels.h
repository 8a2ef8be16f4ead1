#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "heat/thermal_nodes.h"

namespace beltgrinding {

/// Fewer nodes for heat that has become smooth: some of those of the level below, at least twice
/// its spacing apart, with Voronoi cells of their own. What flows follows the ways of the level
/// below: neighbours are those whose finer nodes are, or that have a common such neighbour; where
/// the surface is bent so strongly that cells in a tangent plane see no border, the border of the
/// finer cells counts.
struct ThermalLevel {
    static constexpr double kCoarser = 2.0;  ///< its spacing over that of the level below

    /// What a finer node's temperature is made of: barycentric in a triangle of nodes near it, so
    /// that a linear field is reproduced; beside the outermost ones as at the border.
    struct Shares {
        std::array<std::uint32_t, 3> node{};
        std::array<float, 3> share{};  ///< not negative, their sum is 1
    };

    double spacing = 0.0;                     ///< mm
    double dispersion = 0.0;                  ///< mm2, as of `ThermalNodes`
    std::vector<Vec3> point;                  ///< mm
    std::vector<Vec3f> normal;                ///< unit
    std::vector<float> area;                  ///< mm2: of finer nodes, by their shares
    std::vector<float> depth;                 ///< mm: of sections, the mean of the same
    std::vector<std::uint32_t> first;         ///< (nodes + 1), of `neighbour` and `conductance`
    std::vector<std::uint32_t> neighbour;     ///< ascending for each
    std::vector<float> conductance;           ///< as of `ThermalNodes`
    std::vector<float> sectional;             ///< mm: the same times the section's depth
    std::vector<Shares> shares;               ///< by node of the level below
    std::vector<std::uint32_t> first_part;    ///< (nodes + 1), of `part`
    std::vector<std::uint32_t> part;          ///< of the level below: those that have a share in it
    std::vector<std::uint32_t> first_member;  ///< (nodes + 1), of `member`
    std::vector<std::uint32_t> member;        ///< of `ThermalNodes`: nearest to it, level by level

    std::size_t size() const { return point.size(); }
};

/// Each of half as many nodes along the surface as the one before; none of a few nodes only.
std::vector<ThermalLevel> make_thermal_levels(const ThermalNodes& nodes);

}  // namespace beltgrinding
