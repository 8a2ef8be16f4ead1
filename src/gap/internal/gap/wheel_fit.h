#pragma once

#include <vector>

#include "beltgrinding/contact_wheel.h"
#include "beltgrinding/geometry.h"
#include "beltgrinding/run_context.h"
#include "contact/belt_arc.h"

namespace beltgrinding {

/// How deep the undeformed wheel reaches into a surface (`point`, mm, outward unit `normal`) at
/// each pose, mm; 0 where it touches at the contact only. A concave place that is tighter than the
/// wheel, or a wall beside the contact, shows as a depth. Depths are radial from the wheel's axis;
/// points whose normals look away from the axis do not count, nor does what meets the half of the
/// wheel that is averted from the work. With `whole` every point within the wheel counts, whatever
/// its normal: a wall beside it, too. Throws InputError, Cancelled.
std::vector<double> wheel_fit(const ContactWheel& wheel,
                              const std::vector<Frame>& work_from_contact,
                              const std::vector<Vec3>& point, const std::vector<Vec3>& normal,
                              const RunContext& context = {}, bool whole = false);

/// The belt of a free run or a platen as it touches nothing: a rectangle in the contact frame's
/// plane z = 0, its length along x; of a curved platen, bent as `face` is.
struct FlatRun {
    double length = 200.0;  ///< mm along it, from roller to roller
    double middle = 0.0;    ///< mm along it from the contact frame's origin, where its middle lies
    double width = 50.0;    ///< mm
    double behind = 50.0;   ///< mm behind it that are the machine's: up to the belt that runs back

    BeltArc face;  ///< how it lies

    /// Throws InputError for sizes that are none.
    void validate() const;
};

/// How deep a surface (`point`, mm) reaches through such a belt into what lies behind it at each
/// pose, mm along z; 0 where it only touches. Throws InputError, Cancelled.
std::vector<double> run_fit(const FlatRun& run, const std::vector<Frame>& work_from_contact,
                            const std::vector<Vec3>& point, const RunContext& context = {});

}  // namespace beltgrinding
