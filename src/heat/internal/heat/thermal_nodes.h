#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "beltgrinding/height_field.h"
#include "heat/depth_modes.h"

namespace beltgrinding {

/// Places on the surface of a height field, at least `spacing` apart and less than that from every
/// sample, and what heat needs to get from one to the next along the surface: the Voronoi cells in
/// their tangent planes, so that a plane is conducted in exactly to second order (Eymard, Gallouet,
/// Herbin: Finite volume methods, 2000). Nothing flows over an edge sharper than 60 degrees, as
/// nothing does by symmetry at a square one, nor over the border of what is sampled.
struct ThermalNodes {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    double spacing = 0.0;                    ///< mm
    std::vector<std::uint32_t> sample;       ///< that each is
    std::vector<std::uint32_t> node_of;      ///< by sample: the nearest
    std::vector<Vec3> point;                 ///< mm
    std::vector<Vec3f> normal;               ///< unit, outwards
    std::vector<float> area;                 ///< mm2, of the cell
    std::vector<std::uint32_t> first;        ///< (nodes + 1), of `neighbour` and `conductance`
    std::vector<std::uint32_t> neighbour;    ///< ascending for each
    std::vector<float> conductance;          ///< length of the common border over the distance
    double dispersion = 0.0;                 ///< mm2: see `make_thermal_nodes`
    double longer = 1.0;                     ///< ways of heat, as of `DepthModes`
    std::vector<float> thickness;            ///< mm, of the section; infinite: a half-space
    std::vector<std::uint32_t> opposite;     ///< node on the section's other side, or kNone
    std::vector<DepthModes::Weights> own;    ///< of each thickness
    std::vector<DepthModes::Weights> other;  ///< the same, of heat from the other side

    std::size_t size() const { return sample.size(); }
    /// mm, (nodes): of each one's section, as far as heat gets.
    std::vector<float> depth() const;
    std::size_t bytes() const;
};

/// Chooses the nodes in the order of the samples; all are half-spaces. Waves of the wave number k
/// are conducted by 1 - k^2 `dispersion` of what they should be, in the mean over directions and
/// nodes.
ThermalNodes make_thermal_nodes(const HeightField& field, double spacing, double longer = 1.0);

/// mm, for each of `conductance`: times what the section is deep (`depth` mm, by node) on the way,
/// two halves in a row.
std::vector<float> sectional_conductances(const ThermalNodes& nodes,
                                          const std::vector<float>& depth);

/// Gives the sections their thickness (mm, by node; NaN: a half-space), and finds the other sides.
void set_thickness(ThermalNodes& nodes, const std::vector<float>& thickness);

}  // namespace beltgrinding
