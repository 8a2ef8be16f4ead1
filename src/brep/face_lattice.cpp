#include "face_lattice.h"

#include <algorithm>
#include <cmath>

#include "base/large_memory.h"
#include "base/parallel.h"

namespace beltgrinding {
namespace {

constexpr double kClearance = 0.5;     // of the spacing: nearer nodes leave the border its place
constexpr double kKeepColumns = 0.06;  // spacing may be that far off before a row's count changes
constexpr int kReach = 2;  // rows and columns around a chord in which nodes may be too near

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double l2 = ab.squaredNorm();
    const double w = l2 > 0 ? std::clamp((p - a).dot(ab) / l2, 0.0, 1.0) : 0.0;
    return (p - a - w * ab).norm();
}

}  // namespace

FaceLattice::FaceLattice(const SurfaceMetric& metric, const PlaneGrid& grid,
                         const Boundary& boundary, double spacing, std::size_t row_count,
                         SampleBudget& budget) {
    lay_rows(metric, grid, boundary, spacing, row_count, budget);
}

void FaceLattice::settle(const FaceSurface& surface, const SurfaceMetric& metric,
                         const PlaneGrid& grid, const Boundary& boundary, double spacing,
                         const Vec3* point, const RunContext& context) {
    clear_border(surface, metric, grid, boundary, spacing, point);
    find_whole_cells(context);
}

void FaceLattice::lay_rows(const SurfaceMetric& metric, const PlaneGrid& grid,
                           const Boundary& boundary, double spacing, std::size_t row_count,
                           SampleBudget& budget) {
    rows_.resize(row_count + 1);
    row_height_ = metric.height() / double(row_count);
    const TrimScan scan(boundary, metric.height() * grid.y_scale, row_count);
    std::size_t nodes = 0;
    int columns = 0;
    for (std::size_t j = 0; j <= row_count; ++j) {
        Row& row = rows_[j];
        row.y = row_height_ * double(j);
        row.t = metric.t_of(row.y);
        const double wanted = metric.row(row.t).total() / spacing;
        if (columns < 1 || std::abs(columns / wanted - 1) > kKeepColumns)
            columns = std::max(1, static_cast<int>(std::lround(wanted)));
        row.n = columns;
        if (j == 0 || j == row_count) continue;  // these lie on the border
        const std::vector<double> x = scan.crossings(double(grid.point(0, row.y).y));
        for (std::size_t i = 0; i + 1 < x.size(); i += 2) {
            const double step = grid.x_scale / columns;
            Run run;
            run.begin = std::max(1, static_cast<int>(std::floor(x[i] / step)) + 1);
            run.end = std::min(columns, static_cast<int>(std::ceil(x[i + 1] / step)));
            if (!row.runs.empty()) run.begin = std::max(run.begin, row.runs.back().end);
            if (run.begin >= run.end) continue;
            run.first = static_cast<std::uint32_t>(nodes);
            nodes += static_cast<std::size_t>(run.end - run.begin);
            row.runs.push_back(run);
        }
    }
    budget.take(nodes);
    s_ = make_large<double>(nodes);
    state_.assign(nodes, 0);
}

std::uint32_t FaceLattice::find(std::size_t row, int column) const {
    const auto& runs = rows_[row].runs;
    const auto after = std::upper_bound(runs.begin(), runs.end(), column,
                                        [](int k, const Run& r) { return k < r.begin; });
    if (after == runs.begin()) return kNone;
    const Run& run = *(after - 1);
    if (column >= run.end) return kNone;
    return run.first + static_cast<std::uint32_t>(column - run.begin);
}

void FaceLattice::clear_border(const FaceSurface& surface, const SurfaceMetric& metric,
                               const PlaneGrid& grid, const Boundary& boundary, double spacing,
                               const Vec3* point) {
    const GeomAdaptor_Surface evaluator = surface.evaluator();
    const auto distance = [&](std::uint32_t node, double t, const Vec3& a, const Vec3& b) {
        if (!metric.stretched()) return segment_distance(point[node], a, b);
        const SurfacePoint at = surface.at(evaluator, s_[node], t);
        const auto stretched = [&](const Vec3& p) {
            return metric.stretched(p - at.point, at, s_[node], t);
        };
        return segment_distance(Vec3::Zero(), stretched(a), stretched(b));
    };
    const int last = static_cast<int>(rows_.size()) - 1;
    for (const auto& segment : boundary.segments) {
        const auto &a = boundary.nodes[segment.a], &b = boundary.nodes[segment.b];
        const Vec3 &pa = boundary.samples[a.sample].point, &pb = boundary.samples[b.sample].point;
        const double scale = 1.0 / (grid.y_scale * row_height_);
        const double low = std::min(a.grid.y, b.grid.y) * scale;
        const double high = std::max(a.grid.y, b.grid.y) * scale;
        const double left = std::min(a.grid.x, b.grid.x) / grid.x_scale;
        const double right = std::max(a.grid.x, b.grid.x) / grid.x_scale;
        // Cells that the chord may pass through: strips [j, j + 1] it touches.
        const int j0 = std::max(0, static_cast<int>(std::floor(low)) - 1);
        const int j1 = std::min(last, static_cast<int>(std::ceil(high)) + 1);
        for (int j = std::max(0, j0 - kReach); j <= std::min(last, j1 + kReach); ++j) {
            const auto& row = rows_[static_cast<std::size_t>(j)];
            if (row.runs.empty()) continue;
            const int k0 = static_cast<int>(std::floor(left * row.n));
            const int k1 = static_cast<int>(std::ceil(right * row.n));
            for (int k = k0 - kReach; k <= k1 + kReach; ++k) {
                const std::uint32_t node = find(static_cast<std::size_t>(j), k);
                if (node == kNone) continue;
                if (j + 1 >= low && j <= high && k >= k0 - 1 && k <= k1) state_[node] |= kCrossed;
                if (distance(node, row.t, pa, pb) < kClearance * spacing) state_[node] |= kDead;
            }
        }
    }
}

void FaceLattice::find_whole_cells(const RunContext& context) {
    whole_.assign(state_.size(), 0);
    parallel_blocks(rows_.size() - 1, kRowBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const Row &low = rows_[j], &high = rows_[j + 1];
            if (low.n != high.n) continue;
            std::size_t i = 0;
            for (const Run& run : low.runs) {
                for (int k = run.begin; k + 1 < run.end; ++k) {
                    while (i < high.runs.size() && high.runs[i].end <= k) ++i;
                    if (i == high.runs.size()) break;
                    const Run& above = high.runs[i];
                    if (k < above.begin || k + 1 >= above.end) continue;
                    const std::uint32_t a = run.first + static_cast<std::uint32_t>(k - run.begin);
                    const std::uint32_t b =
                        above.first + static_cast<std::uint32_t>(k - above.begin);
                    if (alive(a) && alive(a + 1) && alive(b) && alive(b + 1) &&
                        !(state_[a] & kCrossed))
                        whole_[a] = 1;
                }
            }
        }
    });
}

bool FaceLattice::in_whole_cell(double grid_x, double grid_y, const PlaneGrid& grid) const {
    const double j = std::floor(grid_y / (grid.y_scale * row_height_));
    if (j < 0 || j + 1 >= double(rows_.size())) return false;
    const auto row = static_cast<std::size_t>(j);
    const int k = static_cast<int>(std::floor(grid_x / grid.x_scale * rows_[row].n));
    const std::uint32_t node = find(row, k);
    return node != kNone && whole(node);
}

}  // namespace beltgrinding
