#pragma once

#include <string>
#include <utility>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/contact_wheel.h"

namespace beltgrinding {

/// An analytic rigid workpiece that the wheel meets at the origin of the contact frame (x along the
/// feed, y along the wheel's axis, z into the workpiece).
struct Workpiece {
    enum class Shape { kPlane, kCylinder, kSphere, kTorus, kStrip, kEdge };
    /// By its name: plane, cylinder, sphere, torus, strip or edge. Throws InputError for another.
    static Shape shape_named(const std::string& name);

    Shape shape = Shape::kPlane;
    double radius = 50.0;       ///< mm, of cylinder, sphere or the torus's tube; negative: concave
    double width = 10.0;        ///< mm, of the strip
    double axis_angle = 0.0;    ///< rad, of cylinder, tube, strip and edge about z; 0: along x
    double ring_radius = 50.0;  ///< mm, of the torus's tube about its middle; negative: inside it
    double edge = 0.0;          ///< mm across its axis, where the plane of an edge ends
    double tilt = 0.0;          ///< rad, of plane, strip or edge about x; positive: up towards +y

    /// Depth of the surface, mm (z), at (x, y); +inf where there is none. Strips and edges end
    /// where `ends` says, not here.
    double depth(double x, double y) const;
    /// Across its axis, mm: where the surface begins and ends; infinite where it does not.
    std::pair<double, double> ends() const;
    /// mm across its axis, of (x, y).
    double across(double x, double y) const;
    /// Throws InputError for dimensions that are none.
    void validate() const;
};

struct SingleContact {
    ContactWheel wheel;
    Workpiece workpiece;
    double spacing = 0.5;  ///< mm, wanted cell; across the wheel adjusted to divide its width
    bool force_control = true;
    double force = 50.0;      ///< N
    double approach = 0.0;    ///< mm, of the wheel's centre along z from first touch
    double tolerance = 1e-4;  ///< relative error of the pressure field, L1
};

struct SingleContactResult {
    ContactGrid grid;          ///< long enough for the whole footprint
    ContactSolution solution;  ///< `approach` from first touch, mm; all iterations
    Eigen::ArrayXd gap;        ///< mm, radial, with the wheel where it stands; +inf: nothing there
    Eigen::ArrayXd coverage;   ///< share of the cell that the workpiece covers
    double time = 0.0;         ///< s of all solves, without setting up the model
    std::string model;         ///< what the model says of itself as it was used
};

/// Presses a wheel on a workpiece. The gap is radial from the wheel where it stands when pressed:
/// the wheel is placed anew until what the solution asks of it beyond that is negligible. The grid
/// grows until the footprint does not reach its ends. Throws InputError.
SingleContactResult press(const SingleContact& contact, const ContactModel& model);

/// Stiffness (MPa/mm) of the elastic foundation that meets a plane under `force` (N) at the same
/// approach as `model` does. Its patch is still another: see docs/methods.md. `softest`: MPa/mm,
/// below what `model` can have; the grid is made to hold the contact of such a foundation.
double foundation_stiffness(const ContactWheel& wheel, const ContactModel& model, double force,
                            double softest);

}  // namespace beltgrinding
