// How the tool is pressed: too far, more than a step can follow; how the pressure lies across it:
// uneven, on an edge, round a hollow.

#include <algorithm>
#include <array>
#include <cmath>

#include "event_recorder.h"

namespace beltgrinding {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr std::size_t kPause = 4;  // steps: noise at a threshold makes one event, not many
// Share of an even distribution that the outermost cells must carry to be pressed: below, it is the
// last of a pressure that fades out before the edge.
constexpr double kPressedEdge = 0.25;
constexpr double kOuterShare = 0.1;  // of the width: what the edge's load is told for
// Times the even share: what carries no more is in use like the rest of the width, as of a cylinder
// on a plane, and all is well.
constexpr double kEven = 1.5;
constexpr int kHollowCells = 2;  // that are not touched between touched ones, at least
// By how much more than the rim a hollow must turn: a share of the rim's turn; rad where the rim is
// straight.
constexpr double kHollow = 0.02;
constexpr double kSlopeReach = 2.0;  // cells over whose samples a slope is averaged

/// A row of cells without pressure between two that are pressed, along the rim or across it.
struct OpenRow {
    int line = 0, begin = 0, end = 0;  ///< the pressed cells at its ends
    int cells() const { return end - begin - 1; }
};

OpenRow longest_open(const Eigen::ArrayXd& pressure, const ContactGrid& grid, bool across) {
    const int lines = across ? grid.nx : grid.ny, cells = across ? grid.ny : grid.nx;
    OpenRow longest{0, 0, 1};
    for (int line = 0; line < lines; ++line) {
        int last = -1;  // pressed; -1: none yet
        for (int cell = 0; cell < cells; ++cell) {
            const int k = across ? cell * grid.nx + line : line * grid.nx + cell;
            if (!(pressure[k] > 0.0)) continue;
            if (const OpenRow open{line, last, cell}; last >= 0 && open.cells() > longest.cells())
                longest = open;
            last = cell;
        }
    }
    return longest;
}

Fact hollow_fact(bool belt, bool across, const Arguments& arguments) {
    if (belt && across)
        return {"event.belt_hollow_across",
                "across the belt, the surface is hollow with a radius of about "
                "{radius:.3g} mm: the belt spans {span:.3g} mm without touching",
                arguments};
    if (belt)
        return {"event.belt_hollow_along",
                "along its travel, the belt spans {span:.3g} mm without touching, where "
                "the surface is hollow with a radius of about {radius:.3g} mm",
                arguments};
    if (across)
        return {"event.hollow_across",
                "across the wheel, the surface is hollow with a radius of about "
                "{radius:.3g} mm: the wheel spans {span:.3g} mm without touching",
                arguments};
    return {"event.hollow_along",
            "along the belt, the surface is hollow with a radius of about "
            "{radius:.3g} mm: the wheel spans {span:.3g} mm without touching",
            arguments};
}

}  // namespace

void EventRecorder::note_compression(std::size_t index, const Pressing& pressing,
                                     Pressing::State state) {
    const double depth = pressing.indentation(), most = pressing.largest_indentation();
    const bool stopped = state == Pressing::State::kOverCompressed;
    if (!stopped && !(depth > most)) return;
    Event* event = note("over_compressed", index, depth);
    if (event == nullptr) return;
    event->limit = most;
    const Arguments held = {
        {"commanded", steps_[index].force}, {"limit", most}, {"force", pressing.solution().force}};
    const Arguments deep = {{"depth", depth}, {"limit", most}};
    if (stopped && pressing.flat()) {
        event->facts = {{"event.force_over_compresses_belt",
                         "{commanded:.3g} N would press the belt in by more than the {limit:.3g} "
                         "mm that it can yield: it is held there, at {force:.3g} N",
                         held}};
    } else if (stopped) {
        event->facts = {{"event.force_over_compresses",
                         "{commanded:.3g} N would press the wheel in by more than the {limit:.3g} "
                         "mm that it can yield: it is held there, at {force:.3g} N",
                         held}};
    } else if (pressing.flat()) {
        event->facts = {
            {"event.belt_over_compressed",
             "the belt is pressed in by {depth:.3g} mm, more than the {limit:.3g} mm "
             "that it can yield: what the contact model says there is not to be trusted",
             deep}};
    } else {
        event->facts = {
            {"event.over_compressed",
             "the wheel is pressed in by {depth:.3g} mm, more than the {limit:.3g} mm "
             "that it can yield: what the contact model says there is not to be trusted",
             deep}};
    }
    put(*event, pressing, 0.0, 0.0);
}

