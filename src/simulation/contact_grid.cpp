#include "contact_grid.h"

#include <algorithm>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

// The wheel's cells must each hold samples: never finer than this many sample spacings.
constexpr double kSamplesPerCell = 1.5;
constexpr double kMostCellsAcross = 2000;

}  // namespace

void check_field(const HeightField& field) {
    field.validate();
    if (field.size() == 0) {
        throw InputError("simulation.empty_field",
                         "the height field is empty; select a face with an area");
    }
}

double contact_cell(const HeightField& field, const ContactWheel& wheel,
                    const Resolution& resolution) {
    const double cell = std::max(resolution.contact_spacing, kSamplesPerCell * field.spacing);
    if (cell > wheel.radius) {
        const Arguments arguments = {{"cell", cell}, {"radius", wheel.radius}};
        if (cell > resolution.contact_spacing) {
            throw InputError("simulation.samples_too_coarse",
                             "the contact's cells of {cell:.3g} mm are larger than the wheel's "
                             "radius of {radius:.3g} mm; lower the samples' spacing",
                             arguments);
        }
        throw InputError("simulation.cells_too_coarse",
                         "the contact's cells of {cell:.3g} mm are larger than the wheel's radius "
                         "of {radius:.3g} mm; lower the contact spacing",
                         arguments);
    }
    if (wheel.width / cell > kMostCellsAcross) {
        throw InputError("simulation.cells_too_many",
                         "contact cells of {cell:.3g} mm are too many across a wheel of "
                         "{width:.3g} mm; raise the contact spacing, or check the wheel's width",
                         {{"cell", cell}, {"width", wheel.width}});
    }
    return cell;
}

}  // namespace beltgrinding
