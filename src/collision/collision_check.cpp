#include "collision/collision_check.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "collision/collision_mesh.h"

namespace beltgrinding {
namespace {

// In a rounded corner the turn goes by two nested slerps, whose speed may exceed that of both
// motions; by less than this factor for turns below half a turn.
constexpr double kCornerTurn = 1.5;
// Relative: how sure the least distance is beyond the clearance, and how exact each look is there.
// A search that may stop so far from the truth is many times faster.
constexpr double kLeastAccuracy = 0.75;
constexpr double kLookError = 0.2;
constexpr int kPolish = 24;         // looks around the nearest place, each cuts its stretch to 0.62
constexpr double kStride = 2.0;     // mm between two looks at bodies that touch or nearly do
constexpr int kFirstLooks = 8;      // evenly over a block, for a good guess of its least
constexpr std::size_t kBlock = 64;  // motions that are followed by themselves

/// How far a body carried by the robot can have moved between two places of the path, that is
/// numbers i + u: the share u of the way of the motion to pose i + 1.
class MotionBound {
  public:
    explicit MotionBound(const ToolPath& path) {
        const auto& poses = path.poses();
        const std::size_t count = poses.size();
        std::vector<double> travel(count, 0.0), turn(count, 0.0);
        for (std::size_t i = 1; i < count; ++i) {
            const Frame &a = poses[i - 1].base_from_tcp, &b = poses[i].base_from_tcp;
            travel[i] = (b.translation() - a.translation()).norm();
            turn[i] = angle_between(a, b);
        }
        const std::vector<double> straight = turn;
        if (path.time_law().timing == TimeLaw::Timing::kTrapezoidal) {
            // Corners mix the turns of both motions, each over its own length.
            std::size_t before = 0;
            for (std::size_t i = 1; i < count; ++i) {
                if (travel[i] <= 0.0 && straight[i] <= 0.0) continue;
                if (before > 0 && travel[i] > 0.0 && travel[before] > 0.0) {
                    turn[i] = std::max(turn[i], straight[before] * travel[i] / travel[before]);
                    turn[before] = std::max(turn[before], straight[i] * travel[before] / travel[i]);
                }
                before = i;
            }
            for (double& angle : turn) angle *= kCornerTurn;
        }
        travel_.assign(1, 0.0);
        turn_.assign(1, 0.0);
        for (std::size_t i = 1; i < count; ++i) {
            travel_.push_back(travel_.back() + travel[i]);
            turn_.push_back(turn_.back() + turn[i]);
        }
    }
    std::size_t motions() const { return travel_.size() - 1; }
    /// mm; `reach`: of the body from the tool frame's origin.
    double way(double begin, double end, double reach) const {
        return at(travel_, end) - at(travel_, begin) + reach * (at(turn_, end) - at(turn_, begin));
    }
    /// The place where half of the way is done.
    double middle(double begin, double end, double reach) const {
        const double half = 0.5 * way(begin, end, reach);
        double low = begin, high = end;
        // To the motion, then linearly within it.
        while (std::floor(low) + 1.0 < high) {
            const double next = std::floor(0.5 * (low + high));
            const double at = next > low ? next : std::floor(low) + 1.0;
            (way(begin, at, reach) < half ? low : high) = at;
        }
        const double whole = way(low, high, reach), done = way(begin, low, reach);
        const double share = whole > 0.0 ? (half - done) / whole : 0.5;
        return low + std::clamp(share, 0.0, 1.0) * (high - low);
    }

  private:
    static double at(const std::vector<double>& sums, double place) {
        const std::size_t i = std::min(static_cast<std::size_t>(place), sums.size() - 2);
        return sums[i] + (place - static_cast<double>(i)) * (sums[i + 1] - sums[i]);
    }
    std::vector<double> travel_, turn_;  // sums up to each pose
};

/// Where a place lies on the path.
struct Moment {
    std::size_t motion;  // to that pose
    double share;
};

Moment moment_at(double place, std::size_t motions) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), motions - 1);
    return {i + 1, place - static_cast<double>(i)};
}

bool carried(Carrier carrier, Holding holding) {
    const bool with_tool = holding == Holding::kToolInHand;
    return carrier == Carrier::kTool || carrier == (with_tool ? Carrier::kWheel : Carrier::kPart);
}

/// The body's frame in the tool's if the robot carries it, else in the base.
Frame holder_from(Carrier carrier, const CellFrames& cell) {
    const bool with_tool = cell.holding == Holding::kToolInHand;
    switch (carrier) {
        case Carrier::kWheel:
            return with_tool ? cell.tcp_from_contact : cell.base_from_contact;
        case Carrier::kPart:
            return with_tool ? cell.base_from_work : cell.tcp_from_work;
        default:
            return Frame::Identity();
    }
}