void EventRecorder::coarse(const Touch& touch) {
    const auto& [pressing, state, belt, removal, most, parts] = touch;
    const std::size_t index = steps_.size() - 1;
    Event* event = note("step_too_coarse", index, removal);
    if (event == nullptr) return;
    event->limit = most;
    const Arguments arguments = {{"removal", removal}, {"limit", most}, {"parts", parts}};
    if (pressing.flat()) {
        event->facts = {
            {"event.belt_step_too_coarse",
             "the law takes {removal:.3g} mm while the belt stands at one place, more than the "
             "{limit:.3g} mm that it is pressed in by, in a step cut into {parts}; more parts are "
             "not tried: the heights are bounded by the belt's face, and not resolved in time",
             arguments}};
    } else {
        event->facts = {
            {"event.step_too_coarse",
             "the law takes {removal:.3g} mm while the wheel stands at one place, more than "
             "the {limit:.3g} mm that it is pressed in by, in a step cut into {parts}; more parts "
             "are not tried: the heights are bounded by the wheel's envelope, and not resolved in "
             "time",
             arguments}};
    }
    put(*event, pressing, 0.0, 0.0);
}

void EventRecorder::note_distribution(std::size_t index, const Pressing& pressing) {
    const ContactSolution& contact = pressing.solution();
    const GapMap& map = pressing.map();
    const ContactGrid& grid = map.grid();
    std::vector<double> by_column(static_cast<std::size_t>(grid.ny), 0.0);  // share of the force
    double centre = 0.0, total = 0.0;
    for (int j = 0; j < grid.ny; ++j) {
        const auto row = Eigen::seqN(j * grid.nx, grid.nx);
        const Eigen::ArrayXd force = contact.pressure(row) * map.coverage()(row);
        const double sum = force.sum();
        if (!(sum > 0.0)) continue;
        by_column[static_cast<std::size_t>(j)] = sum;
        total += sum;
        centre +=
            (force * Eigen::ArrayXd::LinSpaced(grid.nx, grid.s(0), grid.s(grid.nx - 1))).sum();
    }
    if (!(total > 0.0)) return;
    for (double& share : by_column) share /= total;
    centre /= total;
    note_edges(index, pressing, by_column);
    const BeltArc& face = pressing.tool().face;  // of a wheel, a free belt, a flat platen: straight
    if (pressing.flat() && face.flat()) return;
    const double tilt = pressing.flat() ? std::abs(face.angle(face.s(centre)))
                                        : std::abs(centre) / process_.wheel.radius;
    if (!(limits_.tilt > 0.0) || tilt <= limits_.tilt) return;
    if (Event* event = note("tilted_contact", index, kDegrees * tilt)) {
        event->limit = kDegrees * limits_.tilt;
        const Arguments arguments = {{"angle", kDegrees * tilt}};
        if (pressing.flat() && centre > 0.0) {
            event->facts = {{"event.belt_tilted_along",
                             "the belt touches {angle:.1f} deg round its platen from the "
                             "programmed contact point, along its travel",
                             arguments}};
        } else if (pressing.flat()) {
            event->facts = {{"event.belt_tilted_against",
                             "the belt touches {angle:.1f} deg round its platen from the "
                             "programmed contact point, against its travel",
                             arguments}};
        } else if (centre > 0.0) {
            event->facts = {{"event.tilted_along",
                             "the wheel touches {angle:.1f} deg round its rim from the programmed "
                             "contact point, along the belt's travel",
                             arguments}};
        } else {
            event->facts = {{"event.tilted_against",
                             "the wheel touches {angle:.1f} deg round its rim from the programmed "
                             "contact point, against it",
                             arguments}};
        }
        put(*event, pressing, centre, 0.0);
    }
}

