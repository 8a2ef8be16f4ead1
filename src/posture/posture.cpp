#include "posture/posture.h"

#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"
#include "cost.h"
#include "joint_pace.h"
#include "ladder.h"
#include "smoothing.h"

namespace beltgrinding {
namespace {

constexpr int kLevels = 3;                  // of refinement
constexpr int kFiner = 3;                   // times, from level to level
constexpr int kMostSteps = 3;               // of the first samples, between neighbouring poses
constexpr int kBeside = 4;                  // samples to both sides of the way of the level before
constexpr std::size_t kMostSamples = 4000;  // of a pose

void check(const std::vector<PassPose>& poses, const PostureOptions& options, const RobotArm& arm) {
    std::size_t samples = 1;
    for (const FreeRange& one : options.free) {
        if (!std::isfinite(one.most) || one.most < 0.0 || !(one.low() <= 0.0) ||
            !(one.spacing > 0.0)) {
            throw InputError("posture.free",
                             "posture: what is free must be zero or positive, its samples apart");
        }
        const double many =
            std::ceil(one.most / one.spacing) + std::ceil(-one.low() / one.spacing) + 1.0;
        samples *= static_cast<std::size_t>(std::min(many, 1e5));
        samples = std::min<std::size_t>(samples, 10 * kMostSamples);
    }
    if (samples > kMostSamples) {
        throw InputError("posture.samples",
                         "posture: roll, lean and shift have {count} samples at a pose, more than "
                         "{most}; set them farther apart",
                         {{"count", samples}, {"most", kMostSamples}});
    }
    if (poses.empty()) throw InputError("posture.no_pose", "posture: there is no pose");
    if (!(options.flip > 0.0) || !(options.chord > 0.0) || !(options.clearance >= 0.0) ||
        !(options.speed.minCoeff() > 0.0) || !(options.acceleration.minCoeff() >= 0.0) ||
        !(options.jerk.minCoeff() >= 0.0)) {
        throw InputError("posture.options",
                         "posture: flip, chord and speeds must be positive, the clearance too");
    }
    for (int j = 0; j < 6; ++j) {
        if (options.home[j] >= arm.lower()[j] && options.home[j] <= arm.upper()[j]) continue;
        throw InputError("posture.home",
                         "home: joint {joint} at {angle:.1f} deg is beyond its "
                         "limits of {lower:.1f} to {upper:.1f} deg",
                         {{"joint", j + 1},
                          {"angle", options.home[j] * 180.0 / M_PI},
                          {"lower", arm.lower()[j] * 180.0 / M_PI},
                          {"upper", arm.upper()[j] * 180.0 / M_PI}});
    }
}

int samples_to(double most, double spacing) {
    return static_cast<int>(std::ceil(most / spacing - 1e-9));
}

Window whole(const PostureOptions& options) {
    Window window;
    for (std::size_t k = 0; k < kFreedoms; ++k) {
        const FreeRange& range = options.free[k];
        window.high[k] = samples_to(range.most, range.spacing);
        window.low[k] = -samples_to(-range.low(), range.spacing);
    }
    return window;
}

/// What holds both.
Window joined(const Window& a, const Window& b) {
    Window all = a;
    for (std::size_t k = 0; k < kFreedoms; ++k) {
        all.low[k] = std::min(a.low[k], b.low[k]);
        all.high[k] = std::max(a.high[k], b.high[k]);
    }
    return all;
}

/// Of a finer level with this spacing, round what the level before has chosen.
std::vector<Window> beside(const std::vector<Window>& windows, const Ladder& ladder,
                           const std::vector<Ladder::Step>& way, const PostureOptions& options,
                           const std::array<double, kFreedoms>& spacing) {
    std::vector<Window> finer = windows;
    std::size_t last = windows.size();
    for (const Ladder::Step& step : way) {
        if (step.vertex < 0) continue;
        const Rung& rung = ladder.rung(step.rung);
        const auto sample =
            rung.window.sample(rung.vertices[static_cast<std::size_t>(step.vertex)].sample);
        Window round = finer[step.rung];
        for (std::size_t k = 0; k < kFreedoms; ++k) {
            if (windows[step.rung].low[k] == windows[step.rung].high[k]) continue;
            const int end = samples_to(options.free[k].most, spacing[k]);
            const int begin = -samples_to(-options.free[k].low(), spacing[k]);
            const int middle = std::clamp(kFiner * sample[k], begin, end);
            round.low[k] = std::max(begin, middle - kBeside);
            round.high[k] = std::min(end, middle + kBeside);
        }
        // Where a pass is cut its pose is there twice, perhaps with axes far apart.
        const Window both = joined(finer[step.rung], round);
        finer[step.rung] = step.rung == last && both.size() <= kMostSamples ? both : round;
        last = step.rung;
    }
    return finer;
}

std::vector<PosturePose> told(const Ladder& ladder, const std::vector<Ladder::Step>& way,
                              const ArmScene& scene, const std::vector<PassPose>& poses,
                              const PostureOptions& options) {
    std::vector<PosturePose> found;
    bool broken = false;
    for (const Ladder::Step& step : way) {
        PosturePose pose;
        const Rung& rung = ladder.rung(step.rung);
        pose.pose = step.rung;
        pose.reached = step.vertex >= 0;
        pose.within_limits = pose.reached || !rung.solved;
        pose.torn = pose.reached && (rung.torn || (broken && !rung.begins_pass));
        pose.cut = step.cut || rung.torn;
        pose.link = step.cut || rung.begins_pass || pose.torn;
        pose.duration = poses[step.rung].duration;
        pose.base_from_tcp = poses[step.rung].base_from_tcp;
        broken = !pose.reached;
        if (pose.reached) {
            const Vertex& vertex = rung.vertices[static_cast<std::size_t>(step.vertex)];
            pose.free = ladder.free(step.rung, vertex.sample);
            pose.base_from_tcp = moved(scene, pose.base_from_tcp, pose.free, options.wheel_radius);
            pose.q = vertex.q;
        }
        found.push_back(pose);
    }
    return found;
}

}  // namespace

Frame moved(const ArmScene& scene, const Frame& base_from_tcp, const Free& free,
            double wheel_radius) {
    if (std::all_of(free.begin(), free.begin() + kOfContact, [](double one) { return one == 0.0; }))
        return base_from_tcp;
    const Eigen::Translation3d axis(0.0, 0.0, -wheel_radius);
    const Frame contact_from_moved = Frame(Eigen::Translation3d(0.0, free[2], 0.0)) *
                                     Eigen::AngleAxisd(free[1], Vec3::UnitX()) * axis *
                                     Eigen::AngleAxisd(free[0], Vec3::UnitY()) * axis.inverse();
    const CellFrames& cell = scene.frames();
    if (cell.holding == Holding::kToolInHand) {
        return base_from_tcp * cell.tcp_from_contact * contact_from_moved *
               cell.tcp_from_contact.inverse();
    }
    return cell.base_from_contact * contact_from_moved.inverse() *
           cell.base_from_contact.inverse() * base_from_tcp;
}

PostureCost posture_cost(const ArmScene& scene, const std::vector<PosturePose>& way,
                         const std::vector<PassPose>& poses, const PostureOptions& options) {
    const Cost cost(scene.arm(), options);
    const std::vector<double> times = times_at(poses);
    PostureCost sum;
    Coordinates at = options.home;
    for (std::size_t n = 0; n < way.size(); ++n) {
        if (!way[n].reached) continue;
        const double duration = poses[way[n].pose].duration;
        sum.travel += cost.travel(at, way[n].q);
        sum.places += times[way[n].pose] * cost.place(way[n].q);
        if (way[n].cut) sum.cuts += options.cut;
        if (!way[n].link) {
            sum.slow += cost.slow(at, way[n].q, duration);
            const bool on = n + 1 < way.size() && !way[n + 1].link && way[n + 1].reached;
            if (on)
                sum.acceleration += cost.acceleration(at, way[n].q, way[n + 1].q, duration,
                                                      poses[way[n + 1].pose].duration);
        }
        at = way[n].q;
    }
    sum.travel += cost.travel(at, options.home);
    return sum;
}

PostureResult find_postures(const ArmScene& scene, const std::vector<PassPose>& poses,
                            const PostureOptions& options, const RunContext& context) {
    check(poses, options, scene.arm());
    std::array<double, kFreedoms> spacing{};
    bool free = false;
    for (std::size_t k = 0; k < kFreedoms; ++k) {
        spacing[k] = options.free[k].spacing;
        free = free || options.free[k].any();
    }
    Ladder ladder(scene, poses, options);
    std::vector<Window> windows(poses.size(), whole(options));
    int most_steps = kMostSteps;
    ladder.build(windows, spacing, most_steps, context);
    std::vector<Ladder::Step> way = ladder.search(context);
    for (int level = 0; free && level < kLevels; ++level) {
        context.report((1.0 + level) / (kLevels + 2.0));
        for (double& one : spacing) one /= kFiner;
        windows = beside(windows, ladder, way, options, spacing);
        most_steps *= kFiner;  // so that the way of the level before stays one
        ladder.build(windows, spacing, most_steps, context);
        way = ladder.search(context);
    }
    PostureResult result;
    result.poses = told(ladder, way, scene, poses, options);
    smooth(scene, poses, options, ladder.bounds(), spacing, result.poses, context);
    for (PosturePose& pose : result.poses) {
        if (!pose.reached) continue;
        if (const auto met = scene.within(pose.q, 0.0)) {
            pose.meets = true;
            pose.first = met->first;
            pose.second = met->second;
        }
    }
    result.cost = posture_cost(scene, result.poses, poses, options);
    keep_pace(options, result.poses);
    context.report(1.0);
    return result;
}

}  // namespace beltgrinding
