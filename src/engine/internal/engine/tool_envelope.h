#pragma once

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/simulation_options.h"
#include "contact/belt_arc.h"

namespace beltgrinding {

/// What the surface is mapped for: where a tool lies that touches nothing, and how far from there
/// it may be pressed in. Lengths in mm.
struct ToolEnvelope {
    ContactWheel wheel;    ///< its surface; a belt's is a plane, which the largest of wheels has
    bool flat = false;     ///< it is a belt's
    double from = 0.0;     ///< flat: along the travel from the contact frame's origin, where the
    double to = 0.0;       ///< belt's free run begins and ends
    BeltArc face;          ///< flat: how the belt's face lies, before and behind such a plane
    double ahead = 0.0;    ///< from the axis: what lies behind cannot be in the contact
    double deepest = 0.0;  ///< it is looked at no deeper than that
    double margin = 0.0;   ///< beyond its surface in which the gap is mapped
    /// Change of approach up to which the gap need not be mapped anew.
    double placement = 0.0;
};
ToolEnvelope tool_envelope(const ProcessSettings& process);

}  // namespace beltgrinding
