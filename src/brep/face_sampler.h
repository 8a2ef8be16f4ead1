#pragma once

// Private to this room: one face.

#include <TopoDS_Face.hxx>
#include <array>

#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"
#include "sample_density.h"

namespace beltgrinding {

struct FaceRequest {
    TopoDS_Face face;
    double spacing = 0;              ///< mm
    double precision = 0;            ///< mm, as SampleDensity::precision
    double edge_spacing = 0;         ///< mm, as SampleDensity::finest
    double area = 0;                 ///< mm2, exact; the samples' areas are scaled to it
    bool reverse = false;            ///< the normal points against the surface's own
    bool parameters = false;         ///< fill FaceSamples::parameters
    SampleBudget* budget = nullptr;  ///< of all faces; null: no limit
};

/// Samples and triangles of one face; the indices count from 0.
struct FaceSamples {
    std::vector<Vec3> point;
    std::vector<Vec3f> normal;
    std::vector<float> area;
    std::vector<std::uint8_t> flags;
    std::vector<Triangle> triangles;
    std::vector<std::array<double, 2>> parameters;  ///< u, v of each sample, if asked for
    std::array<double, 2> period{};                 ///< in u and v; 0: not closed
    double sampled_area = 0;                        ///< mm2, before scaling
};

/// Throws std::runtime_error with the rest of a sentence that begins with the face's name, or
/// Standard_Failure.
FaceSamples sample_face(const FaceRequest& request, const RunContext& context);

}  // namespace beltgrinding
