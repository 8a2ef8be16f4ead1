#include "path_motion.h"

#include <algorithm>
#include <cmath>

namespace beltgrinding {
namespace {

// In a rounded corner the turn goes by two nested slerps, whose speed may exceed that of both
// motions; by less than this factor for turns below half a turn.
constexpr double kCornerTurn = 1.5;

constexpr std::size_t kAtFlange = 6;  // the link that goes with what is at the flange
constexpr std::size_t kBlock = 64;    // motions that are followed by themselves

/// Where a place lies on the path: in the motion to a pose.
struct Moment {
    std::size_t motion;
    double share;
};

Moment moment_at(double place, std::size_t motions) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), motions - 1);
    return {i + 1, place - static_cast<double>(i)};
}

}  // namespace

bool carried(Carrier carrier, Holding holding) {
    const bool with_tool = holding == Holding::kToolInHand;
    return carrier == Carrier::kTool || carrier == (with_tool ? Carrier::kWheel : Carrier::kPart);
}

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

bool meets(const CollisionBody& first, const CollisionBody& second, Holding holding) {
    const bool held = carried(first.carrier, holding);
    if (first.carrier == Carrier::kLink)
        return second.carrier == Carrier::kLink && first.link + 1 < second.link;
    if (second.carrier != Carrier::kLink) return !held && carried(second.carrier, holding);
    if (held) return second.link < kAtFlange;
    return second.link > 0 || first.carrier != Carrier::kBase;
}

PathTravel::PathTravel(const ToolPath& path) : path_(path) {
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
    double time = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        begins_.push_back(time);
        time += path.duration(i);
    }
    travel_.assign(1, 0.0);
    turn_.assign(1, 0.0);
    for (std::size_t i = 1; i < count; ++i) {
        travel_.push_back(travel_.back() + travel[i]);
        turn_.push_back(turn_.back() + turn[i]);
    }
}

double PathTravel::way(double begin, double end, double reach) const {
    return sum_at(travel_, end) - sum_at(travel_, begin) +
           reach * (sum_at(turn_, end) - sum_at(turn_, begin));
}

double PathTravel::time(double place) const {
    const Moment at = moment_at(place, motions());
    return begins_[at.motion] + path_.elapsed(at.motion, at.share);
}

std::uint32_t PathTravel::pose(double place) const {
    return static_cast<std::uint32_t>(moment_at(place, motions()).motion);
}

Frame PathTravel::base_from_tcp(double place) const {
    const Moment at = moment_at(place, motions());
    return path_.base_from_tcp(at.motion, at.share);
}

PathMotion::PathMotion(const PathTravel& travel, Carrier standing, Carrier moving, double reach)
    : travel_(travel),
      base_from_first_(holder_from(standing, travel.path().frames())),
      tcp_from_second_(holder_from(moving, travel.path().frames())),
      reach_(reach) {}

std::vector<PairMotion::Stretch> PathMotion::stretches() const {
    std::vector<Stretch> all;
    add_stretches(all, 0, travel_.motions(), kBlock);
    return all;
}

double PathMotion::way(double begin, double end) const {
    return travel_.way(begin, end, reach_);
}

Frame PathMotion::first_from_second(double place) const {
    return base_from_first_.inverse() * travel_.base_from_tcp(place) * tcp_from_second_;
}

Frame PathMotion::work_from_first(double place) const {
    const CellFrames& cell = travel_.path().frames();
    const Frame base_from_work = cell.holding == Holding::kToolInHand
                                     ? cell.base_from_work
                                     : Frame(travel_.base_from_tcp(place) * cell.tcp_from_work);
    return base_from_work.inverse() * base_from_first_;
}

}  // namespace beltgrinding
