#include "ladder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "robot/inverse_kinematics.h"

namespace beltgrinding {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr std::size_t kVertices = 4096;  // of a rung, about, with whole turns
constexpr std::size_t kMostTurns = 64;
constexpr int kSearches = 60;    // until no body is met any more
constexpr double kSoft = 3.0;    // times the clearance: nearer begins to cost
constexpr double kAlike = 1e-6;  // rad, between joints that are the same but for whole turns

/// Whether two solutions differ by whole turns of joints only.
bool turned_alike(const Coordinates& a, const Coordinates& b) {
    for (int j = 0; j < 6; ++j) {
        if (std::abs(std::remainder(a[j] - b[j], 2.0 * M_PI)) > kAlike) return false;
    }
    for (Eigen::Index j = 6; j < a.size(); ++j)
        if (std::abs(a[j] - b[j]) > kAlike) return false;
    return true;
}

}  // namespace

std::size_t Window::number(const std::array<int, kFreedoms>& sample) const {
    std::size_t n = 0;
    for (std::size_t k = 0; k < kFreedoms; ++k)
        n = n * static_cast<std::size_t>(count(k)) + static_cast<std::size_t>(sample[k] - low[k]);
    return n;
}

std::array<int, kFreedoms> Window::sample(std::size_t number) const {
    std::array<int, kFreedoms> found{};
    for (std::size_t k = kFreedoms; k-- > 0;) {
        const auto n = static_cast<std::size_t>(count(k));
        found[k] = low[k] + static_cast<int>(number % n);
        number /= n;
    }
    return found;
}

Coordinates with_axes(const ArmScene& scene, const Joints& q, const Free& free) {
    Coordinates at = scene.axes().standing(q);
    for (Eigen::Index j = 6; j < at.size(); ++j)
        at[j] = std::clamp(at[j] + free[kOfContact + static_cast<std::size_t>(j - 6)],
                           scene.lower()[j], scene.upper()[j]);
    return at;
}

std::vector<Joints> turns_within(const RobotArm& arm, const Joints& q, const Joints& near,
                                 std::size_t most) {
    std::vector<Joints> all{q};
    for (int j = 0; j < 6; ++j) {
        std::vector<Joints> next;
        const double first =
            q[j] + 2.0 * M_PI * std::ceil((arm.lower()[j] - q[j]) / (2.0 * M_PI) - 1e-12);
        for (double angle = first; angle <= arm.upper()[j]; angle += 2.0 * M_PI) {
            for (Joints one : all) {
                one[j] = angle;
                next.push_back(one);
            }
        }
        all = std::move(next);
    }
    std::stable_sort(all.begin(), all.end(), [&](const Joints& a, const Joints& b) {
        return (a - near).squaredNorm() < (b - near).squaredNorm();
    });
    if (all.size() > most) all.resize(most);
    return all;
}

Ladder::Ladder(const ArmScene& scene, const std::vector<PassPose>& poses,
               const PostureOptions& options)
    : scene_(scene),
      poses_(poses),
      options_(options),
      cost_(scene.arm(), options),
      times_(times_at(poses)),
      bounds_(poses.size(), Free{}) {
    // The tool frame goes straight, what turns about a point off it does not: a chord of the arc.
    const auto bound = [&](double arm) {
        return arm > options.chord ? 2.0 * std::acos(1.0 - options.chord / arm) : M_PI;
    };
    for (std::size_t i = 1; i < poses.size(); ++i) {
        if (poses[i].begins) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            double lever = 0.0;
            for (const std::size_t p : {i - 1, i}) {
                // How far a small turn moves the tool's origin tells its lever.
                Free turned{};
                turned[k] = 1e-3;
                const Frame& at = poses[p].base_from_tcp;
                const Frame to = moved(scene, at, turned, options.wheel_radius);
                lever = std::max(lever, (to.translation() - at.translation()).norm() / 1e-3);
            }
            bounds_[i][k] = bound(lever);
        }
        bounds_[i][2] =
            (poses[i].base_from_tcp.translation() - poses[i - 1].base_from_tcp.translation())
                .norm();
        // The tool goes straight in the frame that goes with the part, whatever the axes do.
        for (std::size_t k = kOfContact; k < kFreedoms; ++k)
            bounds_[i][k] = std::numeric_limits<double>::infinity();
    }
}

