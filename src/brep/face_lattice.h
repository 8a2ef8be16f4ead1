#pragma once

// Private to this room: the regular grid of samples inside a face.

#include <cstdint>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "beltgrinding/run_context.h"
#include "face_surface.h"
#include "face_trim.h"

namespace beltgrinding {

/// Rows of constant t at equal distance, each with nodes at equal arc length. Node k of n lies at
/// share k / n of its row's arc length, so neighbouring rows of the same n form quads ("cells").
/// Only nodes inside the border and not too near to it are alive.
class FaceLattice {
  public:
    /// Lays the rows, and finds which nodes are inside the border. `row_count` intervals of equal
    /// height. Throws InputError where the budget is spent.
    FaceLattice(const SurfaceMetric& metric, const PlaneGrid& grid, const Boundary& boundary,
                double spacing, std::size_t row_count, SampleBudget& budget);

    /// Hands each node's point to `put(node, point)`: from several threads, each node once. Throws
    /// Standard_Failure, and what `put` throws.
    template <class Put>
    void place(const FaceSurface& surface, const SurfaceMetric& metric, const RunContext& context,
               Put put);
    /// Drops the nodes near the border, and finds the whole cells. `point`: of the nodes, in their
    /// order, as they were placed. Throws Standard_Failure.
    void settle(const FaceSurface& surface, const SurfaceMetric& metric, const PlaneGrid& grid,
                const Boundary& boundary, double spacing, const Vec3* point,
                const RunContext& context);

    std::size_t size() const { return state_.size(); }
    double s(std::uint32_t node) const { return s_[node]; }
    double t(std::size_t row) const { return rows_[row].t; }
    bool alive(std::uint32_t node) const { return !(state_[node] & kDead); }
    /// True if all four corners of the cell above-right of the node are alive and no border passes
    /// through it: it becomes two triangles as it is.
    bool whole(std::uint32_t node) const { return whole_[node] != 0; }

    struct Run {
        int begin = 0, end = 0;   ///< columns [begin, end)
        std::uint32_t first = 0;  ///< node of column `begin`
    };
    struct Row {
        double t = 0, y = 0;
        int n = 0;  ///< intervals of the whole row
        std::vector<Run> runs;
    };
    const std::vector<Row>& rows() const { return rows_; }
    /// Node of a column, kNone if outside.
    std::uint32_t find(std::size_t row, int column) const;
    static constexpr std::uint32_t kNone = 0xffffffffu;
    /// True if the point of the grid lies in a whole cell.
    bool in_whole_cell(double grid_x, double grid_y, const PlaneGrid& grid) const;

  private:
    static constexpr std::size_t kRowBlock = 8;
    enum : std::uint8_t { kDead = 1, kCrossed = 2 };
    void lay_rows(const SurfaceMetric& metric, const PlaneGrid& grid, const Boundary& boundary,
                  double spacing, std::size_t row_count, SampleBudget& budget);
    void clear_border(const FaceSurface& surface, const SurfaceMetric& metric,
                      const PlaneGrid& grid, const Boundary& boundary, double spacing,
                      const Vec3* point);
    void find_whole_cells(const RunContext& context);

    std::vector<Row> rows_;
    std::unique_ptr<double[]> s_;  ///< filled by many threads, and not before
    std::vector<std::uint8_t> state_;
    std::vector<std::uint8_t> whole_;  ///< by threads that read the neighbours' state
    double row_height_ = 1;
};

template <class Put>
void FaceLattice::place(const FaceSurface& surface, const SurfaceMetric& metric,
                        const RunContext& context, Put put) {
    parallel_blocks(rows_.size(), kRowBlock, context, [&](std::size_t begin, std::size_t end) {
        const GeomAdaptor_Surface evaluator = surface.evaluator();
        for (std::size_t j = begin; j < end; ++j) {
            const Row& row = rows_[j];
            if (row.runs.empty()) continue;
            const SurfaceMetric::Row lengths = metric.row(row.t);
            SurfaceRow points = surface.row(evaluator, row.t);
            std::size_t cell = 0;
            for (const Run& run : row.runs) {
                for (int k = run.begin; k < run.end; ++k) {
                    const std::uint32_t node =
                        run.first + static_cast<std::uint32_t>(k - run.begin);
                    s_[node] = metric.s_of(lengths, double(k) / row.n, cell);
                    put(node, points.at(s_[node]));
                }
            }
        }
    });
}

}  // namespace beltgrinding
