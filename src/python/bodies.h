#pragma once

#include <vector>

#include "arrays.h"
#include "collision/collision_check.h"

namespace beltgrinding::python {

/// The bodies that dicts of name, frame, link, mesh, margin say.
std::vector<CollisionBody> bodies_from(const py::list& given);

}  // namespace beltgrinding::python
