#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "beltgrinding/fact.h"
#include "beltgrinding/geometry.h"
#include "beltgrinding/height_field.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// How the rays are searched.
struct StockOptions {
    double search_above = 10.0;  ///< mm outward from the design surface
    double search_below = 2.0;   ///< mm inward from it
    double least_cosine = 0.0;   ///< surfaces that the ray grazes more than this are not met
    double unit = 1.0;  ///< mm of the mesh's file, by which it is already multiplied: for messages
};

/// What was found, for messages and for the summary.
struct StockReport {
    std::size_t missed = 0;      ///< rays without a hit within the search distance
    std::size_t defective = 0;   ///< samples with stock below the design surface
    double volume = 0.0;         ///< sum of area x max(height, 0), mm3
    std::vector<Fact> warnings;  ///< what the user should know
};

/// Sets every height to the uniform `allowance` (mm; negative is defective stock).
StockReport apply_allowance(HeightField& field, double allowance);

/// Adds a `thickness` (mm, one a sample, negative: less) to stock that is there already. Where rays
/// missed it nothing is known, and stays so. Throws InputError for a number that is not finite, or
/// another count than the field's.
StockReport add_stock(HeightField& field, const std::vector<double>& thickness);

/// Begins with what an earlier run of the same design left: its heights, linear between its
/// samples, its flags and, if `finish` is wanted, its finish without the motions, unknown where it
/// has none. The samplings may differ. Throws InputError where more than a few samples have none of
/// the same face near.
StockReport apply_left(HeightField& field, const HeightField& left, bool finish = false,
                       const RunContext& context = {});

/// Intersects every normal ray with the mesh (outward and inward, Embree) and sets heights and
/// flags: a missed ray keeps height 0 and is flagged, never dropped. Throws InputError when the
/// mesh is empty, holds NaN, or is so far from the field that hardly a ray can hit (wrong unit or
/// frame: the message says the factor that would fit).
StockReport apply_mesh(HeightField& field, const TriangleMesh& mesh, const StockOptions& options,
                       const RunContext& context = {});

}  // namespace beltgrinding
