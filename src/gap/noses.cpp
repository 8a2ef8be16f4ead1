#include "gap/noses.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

// Of the radius of a nose and the stock on it: the wheel's place is then right to 3 %, and does not
// depend on where the nose lies between the cells.
constexpr double kCellOnNose = 0.3;
constexpr double kSamplesPerCell = 1.0;
constexpr double kNoise = 0.02;  // rad from sample to sample: less is no bend
constexpr double kLongest =
    2.0;  // of a cell's shorter side: longer ones lose what they share with others
constexpr double kLeastPart = 0.03;  // of the bend along a side: less does not show in its cells
constexpr double kMayBear = 0.03;    // mm: gaps of what may bear pressure

}  // namespace

void Noses::look(const SampleBlocks& blocks) {
    const HeightField& field = blocks.field();
    if (field_ == &field && size_ == field.size()) return;
    field_ = &field;
    size_ = field.size();
    bends_.assign(field.size(), {});
    // Cells are halved at least: what bends less than that needs no look.
    const double widest = cell_ / (std::sqrt(2.0) * kCellOnNose);
    bool any = false;
    for (const Triangle& triangle : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
            const Vec3 along = field.point[b] - field.point[a];
            const Vec3 turn = (field.normal[b] - field.normal[a]).cast<double>();
            const double apart = along.norm(), bend = turn.norm();
            if (!(along.dot(turn) > 0.0) || bend < kNoise || apart > widest * bend) continue;
            for (const std::uint32_t k : {a, b}) {
                Bend& known = bends_[k];
                const auto radius = static_cast<float>(apart / bend);
                if (known.radius > 0.0F && known.radius <= radius) continue;
                known = {radius, static_cast<float>(apart), (along / apart).cast<float>()};
                any = true;
            }
        }
    }
    bent_.clear();
    if (!any) {
        bends_.clear();
        return;
    }
    bent_.assign(blocks.count(), 0);
    for (std::size_t k = 0; k < blocks.samples().size(); ++k)
        if (bends_[blocks.sample(k)].radius > 0.0F) bent_[k / kBlockLanes] = 1;
}

Noses::Sides Noses::sides(const PlacedSamples& placed, const SampleBlocks& blocks) const {
    if (bends_.empty()) return widest();
    // Where the wheel is not yet at the work, what it will meet first.
    const double lowest = std::max(placed.least_gap(), 0.0);
    const Eigen::Matrix3d rotation = placed.pose().contact_from_work().linear();
    Sides wanted = widest();
    placed.for_gaps([&](std::size_t position, float gap) {
        if (bent_[position / kBlockLanes] == 0 || gap > lowest + kMayBear) return;
        const Bend& bend = bends_[blocks.sample(position)];
        if (!(bend.radius > 0.0F)) return;
        const double top = bend.radius + std::max(blocks.height(position), 0.0);
        const double cell = std::max(kCellOnNose * top, kSamplesPerCell * bend.apart);
        // A nose askew bends less along either side.
        const double aside = (rotation * bend.way.cast<double>()).y();
        const double square = std::min(aside * aside, 1.0);
        if (square > kLeastPart) wanted.across = std::min(wanted.across, cell / square);
        if (1.0 - square > kLeastPart) wanted.along = std::min(wanted.along, cell / (1.0 - square));
    });
    const double longest = kLongest * std::min(wanted.along, wanted.across);
    return {halved(std::min(wanted.along, longest)), halved(std::min(wanted.across, longest))};
}

double Noses::halved(double wanted) const {
    return cell_ * std::exp2(-std::round(std::log2(cell_ / wanted)));
}

}  // namespace beltgrinding
