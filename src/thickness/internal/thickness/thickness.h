#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// Thickness at some samples, mm; NaN where it cannot be measured.
struct Thickness {
    std::vector<float> design;     ///< along the normal through the material to the opposite face
    std::vector<float> deviation;  ///< of the ground part's from the design's
};

/// Measures the thickness at `samples`: a ray from the design point, against the normal, to where
/// it leaves the material, on the samples' own triangles or on `others`, the triangles of the faces
/// that are not sampled (they stay as designed; may be empty). The ground thickness follows from
/// the heights at both ends, h + h' / cos of the angle between ray and opposite normal, which is
/// exact where the opposite face is flat. NaN where the ray leaves nowhere, where the opposite face
/// is slanted by more than 60 degrees, and where the stock was missed at either end. Throws
/// Cancelled.
Thickness measure_thickness(const HeightField& field, const std::vector<std::uint32_t>& samples,
                            const TriangleMesh& others, const RunContext& context = {});

}  // namespace beltgrinding
