#include "beltgrinding/registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

#include "base/parallel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr double kFarther = 6.0;   // of the residual: a pair so far apart is no pair
constexpr double kBeside = 1.5;    // of the datum's spacing, along it: the point lies beside it
constexpr double kSameSide = 0.5;  // cosine between normals that agree
constexpr double kUndetermined = 1e-3;    // eigenvalue of the mean normal equations, scaled
constexpr double kSettledShift = 1e-5;    // mm, and of the datum's radius: no more motion
constexpr double kSettledShare = 1e-4;    // of the residual
constexpr double kMedianToSd = 1.4826;    // of a normal distribution
constexpr std::size_t kFewest = 30;       // pairs
constexpr int kMeasureRounds = 4;         // of nearest points and plane
constexpr double kAside = 1.5;            // of the neighbours' spread: their mean lies beside
constexpr double kMeasureSettled = 1e-4;  // mm
constexpr std::size_t kBlock = 512;

/// The nearest of given points, in double precision.
class NearestPoints {
  public:
    /// Keeps a reference: `points` must outlive it.
    explicit NearestPoints(const std::vector<Vec3>& points) : points_{points}, tree_(3, points_) {}

    /// Fills `found` with the indices of the points nearest to `at`, as many as it is long, and
    /// `squared` (as long) with their squared distances, nearest first. False: there are fewer.
    bool operator()(const Vec3& at, std::vector<std::uint32_t>& found,
                    std::vector<double>& squared) const {
        return tree_.knnSearch(at.data(), found.size(), found.data(), squared.data()) ==
               found.size();
    }

  private:
    struct Points {
        const std::vector<Vec3>& points;
        std::size_t kdtree_get_point_count() const { return points.size(); }
        double kdtree_get_pt(std::size_t i, std::size_t axis) const {
            return points[i][Eigen::Index(axis)];
        }
        template <class Bounds>
        bool kdtree_get_bbox(Bounds&) const {
            return false;
        }
    };
    Points points_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3,
                                        std::uint32_t>
        tree_;
};

/// A point of the scan and the nearest of the datum.
struct Pair {
    std::uint32_t source = 0, target = 0;
    double squared = -1;  ///< mm2, along the datum's normal: what is trimmed by; < 0: no pair
};

/// Leaves the `count` pairs of least `squared`, in their order.
void trim(std::vector<Pair>& pairs, std::size_t count) {
    if (count >= pairs.size()) return;
    std::vector<double> squares;
    squares.reserve(pairs.size());
    for (const Pair& p : pairs) squares.push_back(p.squared);
    const auto cut = squares.begin() + std::ptrdiff_t(count);
    std::nth_element(squares.begin(), cut, squares.end());
    const double limit = *cut;
    std::size_t below = 0;
    for (const Pair& p : pairs) below += p.squared < limit;
    std::size_t at_limit = count - below;
    std::erase_if(pairs, [&](const Pair& p) {
        if (p.squared != limit) return p.squared > limit;
        if (at_limit == 0) return true;
        --at_limit;
        return false;
    });
}

/// Sums over the pairs: J^T J, J^T r, r^2 with J = [normal, point x normal / radius].
struct Normals {
    Mat6 square = Mat6::Zero();
    Vec6 right = Vec6::Zero();
    double residual = 0;
    double scale = 0;  ///< mm, robust, of all pairs before the trimming
    std::size_t pairs = 0;
};

