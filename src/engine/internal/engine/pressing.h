#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "beltgrinding/simulation_options.h"
#include "engine/state.h"
#include "engine/tool_envelope.h"
#include "gap/gap_map.h"
#include "heightfield/sample_blocks.h"

namespace beltgrinding {

/// What pressing ended in. `kBeyondTravel`: force control met its end stop, the force is what the
/// wheel has there. `kOverCompressed`: the force would press the wheel in further than the model
/// can be asked for; it stands there. `kMoved`, of `press_again`: the wheel went so far that it
/// must be pressed anew.
enum class PressState { kNoContact, kPressed, kBeyondTravel, kOverCompressed, kMoved };

/// What one pose leaves to the next: where the wheel stood, how it was pressed, what was near.
struct PressingMemory {
    ContactSolution solution;
    DisplacedPressure displaced;
    std::optional<ContactGrid> grid;  // of the solution
    GapMap::Carried map;
    NearBlocks near;
    std::vector<std::uint32_t> hits;
    Frame programmed = Frame::Identity();
    double placed = 0.0, held_at = 0.0, give = 0.0;
    std::optional<double> localised;
    Eigen::ArrayXd gap;
    double stands_at = 0.0;
    bool warm = false;
    PressState state = PressState::kNoContact;
    std::shared_ptr<const ContactMemory> memory;  // of the model

    std::size_t bytes() const;
};

/// Presses the wheel on the current surface at one pose: localises, maps the gap, solves the
/// contact. Keeps the approach and the pressure of the last pose to start the next one from.
class Pressing final : public Keeps<Latest<PressingMemory>> {
  public:
    /// `spacing`: mm, cell of the wheel's grid; `tolerance`: relative error of the pressure field.
    /// The process and the model must outlive it.
    /// `context`: cancels a contact while it is solved.
    Pressing(const ProcessSettings& process, double spacing, double tolerance,
             const ContactModel& model, const RunContext& context);

    using State = PressState;

    /// mm/MPa by which the surface will recede while it is pressed, as of `ContactProblem`: from
    /// here on. 0 for a wheel, which need not know.
    void recede(double recession) { recession_ = recession; }
    /// The tool is a belt that runs free or over a platen.
    bool flat() const { return tool_.flat; }
    const ToolEnvelope& tool() const { return tool_; }
    /// Presses at the programmed pose.
    State press(const SampleBlocks& blocks, const Frame& work_from_contact, double force);
    /// Solves again at the same place after the surface was lowered (no new localisation).
    State press_again(const SampleBlocks& blocks, double force);
    struct Pressed {
        ContactSolution solution;
        DisplacedPressure pressure;
    };
    /// As it stands now, with another force, on the surface as it was mapped last; the wheel stays.
    /// Empty where the force is not what was asked for.
    std::optional<Pressed> with_force(double force);
    /// The same under the same force, with the gap changed by so many mm, by cell.
    std::optional<Pressed> with_gap(const Eigen::ArrayXd& change);
    /// Shares a solution's pressure at edges out among their samples, from now on. The next one
    /// does so by itself; after `with_force` or `with_gap`, whoever asked must.
    void share_out(const SampleBlocks& blocks, const ContactSolution& solution);
    /// From here on `hold` is about this programmed pose.
    void stand(const Frame& work_from_contact) {
        programmed_ = work_from_contact;
        all_edges_ = false;
        localised_.reset();
    }
    /// Holds the wheel by a spring: it stands at `place` mm along z from the pose, less `give` mm
    /// for each N of the contact.
    State hold(const SampleBlocks& blocks, double place, double give);
    /// The wheel that is held is so by an end of the travel. Returns its state.
    State at_stop() {
        if (state_ != State::kNoContact) state_ = State::kBeyondTravel;
        return state_;
    }
    /// Presses anew where `press` did.
    State press_anew(const SampleBlocks& blocks, double force) {
        return press(blocks, Frame(programmed_), force);
    }

