#pragma once

#include <optional>

#include "beltgrinding/simulation_options.h"

namespace beltgrinding {

/// What moves the wheel under a force control that takes time, along the contact's z from the
/// programmed pose: m z'' + d z' = F_r - F with the contact's force F, T F_r' + F_r = F_c with the
/// commanded F_c; z within the travel, z' within the limit of speed.
///
/// A time step is two stages of the diagonally implicit Runge-Kutta method of second order with
/// gamma = 1 - 1 / sqrt(2) (Alexander, SIAM J. Numer. Anal. 14, 1977), which is L-stable: what is
/// quicker than the step has come to rest in the end, and an undamped wheel never gains energy. In
/// each stage the wheel is held by a spring: its place is `Stage::place - Stage::give F`, which a
/// contact is solved with as with a robot that gives way, however the force grows with the
/// indentation, and where there is none.
class ForceActuator {
  public:
    /// `travel`: mm, both ways.
    ForceActuator(const ForceDynamics& dynamics, double travel);

    /// Puts the wheel to rest at `place` mm, with a regulator that has come to `force` N.
    void rest(double place, double force);

    double place() const { return place_; }          ///< mm along z
    double speed() const { return speed_; }          ///< mm/s along z
    double regulated() const { return regulated_; }  ///< F_r, N
    /// The wheel is at an end of its travel, and pressed against it if the contact has `force`.
    bool held_by_stop(double force) const;

    /// F_r in `seconds` s, N.
    double regulated_after(double seconds, double commanded) const;
    /// The mean of F_r over the next `seconds` s, N.
    double mean_regulated(double seconds, double commanded) const;
    /// Only the regulator goes on.
    void regulate(double seconds, double commanded);

    /// 1/s, how quickly the wheel answers on a contact of `stiffness` N/mm.
    double quickness(double stiffness) const;

    /// How the wheel is held in a stage.
    struct Stage {
        double place = 0.0;  ///< mm, where it would be without a contact
        double give = 0.0;   ///< mm/N
        double share = 0.0;  ///< of the time step, in which the stage's force acts
    };
    static constexpr int kStages = 2;
    /// A time step of `seconds` s begins; `stiffness`, N/mm of the contact, bounds what is worth
    /// telling from an immediate answer.
    void begin(double seconds, double commanded, double stiffness);
    /// Of the next stage.
    Stage stage() const;
    /// Where a limit of travel or speed holds the wheel that would come to `place`; none: it does.
    std::optional<double> limited(double place) const;
    /// The stage ends at `place`. After the last one the time step is done.
    void end_stage(double place);

  private:
    /// The regulator's force becomes `force`.
    void regulate_to(double force, double commanded);

    ForceDynamics dynamics_;
    double travel_;
    double place_ = 0.0, speed_ = 0.0, regulated_ = 0.0;
    int stage_ = 0;
    double seconds_ = 0.0, inertia_ = 0.0;  // of the time step: s; N s2/mm, m + gamma h d
    double forces_[kStages] = {};           // F_r
    double from_ = 0.0, from_speed_ = 0.0;  // what the stage begins with
};

}  // namespace beltgrinding