/// Follows one pair.
class Pair {
  public:
    struct Look {
        double place;
        NearestPoints nearest;
        double distance;  // margins counted
        double low;       // the true one is no smaller
    };

    Pair(const ToolPath& path, const MotionBound& bound, const CollisionBody& first,
         const CollisionMesh& standing, const CollisionBody& second, const CollisionMesh& moving,
         const CollisionOptions& options)
        : path_(path),
          bound_(bound),
          standing_(standing),
          moving_(moving),
          options_(options),
          margin_(first.margin + second.margin),
          first_from_base_(holder_from(first.carrier, path.frames()).inverse()),
          tcp_from_second_(holder_from(second.carrier, path.frames())),
          reach_(moving.reach(tcp_from_second_.inverse().translation())) {}

    /// Looks at the stretch between two places, so closely that nothing is missed, in order;
    /// without the one at its begin. `done(length)` is called with the stretches that are settled.
    template <class Done>
    std::vector<Look> follow(double begin, double end, const RunContext& context, Done done) const {
        std::vector<Look> looks;
        double least = std::numeric_limits<double>::infinity();
        NearestPoints known;
        for (int k = 0; k < kFirstLooks; ++k) {
            context.throw_if_cancelled();
            const Look at = look(begin + (end - begin) * k / kFirstLooks, known);
            least = std::min(least, at.distance);
            known = at.nearest;
        }
        struct Stretch {
            Look begin, end;
        };
        std::vector<Stretch> open{{look(begin, known), look(end, known)}};
        while (!open.empty()) {
            context.throw_if_cancelled();
            const Stretch s = open.back();
            open.pop_back();
            least = std::min({least, s.begin.distance, s.end.distance});
            const double way = bound_.way(s.begin.place, s.end.place, reach_);
            const double place = bound_.middle(s.begin.place, s.end.place, reach_);
            const bool divisible = s.begin.place < place && place < s.end.place;
            if (settled(s.begin, s.end, way, least) || !divisible) {
                looks.push_back(s.end);
                done(s.end.place - s.begin.place);
                continue;
            }
            const Look middle = look(place, nearer(s.begin, s.end, place));
            open.push_back({middle, s.end});
            open.push_back({s.begin, middle});
        }
        return looks;
    }

    /// Takes the looks of the whole path, in order.
    void finish(const std::vector<std::vector<Look>>& blocks) {
        looks_ = {look(0.0, {})};
        for (const auto& block : blocks) looks_.insert(looks_.end(), block.begin(), block.end());
        mark_inside();
        polish();
    }

    const std::vector<Look>& looks() const { return looks_; }
    Frame base_from_first() const { return first_from_base_.inverse(); }
    Frame base_from_second(double place) const { return base_from_tcp(place) * tcp_from_second_; }
    Frame base_from_tcp(double place) const {
        const Moment at = moment_at(place, bound_.motions());
        return path_.base_from_tcp(at.motion, at.share);
    }

  private:
    bool settled(const Look& begin, const Look& end, double way, double least) const {
        const double bound = 0.5 * (begin.low + end.low - way);  // of the distance in between
        if (way <= options_.resolution) return true;
        if (begin.distance <= 0.0 && end.distance <= 0.0) return way <= kStride;
        const bool clear = bound >= options_.clearance;
        if (clear && bound >= (1.0 - kLeastAccuracy) * least) return true;
        if (clear || bound < least - options_.resolution) return false;
        return bound > 0.0 && std::max(begin.distance, end.distance) < options_.clearance &&
               way <= kStride;
    }

    Frame first_from_second(double place) const {
        return first_from_base_ * base_from_second(place);
    }

    /// Exact below the clearance.
    Look look(double place, const NearestPoints& known, bool exact = false) const {
        const Frame frame = first_from_second(place);
        Look at{place, standing_.nearest(moving_, frame, known, exact ? 0.0 : kLookError), 0.0,
                0.0};
        at.low = at.nearest.distance / (exact ? 1.0 : 1.0 + kLookError) - margin_;
        if (!exact && at.low < options_.clearance && at.nearest.distance > 0.0) {
            return look(place, at.nearest, true);
        }
        at.distance = std::max(0.0, at.nearest.distance - margin_);
        at.low = std::max(0.0, at.low);
        return at;
    }

    /// Of two looks, the one whose points are the nearer at `place`.
    const NearestPoints& nearer(const Look& a, const Look& b, double place) const {
        const Frame frame = first_from_second(place);
        const auto apart = [&](const Look& at) {
            return (at.nearest.here - frame * at.nearest.there).squaredNorm();
        };
        return apart(a) <= apart(b) ? a.nearest : b.nearest;
    }

