#include "heightfield/height_field.h"

namespace beltgrinding {

void HeightField::resize(std::size_t n) {
    point.resize(n, Vec3::Zero());
    normal.resize(n, Vec3f::UnitZ());
    area.resize(n, 0.0F);
    stock_height.resize(n, 0.0F);
    height.resize(n, 0.0);
    face.resize(n, 0);
    flags.resize(n, 0);
}

std::size_t HeightField::bytes() const {
    return point.capacity() * sizeof(Vec3) + normal.capacity() * sizeof(Vec3f) +
           area.capacity() * sizeof(float) + stock_height.capacity() * sizeof(float) +
           height.capacity() * sizeof(double) + face.capacity() * sizeof(std::uint32_t) +
           flags.capacity() + triangles.capacity() * sizeof(Triangle);
}

}  // namespace beltgrinding
