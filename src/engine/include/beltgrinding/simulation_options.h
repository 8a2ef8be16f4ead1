#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "beltgrinding/belt_machine.h"
#include "beltgrinding/belt_wear.h"
#include "beltgrinding/contact_model.h"
#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/event.h"
#include "beltgrinding/heat.h"
#include "beltgrinding/height_field.h"
#include "beltgrinding/removal_law.h"
#include "beltgrinding/tool_path.h"

namespace beltgrinding {

class Checkpoints;
class Recorder;
class Recording;
class SampleBlocks;

/// One row of the time series.
struct StepRecord {
    double time = 0.0;       ///< s
    std::uint32_t pose = 0;  ///< programmed pose that the step leads to, from 0
    float duration = 0.0f;   ///< s
    float feed = 0.0f;       ///< mm/s, infeed speed of the contact point over the work
    float force = 0.0f;      ///< N, mean over the step
    float approach = 0.0f;   ///< mm, the wheel's way from the programmed pose along z, at first
    float deepest_approach = 0.0f;  ///< mm, where it stood deepest within the step
    float contact_area = 0.0f;      ///< mm2
    float peak_pressure = 0.0f;     ///< MPa
    float removal_rate = 0.0f;      ///< mm3/s
    std::uint32_t segments = 0;     ///< found by localisation
};

/// How a force control meets its force F_c: by a regulator whose force F_r lags, T F_r' + F_r =
/// F_c, and a mass that it moves with the wheel against the contact's force F, m z'' + d z' =
/// F_r - F, z along the contact frame's z. All 0: at every moment, as ideal force control does.
struct ForceDynamics {
    double lag = 0.0;          ///< T, s
    double mass = 0.0;         ///< m, N s2/mm (t)
    double damping = 0.0;      ///< d, N s/mm
    double speed_limit = 0.0;  ///< mm/s, of z'; 0: none

    /// The force is met at every moment.
    bool ideal() const { return !(lag > 0.0) && !moves(); }
    /// The wheel takes time to move.
    bool moves() const { return mass > 0.0 || damping > 0.0; }
};

/// How the wheel is pressed and the belt runs: what decides what is ground.
struct ProcessSettings {
    ContactWheel wheel;  ///< its shape
    /// A free belt or a platen is pressed in place of the wheel, whose shape is then of no account:
    /// the contact frame's origin lies on the face of the belt that touches nothing. The contact
    /// model must be the machine's (`make_belt_contact`).
    BeltMachine machine;
    bool force_control = true;     ///< else the wheel keeps to the programmed poses
    double force = 50.0;           ///< N, where the path has none
    double force_travel = 5.0;     ///< mm, how far force control moves the wheel along z, both ways
    ForceDynamics dynamics;        ///< of the force control
    double robot_stiffness = 0.0;  ///< N/mm along z under position control; 0: rigid
    /// mm by which the rim stands out of the wheel's shape under position control, grown by its
    /// rotation
    double wheel_growth = 0.0;
    double belt_speed = 20000.0;  ///< mm/s
    double belt_wear = 1.0;       ///< k_t of the belt as it comes, a factor on `wear`
    BeltWear wear;                ///< how k_t falls with use
    BeltState belt;               ///< what the belt has done before
    double pause = 0.0;  ///< s before the path in which the belt runs free and the part cools

    /// Throws InputError naming the invalid setting.
    void validate() const;
};

/// How finely the process is computed.
struct Resolution {
    double contact_spacing = 1.0;  ///< mm, cell of the wheel's grid (never finer than the samples)
    double contact_tolerance = 1e-3;  ///< relative error of the pressure
    double max_travel = 1.0;          ///< mm, how far the contact point may move in a step
    double max_angle = 0.02;          ///< rad, how far the wheel may turn against the work in one

    /// Throws InputError naming the invalid setting.
    void validate() const;
};

/// What is noted as an event when it is passed. Nothing that is ground depends on it.
struct MonitorLimits {
    double heat = 0.0;              ///< MPa mm/s, largest p V_b without a risk of burning; 0: none
    double pressure = 0.0;          ///< MPa; 0: none
    double orientation_jump = 0.0;  ///< rad between neighbouring poses at feed; 0: none
    double tilt = 0.0;              ///< rad of the contact's centre round the rim; 0: none
    /// Share of the commanded force above which a force control that takes time exceeds it; 0: none
    double overshoot = 0.0;
    double bounce = 0.0;  ///< s, within which the wheel is off the work and on it again; 0: none
    /// mm, height below which a sample is cut too deep: one for all, or one per sample; empty: none
    std::vector<float> lower = {};

