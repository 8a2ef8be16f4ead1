#include "clusters.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

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
    std::vector<std::uint32_t> root(field.size(), Verdict::kNone);
    for (const std::uint32_t i : out) root[i] = sets.find(i);
    std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
        return root[a] != root[b] ? root[a] < root[b] : a < b;
    });
    Members members;
    for (std::size_t k = 0; k < out.size(); ++k) {
        if (k == 0 || root[out[k]] != root[out[k - 1]]) members.begin.push_back(k);
    }
    members.begin.push_back(out.size());
    members.sample = std::move(out);
    return members;
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
    struct Part {
        std::uint32_t motion;
        double area, depth;
    };
    std::vector<Part> parts;
    for (const std::uint32_t i : samples) {
        if (trace.first[i] == RemovalTrace::kNever) continue;
        const std::uint32_t dominant = trace.dominant[i];
        parts.push_back({dominant, field.area[i], trace.dominant_depth[i]});
        if (!cluster.above) continue;
        const std::uint32_t first = trace.first[i], last = trace.last[i];
        if (first != dominant) parts.push_back({first, field.area[i], 0.0});
        if (last != dominant && last != first) parts.push_back({last, field.area[i], 0.0});
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.motion < b.motion; });
    std::vector<MotionShare> shares;
    for (const Part& part : parts) {
        if (shares.empty() || shares.back().motion != part.motion) {
            shares.push_back({part.motion, 0.0, 0.0});
        }
        shares.back().share += part.area / cluster.area;
        shares.back().depth = std::max(shares.back().depth, part.depth);
    }
    std::stable_sort(shares.begin(), shares.end(),
                     [](const MotionShare& a, const MotionShare& b) { return a.share > b.share; });
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
            cluster.faces.push_back(field.face[i]);
            cluster.zones.push_back(verdict.zone[i]);
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
