#include "gap/field_form.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "gap/placed_block.h"

namespace beltgrinding {
namespace {

constexpr double kGraded = 0.001;   // of the samples away from borders: fewer small ones are chance
constexpr double kDenser = 0.6;     // of the field's spacing: where curvature asks for more samples
constexpr double kStraight = 1e-6;  // less: a spike, which has no way along

/// Twice the area times the middle, and twice the area, of what of a triangle is a corner's, from
/// there: what is nearest to it, in an obtuse triangle up to the middles of its sides. Two
/// triangles of a rectangle give the same whichever its diagonal. `one`, `other`: the ways to the
/// other corners, mm.
std::pair<Vec3, double> corner_part(const Vec3& one, const Vec3& other) {
    const double a = one.squaredNorm(), b = other.squaredNorm(), dot = one.dot(other);
    Vec3 middle;  // of the circle through the corners, but in an obtuse triangle
    if (dot <= 0.0)
        middle = 0.5 * (one + other);
    else if (dot >= b)
        middle = 0.5 * one;
    else if (dot >= a)
        middle = 0.5 * other;
    else
        middle = 0.5 / (a * b - dot * dot) * (b * (a - dot) * one + a * (b - dot) * other);
    const double by_one = 0.5 * one.cross(middle).norm();
    const double by_other = 0.5 * other.cross(middle).norm();
    const Vec3 sum = by_one * (0.5 * one + middle) + by_other * (0.5 * other + middle);
    return {sum / 3.0, by_one + by_other};
}

}  // namespace

void FieldForm::look(const SampleBlocks& blocks, std::optional<double> lowest_step) {
    const HeightField& field = blocks.field();
    if (field_ == &field && size_ == field.size()) return;
    field_ = &field;
    size_ = field.size();
    find_borders(field);
    find_longer(field);
    if (lowest_step) find_steps(blocks, *lowest_step);
}

void FieldForm::find_borders(const HeightField& field) {
    borders_.clear();
    for (std::uint32_t k = 0; k < field.size(); ++k)
        if ((field.flags[k] & kOnBoundary) != 0) borders_.push_back({k, Vec3f::Zero(), 0.0f});
    if (borders_.empty()) return;
    std::vector<double> areas(borders_.size(), 0.0);
    std::vector<Vec3> moments(borders_.size(), Vec3::Zero());
    const auto number = [&](std::uint32_t sample) {
        const auto by_sample = [](const Border& a, std::uint32_t k) { return a.sample < k; };
        return static_cast<std::size_t>(
            std::lower_bound(borders_.begin(), borders_.end(), sample, by_sample) -
            borders_.begin());
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ways;  // between samples on a border
    for (const Triangle& triangle : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner];
            if ((field.flags[a] & kOnBoundary) == 0) continue;
            const Vec3 one = field.point[triangle[(corner + 1) % 3]] - field.point[a];
            const Vec3 other = field.point[triangle[(corner + 2) % 3]] - field.point[a];
            const auto [moment, area] = corner_part(one, other);
            const std::size_t k = number(a);
            moments[k] += moment;
            areas[k] += area;
            const std::uint32_t next = triangle[(corner + 1) % 3];
            if ((field.flags[next] & kOnBoundary) != 0) ways.emplace_back(a, next);
        }
    }
    // Along the border the middle has no business: there it is as the triangles happen to lie.
    std::sort(ways.begin(), ways.end());
    std::vector<Vec3> along(borders_.size(), Vec3::Zero());
    std::vector<int> neighbours(borders_.size(), 0);
    for (const auto& [from, to] : ways) {
        if (std::binary_search(ways.begin(), ways.end(), std::pair(to, from))) continue;
        const Vec3 way = field.point[to] - field.point[from];
        const double length = way.norm();
        if (!(length > 0.0)) continue;
        for (const std::uint32_t one : {from, to}) {
            const std::size_t k = number(one);
            along[k] += way / length;
            borders_[k].along += static_cast<float>(length);
            ++neighbours[k];
        }
    }
    for (std::size_t k = 0; k < borders_.size(); ++k) {
        const double apart = neighbours[k] > 0 ? borders_[k].along / neighbours[k] : 0.0;
        borders_[k].along = apart < kDenser * field.spacing ? static_cast<float>(apart) : 0.0f;
        if (areas[k] <= 0.0) continue;
        Vec3 middle = moments[k] / areas[k];
        const double square = along[k].squaredNorm();
        if (square > kStraight) middle -= along[k].dot(middle) / square * along[k];
        borders_[k].middle = middle.cast<float>();
    }
}

void FieldForm::find_longer(const HeightField& field) {
    longer_.clear();
    std::vector<char> beside(field.size(), 0);
    for (const Triangle& t : field.triangles)
        if (((field.flags[t[0]] | field.flags[t[1]] | field.flags[t[2]]) & kOnBoundary) != 0)
            for (const std::uint32_t k : t) beside[k] = 1;
    const double small = kDenser * field.spacing * field.spacing;
    std::size_t denser = 0;
    for (std::size_t k = 0; k < field.size(); ++k)
        if (beside[k] == 0 && field.area[k] < small) ++denser;
    if (static_cast<double>(denser) < kGraded * static_cast<double>(field.size())) return;
    std::vector<Eigen::Matrix3f> ways(field.size(), Eigen::Matrix3f::Zero());
    for (const Triangle& t : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = t[corner], b = t[(corner + 1) % 3];
            const Vec3f way = (field.point[b] - field.point[a]).cast<float>();
            const Eigen::Matrix3f square = way * way.transpose();
            ways[a] += square;
            ways[b] += square;
        }
    }
    longer_.resize(field.size());
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    for (std::size_t k = 0; k < field.size(); ++k) {
        solver.computeDirect(ways[k]);
        const float most = solver.eigenvalues()[2], less = solver.eigenvalues()[1];
        longer_[k] = less > 0.0f ? Vec3f(std::sqrt(most / less) * solver.eigenvectors().col(2))
                                 : Vec3f::Zero();
    }
}

const FieldForm::Border* FieldForm::border(std::uint32_t sample) const {
    const auto found =
        std::lower_bound(borders_.begin(), borders_.end(), sample,
                         [](const Border& a, std::uint32_t k) { return a.sample < k; });
    return found != borders_.end() && found->sample == sample ? &*found : nullptr;
}

void FieldForm::find_steps(const SampleBlocks& blocks, double lowest) {
    const HeightField& field = blocks.field();
    // By what does not change while it is ground: a run that goes on from a checkpoint sees it too.
    std::vector<std::uint8_t> may_step(field.size(), 0);
    for (std::size_t k = 0; k < field.size(); ++k)
        may_step[k] = (field.flags[k] & kOnBoundary) != 0 ? 1 : 0;
    for (const Triangle& triangle : field.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
            if (std::abs(field.stock_height[a] - field.stock_height[b]) > lowest)
                may_step[a] = may_step[b] = 1;
        }
    }
    steps_.assign(blocks.count(), 0);
    for (std::size_t k = 0; k < blocks.samples().size(); ++k) {
        if (may_step[blocks.sample(k)] != 0)
            steps_[k / kBlockLanes] |= std::uint64_t{1} << (k % kBlockLanes);
    }
}

}  // namespace beltgrinding
