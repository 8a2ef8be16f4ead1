#include "collision/collision_check.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "collision_pair.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 64;  // motions that are followed by themselves

bool carried(Carrier carrier, Holding holding) {
    const bool with_tool = holding == Holding::kToolInHand;
    return carrier == Carrier::kTool || carrier == (with_tool ? Carrier::kWheel : Carrier::kPart);
}

Fact meeting(bool collides, bool rapid, Arguments arguments, double distance) {
    if (collides && rapid)
        return {"event.collision_rapid", "{body} and {other} run into each other in a rapid motion",
                arguments};
    if (collides) return {"event.collision", "{body} and {other} run into each other", arguments};
    arguments.emplace_back("distance", distance);
    if (rapid)
        return {"event.near_miss_rapid",
                "{body} and {other} come within {distance:.2f} mm of each other in a rapid motion",
                arguments};
    return {"event.near_miss", "{body} and {other} come within {distance:.2f} mm of each other",
            arguments};
}

/// What was found of a pair, on the path's time and in the work frame.
class Report {
  public:
    Report(const ToolPath& path, const CollisionOptions& options) : path_(path), options_(options) {
        double time = 0.0;
        for (std::size_t i = 0; i < path.poses().size(); ++i) {
            begins_.push_back(time);
            time += path.duration(i);
        }
    }

    void add(const CollisionPair& pair, std::size_t first, std::size_t second,
             const std::vector<CollisionBody>& bodies, CollisionResult& result) const {
        const auto& looks = pair.looks();
        const auto nearer = [](const CollisionPair::Look& a, const CollisionPair::Look& b) {
            return a.distance < b.distance;
        };
        const auto least = std::min_element(looks.begin(), looks.end(), nearer);
        const auto [on_first, on_second] = points(pair, *least);
        result.pairs.push_back(
            {first, second, least->distance, pose(*least), time(*least), on_first, on_second});
        const std::array<const CollisionBody*, 2> both = {&bodies[first], &bodies[second]};
        for (auto at = looks.begin(); at != looks.end();) {
            if (at->distance >= options_.clearance && at->distance > 0.0) {
                ++at;
                continue;
            }
            const auto end = std::find_if(at, looks.end(), [&](const CollisionPair::Look& look) {
                return look.distance >= options_.clearance && look.distance > 0.0;
            });
            result.events.push_back(event(pair, at, end, both));
            at = end;
        }
    }

  private:
    using Looks = CollisionPair::Looks::const_iterator;

    double time(const CollisionPair::Look& look) const {
        const Moment at = moment_at(look.place, begins_.size() - 1);
        return begins_[at.motion] + path_.elapsed(at.motion, at.share);
    }
    std::uint32_t pose(const CollisionPair::Look& look) const {
        return static_cast<std::uint32_t>(moment_at(look.place, begins_.size() - 1).motion);
    }
    std::pair<Vec3, Vec3> points(const CollisionPair& pair, const CollisionPair::Look& look) const {
        const CellFrames& cell = path_.frames();
        const Frame base_from_work =
            cell.holding == Holding::kToolInHand
                ? cell.base_from_work
                : Frame(pair.base_from_tcp(look.place) * cell.tcp_from_work);
        const Frame work_from_base = base_from_work.inverse();
        return {work_from_base * pair.base_from_first() * look.nearest.here,
                work_from_base * pair.base_from_second(look.place) * look.nearest.there};
    }

