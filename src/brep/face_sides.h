#pragma once

// Private to this room: which side of loose faces is outside.

#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <vector>

#include "beltgrinding/run_context.h"

namespace beltgrinding {

/// A border that two faces have in common: an edge, or free edges that lie on each other.
struct FaceBorder {
    std::uint32_t a = 0, b = 0;  ///< faces, from 0, a < b
    double length = 0;           ///< mm
    bool alike = true;           ///< as oriented, both have the same side outside
    bool judged = true;          ///< false where more than two faces meet: `alike` says nothing
};

struct FaceSides {
    std::vector<char> turned;          ///< by face: its outside is against its orientation
    std::vector<char> doubtful;        ///< by face: which side is outside cannot be told
    std::vector<FaceBorder> contrary;  ///< borders at which no choice of sides fits
};

/// All common borders of the faces of `meshed`, which carries its triangulation, longest first;
/// free edges count as one where they are nearer than `tolerance` mm.
std::vector<FaceBorder> common_borders(const TopoDS_Shape& meshed, double tolerance);

/// Which side of the faces with `loose` set is outside. Borders tell it for neighbours against each
/// other: their boundary runs along a common edge in opposite ways. For what hangs together then
/// generalised winding numbers do (Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside
/// segmentation using generalized winding numbers, ACM Trans. Graph. 32, 2013): on the outer side
/// that of all loose faces is 0, on the inner side 1, as far as they close. Where faces agree with
/// their neighbours as they are given, nothing is turned unless they close; where nothing tells,
/// most of the area stays as it is given. Throws Cancelled.
FaceSides face_sides(const TopoDS_Shape& meshed, const std::vector<char>& loose,
                     const std::vector<FaceBorder>& borders, const RunContext& context);

}  // namespace beltgrinding