class Aligner {
  public:
    Aligner(const ScanPoints& scan, const DatumSurface& datum, const RegistrationOptions& options)
        : datum_(datum), options_(options), nearest_(datum.points) {
        centre_ = Vec3::Zero();
        for (const Vec3& p : datum.points) centre_ += p;
        centre_ /= double(datum.points.size());
        for (const Vec3& p : datum.points) radius_ += (p - centre_).squaredNorm();
        radius_ = std::sqrt(radius_ / double(datum.points.size()));
        const std::size_t n = scan.points.size();
        const std::size_t step = std::max<std::size_t>(
            1, (n + options.most_points - 1) / std::max<std::size_t>(1, options.most_points));
        const bool normals = scan.normals.size() == n;
        for (std::size_t i = 0; i < n; i += step) {
            points_.push_back(options.start * scan.points[i] - centre_);
            if (normals)
                normals_.push_back(options.start.linear() * scan.normals[i].cast<double>());
        }
    }

    Registration run(const RunContext& context) {
        Registration result;
        result.centre = centre_;
        double distance = options_.max_distance;
        Normals sums;
        for (; result.iterations < options_.iterations; ++result.iterations) {
            context.throw_if_cancelled();
            context.report(double(result.iterations) / options_.iterations);
            sums = pair_up(distance, context);
            if (sums.pairs < kFewest)
                throw InputError("scan.too_few_pairs",
                                 "scan: {pairs} of its points lie within {distance:.3g} mm of the "
                                 "design's datum faces, at least {least} are needed; look at its "
                                 "unit and at where it starts",
                                 {{"pairs", sums.pairs},
                                  {"distance", options_.max_distance},
                                  {"least", kFewest}});
            const Vec6 step = solve(sums);
            apply(step);
            const double rms = std::sqrt(sums.residual / double(sums.pairs));
            const double nearer = std::clamp(kFarther * sums.scale, 0.5 * datum_.spacing, distance);
            const double little = std::max(kSettledShift, kSettledShare * rms);
            const bool settled = step.head<3>().norm() < little && step.tail<3>().norm() < little &&
                                 nearer > 0.99 * distance;
            distance = nearer;
            if (settled) {
                result.converged = true;
                break;
            }
        }
        sums = pair_up(distance, context);
        result.distance = distance;
        result.used = sums.pairs;
        result.used_share = double(sums.pairs) / double(points_.size());
        result.rms = sums.pairs > 0 ? std::sqrt(sums.residual / double(sums.pairs)) : 0.0;
        result.work_from_scan = Eigen::Translation3d(centre_) * motion_ *
                                Eigen::Translation3d(-centre_) * options_.start;
        tell_freedoms(sums, result);
        return result;
    }

