#include "contact/single_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stopwatch.h"
#include "beltgrinding/error.h"
#include "contact/compliance.h"

namespace beltgrinding {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFirstCells = 48;  // along the circumference
constexpr int kMaxCells = 4096;
constexpr int kMaxPlacements = 30;
constexpr double kPlaced = 1e-5;          // mm that the wheel may still be off its place
constexpr int kPointsPerSide = 8;         // of a cell, for the share that the workpiece covers
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
            SingleContactResult result = press();
            if (grid_.nx == most || !reaches_ends(result)) return result;
        }
    }

  private:
    /// Gap, coverage of every cell with the wheel's centre at `placed`.
    void set_gap(double placed) {
        problem_.gap.resize(grid_.cells());
        problem_.coverage.resize(grid_.cells());
        for (int j = 0; j < grid_.ny; ++j) {
            for (int i = 0; i < grid_.nx; ++i) set_cell(placed, i, j);
        }
    }
    void set_cell(double placed, int i, int j) {
        double gap = 0.0;
        int covered = 0;
        const auto look = [&](double s, double y) {
            const double r = meet(contact_, placed, s, y);
            if (!std::isfinite(r)) return;
            gap += r - (contact_.wheel.radius - contact_.wheel.drop(y));
            ++covered;
        };
        int points = 1;
        if (contact_.workpiece.shape != Workpiece::Shape::kStrip) {
            look(grid_.s(i), grid_.y(j));
        } else {
            points = kPointsPerSide * kPointsPerSide;
            for (int p = 0; p < points; ++p) {
                const int column = p % kPointsPerSide, row = p / kPointsPerSide;
                const double u = (column + 0.5) / kPointsPerSide - 0.5;
                const double v = (row + 0.5) / kPointsPerSide - 0.5;
                look(grid_.s(i) + u * grid_.ds, grid_.y(j) + v * grid_.dy);
            }
        }
        const int cell = j * grid_.nx + i;
        problem_.gap[cell] = covered > 0 ? gap / covered : kInfinity;
        problem_.coverage[cell] = static_cast<double>(covered) / points;
    }

    SingleContactResult press() {
        const auto prepared = model_.prepare(grid_);
        set_gap(0.0);
        const double touch = problem_.gap.minCoeff();
        if (!std::isfinite(touch))
            throw InputError("contact.none", "contact: the wheel meets the workpiece nowhere");
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
};

}  // namespace

Workpiece::Shape Workpiece::shape_named(const std::string& name) {
    if (name == "plane") return Shape::kPlane;
    if (name == "cylinder") return Shape::kCylinder;
    if (name == "sphere") return Shape::kSphere;
    if (name == "strip") return Shape::kStrip;
    throw InputError("call.workpiece",
                     "workpiece: there is no shape '{name}'; use plane, cylinder, sphere or strip",
                     {{"name", name}});
}

double Workpiece::depth(double x, double y) const {
    const double across = -x * std::sin(axis_angle) + y * std::cos(axis_angle);
    const auto round = [&](double square) {
        const double r2 = radius * radius;
        if (square > r2) return kInfinity;
        return std::copysign(std::abs(radius) - std::sqrt(r2 - square), radius);
    };
    switch (shape) {
        case Shape::kPlane:
            return 0.0;
        case Shape::kCylinder:
            return round(across * across);
        case Shape::kSphere:
            return round(x * x + y * y);
        case Shape::kStrip:
            return std::abs(across) <= 0.5 * width ? 0.0 : kInfinity;
    }
    return kInfinity;
}

void Workpiece::validate() const {
    const bool round = shape == Shape::kCylinder || shape == Shape::kSphere;
    if (round && (!std::isfinite(radius) || radius == 0.0)) {
        throw InputError("contact.workpiece_radius",
                         "workpiece: the radius must not be zero, in millimetres");
    }
    if (shape == Shape::kStrip && (!std::isfinite(width) || width <= 0.0)) {
        throw InputError("contact.strip_width",
                         "workpiece: the strip's width must be positive, in millimetres");
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
