#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Points in cubic cells: about `kPointsPerCell` each where they lie evenly on a surface.
class PointCells {
  public:
    static constexpr double kPointsPerCell = 8.0;
    static constexpr std::size_t kMostCells = 1 << 21;

    explicit PointCells(const std::vector<Vec3>& point) {
        Box box;
        for (const Vec3& p : point) box.extend(p);
        low_ = box.min();
        const Vec3 size = box.sizes().cwiseMax(1e-9);
        // A surface fills about as many cells as its extents' largest face has.
        const double area = size.maxCoeff() * (size.sum() - size.maxCoeff() - size.minCoeff());
        edge_ = std::sqrt(std::max(area, 1e-12) * kPointsPerCell / double(point.size()));
        edge_ = std::max(edge_, size.maxCoeff() / 1000.0);
        do {
            count_ = ((size / edge_).array().floor() + 1).cast<long>();
            edge_ *= 1.3;
        } while (count_.prod() > long(kMostCells));
        edge_ /= 1.3;
        start_.assign(static_cast<std::size_t>(count_.prod()) + 1, 0);
        for (const Vec3& p : point) ++start_[number(cell(p)) + 1];
        for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
        std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
        index_.resize(point.size());
        for (std::size_t i = 0; i < point.size(); ++i) index_[next[number(cell(point[i]))]++] = i;
    }

    /// Calls `visit(i)` for all points in cells that meet the box.
    template <class Visit>
    void in(const Box& box, Visit&& visit) const {
        const Eigen::Array3i a = cell(box.min()), b = cell(box.max());
        for (int z = a.z(); z <= b.z(); ++z)
            for (int y = a.y(); y <= b.y(); ++y) {
                const std::size_t first = number({a.x(), y, z}), last = number({b.x(), y, z});
                for (std::size_t k = start_[first]; k < start_[last + 1]; ++k) visit(index_[k]);
            }
    }

  private:
    Eigen::Array3i cell(const Vec3& p) const {
        const Eigen::Array3d at = ((p - low_) / edge_).array().floor();
        return at.max(0.0).min((count_ - 1).cast<double>()).cast<int>();
    }
    std::size_t number(const Eigen::Array3i& c) const {
        return static_cast<std::size_t>((c.z() * count_.y() + c.y()) * count_.x() + c.x());
    }

    Vec3 low_;
    double edge_ = 1.0;
    Eigen::Array3<long> count_;
    std::vector<std::size_t> start_, index_;
};

}  // namespace beltgrinding