  private:
    /// The pairs no farther apart than `distance` that are of the datum's surface.
    std::vector<Pair> pairs_within(double distance, const RunContext& context) const {
        std::vector<Pair> all(points_.size());
        parallel_blocks(points_.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> index(1);
            std::vector<double> squared(1);
            for (std::size_t s = begin; s < end; ++s) {
                const Vec3 moved = motion_ * points_[s];
                if (!nearest_(moved + centre_, index, squared)) continue;
                if (squared[0] > distance * distance) continue;
                const std::size_t t = index[0];
                const Vec3 normal = datum_.normals[t].cast<double>();
                const Vec3 apart = moved - (datum_.points[t] - centre_);
                const double height = apart.dot(normal);
                if ((apart - height * normal).norm() > kBeside * datum_.spacing) continue;
                if (!normals_.empty() && (motion_.linear() * normals_[s]).dot(normal) < kSameSide)
                    continue;
                all[s] = {std::uint32_t(s), index[0], height * height};
            }
        });
        std::erase_if(all, [](const Pair& p) { return p.squared < 0; });
        return all;
    }

    Normals pair_up(double distance, const RunContext& context) const {
        std::vector<Pair> pairs = pairs_within(distance, context);
        Normals sums;
        if (!pairs.empty()) {
            std::vector<double> squares;
            squares.reserve(pairs.size());
            for (const Pair& p : pairs) squares.push_back(p.squared);
            const auto middle = squares.begin() + std::ptrdiff_t(squares.size() / 2);
            std::nth_element(squares.begin(), middle, squares.end());
            sums.scale = kMedianToSd * std::sqrt(*middle);
        }
        trim(pairs, std::max(kFewest, std::size_t(options_.share * double(pairs.size()))));
        sums.pairs = pairs.size();
        for (const Pair& pair : pairs) {
            const std::size_t t = pair.target;
            const Vec3 normal = datum_.normals[t].cast<double>();
            const Vec3 p = motion_ * points_[pair.source];
            const double r = (p - (datum_.points[t] - centre_)).dot(normal);
            Vec6 j;
            j << normal, p.cross(normal) / radius_;
            sums.square += j * j.transpose();
            sums.right -= r * j;
            sums.residual += r * r;
        }
        return sums;
    }

    /// The eigenvectors of the free motions that the pairs determine, with their eigenvalues.
    Eigen::SelfAdjointEigenSolver<Mat6> free_motions(const Normals& sums) const {
        Mat6 square = sums.square / double(std::max<std::size_t>(1, sums.pairs));
        for (int i = 0; i < 6; ++i) {
            if (!options_.fixed[static_cast<std::size_t>(i)]) continue;
            square.row(i).setZero();
            square.col(i).setZero();
        }
        return Eigen::SelfAdjointEigenSolver<Mat6>(square);
    }

    Vec6 solve(const Normals& sums) const {
        const auto solver = free_motions(sums);
        Vec6 right = sums.right / double(sums.pairs);
        for (int i = 0; i < 6; ++i)
            if (options_.fixed[static_cast<std::size_t>(i)]) right[i] = 0;
        Vec6 step = Vec6::Zero();
        for (int i = 0; i < 6; ++i) {
            if (solver.eigenvalues()[i] < kUndetermined) continue;
            const Vec6 axis = solver.eigenvectors().col(i);
            step += axis * (axis.dot(right) / solver.eigenvalues()[i]);
        }
        return step;
    }

    void apply(const Vec6& step) {
        const Vec3 turn = step.tail<3>() / radius_;
        const bool turns_freely = !options_.fixed[3] && !options_.fixed[4] && !options_.fixed[5];
        if (turns_freely) {
            const Frame more = Eigen::Translation3d(Vec3(step.head<3>())) * rotation(turn);
            motion_ = more * motion_;
            return;
        }
        // The sum of rotation vectors keeps a fixed component at 0; a product of rotations does
        // not.
        turned_ += turn;
        shifted_ += step.head<3>();
        motion_ = Eigen::Translation3d(shifted_) * rotation(turned_);
    }

    static Frame rotation(const Vec3& vector) {
        const double angle = vector.norm();
        Frame frame = Frame::Identity();
        if (angle > 0) frame.linear() = Eigen::AngleAxisd(angle, vector / angle).matrix();
        return frame;
    }

    void tell_freedoms(const Normals& sums, Registration& result) const {
        const auto solver = free_motions(sums);
        const double variance =
            sums.pairs > 6 ? sums.residual / double(sums.pairs - 6) / double(sums.pairs) : 0.0;
        std::array<double, 6> square{};
        for (int i = 0; i < 6; ++i) {
            const Vec6 axis = solver.eigenvectors().col(i);
            const double value = solver.eigenvalues()[i];
            bool held = true;  // a fixed freedom's own eigenvector
            for (int k = 0; k < 6; ++k)
                held = held &&
                       (options_.fixed[static_cast<std::size_t>(k)] || std::abs(axis[k]) < 1e-9);
            if (held) continue;
            std::array<double, 6> motion{};
            for (std::size_t k = 0; k < 6; ++k) {
                const double part = axis[static_cast<Eigen::Index>(k)];
                motion[k] = part;
                if (value < kUndetermined) {
                    if (std::abs(part) > 0.1) square[k] = std::numeric_limits<double>::infinity();
                } else {
                    square[k] += part * part * variance / value;
                }
            }
            if (value < kUndetermined) result.undetermined.push_back(motion);
        }
        for (std::size_t k = 0; k < 6; ++k)
            result.sd[k] = options_.fixed[k] ? 0.0 : std::sqrt(square[k]) / (k < 3 ? 1.0 : radius_);
    }

    const DatumSurface& datum_;
    const RegistrationOptions& options_;
    Vec3 centre_;
    double radius_ = 0;
    std::vector<Vec3> points_, normals_;  ///< of the scan as it starts, about the centre
    NearestPoints nearest_;
    Frame motion_ = Frame::Identity();  ///< since the start
    Vec3 turned_ = Vec3::Zero(), shifted_ = Vec3::Zero();
};