    /// Throws InputError naming the invalid limit. `samples`: of the field.
    void validate(std::size_t samples) const;
};

/// How hot the part becomes, if asked for.
struct HeatRequest {
    static constexpr double kVapour = 6000.0;  ///< degrees C: tungsten boils, as the last metal

    PartHeat* part = nullptr;  ///< goes on with this path; stays as it was on cancel or error
    double friction = 0.0;     ///< mu, of the belt on the work: q = mu p V_b
    double partition = 0.0;    ///< share of q that flows into the work
    double low = 1.0;          ///< share of the rise that it may be at least, and
    double high = 1.0;         ///< at most: friction and partition, which it is in proportion to,
                               ///< being uncertain
    double start = 20.0;       ///< degrees C, of the part
    double burn = 0.0;         ///< degrees C above which the material is burnt; 0: not known

    /// Throws InputError naming the invalid setting.
    void validate(std::size_t samples) const;
};

/// A range of a quantity; all by default.
struct Range {
    double low = 0.0;                                       ///< the least
    double high = std::numeric_limits<double>::infinity();  ///< the greatest

    /// Whether it holds the value.
    bool holds(double value) const { return value >= low && value <= high; }
};

/// What finish the passes leave, if asked for. The roughness of a pass, where it has come to rest:
/// Ra = Ra_ref (p / p_ref)^b (V_b / V_ref)^d (V_w / V_w,ref)^e k^f, p the mean pressure over the
/// time that the pass pressed the sample, V_b, V_w and k, the share of a fresh belt's cut that
/// remains, as it left the sample. Each pass leaves `rest` of the difference to it.
struct FinishRequest {
    bool wanted = false;               ///< lays and passes, and the rest if there is a `roughness`
    double roughness = 0.0;            ///< Ra_ref, um, of the belt's grain; 0: none is computed
    double pressure_exponent = 0.0;    ///< b
    double speed_exponent = 0.0;       ///< d
    double feed_exponent = 0.0;        ///< e
    double cut_exponent = 0.0;         ///< f
    double reference_pressure = 0.1;   ///< p_ref, MPa
    double reference_speed = 20000.0;  ///< V_ref, mm/s
    double reference_feed = 50.0;      ///< V_w,ref, mm/s
    Range pressure = {};               ///< MPa: what was measured; passes elsewhere leave what is
                                       ///< not known, those lighter than that nothing
    Range speed = {};                  ///< mm/s
    Range feed = {};                   ///< mm/s
    Range cut = {};                    ///< of k
    double rest = 0.0;                 ///< share of the roughness before that a pass leaves, [0, 1)
    double before = std::numeric_limits<double>::quiet_NaN();  ///< um, Ra of the part; NaN: unknown

    /// Throws InputError naming the invalid setting.
    void validate() const;
};

/// A law, and how the belt's cut falls under it.
struct ShiftedLaw {
    std::shared_ptr<const RemovalLaw> law;  ///< moved
    std::optional<BeltWear> wear = {};      ///< none: as the simulation's
};

/// What a simulation keeps besides the heights and the time series.
struct OutputRequest {
    bool trace = true;  ///< keep `field.trace`; without, what it holds is dropped
    std::uint32_t first_motion =
        0;  ///< number of the motion to the path's first pose, in the trace
    Recording* recording = nullptr;  ///< goes on with this path; cleared on cancel or error
    /// The law, moved by one standard deviation along each direction in which it is uncertain: for
    /// `SimulationResult::shifts`.
    std::vector<ShiftedLaw> shifted_laws = {};
    bool cell_errors = true;  ///< estimate what the contact's cells leave open
    bool influence = false;   ///< keep what every motion removed where
    /// Keep what every motion would remove more where by more force, as far as its force is
    /// controlled.
    bool force_influence = false;
    /// States of an earlier simulation, of the same field and settings, to go on from; keeps those
    /// of this one from then on. Sound on cancel or error, too.
    Checkpoints* checkpoints = nullptr;
    /// Make recorders of your own, which watch beside the others (engine/recorder.h).
    std::vector<std::function<std::unique_ptr<Recorder>(const SampleBlocks&)>> recorders = {};
};

/// How a simulation is done.
struct SimulationOptions {
    ProcessSettings process;  ///< what decides what is ground
    Resolution resolution;    ///< how finely it is computed
    MonitorLimits limits;     ///< what is noted as an event
    OutputRequest outputs;    ///< what is kept
    HeatRequest heat;         ///< how hot the part becomes
    FinishRequest finish;     ///< what finish it gets
    bool must_touch = true;   ///< a path that never touches the stock is an error
};

/// s of wall time by phase of a simulation.
struct PhaseTimes {
    double build = 0.0;     ///< of the field's tree
    double localise = 0.0;  ///< the segments in the wheel's reach
    double gap = 0.0;       ///< mapping the surface on the wheel's grid
    double contact = 0.0;   ///< solving
    double removal = 0.0;   ///< lowering the samples
    double trace = 0.0;     ///< noting what removed
    double events = 0.0;    ///< watching for them
    double heat = 0.0;      ///< conducting heat
    double finish = 0.0;    ///< noting what the passes leave

