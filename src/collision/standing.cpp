#include "collision/standing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/parallel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 16;  // poses

bool meet(const FixedBody& fixed, const CollisionMesh& held, const Frame& work_from_held) {
    return fixed.mesh.within(held, work_from_held, fixed.margin) ||
           fixed.mesh.surrounds(held, work_from_held) ||
           held.surrounds(fixed.mesh, work_from_held.inverse());
}

}  // namespace

std::vector<std::int32_t> first_met(const std::vector<CollisionMesh>& held,
                                    const std::vector<FixedBody>& fixed,
                                    const std::vector<Frame>& work_from_contact,
                                    const RunContext& context) {
    for (const FixedBody& body : fixed) {
        if (!std::isfinite(body.margin) || body.margin < 0.0) {
            throw InputError("collision.margin", "a body's margin must be zero or positive, in mm");
        }
    }
    std::vector<std::int32_t> found(work_from_contact.size(), -1);
    parallel_blocks(found.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto met = std::find_if(held.begin(), held.end(), [&](const CollisionMesh& mesh) {
                return std::any_of(fixed.begin(), fixed.end(), [&](const FixedBody& body) {
                    return meet(body, mesh, work_from_contact[k]);
                });
            });
            if (met != held.end()) found[k] = static_cast<std::int32_t>(met - held.begin());
        }
    });
    return found;
}

}  // namespace beltgrinding
