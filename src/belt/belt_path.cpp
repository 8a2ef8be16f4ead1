#include "belt_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beltgrinding {
namespace {

constexpr double kFinest = 0.25;    // bending lengths: half columns are of use down to this
constexpr double kHalved = 3.0;     // bending lengths beside first and last touch with half columns
constexpr double kGrowth = 1.7;     // of the columns' widths beyond the fine ones
constexpr double kCoarsest = 16.0;  // mm, of a free run's columns
constexpr int kRollerMoves = 6;     // until the belt's length is kept to far below a micrometre

/// (x, z), and x on the work.
using Points = std::vector<Eigen::Vector3d>;

double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// The upper hull of the obstacle between the rollers: a string pulled tight over it (Andrew's
/// monotone chain, Information Processing Letters 9, 1979).
Points string_over(const Points& obstacle, double left, double right) {
    Points hull = {{left, 0.0, left}};
    const auto add = [&](const Eigen::Vector3d& p) {
        while (hull.size() > 1 &&
               cross(hull.back() - hull[hull.size() - 2], p - hull.back()) >= 0.0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const Eigen::Vector3d& p : obstacle)
        if (p.x() > hull.back().x() && p.x() < right) add(p);
    add({right, 0.0, right});
    return hull;
}

double distance(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (to - from).head<2>().norm();
}

double length_of(const Points& points) {
    double sum = 0.0;
    for (std::size_t k = 1; k < points.size(); ++k) sum += distance(points[k - 1], points[k]);
    return sum;
}

double direction(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return std::atan2(to.y() - from.y(), to.x() - from.x());
}

struct Ends {
    double left, right;
};

Points string_between_rollers(const BeltRun& run, const Points& obstacle, Ends& ends) {
    ends = {-0.5 * run.length - run.position, 0.5 * run.length - run.position};
    Points points = string_over(obstacle, ends.left, ends.right);
    if (run.rollers == BeltRun::Rollers::kFixed) return points;
    for (int k = 0; k < kRollerMoves && points.size() > 2; ++k) {
        const double move = 0.5 * (length_of(points) - run.length);
        ends.left += move;
        ends.right -= move;
        points = string_over(obstacle, ends.left, ends.right);
    }
    return points;
}

/// Borders of columns from `from` to `to`, which become wider with the distance from there.
std::vector<double> widening(double from, double to, double first) {
    std::vector<double> steps;
    const double whole = std::abs(to - from);
    double sum = 0.0;
    for (double next = first; sum < whole; next = std::min(kGrowth * next, kCoarsest)) {
        steps.push_back(next);
        sum += next;
    }
    std::vector<double> borders;
    double at = 0.0;
    for (const double step : steps) {
        at += step * whole / sum;
        borders.push_back(from + std::copysign(at, to - from));
    }
    if (!borders.empty()) borders.back() = to;
    return borders;
}

/// Angles at the ascending `places` of a string that turns by `turns` at `corners`, rounded by
/// exp(-|s| / l) / (2 l), which is what a plate under tension makes of a corner.
std::vector<double> rounded(const std::vector<double>& places, const std::vector<double>& corners,
                            const std::vector<double>& turns, double start, double l) {
    std::vector<double> angles(places.size(), start);
    const auto decay = [&](double distance) { return l > 0.0 ? std::exp(-distance / l) : 0.0; };
    // What lies before a place has turned but for a tail, what lies after only by one.
    double turned = 0.0, tail = 0.0, at = 0.0;
    std::size_t next = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        while (next < corners.size() && corners[next] <= places[k]) {
            tail = tail * decay(corners[next] - at) + turns[next];
            at = corners[next];
            turned += turns[next++];
        }
        tail *= decay(places[k] - at);
        at = places[k];
        angles[k] += turned - 0.5 * tail;
    }
    tail = 0.0;
    at = places.back();
    next = corners.size();
    for (std::size_t k = places.size(); k-- > 0;) {
        while (next > 0 && corners[next - 1] > places[k]) {
            --next;
            tail = tail * decay(at - corners[next]) + turns[next];
            at = corners[next];
        }
        tail *= decay(at - places[k]);
        at = places[k];
        angles[k] += 0.5 * tail;
    }
    return angles;
}

/// Columns of the fine borders, which are those of the grid's columns `numbers`, and wider ones up
/// to the rollers at `left` and `right`, mm along the path.
std::vector<double> columns_between(BeltPath& path, std::vector<double> fine,
                                    const std::vector<int>& numbers, double left, double right,
                                    double cell) {
    if (fine.empty()) fine.push_back(0.5 * (left + right));
    std::vector<double> borders = widening(fine.front(), left, kGrowth * cell);
    std::reverse(borders.begin(), borders.end());
    path.cell.assign(borders.size(), -1);
    path.cell.insert(path.cell.end(), numbers.begin(), numbers.end());
    borders.insert(borders.end(), fine.begin(), fine.end());
    for (const double border : widening(fine.back(), right, kGrowth * cell))
        borders.push_back(border);
    path.cell.resize(borders.size() - 1, -1);
    path.columns = BeltColumns::of(borders);
    return borders;
}

}  // namespace

