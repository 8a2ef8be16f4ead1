#include "gap/noses.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace beltgrinding {
namespace {

// Of the radius of a nose and the stock on it: the wheel's place is then right to 3 %, and does not
// depend on where the nose lies between the cells.
constexpr double kCellOnNose = 0.3;
constexpr double kBends = 6.0;  // cells, of a nose's radius: wider ones are no nose
constexpr double kSamplesPerCell = 1.0;
// Of the grid, about: more take a tenth of a second a step.
constexpr double kMostCells = 6000.0;
constexpr double kNoise = 0.02;  // rad from sample to sample: less is no bend
constexpr double kLongest =
    2.0;  // of a cell's shorter side: longer ones lose what they share with others
constexpr double kLeastPart = 0.03;  // of the bend along a side: less does not show in its cells
constexpr double kMayBear = 0.03;    // mm: gaps of what may bear pressure
constexpr double kLevel = 1e-4;      // rise of the ground per mm: less is none
constexpr double kTie = 1e-6;        // square to neighbours that all lie in line, it does not rise

}  // namespace

void Noses::look(const SampleBlocks& blocks) {
    const HeightField& field = blocks.field();
    if (field_ == &field && size_ == field.size()) return;
    field_ = &field;
    size_ = field.size();
    bends_ = {};
    const double widest = kBends * cell_;
    for (const Triangle& triangle : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
            const Vec3 along = field.point[b] - field.point[a];
            const Vec3 turn = (field.normal[b] - field.normal[a]).cast<double>();
            const double apart = along.norm(), bend = turn.norm();
            if (!(along.dot(turn) > 0.0) || bend < kNoise || apart > widest * bend) continue;
            if (bends_.empty()) bends_.resize(field.size());  // few parts have any
            for (const std::uint32_t k : {a, b}) {
                Bend& known = bends_[k];
                const auto radius = static_cast<float>(apart / bend);
                if (known.radius > 0.0F && known.radius <= radius) continue;
                known = {radius, static_cast<float>(apart), (along / apart).cast<float>()};
            }
        }
    }
    bent_.clear();
    if (bends_.empty()) return;
    bent_.assign(blocks.count(), 0);
    position_.resize(field.size());
    for (std::size_t k = 0; k < blocks.samples().size(); ++k) {
        position_[blocks.sample(k)] = static_cast<std::uint32_t>(k);
        if (bends_[blocks.sample(k)].radius > 0.0F) bent_[k / kBlockLanes] = 1;
    }
    find_neighbours(field);
}

void Noses::find_neighbours(const HeightField& field) {
    // Of each triangle's corner the next: both of an edge within, as other triangles go round it
    // the other way; of the surface's border one.
    const auto for_pairs = [&](auto visit) {
        for (const Triangle& triangle : field.triangles)
            for (std::size_t corner = 0; corner < 3; ++corner)
                if (const std::uint32_t from = triangle[corner]; bends_[from].radius > 0.0F)
                    visit(from, triangle[(corner + 1) % 3]);
    };
    first_.assign(field.size() + 1, 0);
    for_pairs([&](std::uint32_t from, std::uint32_t) { ++first_[from + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    neighbours_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_pairs([&](std::uint32_t from, std::uint32_t to) { neighbours_[next[from]++] = to; });
}

Vec3 Noses::lean(const SampleBlocks& blocks, std::uint32_t sample) const {
    const HeightField& field = blocks.field();
    const Vec3 normal = field.normal[sample].cast<double>();
    const double height = blocks.height(position_[sample]);
    const double offset = std::max(height, deepest(sample));
    // The least squares of the heights round it, on the surface offset by its own.
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Vec3 rises = Vec3::Zero();
    for (std::uint32_t k = first_[sample]; k < first_[sample + 1]; ++k) {
        const std::uint32_t other = neighbours_[k];
        const double rise = blocks.height(position_[other]) - height;
        Vec3 away = field.point[other] - field.point[sample] +
                    offset * (field.normal[other].cast<double>() - normal);
        away -= away.dot(normal) * normal;
        const double square = away.squaredNorm();
        if (!(square > 0.0)) continue;
        squares += away * away.transpose() / square;
        rises += rise / square * away;
    }
    if (!(rises.squaredNorm() > kLevel * kLevel)) return Vec3::Zero();
    squares += kTie * Eigen::Matrix3d::Identity() + normal * normal.transpose();
    return squares.ldlt().solve(rises);
}

void Noses::follow_the_ground(PlacedSamples& placed, const SampleBlocks& blocks,
                              const ContactGrid& grid) const {
    if (bends_.empty()) return;
    placed.tilt(grid, [&](std::size_t position, double s, double gap) -> Eigen::Vector2d {
        const std::uint32_t sample = blocks.sample(position);
        if (!(bends_[sample].radius > 0.0F)) return Eigen::Vector2d::Zero();
        const Vec3 lean = this->lean(blocks, sample);
        if (lean.isZero()) return Eigen::Vector2d::Zero();
        const Vec3 design = blocks.field().normal[sample].cast<double>();
        return placed.pose().slopes(design - lean, s, gap) - placed.pose().slopes(design, s, gap);
    });
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
        // A nose askew bends less along either side, and where its flank falls off, along neither.
        const Vec3 way = rotation * bend.way.cast<double>();
        const double along = way.x() * way.x(), across = way.y() * way.y();
        if (across > kLeastPart) wanted.across = std::min(wanted.across, cell / across);
        if (along > kLeastPart) wanted.along = std::min(wanted.along, cell / along);
    });
    const double longest = kLongest * std::min(wanted.along, wanted.across);
    wanted = {std::min(wanted.along, longest), std::min(wanted.across, longest)};
    const double cells =
        2.0 * placed.half_length() * placed.pose().wheel().width / (wanted.along * wanted.across);
    const double wider = std::sqrt(std::max(cells / kMostCells, 1.0));
    return {halved(wider * wanted.along), halved(wider * wanted.across)};
}

double Noses::halved(double wanted) const {
    return cell_ * std::exp2(-std::max(std::round(std::log2(cell_ / wanted)), 0.0));
}

}  // namespace beltgrinding
