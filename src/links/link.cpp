#include "links/link.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "beltgrinding/error.h"
#include "rrt_connect.h"

namespace beltgrinding {
namespace {

constexpr int kHalvings = 3;    // of the clearance
constexpr double kSame = 1e-9;  // rad

class Ways {
  public:
    Ways(const ArmScene& scene, double clearance, double resolution)
        : scene_(scene), clearance_(clearance), resolution_(resolution) {}
    bool free(const Coordinates& q) const { return !scene_.within(q, clearance_); }
    bool free(const Coordinates& a, const Coordinates& b) const {
        return !scene_.on_way(a, b, clearance_, resolution_);
    }

  private:
    const ArmScene& scene_;
    double clearance_, resolution_;
};

/// Between two random places of the way the straight way, where it is free.
void shorten(std::vector<Coordinates>& way, const Ways& ways, const LinkOptions& options,
             const RunContext& context) {
    std::mt19937 random(options.seed);
    // Not by a distribution, whose numbers differ from library to library.
    const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (std::size_t k = 0; k < options.shortcuts && way.size() > 2; ++k) {
        context.throw_if_cancelled();
        const double parts = static_cast<double>(way.size() - 1);
        double a = share() * parts, b = share() * parts;
        if (a > b) std::swap(a, b);
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        if (i == j) continue;
        const Coordinates from = way[i] + (a - std::floor(a)) * (way[i + 1] - way[i]);
        const Coordinates to = way[j] + (b - std::floor(b)) * (way[j + 1] - way[j]);
        if (!ways.free(from, to)) continue;
        std::vector<Coordinates> next(way.begin(),
                                      way.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        for (const Coordinates& q : {from, to})
            if ((q - next.back()).cwiseAbs().maxCoeff() > kSame) next.push_back(q);
        for (std::size_t n = j + 1; n < way.size(); ++n)
            if ((way[n] - next.back()).cwiseAbs().maxCoeff() > kSame) next.push_back(way[n]);
        way = std::move(next);
    }
    // Corners that are not needed.
    for (std::size_t n = 1; n + 1 < way.size();) {
        if (ways.free(way[n - 1], way[n + 1])) {
            way.erase(way.begin() + static_cast<std::ptrdiff_t>(n));
        } else {
            ++n;
        }
    }
}

}  // namespace

std::optional<Link> find_link(const ArmScene& scene, const Coordinates& from, const Coordinates& to,
                              const LinkOptions& options, const RunContext& context) {
    if (!(options.clearance > 0.0) || !(options.resolution > 0.0)) {
        throw InputError("links.options",
                         "links: clearance and resolution must be positive, in mm");
    }
    double clearance = options.clearance;
    for (int k = 0; k <= kHalvings; ++k, clearance *= 0.5) {
        const Ways ways(scene, clearance, std::min(options.resolution, 0.5 * clearance));
        if (!ways.free(from) || !ways.free(to)) continue;
        Link link{{from, to}, clearance, true};
        if (ways.free(from, to)) return link;
        link.straight = false;
        link.joints = rrt_connect(
            scene.lower(), scene.upper(), from, to,
            [&](const Coordinates& q) { return ways.free(q); },
            [&](const Coordinates& a, const Coordinates& b) { return ways.free(a, b); },
            options.seed, options.iterations, context);
        if (link.joints.empty()) continue;
        shorten(link.joints, ways, options, context);
        return link;
    }
    return std::nullopt;
}

}  // namespace beltgrinding