std::array<double, 3> BeltColumns::curvature(int i) const {
    if (i == 0 || i + 1 == count()) return {0.0, 0.0, 0.0};
    const auto k = static_cast<std::size_t>(i);
    const double before = 1.0 / (between[k] * apart(i)), after = 1.0 / (between[k + 1] * apart(i));
    return {before, -before - after, after};
}

BeltColumns BeltColumns::of(const std::vector<double>& borders) {
    BeltColumns columns;
    for (std::size_t k = 1; k < borders.size(); ++k)
        columns.width.push_back(borders[k] - borders[k - 1]);
    const auto& width = columns.width;
    columns.between.push_back(0.5 * width.front());
    for (std::size_t k = 1; k < width.size(); ++k)
        columns.between.push_back(0.5 * (width[k - 1] + width[k]));
    columns.between.push_back(0.5 * width.back());
    return columns;
}

BeltPath belt_path(const BeltRun& run, const BeltPathRequest& request) {
    BeltPath path;
    Ends ends{};
    Points obstacle;
    for (const RidgePoint& p : request.obstacle)
        obstacle.emplace_back(p.x, p.z + request.lift, p.surface);
    Points points = string_between_rollers(run, obstacle, ends);
    path.left = ends.left;
    path.right = ends.right;
    if (points.size() < 3) return path;
    std::vector<double> corners, turns;
    double s = 0.0, angle = direction(points[0], points[1]);
    path.left_angle = angle;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
        s += distance(points[k - 1], points[k]);
        const double next = direction(points[k], points[k + 1]);
        corners.push_back(s);
        turns.push_back(next - angle);
        angle = next;
    }
    path.right_angle = -angle;
    path.length = s + distance(points[points.size() - 2], points.back());

    // The grid's columns as far as contact is expected, then wider ones.
    const double half = 0.5 * request.cells;
    const auto column = [&](double x) {
        return static_cast<int>(std::floor(x / request.cell + half));
    };
    const int least = std::clamp(column(points[1].z() - request.margin), 0, request.cells - 1);
    const int most = std::clamp(column(points[points.size() - 2].z() + request.margin), least,
                                request.cells - 1);
    std::vector<double> fine;
    std::vector<int> cells;
    double start = 0.0;
    std::size_t piece = 0;  // of the string, from `start` on
    points.front().z() += request.half * std::sin(path.left_angle);
    points.back().z() -= request.half * std::sin(path.right_angle);
    const auto place = [&](double x) {  // along the path, of x on the work
        while (piece + 2 < points.size() && x > points[piece + 1].z()) {
            start += distance(points[piece], points[piece + 1]);
            ++piece;
        }
        const Eigen::Vector3d &from = points[piece], &to = points[piece + 1];
        return start + (x - from.z()) * distance(from, to) / (to.z() - from.z());
    };
    // A thick belt that leaves a roller steeply has a face that begins beyond it.
    const double begin =
        std::max(path.left + request.cell, points.front().z() + 0.5 * request.cell);
    const double end = std::min(path.right - request.cell, points.back().z() - 0.5 * request.cell);
    const double near = kHalved * request.bending + request.cell;
    const double touch = points[1].z(), leave = points[points.size() - 2].z();
    for (int c = least; c <= most; ++c) {
        const double low = (c - half) * request.cell, high = low + request.cell;
        if (low <= begin || high >= end) continue;
        const double from = place(low), to = place(high);
        const double middle = 0.5 * (low + high);
        const bool halved =
            request.halves && std::min(std::abs(middle - touch), std::abs(middle - leave)) < near;
        const double wanted =
            halved ? std::max(0.5 * request.cell, kFinest * request.bending) : request.cell;
        const int parts = std::max(1, static_cast<int>(std::lround((to - from) / wanted)));
        if (fine.empty()) fine.push_back(from);
        for (int k = 1; k <= parts; ++k) {
            fine.push_back(std::lerp(from, to, static_cast<double>(k) / parts));
            cells.push_back(c);
        }
    }
    if (fine.empty()) fine.push_back(0.5 * path.length);
    std::vector<double> borders = widening(fine.front(), 0.0, kGrowth * request.cell);
    std::reverse(borders.begin(), borders.end());
    path.cell.assign(borders.size(), -1);
    path.cell.insert(path.cell.end(), cells.begin(), cells.end());
    borders.insert(borders.end(), fine.begin(), fine.end());
    for (const double border : widening(fine.back(), path.length, kGrowth * request.cell))
        borders.push_back(border);
    path.cell.resize(borders.size() - 1, -1);
    path.columns = BeltColumns::of(borders);

    const std::vector<double> angles =
        rounded(borders, corners, turns, path.left_angle, request.bending);
    const std::size_t n = path.columns.width.size();
    double x = path.left, z = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double h = path.columns.width[i], middle = 0.5 * (angles[i] + angles[i + 1]);
        path.angle.push_back(middle);
        path.turn.push_back((angles[i + 1] - angles[i]) / h);
        const double quarter = 0.5 * (angles[i] + middle);  // half-way to the column's middle
        path.x.push_back(x + 0.5 * h * std::cos(quarter));
        path.z.push_back(z + 0.5 * h * std::sin(quarter));
        x += h * std::cos(middle);
        z += h * std::sin(middle);
    }
    // Rounding a corner shortens what is before and behind it by a little.
    for (std::size_t i = 0; i < n; ++i) {
        const double share = (borders[i] + borders[i + 1]) / (2.0 * path.length);
        path.x[i] += share * (path.right - x);
        path.z[i] -= share * z;
    }
    return path;
}