void Ladder::build(const std::vector<Window>& windows, const std::array<double, kFreedoms>& spacing,
                   int most_steps, const RunContext& context) {
    spacing_ = spacing;
    rungs_.assign(poses_.size(), {});
    for (std::size_t i = 0; i < rungs_.size(); ++i) {
        rungs_[i].window = windows[i];
        rungs_[i].begins_pass = i == 0 || poses_[i].begins;
        for (std::size_t k = 0; k < kFreedoms; ++k) {
            const double steps = spacing[k] > 0.0 ? bounds_[i][k] / spacing[k] : 0.0;
            rungs_[i].steps[k] = static_cast<int>(std::min<double>(steps + 1e-9, most_steps));
        }
    }
    parallel_blocks(rungs_.size(), 4, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) fill(i);
    });
}

Free Ladder::free(std::size_t rung, std::uint32_t sample) const {
    const std::array<int, kFreedoms> at = rungs_[rung].window.sample(sample);
    Free free{};
    for (std::size_t k = 0; k < kFreedoms; ++k) {
        const FreeRange& range = options_.free[k];
        free[k] = std::clamp(at[k] * spacing_[k], range.low(), range.most);
    }
    return free;
}

void Ladder::fill(std::size_t i) {
    Rung& rung = rungs_[i];
    const std::size_t samples = rung.window.size();
    const std::size_t turns = std::clamp<std::size_t>(kVertices / (8 * samples), 4, kMostTurns);
    const Joints home = options_.home.head<6>();
    for (std::size_t s = 0; s < samples; ++s) {
        rung.begins.push_back(static_cast<std::uint32_t>(rung.vertices.size()));
        const auto sample = static_cast<std::uint32_t>(s);
        const Free at = free(i, sample);
        const Frame base_from_tcp =
            moved(scene_, poses_[i].base_from_tcp, at, options_.wheel_radius);
        const Frame robot_from_flange =
            scene_.robot_from_flange(base_from_tcp, with_axes(scene_, Joints::Zero(), at));
        for (const ArmSolution& one : inverse(scene_.arm(), robot_from_flange, home)) {
            rung.solved = true;
            for (const Joints& q : turns_within(scene_.arm(), one.q, home, turns)) {
                Vertex vertex;
                vertex.q = with_axes(scene_, q, at);
                vertex.place = times_[i] * cost_.place(vertex.q);
                vertex.sample = sample;
                vertex.branch = static_cast<std::int8_t>(one.branch);
                rung.vertices.push_back(vertex);
            }
        }
    }
    rung.begins.push_back(static_cast<std::uint32_t>(rung.vertices.size()));
    rung.seen.assign(samples, 0);
}

void Ladder::link(std::size_t i, const Rung* before) {
    Rung& rung = rungs_[i];
    for (Vertex& vertex : rung.vertices) {
        vertex.cut_from = -1;
        vertex.before = -1;
        double least = before == nullptr ? cost_.travel(options_.home, vertex.q) : kNone;
        if (before != nullptr) {
            for (std::size_t u = 0; u < before->vertices.size(); ++u) {
                const Vertex& from = before->vertices[u];
                if (from.cost >= least) continue;
                const double cost = from.cost + cost_.travel(from.q, vertex.q);
                if (cost < least) {
                    least = cost;
                    vertex.before = static_cast<std::int32_t>(u);
                }
            }
        }
        vertex.cost = least + vertex.place;
    }
}

/// From the vertices of a sample of the rung before, by those that are cheaper than what it has.
void Ladder::follow_from(const Rung& before, std::size_t sample, double duration,
                         Vertex& vertex) const {
    for (std::uint32_t u = before.begins[sample]; u < before.begins[sample + 1]; ++u) {
        const Vertex& from = before.vertices[u];
        if (from.branch != vertex.branch || from.cost >= vertex.cost ||
            (from.q - vertex.q).cwiseAbs().maxCoeff() > options_.flip)
            continue;
        const double cost = from.cost + cost_.edge(from.q, vertex.q, duration);
        if (cost < vertex.cost) {
            vertex.cost = cost;
            vertex.before = static_cast<std::int32_t>(u);
        }
    }
}

