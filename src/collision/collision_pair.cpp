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

}  // namespace

CollisionPair::CollisionPair(std::unique_ptr<const PairMotion> motion, const CollisionMesh& first,
                             const CollisionMesh& second, double margin,
                             const CollisionOptions& options)
    : motion_(std::move(motion)),
      first_(first),
      second_(second),
      options_(options),
      margin_(margin) {}

CollisionPair::Looks CollisionPair::follow(const PairMotion::Stretch& stretch,
                                           const RunContext& context,
                                           const std::function<void(double)>& done) const {
    const auto [begin, end] = stretch;
    Looks looks;
    double least = std::numeric_limits<double>::infinity();
    NearestPoints known;
    const int first = motion_->way(begin, end) > options_.resolution ? kFirstLooks : 1;
    for (int k = 0; k < first; ++k) {
        context.throw_if_cancelled();
        const Look at = look(begin + (end - begin) * k / first, known);
        least = std::min(least, at.distance);
        known = at.nearest;
    }
    struct Between {
        Look begin, end;
    };
    std::vector<Between> open{{look(begin, known), look(end, known)}};
    while (!open.empty()) {
        context.throw_if_cancelled();
        const Between s = open.back();
        open.pop_back();
        least = std::min({least, s.begin.distance, s.end.distance});
        const double way = motion_->way(s.begin.place, s.end.place);
        const double place = motion_->middle(s.begin.place, s.end.place);
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

void CollisionPair::finish(const std::vector<Looks>& followed) {
    const auto stretches = motion_->stretches();
    looks_.clear();
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        if (k == 0 || stretches[k].begin != stretches[k - 1].end) {
            looks_.push_back(look(stretches[k].begin, {}));
        }
        looks_.insert(looks_.end(), followed[k].begin(), followed[k].end());
    }
    mark_inside();
    polish();
}

std::pair<Vec3, Vec3> CollisionPair::points(const Look& look) const {
    const Frame work_from_first = motion_->work_from_first(look.place);
    return {work_from_first * look.nearest.here,
            work_from_first * motion_->first_from_second(look.place) * look.nearest.there};
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

// Exact below the clearance.
CollisionPair::Look CollisionPair::look(double place, const NearestPoints& known,
                                        bool exact) const {
    const Frame frame = motion_->first_from_second(place);
    Look at{place, first_.nearest(second_, frame, known, exact ? 0.0 : kLookError), 0.0, 0.0};
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
    const Frame frame = motion_->first_from_second(place);
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
    const Frame frame = motion_->first_from_second(place);
    return first_.contains(frame * second_.some_vertex()) ||
           second_.contains(frame.inverse() * first_.some_vertex());
}

}  // namespace beltgrinding
