#include "models/single_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/stopwatch.h"
#include "beltgrinding/error.h"
#include "contact/coverage.h"
#include "contact/wheel_grid.h"
#include "elastic/compliance.h"

namespace beltgrinding {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFirstCells = 48;  // along the circumference
constexpr int kMaxCells = 4096;
constexpr int kMaxPlacements = 30;
constexpr double kPlaced = 1e-5;          // mm that the wheel may still be off its place
constexpr double kLargestTilt = 0.5;      // rad
constexpr double kLargestAngle = 1.2;     // rad; farther round the wheel nothing touches
constexpr double kCellsPerRadius = 20.0;  // at least, along the circumference
constexpr double kCellsPerContact = 64.0;

/// Radius at which the ray from the wheel's centre (moved by `placed` along z) at the angle s / R
/// meets the workpiece, mm; +inf if it does not.
double meet(const SingleContact& contact, double placed, double s, double y) {
    const double radius = contact.wheel.radius, angle = s / radius;
    if (std::abs(angle) > kLargestAngle) return kInfinity;
    double r = radius;
    for (int i = 0; i < 20; ++i) {
        const double depth = contact.workpiece.depth(r * std::sin(angle), y);
        if (!std::isfinite(depth)) return kInfinity;
        const double next = (radius - placed + depth) / std::cos(angle);
        if (std::abs(next - r) < 1e-12 * radius) return next;
        r = next;
    }
    return r;
}

class Press {
  public:
    Press(const SingleContact& contact, const ContactModel& model)
        : contact_(contact), model_(model) {}

    SingleContactResult run() {
        if (model_.rigid())
            throw InputError("contact.rigid_pressure", "contact: a rigid tool has no pressure");
        contact_.wheel.validate();
        contact_.workpiece.validate();
        if (!std::isfinite(contact_.spacing) || contact_.spacing <= 0.0) {
            throw InputError("contact.spacing",
                             "contact: the grid's spacing must be positive, in millimetres");
        }
        const double across = std::round(contact_.wheel.width / contact_.spacing);
        grid_.ny = static_cast<int>(std::clamp(across, 1.0, 1.0 * kMaxCells));
        grid_.dy = contact_.wheel.width / grid_.ny;
        grid_.ds = std::min(contact_.spacing, contact_.wheel.radius / kCellsPerRadius);
        problem_.tolerance = contact_.tolerance;
        problem_.force = contact_.force;
        const double round = 2.0 * kLargestAngle * contact_.wheel.radius / grid_.ds;
        const int most = static_cast<int>(std::min(round, 1.0 * kMaxCells));
        for (int nx = kFirstCells;; nx *= 2) {
            grid_.nx = std::min(nx, most);
            // An edge can lie beyond the first grids.
            const std::optional<SingleContactResult> result = press();
            if (result && (grid_.nx == most || !reaches_ends(*result))) return *result;
            if (grid_.nx == most)
                throw InputError("contact.none", "contact: the wheel meets the workpiece nowhere");
        }
    }

