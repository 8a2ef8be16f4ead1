#include "clusters.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include "inspection/zones.h"
#include "mesh/topology.h"

namespace beltgrinding {
namespace {

/// (first sample, number) of a cluster per out-of-tolerance sample, through `members`: samples
/// sorted by cluster.
struct Members {
    std::vector<std::uint32_t> sample;  // by cluster, then ascending
    std::vector<std::size_t> begin;     // of each cluster, and the end
};

Members connected(const HeightField& field, const std::vector<double>& beyond) {
    const auto side = [&](std::uint32_t i) { return (beyond[i] > 0.0) - (beyond[i] < 0.0); };
    DisjointSets sets(field.size());
    const auto join = [&](std::uint32_t i, std::uint32_t j) {
        if (side(i) != 0 && side(i) == side(j)) sets.join(i, j);
    };
    for (const Triangle& t : field.triangles) {
        join(t[0], t[1]);
        join(t[1], t[2]);
        join(t[2], t[0]);
    }
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < field.size(); ++i) {
        if (side(i) != 0) out.push_back(i);
    }
    for (const BorderPair& pair : border_pairs(field, out)) join(pair.a, pair.b);
    // By root, then ascending: roots are numbers of samples, so a count of each sorts them.
    std::vector<std::uint32_t> root(out.size());
    std::vector<std::uint32_t> next(field.size(), 0);
    for (std::size_t k = 0; k < out.size(); ++k) ++next[root[k] = sets.find(out[k])];
    Members members;
    std::uint32_t so_far = 0;
    for (std::uint32_t& place : next) {
        if (place > 0) members.begin.push_back(so_far);
        so_far += std::exchange(place, so_far);
    }
    members.begin.push_back(out.size());
    members.sample.resize(out.size());
    for (std::size_t k = 0; k < out.size(); ++k) members.sample[next[root[k]]++] = out[k];
    return members;
}

/// Appends what is not the last one.
void append_other(std::vector<std::uint32_t>& values, std::uint32_t value) {
    if (values.empty() || values.back() != value) values.push_back(value);
}

std::vector<std::uint32_t> sorted_unique(std::vector<std::uint32_t> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

/// Lengths along the two longest principal axes.
void measure(const HeightField& field, std::span<const std::uint32_t> samples, Cluster& cluster) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const std::uint32_t i : samples) {
        const Vec3 arm = field.point[i] - cluster.centroid;
        spread += field.area[i] * arm * arm.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const std::uint32_t i : samples) {
        const Vec3 along = axes.eigenvectors().transpose() * (field.point[i] - cluster.centroid);
        low = low.cwiseMin(along);
        high = high.cwiseMax(along);
    }
    Vec3 length = high - low;
    std::sort(length.begin(), length.end());
    cluster.extent = length[2];
    cluster.width = length[1];
}

std::vector<MotionShare> motions_of(const HeightField& field,
                                    std::span<const std::uint32_t> samples,
                                    const Cluster& cluster) {
    const RemovalTrace& trace = field.trace;
    if (trace.empty()) return {};
    std::vector<MotionShare> shares;
    std::unordered_map<std::uint32_t, std::size_t> places;  // in shares, by motion
    std::uint32_t recent = 0;
    std::size_t place = 0;
    const auto add = [&](std::uint32_t motion, double area, double depth) {
        if (motion != recent || shares.empty()) {  // neighbours mostly have the same
            const auto found = places.try_emplace(motion, shares.size());
            if (found.second) shares.push_back({motion, 0.0, 0.0});
            recent = motion;
            place = found.first->second;
        }
        shares[place].share += area;  // a share of the cluster's below
        shares[place].depth = std::max(shares[place].depth, depth);
    };
    for (const std::uint32_t i : samples) {
        if (trace.first[i] == RemovalTrace::kNever) continue;
        const std::uint32_t dominant = trace.dominant[i];
        add(dominant, field.area[i], trace.dominant_depth[i]);
        if (!cluster.above) continue;
        const std::uint32_t first = trace.first[i], last = trace.last[i];
        if (first != dominant) add(first, field.area[i], 0.0);
        if (last != dominant && last != first) add(last, field.area[i], 0.0);
    }
    for (MotionShare& one : shares) one.share /= cluster.area;
    std::sort(shares.begin(), shares.end(), [](const MotionShare& a, const MotionShare& b) {
        return a.share != b.share ? a.share > b.share : a.motion < b.motion;
    });
    return shares;
}

}  // namespace

void find_clusters(const HeightField& field, const std::vector<double>& beyond,
                   const std::function<WorstPoint(std::uint32_t)>& judged, Verdict& verdict) {
    const Members members = connected(field, beyond);
    const std::size_t count = members.begin.size() - 1;
    const auto samples_of = [&](std::size_t k) {
        return std::span(members.sample)
            .subspan(members.begin[k], members.begin[k + 1] - members.begin[k]);
    };
    std::vector<double> area(count, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
        for (const std::uint32_t i : samples_of(k)) area[k] += field.area[i];
    }
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return area[a] > area[b]; });

    verdict.cluster.assign(field.size(), Verdict::kNone);
    verdict.clusters.clear();
    verdict.clusters.reserve(count);
    for (const std::size_t k : order) {
        const auto samples = samples_of(k);
        Cluster cluster;
        std::uint32_t worst = samples.front();
        cluster.above = beyond[worst] > 0.0;
        cluster.samples = samples.size();
        cluster.area = area[k];
        for (const std::uint32_t i : samples) {
            if (std::abs(beyond[i]) > std::abs(beyond[worst])) worst = i;
            cluster.volume += field.area[i] * std::abs(beyond[i]);
            cluster.centroid += field.area[i] * field.point[i];
            cluster.box.extend(field.point[i]);
            append_other(cluster.faces, field.face[i]);
            append_other(cluster.zones, verdict.zone[i]);
            if (!field.trace.empty() && !field.trace.touched(i)) {
                cluster.untouched_area += field.area[i];
            }
            verdict.cluster[i] = static_cast<std::uint32_t>(verdict.clusters.size());
        }
        cluster.worst = judged(worst);
        // Samples at a pole stand for no area.
        cluster.centroid =
            cluster.area > 0.0 ? Vec3(cluster.centroid / cluster.area) : Vec3(field.point[worst]);
        cluster.faces = sorted_unique(std::move(cluster.faces));
        cluster.zones = sorted_unique(std::move(cluster.zones));
        measure(field, samples, cluster);
        if (cluster.area > 0.0) cluster.motions = motions_of(field, samples, cluster);
        verdict.clusters.push_back(std::move(cluster));
    }
}

}  // namespace beltgrinding
