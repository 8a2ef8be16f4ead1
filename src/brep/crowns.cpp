#include "crowns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace beltgrinding {
namespace {

constexpr double kAcross = 0.5;      // cosine to the way in which normals turn
constexpr double kWellWithin = 0.5;  // of the turn that is too much

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// How normals turn along edges.
class Turning {
  public:
    explicit Turning(const FaceSamples& samples) : samples_(samples) {}

    Vec3 along(const Edge& edge) const {
        return samples_.point[edge.second] - samples_.point[edge.first];
    }
    Vec3 change(const Edge& edge) const {
        return (samples_.normal[edge.second] - samples_.normal[edge.first]).cast<double>();
    }
    /// rad; 0 where it is hollow or degenerate.
    double turn(const Edge& edge) const {
        const auto& [a, b] = edge;
        if (((samples_.flags[a] | samples_.flags[b]) & kDegenerate) != 0) return 0.0;
        if (!(along(edge).dot(change(edge)) > 0.0)) return 0.0;
        return 2.0 * std::asin(std::min(1.0, 0.5 * change(edge).norm()));
    }

  private:
    const FaceSamples& samples_;
};

/// The edges within the face that turn by more than `most_turn` rad, though neither of their
/// samples has a near one across the crown: where rows do not match, long edges lead askew over
/// crowns that their rows show.
std::vector<Edge> hidden(const FaceSamples& samples, const Turning& turning, double most_turn) {
    std::map<Edge, int> turned;  // with their triangles: of an edge on the border one
    std::vector<char> asked(samples.point.size(), 0);
    for (const Triangle& triangle : samples.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge edge = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            if (turning.turn(edge) > most_turn) {
                ++turned[edge];
                asked[edge.first] = asked[edge.second] = 1;
            }
        }
    }
    if (turned.empty()) return {};
    std::vector<Edge> beside;  // from samples that are asked to their neighbours
    for (const Triangle& triangle : samples.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
                if (asked[triangle[k]] != 0) beside.emplace_back(triangle[k], triangle[other]);
    std::sort(beside.begin(), beside.end());
    const auto sees = [&](std::uint32_t sample, const Vec3& way) {
        auto it = std::lower_bound(beside.begin(), beside.end(), Edge(sample, 0));
        for (; it != beside.end() && it->first == sample; ++it) {
            const Vec3 along = turning.along(*it);
            if (along.dot(way) > kAcross * along.norm() &&
                turning.change(*it).norm() < kWellWithin * most_turn)
                return true;
        }
        return false;
    };
    std::vector<Edge> found;
    for (const auto& [edge, triangles] : turned) {
        const Vec3 way = turning.change(edge).normalized();
        if (triangles > 1 && !sees(edge.first, way) && !sees(edge.second, -way))
            found.push_back(edge);
    }
    return found;
}

}  // namespace

Crowns hidden_crowns(const FaceSamples& samples, double spacing, double most_turn) {
    const Turning turning(samples);
    const std::vector<Edge> edges = hidden(samples, turning, most_turn);
    double least = std::numeric_limits<double>::infinity();  // radius, mm
    for (const Edge& edge : edges)
        least = std::min(least, turning.along(edge).norm() / turning.change(edge).norm());
    const double wanted = SampleDensity::kTurn * least;
    return {edges.size(),
            std::min(std::max(wanted, SampleDensity::kFinestShare * spacing), spacing)};
}

}  // namespace beltgrinding