  private:
    /// Gap, coverage of every cell with the wheel's centre at `placed`.
    void set_gap(double placed) {
        covered_.clear(grid_.cells());
        problem_.gap.setConstant(grid_.cells(), kInfinity);
        for (int j = 0; j < grid_.ny; ++j)
            for (int i = 0; i < grid_.nx; ++i) cover(placed, i, j);
        covered_.merge_slivers(grid_);
        for (int j = 0; j < grid_.ny; ++j) {
            for (int i = 0; i < grid_.nx; ++i) {
                const int cell = j * grid_.nx + i;
                if (covered_.share[cell] <= 0.0) continue;
                const double s = grid_.s(i) + covered_.along[cell] * grid_.ds;
                const double y = grid_.y(j) + covered_.across[cell] * grid_.dy;
                problem_.gap[cell] =
                    meet(contact_, placed, s, y) - (contact_.wheel.radius - contact_.wheel.drop(y));
            }
        }
        problem_.drop = profile_drop(contact_.wheel, grid_);
        problem_.coverage = covered_.share;
    }
    /// A place of the unmoved wheel: its gap, and where across the workpiece's axis it lies, mm.
    struct Place {
        double s, y, gap, at;
    };
    Place place(double s, double y) const {
        const double r = meet(contact_, 0.0, s, y);
        if (!std::isfinite(r)) return {s, y, kInfinity, kInfinity};
        return {s, y, r - (contact_.wheel.radius - contact_.wheel.drop(y)),
                contact_.workpiece.across(r * std::sin(s / contact_.wheel.radius), y)};
    }
    /// The smallest gap on the workpiece between two places that are half a cell apart: of its ends
    /// where one lies between them, else of `to`.
    double gap_between(const Place& from, const Place& to) const {
        const auto [low, high] = contact_.workpiece.ends();
        double least = to.at >= low && to.at <= high ? to.gap : kInfinity;
        for (const double end : {low, high}) {
            if (!std::isfinite(end + from.at + to.at) || (from.at < end) == (to.at < end)) continue;
            const double share = (end - from.at) / (to.at - from.at);
            const Place on_end =
                place(from.s + share * (to.s - from.s), from.y + share * (to.y - from.y));
            least = std::min(least, on_end.gap);
        }
        return least;
    }
    /// Where the wheel's centre is when it touches first, mm: by the middles and borders of cells,
    /// and the workpiece's ends between them.
    double first_touch() const {
        double least = kInfinity;
        const double half = 0.5 * contact_.wheel.width;
        std::vector<Place> before;
        for (int j = 0; j <= 2 * grid_.ny; ++j) {
            std::vector<Place> row;
            for (int i = 0; i <= 2 * grid_.nx; ++i) {
                row.push_back(place(grid_.s(0) + 0.5 * (i - 1) * grid_.ds,
                                    std::min(j * 0.5 * grid_.dy - half, half)));
                const Place& last = row.back();
                least = std::min(least, gap_between(i > 0 ? row[row.size() - 2] : last, last));
                if (j > 0)
                    least = std::min(least, gap_between(before[static_cast<std::size_t>(i)], last));
            }
            before = std::move(row);
        }
        return least;
    }
    /// What of the cell lies between the workpiece's ends: a polygon that each of them cuts.
    void cover(double placed, int i, int j) {
        const double s = grid_.s(i), y = grid_.y(j);
        const double middle = meet(contact_, placed, s, y);
        if (!std::isfinite(middle)) return;
        std::vector<Eigen::Vector2d> part{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
        const std::pair<double, double> ends = contact_.workpiece.ends();
        // mm from the middle, across the workpiece's axis; the wheel is straight over a cell.
        const double x = middle * std::sin(s / contact_.wheel.radius);
        const double at = contact_.workpiece.across(x, y);
        const double by_s = contact_.workpiece.across(grid_.ds * x_per_arc(placed, s, y), 0.0);
        const double by_y = contact_.workpiece.across(0.0, grid_.dy);
        if (std::isfinite(ends.second))
            part = cut(part, [&](const Eigen::Vector2d& p) {
                return ends.second - at - by_s * p.x() - by_y * p.y();
            });
        if (std::isfinite(ends.first))
            part = cut(part, [&](const Eigen::Vector2d& p) {
                return at + by_s * p.x() + by_y * p.y() - ends.first;
            });
        double area = 0.0;
        Eigen::Vector2d moment = Eigen::Vector2d::Zero();
        for (std::size_t k = 1; k + 1 < part.size(); ++k) {
            const Eigen::Vector2d u = part[k] - part[0], v = part[k + 1] - part[0];
            const double triangle = 0.5 * (u.x() * v.y() - u.y() * v.x());
            area += triangle;
            moment += triangle / 3.0 * (part[0] + part[k] + part[k + 1]);
        }
        if (!(area > 0.0)) return;
        const int cell = j * grid_.nx + i;
        covered_.share[cell] = area;
        covered_.along[cell] = moment.x() / area;
        covered_.across[cell] = moment.y() / area;
    }
    /// mm along x for a mm round the wheel.
    double x_per_arc(double placed, double s, double y) const {
        const auto x = [&](double at) {
            return meet(contact_, placed, at, y) * std::sin(at / contact_.wheel.radius);
        };
        const double before = x(s - 0.5 * grid_.ds), after = x(s + 0.5 * grid_.ds);
        return std::isfinite(after - before) ? (after - before) / grid_.ds : 1.0;
    }
    /// What of the polygon has `inside` above 0 (Sutherland and Hodgman, Comm. ACM 17, 1974).
    template <class Inside>
    static std::vector<Eigen::Vector2d> cut(const std::vector<Eigen::Vector2d>& polygon,
                                            Inside inside) {
        std::vector<Eigen::Vector2d> result;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Eigen::Vector2d &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
            const double a = inside(from), b = inside(to);
            if (a >= 0.0) result.push_back(from);
            if ((a >= 0.0) != (b >= 0.0)) result.push_back(from + a / (a - b) * (to - from));
        }
        return result;
    }

    /// None where the wheel meets nothing within the grid.
    std::optional<SingleContactResult> press() {
        const double touch = first_touch();
        if (!std::isfinite(touch)) return {};
        const auto prepared = model_.prepare(grid_);
        SingleContactResult result;
        result.grid = grid_;
        result.model = prepared->describe();
        problem_.force_control = contact_.force_control;
        double placed = touch;
        if (!contact_.force_control) {
            placed += contact_.approach;
            problem_.approach = 0.0;
        }
        Eigen::ArrayXd start;
        int iterations = 0;
        for (int k = 0; k < kMaxPlacements; ++k) {
            set_gap(placed);
            if (!(problem_.coverage > 0.0).any()) return {};  // it lies between two cells
            {
                const Stopwatch watch(result.time);
                result.solution = prepared->solve(problem_, start.size() > 0 ? &start : nullptr);
            }
            iterations += result.solution.iterations;
            if (!contact_.force_control) break;
            placed += result.solution.approach;
            start = result.solution.pressure;
            if (std::abs(result.solution.approach) < kPlaced) break;
        }
        result.gap = problem_.gap;
        result.coverage = problem_.coverage;
        result.solution.approach = placed - touch;
        result.solution.iterations = iterations;
        return result;
    }

