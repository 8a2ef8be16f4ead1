#include "beltgrinding/event.h"

#include <array>
#include <stdexcept>

namespace beltgrinding {
namespace {

constexpr Severity kInfo = Severity::kInfo, kWarning = Severity::kWarning,
                   kError = Severity::kError;
constexpr bool kLarger = true, kSmaller = false;

constexpr std::array kKinds = {
    EventKind{"loss_of_contact", kWarning, "mm", kLarger,
              "within a pass the wheel or belt runs over the work without touching it; the value "
              "is how far",
              "move the poses towards the work there, or enlarge the travel of the force control"},
    EventKind{"force_not_reached", kWarning, "N", kSmaller,
              "the force control is at the end of its travel and presses less than commanded",
              "move the pose towards the work, or enlarge the travel of the force control"},
    EventKind{"force_exceeded", kWarning, "N", kLarger,
              "the force control is at the end of its travel and presses more than commanded",
              "move the pose away from the work, or enlarge the travel of the force control"},
    EventKind{
        "force_overshoot", kWarning, "N", kLarger,
        "the force control takes time, and presses more than commanded by a larger share than "
        "stated: on the way up a rib or an edge, or when the wheel or belt meets the work",
        "lower the feed there, or take a lighter or a better damped force control; let the pass "
        "begin and end away from edges, with less force"},
    EventKind{"bounces", kWarning, "s", kLarger,
              "the wheel or belt leaves the work and comes back to it within a short time, by the "
              "motion of the force control; the value is how long it was off",
              "lower the feed there, or take a lighter or a better damped force control"},
    EventKind{"over_pressure", kWarning, "MPa", kLarger,
              "the pressure exceeds the limit that the process law has",
              "lower the force, take a softer or a wider wheel, or a wider belt, or lead it over "
              "the edge more gently"},
    EventKind{"edge_contact", kWarning, "%", kLarger,
              "the wheel or belt presses with its side edge; the value is the share of the force "
              "that the outer tenth of the width carries there",
              "turn the wheel's axis, or the belt's breadth, parallel to the surface, shift it "
              "sideways, or take a crowned wheel"},
    EventKind{"wheel_too_large", kWarning, "mm", kSmaller,
              "the surface is hollow and the wheel or belt spans it: it rests on both sides and "
              "does not touch between; the value is the surface's radius",
              "take a smaller wheel, or one with a stronger crown; across the width, a narrower "
              "wheel or belt; along a belt, a wheel that fits into the hollow"},
    EventKind{"tilted_contact", kWarning, "deg", kLarger,
              "the wheel touches far round its rim, or a belt far round a curved platen, from the "
              "programmed contact point, so that the pressing direction is not the surface's "
              "normal",
              "turn the pose so that its z axis points against the surface's normal"},
    EventKind{
        "burn_risk", kError, "MPa m/s", kLarger,
        "pressure times belt speed exceeds the limit of heat; or, in °C, the temperature exceeds "
        "the material's limit",
        "lower the force or the belt speed, raise the feed, or let the part cool between passes"},
    EventKind{"law_out_of_range", kWarning, "", kLarger,
              "the process law is asked for what was not measured; its last value is used",
              "come back into the measured range, or measure there and calibrate again"},
    EventKind{"belt_out_of_range", kWarning, "J", kLarger,
              "the belt has done more than its wear was measured for",
              "change the belt, or measure its wear further"},
    EventKind{"gouge", kError, "mm", kSmaller,
              "the motion grinds samples below the lower limit of their tolerance that were within "
              "it before",
              "lower force or dwell there, raise the feed, or lead the pass elsewhere"},
    EventKind{"depth_exceeded", kError, "mm", kSmaller,
              "the motion grinds deeper below the design than the height segments reach",
              "correct the pose; if it is meant, raise sampling.depth_mm"},
    EventKind{"orientation_jump", kWarning, "deg", kLarger,
              "two neighbouring poses of a feed motion are turned far against each other",
              "put poses between them, check the angles of the pose, or choose another roll where "
              "the program gives tool axes only"},
    EventKind{"program_gap", kWarning, "", kLarger,
              "motions of the program before this pose are left out, since they are not known: the "
              "way to it is taken as a positioning move, and nothing is ground on it",
              "the program's warnings say what is not known, and in which line; give it, or split "
              "the program there"},
    EventKind{"collision", kError, "mm", kSmaller, "two bodies of the cell run into each other",
              "retract further, approach from another side, or move the body"},
    EventKind{"near_miss", kWarning, "mm", kSmaller,
              "two bodies of the cell come nearer than the clearance that the cell asks for; the "
              "value is their distance",
              "keep further away, or lower cell.clearance_mm if it is meant"},
    EventKind{"out_of_reach", kError, "mm", kLarger,
              "no joint angles put the tool there; the value is what is missing",
              "move part or robot, or turn the tool about an axis that is free"},
    EventKind{"joint_limit", kError, "deg", kLarger,
              "a joint lies beyond its limit; the value is how far",
              "begin in another configuration, or unwind between passes by a PTP motion"},
    EventKind{"singularity", kWarning, "deg", kSmaller,
              "the robot is near a singularity, where joints turn fast",
              "tilt the tool a few degrees, or move the part"},
    EventKind{"wrist_flip", kError, "deg", kLarger,
              "joints 4 and 6 turn by some half a turn within a step",
              "keep clear of the wrist singularity, or put a PTP motion there"},
    EventKind{"arm_flip", kError, "deg", kLarger,
              "a joint of the arm (1 to 3) turns far within a step",
              "keep clear of the singularity, or put a PTP motion there"},
    EventKind{"joint_speed", kWarning, "times", kLarger,
              "the feed needs more of a joint than it has, so that the robot is slower and grinds "
              "deeper there; the value is how many times its greatest speed",
              "lower the feed there, or keep clear of the singularity"},
    EventKind{"over_compressed", kWarning, "mm", kLarger,
              "the wheel is pressed in further than its elastic rim is thick, or than half its "
              "radius, or a belt further than a platen's layers are thick, or than half its free "
              "length: no contact model holds there",
              "lower the force, or move the pose away from the work; check Young's modulus and the "
              "unit of the force"},
    EventKind{
        "step_too_coarse", kWarning, "mm", kLarger,
        "the wheel or belt follows the surface, and more than it is pressed in by is ground at one "
        "place before it moves on, even with the step cut smaller; the value is how much",
        "lower simulation.max_travel_mm; or raise the feed, lower the force or the law's "
        "coefficient, if one of them is a mistake"},
    EventKind{
        "volume_lost", kWarning, "mm3", kLarger,
        "less is ground than the law takes under the pressure: no sample has it, since the wheel's "
        "own surface stands in the way, or the samples are too coarse for the part's form there; "
        "the value is how much on the whole path",
        "lower sampling.spacing_mm; or the force or the law's coefficient, if it is a mistake"},
    EventKind{"not_converged", kWarning, "iterations", kLarger,
              "the contact was not solved to the tolerance asked for",
              "refine the contact grid, or raise belt_machine.contact_tolerance"},
    EventKind{
        "roughness_exceeded", kError, "um", kLarger,
        "a zone is rougher than it calls for; the value is the Ra at the worst place",
        "grind the zone once more with a finer grit, or at pressure, speed and feed that left "
        "less in the measurements"},
    EventKind{"wrong_lay", kError, "%", kLarger,
              "in a zone the scratches run otherwise than it calls for; the value is on what share "
              "of its area",
              "lead the last pass over the zone so that the belt travels as is called for; crossed "
              "scratches take a pass across the one before, others none"},
    EventKind{"finish_unknown", kWarning, "%", kLarger,
              "whether a zone has the roughness or the lay that it calls for is not known; the "
              "value is on what share of its area, the limit what may be unknown",
              "grind all of the zone, within what was measured; or measure further and fit again, "
              "or give Ra before grinding"},
};

}  // namespace

std::span<const EventKind> event_kinds() {
    return kKinds;
}

const EventKind& event_kind(const std::string& code) {
    for (const EventKind& kind : kKinds) {
        if (code == kind.code) return kind;
    }
    throw std::logic_error("there is no kind of event '" + code + "'");
}

const char* name(Severity severity) {
    return severity == kInfo ? "info" : severity == kWarning ? "warning" : "error";
}

}  // namespace beltgrinding
