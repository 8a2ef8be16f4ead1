#include "beltgrinding/height_field.h"

#include <limits>

namespace beltgrinding {

void RemovalTrace::reset(std::size_t n) {
    first.assign(n, kNever);
    last.assign(n, kNever);
    dominant.assign(n, kNever);
    dominant_depth.assign(n, 0.0F);
    peak_pressure.assign(n, 0.0F);
}

std::size_t RemovalTrace::bytes() const {
    return (first.capacity() + last.capacity() + dominant.capacity()) * sizeof(std::uint32_t) +
           (dominant_depth.capacity() + peak_pressure.capacity()) * sizeof(float);
}

float FinishTrace::roughness(std::size_t i) const {
    if (!(unknown[i] <= kMostUnknown)) return std::numeric_limits<float>::quiet_NaN();
    return settled[i] / (1.0F - unknown[i]);
}

std::size_t FinishTrace::bytes() const {
    return (settled.capacity() + unknown.capacity() + crossing.capacity()) * sizeof(float) +
           lay.capacity() * sizeof(Vec3f) +
           (passes.capacity() + motion.capacity()) * sizeof(std::uint32_t) + outside.capacity();
}

void HeightField::resize(std::size_t n) {
    point.resize(n, Vec3::Zero());
    if (!rays.empty()) rays.resize(n, Vec3f::UnitZ());
    normal.resize(n, Vec3f::UnitZ());
    area.resize(n, 0.0F);
    stock_height.resize(n, 0.0F);
    height.resize(n, 0.0);
    face.resize(n, 0);
    flags.resize(n, 0);
}

std::size_t HeightField::bytes() const {
    return point.capacity() * sizeof(Vec3) + normal.capacity() * sizeof(Vec3f) +
           rays.capacity() * sizeof(Vec3f) + area.capacity() * sizeof(float) +
           stock_height.capacity() * sizeof(float) + height.capacity() * sizeof(double) +
           face.capacity() * sizeof(std::uint32_t) + flags.capacity() +
           (height_sd.capacity() + height_error.capacity() + measured.capacity() +
            heat.rise.capacity()) *
               sizeof(float) +
           heat.motion.capacity() * sizeof(std::uint32_t) + trace.bytes() + finish.bytes() +
           triangles.bytes();
}

}  // namespace beltgrinding
