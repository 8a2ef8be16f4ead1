#include "engine/wheel_control.h"

#include "actuated_wheel.h"
#include "landing.h"

namespace beltgrinding {
namespace {

/// The force is met at every moment, or the wheel keeps to its poses.
class IdealControl final : public Keeps<Nothing, WheelControl> {
  public:
    IdealControl(const ProcessSettings& process, Pressing& pressing)
        : pressing_(pressing), landing_(process, pressing) {}

    std::string kind() const override { return "ideal control"; }
    Pressing::State look(const SampleBlocks& blocks, const PathStep& step) override {
        const auto state = pressing_.press(blocks, step.work_from_contact, step.force);
        lands_ = landing_.within(blocks, step);
        return state;
    }
    double parts(const PathStep&) const override { return lands_ ? 2.0 : 1.0; }
    bool moves() const override { return false; }
    double grind(Grinding& grinding, const PathStep& step, double share) override {
        return grinding.grind(step, share);
    }
    double bounce() const override { return 0.0; }
    void end(const PathStep&) override {}

  private:
    Nothing take(std::span<const std::uint32_t>) override { return {}; }
    void put(std::span<const Nothing* const>) override {}

    Pressing& pressing_;
    Landing landing_;
    bool lands_ = false;  // in the step that was looked at
};

}  // namespace

std::unique_ptr<WheelControl> make_wheel_control(const ProcessSettings& process,
                                                 Pressing& pressing) {
    if (!process.force_control || process.dynamics.ideal())
        return std::make_unique<IdealControl>(process, pressing);
    return std::make_unique<ActuatedWheel>(process, pressing);
}

}  // namespace beltgrinding
