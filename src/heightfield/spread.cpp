#include "heightfield/spread.h"

#include <algorithm>
#include <cstddef>

#include "beltgrinding/error.h"

namespace beltgrinding {

void spread_largest(const HeightField& field, std::vector<float>& values, int rings) {
    if (values.size() != field.size())
        throw InputError("call.spread", "spread_largest needs one value per sample");
    std::vector<float> before;
    for (int ring = 0; ring < rings; ++ring) {
        before = values;
        for (const Triangle& triangle : field.triangles) {
            const float most =
                std::max({before[triangle[0]], before[triangle[1]], before[triangle[2]]});
            for (const std::uint32_t corner : triangle)
                values[corner] = std::max(values[corner], most);
        }
    }
}

}  // namespace beltgrinding