void Ladder::follow(std::size_t i) {
    const Rung& before = rungs_[i - 1];
    Rung& rung = rungs_[i];
    for (Vertex& vertex : rung.vertices) {
        vertex.cost = kNone;
        vertex.before = -1;
        vertex.cut_from = -1;
        const std::array<int, kFreedoms> at = rung.window.sample(vertex.sample);
        Window beside;
        bool any = true;
        for (std::size_t k = 0; k < kFreedoms; ++k) {
            beside.low[k] = std::max(before.window.low[k], at[k] - rung.steps[k]);
            beside.high[k] = std::min(before.window.high[k], at[k] + rung.steps[k]);
            any = any && beside.low[k] <= beside.high[k];
        }
        for (std::size_t n = 0; any && n < beside.size(); ++n) {
            const std::size_t sample = before.window.number(beside.sample(n));
            follow_from(before, sample, poses_[i].duration, vertex);
        }
        vertex.cost += vertex.place;
    }
}

/// A pass that goes on in another posture ends at this pose, and begins anew there.
void Ladder::cut(std::size_t i) {
    Rung& rung = rungs_[i];
    std::vector<std::size_t> open;  // those that a cut may begin at, the cheapest first
    for (std::size_t u = 0; u < rung.vertices.size(); ++u)
        if (rung.vertices[u].cost < kNone) open.push_back(u);
    std::sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
        return rung.vertices[a].cost < rung.vertices[b].cost;
    });
    std::vector<double> costs(rung.vertices.size());
    for (std::size_t u = 0; u < costs.size(); ++u) costs[u] = rung.vertices[u].cost;
    for (Vertex& vertex : rung.vertices) {
        for (const std::size_t u : open) {
            const double begun = costs[u] + options_.cut + vertex.place;
            if (begun >= vertex.cost) break;
            const double cost = begun + cost_.travel(rung.vertices[u].q, vertex.q);
            if (cost < vertex.cost) {
                vertex.cost = cost;
                vertex.cut_from = static_cast<std::int32_t>(u);
            }
        }
    }
}

void Ladder::forward(std::size_t i) {
    const bool broken = i > 0 && rungs_[i - 1].vertices.empty();
    if (i == 0 || rungs_[i].begins_pass || broken) {
        std::size_t last = i;
        while (last > 0 && rungs_[last - 1].vertices.empty()) --last;
        link(i, last == 0 ? nullptr : &rungs_[last - 1]);
        return;
    }
    follow(i);
    Rung& rung = rungs_[i];
    rung.torn = std::none_of(rung.vertices.begin(), rung.vertices.end(),
                             [](const Vertex& vertex) { return vertex.cost < kNone; });
    if (rung.torn) {
        link(i, &rungs_[i - 1]);
        for (Vertex& vertex : rung.vertices) vertex.cost += options_.cut;
    } else {
        cut(i);
    }
}

std::vector<Ladder::Step> Ladder::backward() const {
    std::vector<Step> way;
    std::int32_t at = -1;
    bool open = false;  // `at` is known
    double last = kNone;
    for (std::size_t i = rungs_.size(); i-- > 0;) {
        const Rung& rung = rungs_[i];
        if (rung.vertices.empty()) {
            way.push_back({i, -1, false});
            continue;
        }
        if (!open) {
            for (std::size_t v = 0; v < rung.vertices.size(); ++v) {
                const Vertex& one = rung.vertices[v];
                const double cost = one.cost + cost_.travel(one.q, options_.home);
                if (at < 0 || cost < last) {
                    at = static_cast<std::int32_t>(v);
                    last = cost;
                }
            }
            open = true;
        }
        const Vertex* vertex = &rung.vertices[static_cast<std::size_t>(at)];
        way.push_back({i, at, vertex->cut_from >= 0});
        if (vertex->cut_from >= 0) {
            way.push_back({i, vertex->cut_from, false});
            vertex = &rung.vertices[static_cast<std::size_t>(vertex->cut_from)];
        }
        at = vertex->before;
    }
    std::reverse(way.begin(), way.end());
    return way;
}