BeltPath straight_path(const BeltRun& run, double cell, int cells) {
    BeltPath path;
    path.left = -0.5 * run.length - run.position;
    path.right = 0.5 * run.length - run.position;
    path.length = run.length;
    std::vector<double> fine;
    std::vector<int> numbers;
    for (int c = 0; c < cells; ++c) {
        const double low = (c - 0.5 * cells) * cell;
        if (low <= path.left + cell || low + cell >= path.right - cell) continue;
        if (fine.empty()) fine.push_back(low);
        fine.push_back(low + cell);
        numbers.push_back(c);
    }
    const std::vector<double> borders =
        columns_between(path, std::move(fine), numbers, path.left, path.right, cell);
    const std::size_t n = path.columns.width.size();
    path.angle.assign(n, 0.0);
    path.turn.assign(n, 0.0);
    path.z.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) path.x.push_back(0.5 * (borders[i] + borders[i + 1]));
    return path;
}

BentPath bent_path(const BeltRun& run, const BeltArc& middle, double thickness, double cell,
                   int cells) {
    BentPath bent;
    BeltPath& path = bent.path;
    const double left = -0.5 * run.length - run.position;
    const double right = 0.5 * run.length - run.position;
    path.left = middle.x(left);
    path.right = middle.x(right);
    path.length = run.length;
    // Columns as long on the face as the grid's cells, as many as lie over all of them.
    const BeltArc face{middle.radius + 0.5 * thickness, middle.end};
    const double half = 0.5 * cells * cell;
    const int more = static_cast<int>(std::ceil((face.s(half) - half) / cell));
    const double shorter = middle.radius / face.radius;
    const auto place = [&](int border) {  // mm along the path
        const double s = (border - 0.5 * cells) * cell;
        const double on = std::clamp(s, -face.half_length(), face.half_length());
        return shorter * on + (s - on);
    };
    std::vector<double> fine;
    std::vector<int> numbers;
    for (int c = -more; c < cells + more; ++c) {
        if (place(c) <= left + cell || place(c + 1) >= right - cell) continue;
        if (fine.empty()) fine.push_back(place(c));
        fine.push_back(place(c + 1));
        numbers.push_back(static_cast<int>(numbers.size()));
    }
    bent.fine = static_cast<int>(numbers.size());
    const std::vector<double> borders =
        columns_between(path, std::move(fine), numbers, left, right, cell);
    bent.column = std::exchange(path.cell, std::vector<int>(path.cell.size(), -1));
    for (std::size_t i = 0; i < path.columns.width.size(); ++i) {
        const double s = 0.5 * (borders[i] + borders[i + 1]);
        const double x = middle.x(s);
        path.x.push_back(x);
        path.z.push_back(middle.behind(x));
        path.angle.push_back(middle.angle(s));
        path.turn.push_back((middle.angle(borders[i + 1]) - middle.angle(borders[i])) /
                            path.columns.width[i]);
        bent.on.push_back(std::abs(s) < middle.half_length() ? 1 : 0);
    }
    return bent;
}

}  // namespace beltgrinding