    /// Beyond the clearance, finds the place around the nearest look where it is nearest, by golden
    /// section.
    void polish() {
        const auto least =
            std::min_element(looks_.begin(), looks_.end(),
                             [](const Look& a, const Look& b) { return a.distance < b.distance; });
        if (least->distance < options_.clearance) return;
        double low = least == looks_.begin() ? least->place : (least - 1)->place;
        double high = least + 1 == looks_.end() ? least->place : (least + 1)->place;
        Look best = look(least->place, least->nearest, true);
        constexpr double kGolden = 0.6180339887498949;
        const auto inner = [&](double share) {
            const Look at = look(low + share * (high - low), best.nearest, true);
            if (at.distance < best.distance) best = at;
            return at;
        };
        Look left = inner(1.0 - kGolden), right = inner(kGolden);
        for (int k = 0; k < kPolish && high - low > 0.0; ++k) {
            if (left.distance <= right.distance) {
                high = right.place;
                right = left;
                left = inner(1.0 - kGolden);
            } else {
                low = left.place;
                left = right;
                right = inner(kGolden);
            }
        }
        // Among the looks in their order.
        looks_.insert(
            std::upper_bound(looks_.begin(), looks_.end(), best,
                             [](const Look& a, const Look& b) { return a.place < b.place; }),
            best);
    }

    // One body can lie wholly within the other, where no surfaces cross: from the start, or after
    // they have crossed.
    void mark_inside() {
        bool inside = false, fresh = true;
        for (Look& at : looks_) {
            if (at.distance <= 0.0) {
                fresh = true;
                continue;
            }
            if (fresh) inside = is_inside(at.place);
            fresh = false;
            if (inside) at.distance = 0.0;
        }
    }

    bool is_inside(double place) const {
        const Frame frame = first_from_second(place);
        return standing_.contains(frame * moving_.some_vertex()) ||
               moving_.contains(frame.inverse() * standing_.some_vertex());
    }

    const ToolPath& path_;
    const MotionBound& bound_;
    const CollisionMesh &standing_, &moving_;
    const CollisionOptions& options_;
    double margin_;
    Frame first_from_base_, tcp_from_second_;
    double reach_;
    std::vector<Look> looks_;
};

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

    void add(const Pair& pair, std::size_t first, std::size_t second,
             const std::vector<CollisionBody>& bodies, CollisionResult& result) const {
        const auto& looks = pair.looks();
        const auto nearer = [](const Pair::Look& a, const Pair::Look& b) {
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
            const auto end = std::find_if(at, looks.end(), [&](const Pair::Look& look) {
                return look.distance >= options_.clearance && look.distance > 0.0;
            });
            result.events.push_back(event(pair, at, end, both));
            at = end;
        }
    }

  private:
    using Looks = std::vector<Pair::Look>::const_iterator;

    double time(const Pair::Look& look) const {
        const Moment at = moment_at(look.place, begins_.size() - 1);
        return begins_[at.motion] + path_.elapsed(at.motion, at.share);
    }
    std::uint32_t pose(const Pair::Look& look) const {
        return static_cast<std::uint32_t>(moment_at(look.place, begins_.size() - 1).motion);
    }
    std::pair<Vec3, Vec3> points(const Pair& pair, const Pair::Look& look) const {
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
    Event event(const Pair& pair, Looks begin, Looks end,
                const std::array<const CollisionBody*, 2>& bodies) const {
        const auto touches = [](const Pair::Look& look) { return look.distance <= 0.0; };
        const auto first = std::find_if(begin, end, touches);
        const bool collides = first != end;
        auto worst = first, last = end - 1;
        if (collides) {
            begin = first;
            while (!touches(*last)) --last;
        } else {
            worst = std::min_element(begin, end, [](const Pair::Look& a, const Pair::Look& b) {
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
        const char* motion = rapid ? " in a rapid motion" : "";
        event.message = bodies[0]->name + " and " + bodies[1]->name;
        if (collides) {
            event.message += std::string(" run into each other") + motion;
        } else {
            std::array<char, 120> text;
            std::snprintf(text.data(), text.size(), " come within %.2f mm of each other%s",
                          event.value, motion);
            event.message += text.data();
        }
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
            "collisions: the clearance must be zero or positive, the resolution positive");
    }
    CollisionResult result;
    if (path.poses().size() < 2) return result;
    std::vector<CollisionMesh> meshes;
    for (const CollisionBody& body : bodies) {
        try {
            meshes.emplace_back(body.mesh, context);
        } catch (const InputError& error) {
            throw InputError(body.name + ": " + error.what());
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
    std::vector<std::unique_ptr<Pair>> pairs;
    for (const auto& [a, b] : numbers) {
        pairs.push_back(std::make_unique<Pair>(path, bound, bodies[a], meshes[a], bodies[b],
                                               meshes[b], options));
    }
    const std::size_t blocks = (bound.motions() + kBlock - 1) / kBlock;
    std::vector<std::vector<std::vector<Pair::Look>>> looks(
        pairs.size(), std::vector<std::vector<Pair::Look>>(blocks));
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