/// Whether a cost has changed.
bool Ladder::look_at(std::size_t i, Vertex& vertex) {
    const bool of_tool = look_at_tool(i, vertex);
    return look_at_arm(i, vertex) || of_tool;
}

double Ladder::near_cost(std::size_t i, const Coordinates& q, ArmScene::Pairs pairs) const {
    const double clearance = options_.clearance;
    if (!scene_.within(q, kSoft * clearance, pairs)) return 0.0;
    const bool nearer = scene_.within(q, clearance, pairs).has_value();
    return times_[i] * kNearCost * (nearer ? 4.0 : 1.0);
}

/// What goes with the tool lies alike for all vertices of a sample, and costs all of them the same.
/// Else the search would think each posture free of it until it has looked there.
bool Ladder::look_at_tool(std::size_t i, const Vertex& vertex) {
    Rung& rung = rungs_[i];
    if (rung.seen[vertex.sample] != 0) return false;
    rung.seen[vertex.sample] = 1;
    const auto met = scene_.within(vertex.q, 0.0, ArmScene::Pairs::kOfTool);
    const double more = met ? kMetCost : near_cost(i, vertex.q, ArmScene::Pairs::kOfTool);
    for (std::size_t v = rung.begins[vertex.sample]; v < rung.begins[vertex.sample + 1]; ++v) {
        Vertex& one = rung.vertices[v];
        one.place += more;
        if (!met) continue;
        one.seen = Seen::kMet;
        one.first = static_cast<std::uint32_t>(met->first);
        one.second = static_cast<std::uint32_t>(met->second);
    }
    return more > 0.0;
}

/// The links lie alike for all vertices that differ by whole turns only.
bool Ladder::look_at_arm(std::size_t i, Vertex& vertex) {
    if (vertex.seen != Seen::kNot) return false;
    Rung& rung = rungs_[i];
    const Coordinates q = vertex.q;
    const auto met = scene_.within(q, 0.0, ArmScene::Pairs::kOfArm);
    const double more = met ? kMetCost : near_cost(i, q, ArmScene::Pairs::kOfArm);
    const Seen seen = met ? Seen::kMet : (more > 0.0 ? Seen::kNear : Seen::kFree);
    for (std::size_t v = rung.begins[vertex.sample]; v < rung.begins[vertex.sample + 1]; ++v) {
        Vertex& one = rung.vertices[v];
        if (one.seen != Seen::kNot || !turned_alike(one.q, q)) continue;
        one.seen = seen;
        one.place += more;
        if (!met) continue;
        one.first = static_cast<std::uint32_t>(met->first);
        one.second = static_cast<std::uint32_t>(met->second);
    }
    return more > 0.0;
}

/// Looks at the way's bodies; where one meets, at all samples of that configuration too. Whether
/// any cost has changed.
bool Ladder::look(const std::vector<Step>& way, const RunContext& context) {
    std::vector<std::uint8_t> changed(way.size(), 0);
    parallel_blocks(way.size(), 1, context, [&](std::size_t k, std::size_t) {
        const Step& step = way[k];
        if (step.vertex < 0 || (k > 0 && way[k - 1].rung == step.rung)) return;
        // A pose at which a pass is cut stands here twice, in one task.
        for (std::size_t n = k; n < way.size() && way[n].rung == step.rung; ++n) {
            Rung& rung = rungs_[step.rung];
            Vertex& vertex = rung.vertices[static_cast<std::size_t>(way[n].vertex)];
            if (!look_at(step.rung, vertex)) continue;
            changed[k] = 1;
            if (vertex.seen != Seen::kMet) continue;
            for (Vertex& other : rung.vertices)
                if (other.branch == vertex.branch) look_at(step.rung, other);
        }
    });
    return std::any_of(changed.begin(), changed.end(), [](std::uint8_t one) { return one != 0; });
}

std::vector<Ladder::Step> Ladder::search(const RunContext& context) {
    std::vector<Step> way;
    for (int k = 0; k < kSearches; ++k) {
        for (std::size_t i = 0; i < rungs_.size(); ++i) {
            context.throw_if_cancelled();
            forward(i);
        }
        way = backward();
        if (!look(way, context)) break;
    }
    return way;
}

}  // namespace beltgrinding
