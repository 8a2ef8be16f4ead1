#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// Points of the surface that a scan is laid on. Frame: work; mm.
struct DatumSurface {
    std::vector<Vec3> points;    ///< mm
    std::vector<Vec3f> normals;  ///< unit, outward
    double spacing = 0.5;        ///< mm, between neighbours
};

/// A scan: points in its own frame, in mm already.
struct ScanPoints {
    std::vector<Vec3> points;    ///< mm
    std::vector<Vec3f> normals;  ///< unit, outward; empty: not known
};

/// How a scan is laid on the datum.
struct RegistrationOptions {
    Frame start = Frame::Identity();  ///< work_from_scan
    double max_distance = 5.0;        ///< mm; scan points farther from the datum are not of it
    double share = 0.9;               ///< of the pairs, the nearest: the rest is trimmed
    /// Translations along and rotations about x, y, z of the work frame, through the datum's
    /// centroid, that stay as the start has them.
    std::array<bool, 6> fixed{};
    int iterations = 100;               ///< at most
    std::size_t most_points = 100'000;  ///< of the scan, evenly taken
};

/// Where the scan lies, and how well that is known.
struct Registration {
    Frame work_from_scan = Frame::Identity();  ///< where the scan lies
    double rms = 0;                            ///< mm, point to plane, of the pairs that were used
    double distance = 0;                       ///< mm, beyond which pairs were left out in the end
    std::size_t used = 0;                      ///< pairs
    double used_share = 0;                     ///< of the scan's points that were looked at
    int iterations = 0;                        ///< done
    bool converged = false;                    ///< the last one moved nothing that matters
    Vec3 centre = Vec3::Zero();                ///< of the rotations below, mm, work frame
    /// Standard deviation of each freedom (mm, rad) if the residuals were independent; infinite
    /// where the geometry leaves it open, 0 where it was fixed.
    std::array<double, 6> sd{};
    /// Motions that the datum does not determine (a plane slides), as unit vectors of translation
    /// and rotation times the datum's radius; the scan keeps the start's place along them.
    std::vector<std::array<double, 6>> undetermined;
};

/// Lays a scan on a datum surface: iterative closest points with the point-to-plane distance (Chen
/// and Medioni 1992), trimmed (Chetverikov et al. 2002), with pairs rejected that are farther apart
/// than six times the residual, that lie beside the datum, or whose normals disagree. Throws
/// InputError when hardly a point of the scan is near the datum.
Registration register_scan(const ScanPoints& scan, const DatumSurface& datum,
                           const RegistrationOptions& options, const RunContext& context = {});

/// Height of a point cloud over design points: along each of `rays` (of any length, which is that
/// of a height of 1 mm) to the plane of the `neighbours` nearest scan points, found again from
/// where the plane was met. NaN where these lie farther than `reach` mm, or to one side. `start`
/// (mm): heights at which the search begins; the cloud is in the work frame.
std::vector<double> measure_cloud(const std::vector<Vec3>& cloud, const std::vector<Vec3>& points,
                                  const std::vector<Vec3f>& rays, const std::vector<double>& start,
                                  double reach, std::size_t neighbours = 12,
                                  const RunContext& context = {});

}  // namespace beltgrinding
