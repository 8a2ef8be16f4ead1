#include "collision_pair.h"

#include <algorithm>
#include <limits>

namespace beltgrinding {
namespace {

// Relative: how sure the least distance is beyond the clearance, and how exact each look is there.
// A search that may stop so far from the truth is many times faster.
constexpr double kLeastAccuracy = 0.75;
constexpr double kLookError = 0.2;
constexpr int kPolish = 24;      // looks around the nearest place, each cuts its stretch to 0.62
constexpr double kStride = 2.0;  // mm between two looks at bodies that touch or nearly do
constexpr int kFirstLooks = 8;   // evenly over a block, for a good guess of its least
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

}  // namespace

CollisionPair::CollisionPair(const ToolPath& path, const MotionBound& bound,
                             const CollisionBody& first, const CollisionMesh& standing,
                             const CollisionBody& second, const CollisionMesh& moving,
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

CollisionPair::Looks CollisionPair::follow(double begin, double end, const RunContext& context,
                                           const std::function<void(double)>& done) const {
    Looks looks;
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

void CollisionPair::finish(const std::vector<Looks>& blocks) {
    looks_ = {look(0.0, {})};
    for (const auto& block : blocks) looks_.insert(looks_.end(), block.begin(), block.end());
    mark_inside();
    polish();
}

Frame CollisionPair::base_from_tcp(double place) const {
    const Moment at = moment_at(place, bound_.motions());
    return path_.base_from_tcp(at.motion, at.share);
}

bool CollisionPair::settled(const Look& begin, const Look& end, double way, double least) const {
    const double bound = 0.5 * (begin.low + end.low - way);  // of the distance in between
    if (way <= options_.resolution) return true;
    if (begin.distance <= 0.0 && end.distance <= 0.0) return way <= kStride;
    const bool clear = bound >= options_.clearance;
    if (clear && bound >= (1.0 - kLeastAccuracy) * least) return true;
    if (clear || bound < least - options_.resolution) return false;
    return bound > 0.0 && std::max(begin.distance, end.distance) < options_.clearance &&
           way <= kStride;
}

Frame CollisionPair::first_from_second(double place) const {
    return first_from_base_ * base_from_second(place);
}

// Exact below the clearance.
CollisionPair::Look CollisionPair::look(double place, const NearestPoints& known,
                                        bool exact) const {
    const Frame frame = first_from_second(place);
    Look at{place, standing_.nearest(moving_, frame, known, exact ? 0.0 : kLookError), 0.0, 0.0};
    at.low = at.nearest.distance / (exact ? 1.0 : 1.0 + kLookError) - margin_;
    if (!exact && at.low < options_.clearance && at.nearest.distance > 0.0) {
        return look(place, at.nearest, true);
    }
    at.distance = std::max(0.0, at.nearest.distance - margin_);
    at.low = std::max(0.0, at.low);
    return at;
}

// Of two looks, the one whose points are the nearer at `place`.
const NearestPoints& CollisionPair::nearer(const Look& a, const Look& b, double place) const {
    const Frame frame = first_from_second(place);
    const auto apart = [&](const Look& at) {
        return (at.nearest.here - frame * at.nearest.there).squaredNorm();
    };
    return apart(a) <= apart(b) ? a.nearest : b.nearest;
}

// Beyond the clearance, finds the place around the nearest look where it is nearest, by golden
// section.
void CollisionPair::polish() {
    const auto least =
        std::min_element(looks_.begin(), looks_.end(),
                         [](const Look& a, const Look& b) { return a.distance < b.distance; });
    if (least->distance < options_.clearance) return;
    double low = least == looks_.begin() ? least->place : (least - 1)->place;
    double high = least + 1 == looks_.end() ? least->place : (least + 1)->place;
    Look best = look(least->place, least->nearest, true);
    constexpr double kGolden = 0.6180339887498949;
    const auto inner = [&](double share) {
        Look at = look(low + share * (high - low), best.nearest, true);
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
    looks_.insert(std::upper_bound(looks_.begin(), looks_.end(), best,
                                   [](const Look& a, const Look& b) { return a.place < b.place; }),
                  best);
}

// One body can lie wholly within the other, where no surfaces cross: from the start, or after
// they have crossed.
void CollisionPair::mark_inside() {
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

bool CollisionPair::is_inside(double place) const {
    const Frame frame = first_from_second(place);
    return standing_.contains(frame * moving_.some_vertex()) ||
           moving_.contains(frame.inverse() * standing_.some_vertex());
}

}  // namespace beltgrinding
