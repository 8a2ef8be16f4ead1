#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/height_field.h"
#include "beltgrinding/verdict.h"

namespace beltgrinding {

/// Number of the zone of every sample: of the last one that holds it, or `zones.size()` for none. A
/// zone with an `edge_radius` holds those samples of its faces where the surface is convex with a
/// smaller radius of curvature, and those that lie within that radius of a sharp convex edge to
/// another face. Throws InputError for a bad band or radius.
std::vector<std::uint32_t> zone_of_samples(const HeightField& field,
                                           const std::vector<ToleranceZone>& zones);

/// Largest principal curvature of the design surface at every sample, 1/mm, positive where the
/// solid is convex, from the normals over the samples' triangles. A radius smaller than half the
/// spacing cannot be told from that.
/// Rusinkiewicz: Estimating curvatures and their derivatives on triangle meshes (3DPVT 2004).
std::vector<float> convex_curvature(const HeightField& field);

/// Samples on the border of their face with a sharp convex edge to another face (its normal turns
/// by more than 30 degrees), ascending.
std::vector<std::uint32_t> sharp_convex_borders(const HeightField& field);

/// From each sample to the middle of its triangles: on a border that leads into the face. Not
/// normalised.
std::vector<Vec3f> into_face(const HeightField& field);

/// Pairs of border samples of different faces that lie side by side across a common edge.
struct BorderPair {
    std::uint32_t a = 0, b = 0;  ///< samples, a < b
};
/// All such pairs of `samples` (any; those not on a border are left out), in ascending order.
std::vector<BorderPair> border_pairs(const HeightField& field,
                                     const std::vector<std::uint32_t>& samples);

}  // namespace beltgrinding
