#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// Gives the samples beside sharp convex edges between faces of `field` rays (`HeightField::rays`)
/// that lean towards the edge's bisector: a sharp edge then has one field over both faces, whose
/// segments do not cross down to the field's depth, and none of the stock round the edge is without
/// samples.
///
/// An edge is where the borders of two faces lie within a tenth of the spacing of each other and
/// the normals differ by 30 to 170 degrees. From the edge to a distance of half that angle (rad)
/// times the field's depth, but two spacings at least and 40 at most, the angle between ray and
/// normal falls from its half to 0. Where several edges meet their directions add. Does nothing to
/// other samples. Throws Cancelled.
void lean_at_edges(HeightField& field, const RunContext& context = {});

/// Distance in mm of the samples whose rays lean to the nearest edge that they lean to; the others
/// have infinity. Empty where no ray leans.
std::vector<float> edge_distances(const HeightField& field);

}  // namespace beltgrinding
