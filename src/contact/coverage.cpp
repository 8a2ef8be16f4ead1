#include "contact/coverage.h"

#include <array>
#include <vector>

#include "contact/fit.h"

namespace beltgrinding {
namespace {

constexpr double kSliver = 0.25;  // of a cell
constexpr double kLeast = 0.05;   // the same, with nothing beside it
// The same where there is nothing else: a land far thinner than a cell.
constexpr double kLeastAlone = 0.005;

}  // namespace

void Coverage::clear(Eigen::Index cells) {
    for (Eigen::ArrayXd* one : {&share, &along, &across}) {
        fit(*one, cells);
        one->setZero();
    }
}

void Coverage::merge_slivers(const ContactGrid& grid) {
    struct Merged {
        int cell, to, di, dj;
    };
    std::vector<Merged> all;
    const double least = (share >= kSliver).any() ? kLeast : kLeastAlone;
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const int cell = j * grid.nx + i;
            if (!(share[cell] > 0.0) || share[cell] >= kSliver) continue;
            Merged best{cell, -1, 0, 0};
            double most = kSliver;
            for (const auto [di, dj] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                if (i + di < 0 || i + di >= grid.nx || j + dj < 0 || j + dj >= grid.ny) continue;
                const int to = cell + dj * grid.nx + di;
                if (share[to] < most) continue;
                most = share[to];
                best = {cell, to, di, dj};
            }
            if (best.to >= 0 || share[cell] < least) all.push_back(best);
        }
    }
    for (const Merged& one : all) {
        if (one.to >= 0) {
            const double to = share[one.to], with = share[one.cell], sum = to + with;
            along[one.to] = (to * along[one.to] + with * (along[one.cell] - one.di)) / sum;
            across[one.to] = (to * across[one.to] + with * (across[one.cell] - one.dj)) / sum;
            share[one.to] = sum;
        }
        share[one.cell] = 0.0;
    }
}

OpenSides open_sides(const ContactGrid& grid, const Eigen::ArrayXd& share, int i, int j) {
    const int cell = j * grid.nx + i;
    const auto side = [](bool before, bool after) {
        return before == after ? 0 : (before ? 1 : -1);
    };
    return {side(i == 0 || share[cell - 1] > 0.0, i + 1 == grid.nx || share[cell + 1] > 0.0),
            side(j == 0 || share[cell - grid.nx] > 0.0,
                 j + 1 == grid.ny || share[cell + grid.nx] > 0.0)};
}

}  // namespace beltgrinding
