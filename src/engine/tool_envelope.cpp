#include "engine/tool_envelope.h"
#include "belt/face_arc.h"

#include <algorithm>

namespace beltgrinding {
namespace {

// Share of the radius ahead of the wheel's centre: what lies behind cannot be in the contact.
constexpr double kAhead = 0.5;
// mm beyond the wheel's surface in which the gap is mapped: more than the approach may change
// between two placements of the wheel, and enough for whole cells around the contact.
constexpr double kMargin = 0.2;
// mm: below this change of approach the gap need not be mapped anew: what the approach does to it
// away from the wheel's middle is added to first order.
constexpr double kPlacement = 0.05;
// mm: a wheel so large that 200 mm of it lie within 5 um of a plane; larger ones lose the samples'
// places along the normal in single precision.
constexpr double kFlatRadius = 1e6;
// mm, the same two of a belt: it is soft, so that its approach changes more from pose to pose; and
// its gap is the same wherever it stands.
constexpr double kBeltMargin = 1.0;
constexpr double kBeltPlacement = 0.5;
// Share of the run's length that a belt may be pressed in: in its middle, its runs then stand at 45
// degrees.
constexpr double kDeepest = 0.5;

}  // namespace

ToolEnvelope tool_envelope(const ProcessSettings& process) {
    ToolEnvelope tool;
    tool.wheel = process.wheel;
    tool.margin = kMargin;
    tool.placement = kPlacement;
    if (!process.machine.free_face()) {
        tool.ahead = kAhead * tool.wheel.radius;
        tool.deepest = (1.0 - kAhead) * tool.wheel.radius;
        return tool;
    }
    const BeltRun& run = process.machine.run;
    tool.wheel = ContactWheel{kFlatRadius, process.machine.belt.width, 0.0};
    tool.flat = true;
    tool.face = face_arc(process.machine);
    tool.from = tool.face.x(-0.5 * run.length - run.position);
    tool.to = tool.face.x(0.5 * run.length - run.position);
    tool.deepest = kDeepest * run.length;
    tool.ahead = kFlatRadius - tool.deepest - process.force_travel -
                 std::max(tool.face.behind(tool.from), tool.face.behind(tool.to));
    tool.margin = kBeltMargin;
    tool.placement = kBeltPlacement;
    return tool;
}

}  // namespace beltgrinding
