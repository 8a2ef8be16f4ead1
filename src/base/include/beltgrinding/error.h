#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "beltgrinding/fact.h"

namespace beltgrinding {

/// A mistake in what the user gave: a file, a face, a pose, a value. The message names the culprit
/// and says what to do. Maps to `beltgrinding_core.InputError` and to exit status 2.
///
///     throw InputError("brep.no_such_face", "{shape} has no face {face}; it has {count} faces",
///                      {{"shape", name}, {"face", f + 1}, {"count", n}});
///
/// `what()` is the English sentence. Nobody decides anything by it: there is the code.
class InputError : public std::runtime_error {
  public:
    /// As in `Fact`. The names `key`, `file`, `line`, `face` and `pose` stand for the culprit and
    /// for nothing else; face and pose are counted from 1, as the user does.
    InputError(std::string code, std::string text, Arguments arguments = {});
    /// From a fact, and what the sentence begins with.
    explicit InputError(Fact fact, std::vector<Fact> context = {});

    /// As in `Fact`; empty: without a code.
    const std::string& code() const { return told_->fact.code; }
    /// The English form, as in `Fact`.
    const std::string& text() const { return told_->fact.text; }
    /// As in `Fact`.
    const Arguments& arguments() const { return told_->fact.arguments; }
    /// What is told, without the context.
    const Fact& fact() const { return told_->fact; }
    /// What the sentence begins with, such as "{file}: "; the outermost first.
    const std::vector<Fact>& context() const { return told_->context; }
    /// Of all arguments those that name the culprit, the context's included; the innermost of a
    /// name only.
    Arguments culprit() const;

    /// The same error with `outer` before all that it says.
    [[nodiscard]] InputError within(Fact outer) const;

  private:
    struct Told {
        Fact fact;
        std::vector<Fact> context;
    };
    std::shared_ptr<const Told> told_;  // copying an exception must not throw
};

/// Thrown by a long call after `RunContext::cancel()`. Nothing is left half-written.
class Cancelled : public std::runtime_error {
  public:
    Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace beltgrinding
