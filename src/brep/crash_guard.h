#pragma once

#include <functional>

namespace beltgrinding {

/// Runs `work`; false if it was ended by a segmentation fault, bus error or floating-point trap.
///
/// For OpenCASCADE's STEP and IGES readers, which follow null pointers in damaged files. The faulty
/// call's destructors do not run: what it held leaks, and its objects must not be used any more.
/// POSIX; one call at a time in the process (the handlers are the process's).
bool survives(const std::function<void()>& work);

}  // namespace beltgrinding
