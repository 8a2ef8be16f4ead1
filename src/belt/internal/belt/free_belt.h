#pragma once

#include <memory>
#include <string>

#include "beltgrinding/belt_machine.h"
#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// A belt that runs free between two rollers, pressed on the work: a thin plate with large
/// deflections, unilateral, on an obstacle (docs/belt-method.md). The solution's force is that
/// along z, its pressure that of a projected area, so that their sum is the force.
class FreeBelt final : public ContactModel {
  public:
    /// Throws InputError for a belt or a run that is none.
    FreeBelt(const AbrasiveBelt& belt, const BeltRun& run);
    std::string describe() const override;

  private:
    std::unique_ptr<PreparedContact> do_prepare(const ContactGrid& grid) const override;

    AbrasiveBelt belt_;
    BeltRun run_;
};

}  // namespace beltgrinding
