#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "beltgrinding/height_field.h"

namespace beltgrinding {

class HeatSpectrum;
struct ThermalLevel;
struct ThermalNodes;

/// How a part's material conducts and stores heat, whatever its temperature.
struct HeatMaterial {
    double conductivity = 0.0;   ///< k, W/(m K), which is N/(s K)
    double heat_capacity = 0.0;  ///< c, J/(kg K)
    double density = 0.0;        ///< rho, kg/m3

    /// rho c, N/(mm2 K)
    double capacity() const { return 1e-6 * density * heat_capacity; }
    /// alpha = k / (rho c), mm2/s
    double diffusivity() const { return conductivity / capacity(); }
    /// Throws InputError naming what is not positive and finite.
    void validate() const;
};

/// What a part's heat is at a moment. Plain: a copy is a checkpoint. Nodes are those of a
/// `PartHeat`, temperatures are rises above the start's.
struct HeatState {
    static constexpr std::uint32_t kNever = 0xFFFFFFFF;  ///< no motion
    static constexpr std::size_t kModes = 16;            ///< of heat across the depth

    double time = 0.0;                  ///< s of process, through all programs
    double heated = 0.0;                ///< s, when heat came last
    std::uint32_t motion = kNever;      ///< that brought it
    Frame place = Frame::Identity();    ///< where, mm: the middle and axes of a box
    Vec3 half = Vec3::Zero();           ///< mm, half the box's sides
    double flowed = 0.0;                ///< K mm3: what is stored, as by what has flowed in
    std::array<double, kModes> most{};  ///< K, by mode: no node has more
    double bound = 0.0;                 ///< K: no rise was ever greater
    std::vector<float> modes;           ///< K, (nodes, modes): its sum is the surface's temperature
    std::vector<double> last;           ///< s, (nodes): when heat came near last; long ago: never
    std::vector<std::uint8_t> warm;     ///< (nodes): may be other than 0
    std::vector<float> peak;            ///< K, (nodes): greatest rise so far
    std::vector<std::uint32_t> source;  ///< (nodes): motion at that moment, or kNever
};

/// The heat in a part that is ground, from the power that flows in through its surface.
///
/// Nodes lie on the surface, some `spacing` apart. Under each the heat is conducted into the depth
/// as in a half-space, or as in a plate of the section's thickness, by exponentials in time
/// (`DepthModes`); each of them is conducted along the surface between nodes by finite volumes on
/// their Voronoi cells. That is exact for a plane half-space and a plane plate with constant
/// properties and no heat lost through the surface, whatever moves, dwells or comes back:
/// G(r, t) = K(t) exp(-r^2 / 4 alpha t) / (4 pi alpha t) is separable (Carslaw & Jaeger, Conduction
/// of Heat in Solids, 2nd ed., 10.2 and 14.10).
class PartHeat {
  public:
    /// `spacing`: mm, wanted between nodes; at least 1.5 of the field's is taken. Throws
    /// InputError.
    PartHeat(const HeightField& field, double spacing, const HeatMaterial& material);

    /// mm
    double spacing() const;
    /// How many nodes there are.
    std::size_t size() const;
    /// (nodes): each one's sample.
    const std::vector<std::uint32_t>& samples() const;
    /// Node of every sample, the nearest.
    const std::vector<std::uint32_t>& node_of() const;
    /// (nodes): the section's thickness under each, mm; NaN or far: a half-space. Before any heat.
    /// Throws InputError on another number or one that is not positive.
    void set_thickness(const std::vector<float>& thickness);
    /// (nodes): the same; infinite: a half-space.
    const std::vector<float>& thickness() const;
    /// As it was given.
    const HeatMaterial& material() const { return material_; }
    /// What it is at the moment.
    const HeatState& state() const { return state_; }
    /// Goes on from a state. Throws InputError for one of other nodes.
    void set_state(HeatState state);
    /// Bytes held.
    std::size_t bytes() const;
    /// Writes the greatest rise of every sample, and the motion then, to `field.heat`. Between
    /// nodes it is interpolated, never beyond theirs. Throws InputError for a field that is not
    /// sound or another one.
    void keep(HeightField& field) const;

    /// For the room's own use.
    const ThermalNodes& nodes() const { return *nodes_; }
    /// The same: levels of fewer nodes, made when they are first asked for.
    const std::vector<ThermalLevel>& levels() const;
    /// Of the level of the fewest nodes.
    const HeatSpectrum& spectrum() const;

  private:
    struct Levels;

    std::shared_ptr<ThermalNodes> nodes_;
    std::shared_ptr<Levels> levels_;
    HeatMaterial material_;
    HeatState state_;
};

}  // namespace beltgrinding