    /// A rigid tool: `solution` has an area and no pressure.
    bool rigid() const { return model_.rigid(); }
    const ContactSolution& solution() const { return solution_; }
    /// N, the integral of the pressure over the surface: the force, but where a belt is wrapped
    /// round the work, whose sides press on one another.
    double pressing_force() const {
        return tool_.flat ? map_.volume_rate(displaced_.pressure, displaced_.beside)
                          : solution_.force;
    }
    /// The contact took all iterations that it is allowed, and was not solved: nothing is worth
    /// asking it more often.
    bool gave_up() const {
        return !solution_.converged && solution_.iterations >= ContactProblem{}.max_iterations;
    }
    /// Its pressure, where it acts.
    const DisplacedPressure& displaced_pressure() const { return displaced_; }
    /// mm by which the wheel reaches into the surface where that is highest.
    double indentation() const { return solution_.approach - map_.lowest(); }
    /// mm of `indentation` beyond which the model is asked for what it cannot know: the elastic
    /// rim's thickness, or what of the wheel is looked at.
    double largest_indentation() const { return largest_indentation_; }
    /// The wheel follows the surface as that recedes: by force control, or a robot that gives way.
    bool yields() const {
        if (!process_.force_control) return process_.robot_stiffness > 0.0;
        return state_ != State::kBeyondTravel || placed_ < 0.0;  // it comes off the far stop
    }
    /// mm along z from the programmed pose to the wheel as pressed.
    double approach() const { return placed_ + solution_.approach - growth_; }
    GapMap& map() { return map_; }
    const GapMap& map() const { return map_; }
    /// What the model says of itself as it was used last.
    std::string describe() const { return contact_ ? contact_->describe() : model_.describe(); }
    /// s of wall time for localise, gap and contact so far.
    const PhaseTimes& times() const { return times_; }
    /// Samples that were mapped last.
    std::size_t localised() const { return map_.samples(); }
    /// Blocks in the reach of the wheel as it was mapped last, ascending.
    const std::vector<std::uint32_t>& in_reach() const { return hits_; }

    std::string kind() const override { return "pressing"; }

  private:
    Latest<PressingMemory> take(std::span<const std::uint32_t> blocks) override;
    void put(std::span<const Latest<PressingMemory>* const> parts) override;

    State press_force(const SampleBlocks& blocks, double force);
    State press_position(const SampleBlocks& blocks);
    Frame placed_frame() const;
    void localise(const SampleBlocks& blocks, double margin);
    /// `pressable`: as of `GapMap::update`.
    void map_gap(const SampleBlocks& blocks, double reach, double pressable);
    void solve_force(const SampleBlocks& blocks, double force);
    /// The wheel is held at `held_at_`, by a spring that gives way by `give_`.
    void solve_held(const SampleBlocks& blocks);
    void solve(const SampleBlocks& blocks, ContactProblem problem);
    bool find_touch(const SampleBlocks& blocks, bool by_samples);
    /// `find_touch` in the ways that are left after so many; counts it.
    bool touch_again(const SampleBlocks& blocks, int& searches);
    /// Where force control wants the wheel, mm along z from the pose, or the limit that it meets.
    struct Wanted {
        double place;
        State state;
    };
    Wanted within_limits(double place) const;
    /// Solves with the wheel held rigidly where it stands. False where it does not touch.
    bool press_held(const SampleBlocks& blocks);
    /// As of `with_force` and `with_gap`.
    std::optional<Pressed> pressed_otherwise(Eigen::ArrayXd gap, double force);
    /// The wheel stands at its pose again and presses on nothing.
    State let_go();

    const ProcessSettings& process_;
    double tolerance_;
    RunContext context_;
    const ContactModel& model_;
    ToolEnvelope tool_;
    double recession_ = 0.0;  // mm/MPa
    GapMap map_;
    std::unique_ptr<PreparedContact> contact_;  // on the grid of the last solution
    ContactSolution solution_;
    DisplacedPressure displaced_;
    NearBlocks near_;
    std::vector<std::uint32_t> hits_;  // blocks
    Frame programmed_ = Frame::Identity();
    double placed_ = 0.0;  // mm along z: where the wheel stands undeformed for the gap
    double growth_;        // mm
    double held_at_ = 0.0, give_ = 0.0;  // mm along z; mm/N
    std::optional<double> localised_;    // mm along z: where `hold` last looked for segments
    Eigen::ArrayXd gap_;                 // mm, by cell, of the last solution
    double stands_at_ = 0.0;             // mm along z, by that
    // Of a belt, whose contacts take long: at this pose pressure was where no edges were looked at.
    bool all_edges_ = false;
    bool warm_ = false;
    State state_ = State::kNoContact;  // of the last time that it was pressed
    double largest_indentation_;
    PhaseTimes times_;
};

}  // namespace beltgrinding
