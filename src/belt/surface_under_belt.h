#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "belt_path.h"
#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// What of the map lies under the belt: rows of the grid, or the part of them within its width.
struct BeltRow {
    int row = 0;         ///< of the grid
    double y = 0.0;      ///< mm, middle of the part within
    double width = 0.0;  ///< mm
};
std::vector<BeltRow> rows_under_belt(const ContactGrid& grid, double width);

/// The surface seen from a path, at the middles of its columns and of the rows: one column a
/// column.
struct BeltGap {
    Eigen::ArrayXXd reach;  ///< mm along the path's normal up to where the belt's middle surface
                            ///< lies on the work; -inf: nothing is there
    Eigen::ArrayXXd cover;  ///< share that the work covers
};

/// The work's surface under the belt as heights over the machine's x and y, from a gap map.
class SurfaceUnderBelt {
  public:
    /// Heights are raised by `lift`, mm. The problem must outlive it.
    SurfaceUnderBelt(const ContactGrid& grid, const ContactProblem& problem,
                     const std::vector<BeltRow>& rows, double thickness);

    /// What the belt's middle surface may touch, the highest of each column; without lift.
    std::vector<RidgePoint> ridge() const;
    BeltGap seen_from(const BeltPath& path, double lift) const;

  private:
    struct Height {
        double z, slope;  // mm, mm/mm along x
        double cover;     // 0: nothing there
    };
    Height at(int row, double x) const;
    /// The place of a row on the normal of a path's column, mm from the path, and the surface
    /// there.
    Height along_normal(int row, const BeltPath& path, int column, double lift, double& u) const;
    /// The same for all rows, where a column's normals leave four columns of the grid that are all
    /// there, nowhere: one cubic is all that they meet.
    struct Normals {
        Eigen::ArrayXd u, place, slope;  // mm, columns of the grid, mm/mm
        std::vector<std::uint8_t> found;
    };
    void along_normals(const BeltPath& path, int column, double lift, Normals& normals) const;
    /// By the columns of the grid from `first` on, where the normals stay between the middle ones.
    void along_normals(const BeltPath& path, int column, double lift, int first,
                       Normals& normals) const;

    const ContactGrid& grid_;
    const ContactProblem& problem_;
    const std::vector<BeltRow>& rows_;
    double half_;             // thickness, mm
    Eigen::ArrayXXd height_;  // mm, (nx, rows); -inf: nothing there
    Eigen::ArrayXXd by_row_;  // the same, (rows, nx)
    Eigen::ArrayXXd slope_;   // along y, mm/mm
};

}  // namespace beltgrinding
