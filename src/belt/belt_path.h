#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "beltgrinding/belt_machine.h"
#include "contact/belt_arc.h"

namespace beltgrinding {

/// Columns of a belt's finite differences: unknowns in their middles, slopes at their borders,
/// hinges at both ends.
struct BeltColumns {
    std::vector<double> width;    ///< mm
    std::vector<double> between;  ///< mm, from middle to middle at each border; at the ends, half
                                  ///< a column

    int count() const { return static_cast<int>(width.size()); }
    bool operator==(const BeltColumns&) const = default;
    /// mm between the places of the slopes before and behind a column, which lie half-way between
    /// the columns' middles: a parabola has its curvature, an even moment no force.
    double apart(int i) const {
        const auto k = static_cast<std::size_t>(i);
        return 0.5 * (between[k] + between[k + 1]);
    }
    /// Weights of the columns i - 1, i and i + 1 in the second derivative; 0 at the ends.
    std::array<double, 3> curvature(int i) const;
    /// Columns from their borders' places, ascending.
    static BeltColumns of(const std::vector<double>& borders);
};

/// A path of the belt's middle surface from roller to roller, in the machine's plane y = 0: x along
/// the belt, z from the work to the belt; the belt that touches nothing lies at z = 0.
struct BeltPath {
    BeltColumns columns;
    std::vector<double> angle, turn;  ///< by column: rad against x; 1/mm, negative: convex part
    std::vector<double> x, z;         ///< mm, of the columns' middles
    double length = 0.0;              ///< mm along the path
    double left = 0.0, right = 0.0;   ///< mm, the rollers' x
    double left_angle = 0.0, right_angle = 0.0;  ///< rad of the free runs, positive: pressed in
    std::vector<int> cell;  ///< by column: that of the grid along x whose forces are its own; -1:
                            ///< none, or by place
};

/// A place of the belt's middle surface, half a thickness off the work, mm.
struct RidgePoint {
    double x = 0.0, z = 0.0;
    double surface = 0.0;  ///< x on the work
};

/// What a string over the part does, with the corners rounded as bending does.
struct BeltPathRequest {
    /// What the belt's middle surface may touch, x ascending.
    std::vector<RidgePoint> obstacle;
    double lift = 0.0;    ///< mm that it is raised by
    double half = 0.0;    ///< mm, half the belt's thickness
    double cell = 1.0;    ///< mm along x of the grid, whose columns are the path's where contact is
                          ///< expected; see `halves`
    bool halves = true;   ///< columns beside where the string first and last touches are halved
    int cells = 64;       ///< of the grid along x, about x = 0
    double margin = 8.0;  ///< mm of such columns beyond that
    double bending = 0.0;  ///< mm, length over which bending rounds a corner, sqrt(D / N)
};

/// Empty columns: the string touches nothing.
BeltPath belt_path(const BeltRun& run, const BeltPathRequest& request);

/// The belt that touches nothing, on the columns of the grid that lie between its rollers.
BeltPath straight_path(const BeltRun& run, double cell, int cells);

/// The belt that touches nothing over a curved platen.
struct BentPath {
    BeltPath path;  ///< its free runs' angles are 0, from which its pull is told; no column is a
                    ///< cell's own
    std::vector<int> column;       ///< by column: its number along the fine ones; -1: it is wider
    std::vector<std::uint8_t> on;  ///< by column: it lies on the platen
    int fine = 0;  ///< such columns, a cell of the grid long each on the belt's face
};

/// `middle`: how the belt's middle surface lies, curved; `thickness`: the belt's, mm.
BentPath bent_path(const BeltRun& run, const BeltArc& middle, double thickness, double cell,
                   int cells);

}  // namespace beltgrinding