    /// Adds each phase.
    PhaseTimes& operator+=(const PhaseTimes& more);
};

/// How much every motion of a path removed at every sample: a sparse matrix, motion by motion.
struct Influence {
    std::vector<std::size_t> first = {0};  ///< (motions + 1), where a motion's entries begin
    std::vector<std::uint32_t> sample;     ///< rising within a motion
    std::vector<float> depth;              ///< mm, not 0
    /// (motions) 1/mm, or empty: not known. Where a motion that removes `d` finds the surface lower
    /// by u than before, against what it finds on the whole, it removes `feedback` d u less: the
    /// wheel presses less there. 0: not known, or the wheel does not follow a force.
    std::vector<float> feedback;

    /// How many there are, those that removed nothing among them.
    std::size_t motions() const { return first.size() - 1; }
    /// Goes on with the motions of `next`, the same field's, which come after these.
    void append(const Influence& next);
    /// That of groups of motions, which are changed together: `group` has the number of each
    /// motion's, below `count`. Throws InputError where the numbers do not fit.
    Influence grouped(std::span<const std::uint32_t> group, std::size_t count) const;
    /// What is left of that in the end, by groups as of `grouped`: at first order, how much lower
    /// the surface is after all motions if a group's motions take longer, or press more. What is
    /// ground deeper is pressed less by later motions, and the rest of their contact more: the
    /// volume stays. `removed`: what the same motions removed, with its `feedback`; `area`
    /// (samples), mm2. Entries below 3 % of a group's greatest are left out; the others get their
    /// volume, unless that were more than a quarter of theirs. The same bits on any number of
    /// threads. Throws InputError where the numbers do not fit, and Cancelled.
    Influence in_the_end(const Influence& removed, std::span<const float> area,
                         std::span<const std::uint32_t> group, std::size_t count,
                         const RunContext& context = {}) const;
};

/// What a simulation gives besides the field.
struct SimulationResult {
    std::vector<Event> events;      ///< in order of time
    std::vector<StepRecord> steps;  ///< one for each step, in order
    double process_time = 0.0;      ///< s, what the robot takes
    double removed_volume = 0.0;    ///< mm3, taken from the field
    BeltState belt;                 ///< what the belt has done in the end
    /// (samples, shifted laws): mm by which each shifted law would have removed more, at first
    /// order (the pressures as they are). Independent: they add up as squares.
    Eigen::ArrayXXd shifts;
    /// mm by which every sample would be lowered further if the contact's cells were as fine as one
    /// likes, at first order (the pressures as they are); negative: less far. Empty: not known.
    std::vector<float> unresolved;
    double integrated_rate = 0.0;  ///< mm3, time integral of the law's rate
    Influence influence;  ///< of the path's motions, from that to its first pose; if asked for
    /// The same per relative change of the motion's force, the surface as it is: mm.
    Influence force_influence;
    std::string model;        ///< what the contact model says of itself as it was used
    PhaseTimes wall;          ///< of this call
    std::size_t resumed = 0;  ///< of `steps`: those that were taken from a checkpoint
    bool touched = false;     ///< the wheel met the stock
    bool unchanged = false;   ///< all is as in the simulation that the checkpoints were of

    /// mm3 of the law's, that was taken from no sample.
    double lost_volume() const { return std::max(integrated_rate - removed_volume, 0.0); }
};

}  // namespace beltgrinding
