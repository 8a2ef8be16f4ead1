#include "resolution_recorder.h"

#include <algorithm>

namespace beltgrinding {
ResolutionRecorder::ResolutionRecorder(const SampleBlocks& blocks)
    : Keeps(&PhaseTimes::trace), blocks_(blocks), sums_(blocks.count(), Lanes{}) {}

void ResolutionRecorder::coarsen(const ContactGrid& grid, const Eigen::ArrayXd& rate,
                                 const Eigen::ArrayXd& coverage) {
    const Eigen::Index nx = grid.nx, ny = grid.ny;
    coarse_.pressure.setZero(grid.cells());
    volume_.resize(grid.cells());
    area_.resize(grid.cells());
    Eigen::Index first = ny, last = -1;  // rows with some rate
    for (Eigen::Index j = 0; j < ny; ++j) {
        if (!(rate.segment(j * nx, nx).maxCoeff() > 0.0)) continue;
        first = std::min(first, j);
        last = j;
    }
    if (last < 0) return;
    const auto near = [ny](Eigen::Index row) { return std::clamp<Eigen::Index>(row, 0, ny - 1); };
    // Joined along s: what is asked for at a row takes its neighbours.
    for (Eigen::Index j = near(first - 2); j <= near(last + 2); ++j) {
        const auto cover = coverage.segment(j * nx, nx);
        const auto join = [nx](const auto& from, auto to) {
            to = 2.0 * from;
            to.head(nx - 1) += from.tail(nx - 1);
            to.tail(nx - 1) += from.head(nx - 1);
        };
        join((cover * rate.segment(j * nx, nx)).eval(), volume_.segment(j * nx, nx));
        join(cover, area_.segment(j * nx, nx));
    }
    const auto across = [&](const Eigen::ArrayXd& from, Eigen::Index j) {
        Eigen::ArrayXd to = 2.0 * from.segment(j * nx, nx);
        if (j > 0) to += from.segment((j - 1) * nx, nx);
        if (j + 1 < ny) to += from.segment((j + 1) * nx, nx);
        return to;
    };
    for (Eigen::Index j = near(first - 1); j <= near(last + 1); ++j) {
        const Eigen::ArrayXd volume = across(volume_, j), area = across(area_, j);
        for (Eigen::Index i = 0; i < nx; ++i) {
            const Eigen::Index cell = j * nx + i;
            if (!(coverage[cell] > 0.0) || !(volume[i] > 0.0)) continue;
            coarse_.pressure[cell] = volume[i] / area[i];
        }
    }
}

void ResolutionRecorder::removed(const Removal& removal) {
    const GapMap& map = removal.pressing.map();
    coarsen(map.grid(), removal.rate, map.coverage());
    coarse_.beside = removal.beside;
    const auto seconds = static_cast<float>(removal.duration * map.scale());
    map.for_pressed_blocks(
        coarse_,
        [&](std::size_t first, const float* values) {
            Lanes& sums = sums_[first / SampleBlocks::kLanes];
            for (std::size_t lane = 0; lane < SampleBlocks::kLanes; ++lane)
                sums[lane] += seconds * std::max(values[lane], 0.0F);
        },
        [&](std::size_t position, double value, double share) {
            sums_[position / SampleBlocks::kLanes][position % SampleBlocks::kLanes] +=
                seconds * static_cast<float>(share * value);
        });
}

void ResolutionRecorder::keep(HeightField& field, SimulationResult& result) {
    result.unresolved.resize(field.size());
    for (std::size_t k = 0; k < blocks_.samples().size(); ++k) {
        const std::uint32_t sample = blocks_.sample(k);
        const double ground = field.height[sample] - blocks_.height(k);
        result.unresolved[sample] =
            static_cast<float>(ground) - sums_[k / SampleBlocks::kLanes][k % SampleBlocks::kLanes];
    }
}

ByBlock<ResolutionRecorder::Lanes> ResolutionRecorder::take(std::span<const std::uint32_t> blocks) {
    return {blocks, [this](std::uint32_t block) { return sums_[block]; }};
}

void ResolutionRecorder::put(std::span<const ByBlock<Lanes>* const> parts) {
    for (const auto* part : parts)
        part->each([this](std::uint32_t block, const Lanes& values) { sums_[block] = values; });
}

}  // namespace beltgrinding