void EventRecorder::note_edges(std::size_t index, const Pressing& pressing,
                               const std::vector<double>& by_column) {
    const ContactGrid& grid = pressing.map().grid();
    const double pressed = kPressedEdge / grid.ny;
    const std::array<bool, 2> on = {by_column.front() > pressed, by_column.back() > pressed};
    if (!on[0] && !on[1]) return;
    std::array<double, 2> outer = {0.0, 0.0};
    const int columns = std::max(1, static_cast<int>(std::lround(kOuterShare * grid.ny)));
    for (int j = 0; j < columns; ++j) {
        outer[0] += by_column[static_cast<std::size_t>(j)];
        outer[1] += by_column[static_cast<std::size_t>(grid.ny - 1 - j)];
    }
    const double even = static_cast<double>(columns) / grid.ny;
    const auto more = static_cast<std::size_t>(outer[1] > outer[0] ? 1 : 0);
    if (outer[more] <= kEven * even) return;
    const double share = 100.0 * outer[more];
    // One for each pass.
    Event* event = events_.note("edge_contact", pass_ * (kPause + 1), steps_[index], share,
                                static_cast<int>(more));
    if (event == nullptr) return;
    event->limit = 100.0 * even;
    const Arguments arguments = {{"share", share}, {"even", event->limit}};
    if (pressing.flat() && more == 1) {
        event->facts = {{"event.belt_edge_at_plus_y",
                         "the belt presses with its edge at +y: the outer tenth of its width "
                         "carries {share:.0f} % of the force there, {even:.0f} % if it were even",
                         arguments}};
    } else if (pressing.flat()) {
        event->facts = {{"event.belt_edge_at_minus_y",
                         "the belt presses with its edge at -y: the outer tenth of its width "
                         "carries {share:.0f} % of the force there, {even:.0f} % if it were even",
                         arguments}};
    } else if (more == 1) {
        event->facts = {{"event.edge_at_plus_y",
                         "the wheel presses with its edge at +y: the outer tenth of its width "
                         "carries {share:.0f} % of the force there, {even:.0f} % if it were even",
                         arguments}};
    } else {
        event->facts = {{"event.edge_at_minus_y",
                         "the wheel presses with its edge at -y: the outer tenth of its width "
                         "carries {share:.0f} % of the force there, {even:.0f} % if it were even",
                         arguments}};
    }
    put(*event, pressing, 0.0, more == 1 ? grid.y(grid.ny - 1) : grid.y(0));
}

// A stretch of cells without pressure between pressed ones, in a row along the rim or across it. It
// is the surface's form, not a groove that was ground before, if the design's normals at both ends
// turn towards each other by more than the rim's do. With theta and alpha half the turn of the
// rim's and of the surface's normals, an arc of radius rho over the same chord has rho sin alpha =
// R sin theta.
void EventRecorder::note_hollow(std::size_t index, const Pressing& pressing, bool across) {
    const GapMap& map = pressing.map();
    const ContactGrid& grid = map.grid();
    const OpenRow open = longest_open(pressing.solution().pressure, grid, across);
    if (open.cells() < kHollowCells) return;
    const auto place = [&](double cell) {
        const double s = across ? grid.s(open.line) : grid.s(0) + cell * grid.ds;
        const double y = across ? grid.y(0) + cell * grid.dy : grid.y(open.line);
        return Eigen::Vector2d(s, y);
    };
    const Eigen::Vector2d from = place(open.begin), to = place(open.end),
                          middle = 0.5 * (from + to);
    const double reach = kSlopeReach * std::max(grid.ds, grid.dy);
    const int axis = across ? 1 : 0;
    const GapMap::MeanSlope one = map.slope_near(blocks_, from.x(), from.y(), reach);
    const GapMap::MeanSlope other = map.slope_near(blocks_, to.x(), to.y(), reach);
    double closing = std::atan(one.slope[axis]) - std::atan(other.slope[axis]);
    const double span = (to - from).norm(), chord = other.place[axis] - one.place[axis];
    const ContactWheel& wheel = pressing.tool().wheel;
    // A belt is straight across, and along it but for a curved platen.
    const BeltArc& face = pressing.tool().face;
    const double round = pressing.flat() ? face.radius : wheel.radius;
    const double radius = across ? wheel.crown_radius : round;
    double turn = radius > 0.0 ? 0.5 * chord / radius : 0.0;
    if (pressing.flat() && !across) {  // whose gap is that to the plane
        turn = 0.5 * (face.angle(face.s(to.x())) - face.angle(face.s(from.x())));
        closing -= 2.0 * turn;
    }
    // Also false where a slope is not known.
    if (!(0.5 * closing > kHollow * (turn > 0.0 ? turn : 1.0))) return;
    const double half_chord = turn > 0.0 ? radius * std::sin(turn) : 0.5 * chord;
    const double in_section = half_chord / std::sin(std::min(turn + 0.5 * closing, M_PI_2));
    // The wheel's section leans against the surface's normal by this tangent (Meusnier's theorem).
    const double leaning = 0.5 * (one.slope[1 - axis] + other.slope[1 - axis]);
    const double hollow = in_section * std::sqrt(1.0 + leaning * leaning);
    Event* event = note("wheel_too_large", index, hollow, across ? 1 : 0);
    if (event == nullptr) return;
    if (radius > 0.0) event->limit = radius;
    event->facts = {hollow_fact(pressing.flat(), across, {{"radius", hollow}, {"span", span}})};
    put(*event, pressing, middle.x(), middle.y());  // for the face
    // No sample is in reach there: it is the rim's point over the hollow.
    const double angle = middle.x() / wheel.radius;
    const double r = wheel.radius - wheel.drop(middle.y());
    event->point =
        steps_[index].work_from_contact *
        Vec3(r * std::sin(angle), middle.y(),
             pressing.approach() - wheel.radius + r * std::cos(angle) - face.behind(middle.x()));
}

}  // namespace beltgrinding
