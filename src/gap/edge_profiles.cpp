#include "gap/edge_profiles.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

constexpr int kLooked = 6;        // cells inwards whose loads bend the surface at the edge
constexpr double kClearly = 1.2;  // an edge that lies askew counts across the axis it turns to more
constexpr int kAll = 2 * EdgeProfiles::kStrips;

/// The mean over a strip of -ln of the distance to a line of load 1 that is spread over another:
/// from a to a + w each, in cells.
double line_over_line(double a, double wa, double b, double wb) {
    const auto twice = [](double z) {
        const double away = std::abs(z);
        return away > 0.0 ? z * z * (0.5 * std::log(away) - 0.75) : 0.0;
    };
    const double sum =
        twice(a + wa - b) - twice(a - b) - twice(a + wa - b - wb) + twice(a - b - wb);
    return -sum / (wa * wb);
}

/// To which sides of a cell there is nothing: of an edge that is clearly across one axis.
OpenSides edge_of(const ContactGrid& grid, const Eigen::ArrayXd& share, int i, int j) {
    OpenSides open = open_sides(grid, share, i, j);
    if (open.along == 0 && open.across == 0) return open;
    double by_s = 0.0, by_y = 0.0;
    for (int b = -1; b <= 1; ++b) {
        for (int a = -1; a <= 1; ++a) {
            const int x = std::clamp(i + a, 0, grid.nx - 1), y = std::clamp(j + b, 0, grid.ny - 1);
            const double here = share[y * grid.nx + x];
            by_s += a * here;
            by_y += b * here;
        }
    }
    by_s = std::abs(by_s);
    by_y = std::abs(by_y);
    if (by_s > kClearly * by_y) return {open.along, 0};
    if (by_y > kClearly * by_s) return {0, open.across};
    return {0, 0};
}

}  // namespace

double EdgeProfiles::Profile::mean(double from, double to, double further) const {
    double sum = 0.0, length = 0.0, at = 0.0;
    for (int k = 0; k < kAll; ++k) {
        const double next = at + width(k);
        const double within = std::min(to, next) - std::max(from, at);
        if (within > 0.0) {
            sum += within * pressure[static_cast<std::size_t>(k)];
            length += within;
        }
        at = next;
    }
    const double behind = std::max(to - std::max(from, at), 0.0);
    return length + behind > 0.0 ? (sum + behind * further) / (length + behind) : further;
}

void EdgeProfiles::find(const ContactGrid& grid, const Eigen::ArrayXd& share,
                        const Eigen::ArrayXd& pressure) {
    profiles_.clear();
    for (Numbers& numbers : numbers_) numbers.assign(static_cast<std::size_t>(grid.cells()), -1);
    const int nx = grid.nx, ny = grid.ny;
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const int cell = j * nx + i;
            if (!(pressure[cell] > 0.0) || !(share[cell] > 0.0)) continue;
            const OpenSides open = edge_of(grid, share, i, j);
            if ((open.along != 0) == (open.across != 0)) continue;
            const bool across = open.across != 0;
            const int side = across ? open.across : open.along, place = across ? j : i;
            const int step = across ? nx : 1, last = across ? ny - 1 : nx - 1;
            const int third = place - 2 * side;
            if (third < 0 || third > last) continue;
            const int second = cell - side * step;
            if (share[second] != 1.0 || !(pressure[second] > 0.0) ||
                !(share[second - side * step] > 0.0))
                continue;
            const auto number = static_cast<int>(profiles_.size());
            Profile profile{cell, across, side, share[cell], 0.0, false, false, {}, {}, {}};
            profile.edge = place + side * (share[cell] - 0.5);
            profiles_.push_back(profile);
            Numbers& numbers = numbers_[across ? 1 : 0];
            for (int k = -1; k <= 2; ++k) {
                const int at = place - k * side;
                if (at >= 0 && at <= last)
                    numbers[static_cast<std::size_t>(cell - k * side * step)] = number;
            }
        }
    }
}

