#pragma once

#include <memory>
#include <string>

#include "beltgrinding/belt_machine.h"
#include "beltgrinding/contact_model.h"
#include "elastic/wheel_rim.h"

namespace beltgrinding {

/// A belt that slides over a plate, flat or curved, with elastic layers, pressed on the work: the
/// plate of `FreeBelt`, borne by the layers where it is pressed on them, and free to lift off. The
/// layers are those of a wheel's rim whose radius is beyond all measure: the same semi-analytical
/// section, with free side faces at the belt's edges; of a curved platen, the rim of its own
/// radius. What the belt's tension presses on that is there before any work. Pressure and force are
/// as those of `FreeBelt`.
class PlatenBelt final : public ContactModel {
  public:
    /// Throws InputError for a belt, a run or a platen that is none.
    PlatenBelt(const AbrasiveBelt& belt, const BeltRun& run, const Platen& platen,
               std::shared_ptr<RimCache> cache = nullptr);
    std::string describe() const override;
    double thickness() const override;

  private:
    std::unique_ptr<PreparedContact> do_prepare(const ContactGrid& grid) const override;

    AbrasiveBelt belt_;
    BeltRun run_;
    Platen platen_;
    std::unique_ptr<WheelRim> layers_;  // none: the plate alone
};

}  // namespace beltgrinding