    /// Of a stretch nearer than the clearance: from the first touch to the last, or the whole.
    Event event(const CollisionPair& pair, Looks begin, Looks end,
                const std::array<const CollisionBody*, 2>& bodies) const {
        const auto touches = [](const CollisionPair::Look& look) { return look.distance <= 0.0; };
        const auto first = std::find_if(begin, end, touches);
        const bool collides = first != end;
        auto worst = first, last = end - 1;
        if (collides) {
            begin = first;
            while (!touches(*last)) --last;
        } else {
            worst = std::min_element(
                begin, end, [](const CollisionPair::Look& a, const CollisionPair::Look& b) {
                    return a.distance < b.distance;
                });
        }
        const EventKind kind = event_kind(collides ? "collision" : "near_miss");
        Event event;
        event.kind = kind.code;
        event.severity = kind.severity;
        event.unit = kind.unit;
        event.pose = pose(*worst);
        event.line = path_.poses()[event.pose].line;
        event.time = time(*begin);
        event.duration = time(*last) - event.time;
        event.worst_time = time(*worst);
        event.value = worst->distance;
        event.limit = collides ? 0.0 : options_.clearance;
        const auto [on_first, on_second] = points(pair, *worst);
        event.point = bodies[0]->carrier == Carrier::kPart   ? on_first
                      : bodies[1]->carrier == Carrier::kPart ? on_second
                                                             : Vec3(0.5 * (on_first + on_second));
        event.bodies = {bodies[0]->name, bodies[1]->name};
        const bool rapid = path_.poses()[event.pose].rapid;
        event.facts = {meeting(
            collides, rapid, {{"body", bodies[0]->name}, {"other", bodies[1]->name}}, event.value)};
        return event;
    }

    const ToolPath& path_;
    const CollisionOptions& options_;
    std::vector<double> begins_;  // s, of the motion to each pose
};

}  // namespace

CollisionResult check_collisions(const ToolPath& path, const std::vector<CollisionBody>& bodies,
                                 const CollisionOptions& options, const RunContext& context) {
    if (!std::isfinite(options.clearance) || options.clearance < 0.0 ||
        !std::isfinite(options.resolution) || !(options.resolution > 0.0)) {
        throw InputError(
            "collision.options",
            "collisions: the clearance must be zero or positive, the resolution positive");
    }
    CollisionResult result;
    if (path.poses().size() < 2) return result;
    std::vector<CollisionMesh> meshes;
    for (const CollisionBody& body : bodies) {
        try {
            meshes.emplace_back(body.mesh, context);
        } catch (const InputError& error) {
            throw error.within({"collision.body", "{body}: ", {{"body", body.name}}});
        }
    }
    struct Numbers {
        std::size_t first, second;
    };
    std::vector<Numbers> numbers;
    const Holding holding = path.frames().holding;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (!carried(bodies[a].carrier, holding) && carried(bodies[b].carrier, holding)) {
                numbers.push_back({a, b});
            }
        }
    }
    const MotionBound bound(path);
    std::vector<std::unique_ptr<CollisionPair>> pairs;
    pairs.reserve(numbers.size());
    for (const auto& [a, b] : numbers) {
        pairs.push_back(std::make_unique<CollisionPair>(path, bound, bodies[a], meshes[a],
                                                        bodies[b], meshes[b], options));
    }
    const std::size_t blocks = (bound.motions() + kBlock - 1) / kBlock;
    std::vector<std::vector<CollisionPair::Looks>> looks(pairs.size(),
                                                         std::vector<CollisionPair::Looks>(blocks));
    std::atomic<double> settled{0.0};
    const double whole = static_cast<double>(bound.motions() * pairs.size());
    parallel_blocks(pairs.size() * blocks, 1, context, [&](std::size_t at, std::size_t) {
        const std::size_t k = at / blocks, block = at % blocks;
        const std::size_t begin = block * kBlock;
        const std::size_t end = std::min(begin + kBlock, bound.motions());
        looks[k][block] = pairs[k]->follow(
            static_cast<double>(begin), static_cast<double>(end), context, [&](double length) {
                settled.fetch_add(length, std::memory_order_relaxed);
                context.report(std::min(1.0, settled.load(std::memory_order_relaxed) / whole));
            });
    });
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        context.throw_if_cancelled();
        pairs[k]->finish(looks[k]);
    }
    const Report report(path, options);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        report.add(*pairs[k], numbers[k].first, numbers[k].second, bodies, result);
    }
    std::stable_sort(result.events.begin(), result.events.end(),
                     [](const Event& a, const Event& b) { return a.time < b.time; });
    context.report(1.0);
    return result;
}

}  // namespace beltgrinding
