#pragma once

#include "beltgrinding/simulation.h"

namespace beltgrinding {

/// Throws InputError for a field that is not sound, or has no samples.
void check_field(const HeightField& field);

/// mm, of the wheel's grid. Throws InputError if the wheel's roundness would be lost in it, or if
/// its cells would be too many across.
double contact_cell(const HeightField& field, const ContactWheel& wheel,
                    const Resolution& resolution);

}  // namespace beltgrinding