void EdgeProfiles::gather(const ContactGrid& grid, const SampleBlocks& blocks,
                          const EdgePatches& patches, std::span<const Footprint> footprints) {
    const double spacing = blocks.field().spacing;
    const auto on_border = [&](const Footprint& f) {
        const auto& block = blocks.block(static_cast<std::uint32_t>(f.position / kBlockLanes));
        return (block.border >> (f.position % kBlockLanes) & 1U) != 0;
    };
    patches.for_patches([&](std::size_t number, const Patch&) {
        const Footprint& f = footprints[number];
        if (!f.nearest || !f.on_grid || !(f.inside > 0.0F)) return;
        const double s = f.s / grid.ds + 0.5 * (grid.nx - 1);
        const double y = f.y / grid.dy + 0.5 * (grid.ny - 1);
        const int i = std::clamp(static_cast<int>(std::lround(s)), 0, grid.nx - 1);
        const int j = std::clamp(static_cast<int>(std::lround(y)), 0, grid.ny - 1);
        for (const bool across : {false, true}) {
            const int found = numbers_[across ? 1 : 0][static_cast<std::size_t>(j * grid.nx + i)];
            if (found < 0) continue;
            Profile& profile = profiles_[static_cast<std::size_t>(found)];
            const double away = profile.side * (profile.edge - (across ? y : s));
            const double slope = across ? f.slope_y : f.slope_s;
            const double along = across ? f.slope_s * (i - s) : f.slope_y * (j - y);
            const double reach = spacing / (across ? grid.dy : grid.ds);
            if (std::abs(away) < reach && on_border(f)) profile.ends = true;
            for (int k = 0; k < kAll; ++k) {
                const double off = away - profile.middle(k);
                const double weight = f.inside * (1.0 - std::abs(off) / reach);
                if (!(weight > 0.0)) continue;
                const auto strip = static_cast<std::size_t>(k);
                profile.weight[strip] += weight;
                profile.gap[strip] += weight * (f.own_gap + along + slope * profile.side * off);
            }
        }
    });
}

bool EdgeProfiles::solve(const ContactGrid& grid, const Eigen::ArrayXd& share,
                         const Eigen::ArrayXd& pressure, double softness, Profile& profile) {
    if (!profile.ends) return false;
    constexpr int kUnknown = kAll + 2;
    const int step = profile.side * (profile.across ? grid.nx : 1);
    const int place = profile.across ? profile.cell / grid.nx : profile.cell % grid.nx;
    const int last = profile.across ? grid.ny - 1 : grid.nx - 1;
    const auto begin = [&](int k) { return profile.middle(k) - 0.5 * profile.width(k); };
    Eigen::Matrix<double, kUnknown, kUnknown> matrix;
    Eigen::Matrix<double, kUnknown, 1> wanted;
    matrix.setZero();
    wanted.setZero();
    for (int a = 0; a < kAll; ++a) {
        const auto strip = static_cast<std::size_t>(a);
        if (!(profile.weight[strip] > 0.0)) return false;
        for (int b = 0; b < kAll; ++b)
            matrix(a, b) = line_over_line(begin(a), profile.width(a), begin(b), profile.width(b)) *
                           profile.width(b);
        matrix(a, kAll + a / kStrips) = -1.0;
        matrix(kAll + a / kStrips, a) = profile.width(a);
        wanted[a] = -profile.gap[strip] / profile.weight[strip] / softness;
        for (int k = 2; k < kLooked; ++k) {
            const int at = place - k * profile.side;
            if (at < 0 || at > last) break;
            const int cell = profile.cell - k * step;
            wanted[a] -= share[cell] * pressure[cell] *
                         line_over_line(begin(a), profile.width(a), profile.covered + k - 1, 1.0);
        }
    }
    wanted[kAll] = profile.covered * pressure[profile.cell];
    wanted[kAll + 1] = pressure[profile.cell - step];
    for (int round = 0; round < kAll; ++round) {
        const Eigen::Matrix<double, kUnknown, 1> found = matrix.partialPivLu().solve(wanted);
        bool pulls = false;
        for (int a = 0; a < kAll; ++a) {
            profile.pressure[static_cast<std::size_t>(a)] = std::max(found[a], 0.0);
            if (found[a] >= 0.0) continue;
            pulls = true;  // there it lifts off
            matrix.row(a).setZero();
            matrix(a, a) = 1.0;
            wanted[a] = 0.0;
        }
        if (!pulls) return true;
    }
    return false;
}

