#pragma once

namespace beltgrinding {

/// How a surface of the belt that touches nothing lies in the machine's plane y = 0: round an arc
/// whose middle is the contact frame's origin, and straight on along its tangents beyond the
/// platen's ends; or straight altogether.
struct BeltArc {
    double radius = 0.0;  ///< mm; 0: it is straight
    double end = 0.0;     ///< rad by which it has turned at the platen's ends

    bool flat() const { return radius == 0.0; }
    /// mm along the belt from the origin to where it leaves the platen.
    double half_length() const { return radius * end; }
    /// rad that it has turned by, `s` mm along the belt from the origin.
    double angle(double s) const;
    /// mm along the travel at `s`.
    double x(double s) const;
    /// mm along the belt at x: the inverse.
    double s(double x) const;
    /// mm that it lies behind the plane z = 0 of the contact frame at x.
    double behind(double x) const;
};

}  // namespace beltgrinding
