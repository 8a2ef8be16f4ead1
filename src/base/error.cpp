#include "beltgrinding/error.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace beltgrinding {
namespace {

constexpr std::array<std::string_view, 5> kCulprit = {"key", "file", "line", "face", "pose"};

std::string whole_sentence(const Fact& fact, const std::vector<Fact>& context) {
    std::string all;
    for (const Fact& outer : context) all += outer.sentence();
    return all + fact.sentence();
}

}  // namespace

InputError::InputError(std::string code, std::string text, Arguments arguments)
    : InputError(Fact{std::move(code), std::move(text), std::move(arguments)}) {}

InputError::InputError(Fact fact, std::vector<Fact> context)
    : std::runtime_error(whole_sentence(fact, context)),
      told_(std::make_shared<const Told>(Told{std::move(fact), std::move(context)})) {}

Arguments InputError::culprit() const {
    Arguments found;
    const auto add = [&](const Fact& fact) {
        for (const Argument& argument : fact.arguments) {
            if (std::find(kCulprit.begin(), kCulprit.end(), argument.name) == kCulprit.end())
                continue;
            const auto same = std::find_if(found.begin(), found.end(), [&](const Argument& other) {
                return other.name == argument.name;
            });
            if (same == found.end()) {
                found.push_back(argument);
            } else {
                *same = argument;
            }
        }
    };
    for (const Fact& outer : context()) add(outer);
    add(fact());
    return found;
}

InputError InputError::within(Fact outer) const {
    std::vector<Fact> context{std::move(outer)};
    context.insert(context.end(), told_->context.begin(), told_->context.end());
    return InputError(told_->fact, std::move(context));
}

}  // namespace beltgrinding
