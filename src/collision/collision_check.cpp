#include "collision/collision_check.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>

#include "arm_motion.h"
#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "collision/touching_links.h"
#include "collision_pair.h"
#include "path_motion.h"

namespace beltgrinding {
namespace {

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

/// What was found of a pair, on the path's places and in the work frame.
class Report {
  public:
    explicit Report(const ToolPath& path) : path_(path) {}

    void add(const CollisionPair& pair, std::size_t first, std::size_t second,
             const std::vector<CollisionBody>& bodies, CollisionResult& result) const {
        const auto& looks = pair.looks();
        const auto nearer = [](const CollisionPair::Look& a, const CollisionPair::Look& b) {
            return a.distance < b.distance;
        };
        const PairMotion& motion = pair.motion();
        const auto least = std::min_element(looks.begin(), looks.end(), nearer);
        const auto [on_first, on_second] = pair.points(*least);
        const bool of_arm = bodies[second].carrier == Carrier::kLink;
        result.pairs.push_back(
            {first, second, least->distance, motion.pose(least->place), 0.0, on_first, on_second});
        result.pair_places.push_back(
            {of_arm, least->place, least->place, least->place, result.pairs.size()});
        const std::array<const CollisionBody*, 2> both = {&bodies[first], &bodies[second]};
        for (auto at = looks.begin(); at != looks.end();) {
            if (at->distance >= pair.clearance() && at->distance > 0.0) {
                ++at;
                continue;
            }
            const auto end = std::find_if(at, looks.end(), [&](const CollisionPair::Look& look) {
                return look.distance >= pair.clearance() && look.distance > 0.0;
            });
            CollisionPlaces places;
            places.of_arm = of_arm;
            places.number = result.events.size();
            result.events.push_back(event(pair, at, end, both, places));
            result.event_places.push_back(places);
            at = end;
        }
    }

  private:
    using Looks = CollisionPair::Looks::const_iterator;

    /// Of a stretch nearer than the clearance: from the first touch to the last, or the whole;
    /// without its times.
    Event event(const CollisionPair& pair, Looks begin, Looks end,
                const std::array<const CollisionBody*, 2>& bodies, CollisionPlaces& places) const {
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
        const PairMotion& motion = pair.motion();
        const EventKind kind = event_kind(collides ? "collision" : "near_miss");
        Event event;
        event.kind = kind.code;
        event.severity = kind.severity;
        event.unit = kind.unit;
        event.pose = motion.pose(worst->place);
        places.begin = begin->place;
        places.last = last->place;
        places.worst = worst->place;
        event.value = worst->distance;
        event.limit = collides ? 0.0 : pair.clearance();
        const auto [on_first, on_second] = pair.points(*worst);
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
};

}  // namespace

CollisionResult check_collisions(const ToolPath& path, const std::vector<CollisionBody>& bodies,
                                 const CollisionOptions& options, const RunContext& context,
                                 const ArmInCell* arm) {
    if (!std::isfinite(options.clearance) || options.clearance < 0.0 ||
        !std::isfinite(options.resolution) || !(options.resolution > 0.0)) {
        throw InputError(
            "collision.options",
            "collisions: the clearance must be zero or positive, the resolution positive");
    }
    const std::vector<CollisionMesh> meshes = prepared(bodies, arm != nullptr, context);
    CollisionResult result;
    if (path.poses().size() < 2) return result;
    const PathTravel path_travel(path);
    std::optional<ArmTravel> arm_travel;
    if (arm != nullptr && !arm->way.empty()) arm_travel.emplace(path, *arm);
    std::vector<std::pair<std::size_t, std::size_t>> numbers;
    std::vector<std::unique_ptr<CollisionPair>> pairs;
    const LookedAt looked_at =
        pairs_looked_at(arm_travel ? arm : nullptr, path.frames(), bodies, meshes);
    result.touching = looked_at.touching;
    for (const auto& [a, b] : looked_at.pairs) {
        const CollisionBody &first = bodies[a], &second = bodies[b];
        std::unique_ptr<const PairMotion> motion;
        if (second.carrier != Carrier::kLink) {
            const Frame holder = holder_from(second.carrier, path.frames());
            motion = std::make_unique<PathMotion>(path_travel, first.carrier, second.carrier,
                                                  meshes[b].reach(holder.inverse().translation()));
        } else if (arm_travel) {
            motion = std::make_unique<ArmMotion>(
                *arm_travel, first, second.link,
                joint_levers(*arm, path.frames(), first, meshes[a], second, meshes[b]));
        } else {
            continue;  // nowhere in reach
        }
        const CollisionOptions own{
            clearance_of(first, second, path.frames().holding, options.clearance),
            options.resolution};
        pairs.push_back(std::make_unique<CollisionPair>(std::move(motion), meshes[a], meshes[b],
                                                        first.margin + second.margin, own));
        numbers.emplace_back(a, b);
    }
    struct Task {
        std::size_t pair, number;
        PairMotion::Stretch stretch;
    };
    std::vector<Task> tasks;
    std::vector<std::vector<CollisionPair::Looks>> looks(pairs.size());
    double whole = 0.0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto stretches = pairs[k]->motion().stretches();
        looks[k].resize(stretches.size());
        for (std::size_t i = 0; i < stretches.size(); ++i) {
            tasks.push_back({k, i, stretches[i]});
            whole += stretches[i].end - stretches[i].begin;
        }
    }
    std::atomic<double> settled{0.0};
    parallel_blocks(tasks.size(), 1, context, [&](std::size_t at, std::size_t) {
        const Task& task = tasks[at];
        looks[task.pair][task.number] =
            pairs[task.pair]->follow(task.stretch, context, [&](double length) {
                settled.fetch_add(length, std::memory_order_relaxed);
                context.report(std::min(1.0, settled.load(std::memory_order_relaxed) / whole));
            });
    });
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        context.throw_if_cancelled();
        pairs[k]->finish(looks[k]);
    }
    const Report report(path);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        report.add(*pairs[k], numbers[k].first, numbers[k].second, bodies, result);
    }
    tell_times(result, path, arm);
    context.report(1.0);
    return result;
}

void tell_times(CollisionResult& result, const ToolPath& path, const ArmInCell* arm) {
    if (path.poses().size() < 2) return;
    const PathTravel travel(path);
    const auto time = [&](bool of_arm, double place) {
        return of_arm ? arm_time(*arm, place) : travel.time(place);
    };
    for (std::size_t i = 0; i < result.pairs.size(); ++i) {
        const CollisionPlaces& places = result.pair_places[i];
        result.pairs[i].time = time(places.of_arm, places.worst);
    }
    std::vector<std::size_t> order(result.events.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        Event& event = result.events[i];
        const CollisionPlaces& places = result.event_places[i];
        order[places.number] = i;
        event.time = time(places.of_arm, places.begin);
        event.duration = time(places.of_arm, places.last) - event.time;
        event.worst_time = time(places.of_arm, places.worst);
        event.line = path.poses()[event.pose].line;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return result.events[a].time < result.events[b].time;
    });
    std::vector<Event> events;
    std::vector<CollisionPlaces> places;
    for (const std::size_t i : order) {
        events.push_back(std::move(result.events[i]));
        places.push_back(result.event_places[i]);
    }
    result.events = std::move(events);
    result.event_places = std::move(places);
}

}  // namespace beltgrinding