void require_finite(const std::vector<Vec3>& points, const char* what) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!points[i].allFinite())
            throw InputError("scan.not_finite", "{cloud}: point {point} is not finite",
                             {{"cloud", what}, {"point", i}});
}

}  // namespace

Registration register_scan(const ScanPoints& scan, const DatumSurface& datum,
                           const RegistrationOptions& options, const RunContext& context) {
    if (scan.points.empty()) throw InputError("scan.empty", "scan: it has no points");
    if (datum.points.empty() || datum.points.size() != datum.normals.size())
        throw InputError("scan.datum", "scan: the datum has no points, or not a normal for each");
    if (!(options.max_distance > 0) || !(options.share > 0) || options.share > 1 ||
        !(datum.spacing > 0))
        throw InputError("scan.options",
                         "scan: distance and spacing must be above 0 mm, the share in (0, 1]");
    require_finite(scan.points, "scan");
    require_finite(datum.points, "datum");
    return Aligner(scan, datum, options).run(context);
}

std::vector<double> measure_cloud(const std::vector<Vec3>& cloud, const std::vector<Vec3>& points,
                                  const std::vector<Vec3f>& rays, const std::vector<double>& start,
                                  double reach, std::size_t neighbours, const RunContext& context) {
    if (points.size() != rays.size() || points.size() != start.size())
        throw InputError("scan.lengths", "scan: points, normals and starts differ in length");
    if (neighbours < 3 || !(reach > 0))
        throw InputError("scan.reach",
                         "scan: a plane needs three neighbours and a reach above 0 mm");
    if (cloud.size() < neighbours)
        throw InputError("scan.no_surface", "scan: {points} points are no surface",
                         {{"points", cloud.size()}});
    require_finite(cloud, "scan");
    const NearestPoints nearest(cloud);
    std::vector<double> heights(points.size(), std::numeric_limits<double>::quiet_NaN());
    const auto k = double(neighbours);
    parallel_blocks(points.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> index(neighbours);
        std::vector<double> squared(neighbours);
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3& foot = points[i];
            const Vec3 ray = rays[i].cast<double>();
            double h = start[i];
            bool found = false;
            for (int round = 0; round < kMeasureRounds; ++round) {
                found = nearest(foot + h * ray, index, squared);
                if (!found) break;
                Vec3 mean = Vec3::Zero();
                for (const auto n : index) mean += cloud[n] / k;
                Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
                for (const auto n : index) {
                    const Vec3 d = cloud[n] - mean;
                    spread += d * d.transpose();
                }
                const Vec3 plane =
                    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
                const double across = plane.dot(ray);
                if (std::abs(across) < kSameSide * ray.norm()) {
                    found = false;
                    break;
                }
                const double met = plane.dot(mean - foot) / across;
                // Beside the cloud all neighbours lie on one side, and their plane is a guess.
                const Vec3 off = mean - foot - met * ray;
                const double width = std::sqrt(spread.trace() / k);
                found = std::isfinite(met) && std::abs(met - start[i]) <= reach &&
                        off.norm() <= kAside * width && width <= reach;
                if (!found || std::abs(met - h) < kMeasureSettled) {
                    h = met;
                    break;
                }
                h = met;
            }
            if (found) heights[i] = h;
        }
    });
    return heights;
}

}  // namespace beltgrinding
