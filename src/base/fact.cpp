#include "beltgrinding/fact.h"

// libfmt, since std::format knows no named fields.
#include <fmt/args.h>
#include <fmt/format.h>

namespace beltgrinding {

std::string Fact::sentence() const {
    fmt::dynamic_format_arg_store<fmt::format_context> store;
    store.reserve(arguments.size(), arguments.size());
    for (const Argument& argument : arguments) {
        std::visit(
            [&](const auto& value) { store.push_back(fmt::arg(argument.name.c_str(), value)); },
            argument.value);
    }
    try {
        return fmt::vformat(text, store);
    } catch (const fmt::format_error&) {
        return text;  // a form that does not fit its arguments must not hide what it is to tell
    }
}

std::string sentence(const std::vector<Fact>& facts) {
    std::string all;
    for (const Fact& fact : facts) {
        if (!all.empty()) all += "; ";
        all += fact.sentence();
    }
    return all;
}

}  // namespace beltgrinding