double EdgeProfiles::factor(const ContactGrid& grid, const Eigen::ArrayXd& pressure,
                            const Footprint& f, const Patch& patch, bool across) const {
    const int above = row_step(grid);
    const int cells[4] = {f.cell, f.cell + 1, f.cell + above, f.cell + above + 1};
    const int i = f.cell % grid.nx, j = f.cell / grid.nx;
    const double at = across ? patch.y : patch.s, half = across ? patch.half_y : patch.half_s;
    const int own =
        std::clamp(static_cast<int>(std::lround(at)), 0, across ? grid.ny - 1 : grid.nx - 1);
    double before = 0.0, after = 0.0;
    for (int row = 0; row < 2; ++row) {
        const int one = row * (across ? 1 : 2), other = one + (across ? 2 : 1);
        const double weight = f.shares[one] + f.shares[other];
        if (!(weight > 0.0)) continue;
        const double value =
            (f.shares[one] * pressure[cells[one]] + f.shares[other] * pressure[cells[other]]) /
            weight;
        before += weight * value;
        const int column = std::min(across ? i + row : own, grid.nx - 1);
        const int line = std::min(across ? own : j + row, grid.ny - 1);
        const int found =
            numbers_[across ? 1 : 0][static_cast<std::size_t>(line * grid.nx + column)];
        if (found < 0 || !profiles_[static_cast<std::size_t>(found)].solved) {
            after += weight * value;
            continue;
        }
        const Profile& profile = profiles_[static_cast<std::size_t>(found)];
        const double away = profile.side * (profile.edge - at);
        after += weight * profile.mean(away - half, away + half, value);
    }
    return before > 0.0 ? after / before : 1.0;
}

void EdgeProfiles::restore(std::span<Footprint> footprints) {
    for (const Before& one : before_)
        std::copy(one.shares.begin(), one.shares.end(), footprints[one.footprint].shares);
    before_.clear();
}

void EdgeProfiles::sharpen(const ContactGrid& grid, const Eigen::ArrayXd& share,
                           const Eigen::ArrayXd& pressure, const EdgeSoftness& softness,
                           const SampleBlocks& blocks, const EdgePatches& patches,
                           std::span<Footprint> footprints) {
    restore(footprints);
    if (patches.empty() || !(softness.along > 0.0) || !(softness.across > 0.0)) return;
    if (pressure.size() != grid.cells()) return;
    find(grid, share, pressure);
    if (profiles_.empty()) return;
    gather(grid, blocks, patches, footprints);
    for (Profile& profile : profiles_) {
        const double yields = profile.across ? softness.along : softness.across;
        profile.solved = solve(grid, share, pressure, yields, profile);
    }
    patches.for_patches([&](std::size_t number, const Patch& patch) {
        Footprint& f = footprints[number];
        if (!f.nearest || !f.on_grid || !(f.inside > 0.0F)) return;
        const double by =
            factor(grid, pressure, f, patch, false) * factor(grid, pressure, f, patch, true);
        if (by == 1.0) return;
        before_.push_back({number, {f.shares[0], f.shares[1], f.shares[2], f.shares[3]}});
        for (float& one : f.shares) one *= static_cast<float>(by);
    });
}

}  // namespace beltgrinding