    bool reaches_ends(const SingleContactResult& result) const {
        const ContactGrid& grid = result.grid;
        for (int j = 0; j < grid.ny; ++j) {
            for (const int i : {0, 1, grid.nx - 2, grid.nx - 1}) {
                if (result.solution.pressure[j * grid.nx + i] > 0.0) return true;
            }
        }
        return false;
    }

    const SingleContact& contact_;
    const ContactModel& model_;
    ContactGrid grid_;
    ContactProblem problem_;
    Coverage covered_;
};

}  // namespace

Workpiece::Shape Workpiece::shape_named(const std::string& name) {
    if (name == "plane") return Shape::kPlane;
    if (name == "cylinder") return Shape::kCylinder;
    if (name == "sphere") return Shape::kSphere;
    if (name == "torus") return Shape::kTorus;
    if (name == "strip") return Shape::kStrip;
    if (name == "edge") return Shape::kEdge;
    throw InputError("call.workpiece",
                     "workpiece: there is no shape '{name}'; use plane, cylinder, sphere, torus, "
                     "strip or edge",
                     {{"name", name}});
}

double Workpiece::across(double x, double y) const {
    return -x * std::sin(axis_angle) + y * std::cos(axis_angle);
}

std::pair<double, double> Workpiece::ends() const {
    if (shape == Shape::kStrip) return {-0.5 * width, 0.5 * width};
    return {-kInfinity, shape == Shape::kEdge ? edge : kInfinity};
}

double Workpiece::depth(double x, double y) const {
    const double c = across(x, y);
    const auto round = [&](double square) {
        const double r2 = radius * radius;
        if (square > r2) return kInfinity;
        return std::copysign(std::abs(radius) - std::sqrt(r2 - square), radius);
    };
    switch (shape) {
        case Shape::kPlane:
        case Shape::kStrip:
        case Shape::kEdge:
            return -y * std::tan(tilt);
        case Shape::kCylinder:
            return round(c * c);
        case Shape::kSphere:
            return round(x * x + y * y);
        case Shape::kTorus: {
            const double along = x * std::cos(axis_angle) + y * std::sin(axis_angle);
            const double crest = ring_radius + radius;
            const double tube = ring_radius + radius - round(c * c);
            const double square = tube * tube - along * along;
            if (!std::isfinite(tube) || square < 0.0) return kInfinity;
            return crest - std::copysign(std::sqrt(square), crest);
        }
    }
    return kInfinity;
}

void Workpiece::validate() const {
    const bool round =
        shape == Shape::kCylinder || shape == Shape::kSphere || shape == Shape::kTorus;
    if (round && (!std::isfinite(radius) || radius == 0.0)) {
        throw InputError("contact.workpiece_radius",
                         "workpiece: the radius must not be zero, in millimetres");
    }
    if (shape == Shape::kTorus &&
        (!std::isfinite(ring_radius) || std::abs(ring_radius) <= std::abs(radius))) {
        throw InputError("contact.ring_radius",
                         "workpiece: a torus's ring radius must be larger than that of its tube");
    }
    if (shape == Shape::kStrip && (!std::isfinite(width) || width <= 0.0)) {
        throw InputError("contact.strip_width",
                         "workpiece: the strip's width must be positive, in millimetres");
    }
    if (!std::isfinite(edge))
        throw InputError("contact.edge", "workpiece: the place of the edge is no number");
    const bool flat = shape == Shape::kPlane || shape == Shape::kStrip || shape == Shape::kEdge;
    if (!(std::abs(tilt) <= kLargestTilt) || (tilt != 0.0 && !flat)) {
        throw InputError("contact.tilt",
                         "workpiece: planes, strips and edges can be tilted, by less than "
                         "{largest:.0f} degrees",
                         {{"largest", kLargestTilt * 180.0 / M_PI}});
    }
    if (!std::isfinite(axis_angle))
        throw InputError("contact.axis_angle", "workpiece: the axis angle is no number");
}

double foundation_stiffness(const ContactWheel& wheel, const ContactModel& model, double force,
                            double softest) {
    // A Winkler layer on a plane: F = 2/3 k w a^3 / R (Johnson, Contact Mechanics, 4.3).
    const double half_length = std::cbrt(1.5 * force * wheel.radius / (wheel.width * softest));
    SingleContact contact;
    contact.wheel = wheel;
    contact.spacing =
        std::max({0.5, wheel.width / kCellsPerContact, 2.0 * half_length / kCellsPerContact});
    contact.force = force;
    contact.tolerance = 1e-3;
    contact.approach = press(contact, model).solution.approach;
    contact.force_control = false;
    const ElasticFoundation unit(1.0);  // whose force is proportional to its stiffness
    return force / press(contact, unit).solution.force;
}

SingleContactResult press(const SingleContact& contact, const ContactModel& model) {
    return Press(contact, model).run();
}

}  // namespace beltgrinding
