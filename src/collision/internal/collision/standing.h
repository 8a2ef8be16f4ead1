#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"
#include "collision/collision_mesh.h"

namespace beltgrinding {

/// A body that is fixed to the work.
struct FixedBody {
    CollisionMesh mesh;   ///< work frame, mm
    double margin = 0.0;  ///< mm by which it is thicker than its mesh (stock on a part)
};

/// For each pose the number of the first of `held`, meshes in the contact frame, that touches one
/// of `fixed` or lies within it, or it within that; -1: none does. Poses are looked at by
/// themselves, not the ways between them. Results do not depend on the number of threads. Throws
/// InputError for a margin that is negative or no number, and Cancelled.
std::vector<std::int32_t> first_met(const std::vector<CollisionMesh>& held,
                                    const std::vector<FixedBody>& fixed,
                                    const std::vector<Frame>& work_from_contact,
                                    const RunContext& context = {});

}  // namespace beltgrinding
