#pragma once

#include <stdexcept>
#include <string>

namespace beltgrinding {

/// A mistake in what the user gave: a file, a face, a pose, a value. The message names the culprit
/// and says what to do. Maps to `beltgrinding_core.InputError` and to exit status 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Thrown by a long call after `RunContext::cancel()`. Nothing is left half-written.
class Cancelled : public std::runtime_error {
  public:
    Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace beltgrinding
