#include "foreign/answer.h"

#include <utility>
#include <vector>

namespace beltgrinding {
namespace {

constexpr std::uint32_t kMostParts = 1000;  // arguments of a fact, facts of an error

void put_text(std::string& bytes, const std::string& text) {
    put_bytes(bytes, std::uint64_t(text.size()));
    bytes += text;
}

bool take_text(std::string_view& bytes, std::string& text) {
    std::uint64_t size = 0;
    if (!take_bytes(bytes, size) || size > bytes.size()) return false;
    text = bytes.substr(0, size);
    bytes.remove_prefix(size);
    return true;
}

bool take_count(std::string_view& bytes, std::uint32_t& count) {
    return take_bytes(bytes, count) && count <= kMostParts;
}

void put_fact(std::string& bytes, const Fact& fact) {
    put_text(bytes, fact.code);
    put_text(bytes, fact.text);
    put_bytes(bytes, std::uint32_t(fact.arguments.size()));
    for (const Argument& argument : fact.arguments) {
        put_text(bytes, argument.name);
        put_bytes(bytes, std::uint32_t(argument.value.index()));
        if (const auto* whole = std::get_if<std::int64_t>(&argument.value)) {
            put_bytes(bytes, *whole);
        } else if (const auto* real = std::get_if<double>(&argument.value)) {
            put_bytes(bytes, *real);
        } else {
            put_text(bytes, std::get<std::string>(argument.value));
        }
    }
}

bool take_argument(std::string_view& bytes, Arguments& arguments) {
    std::string name, words;
    std::uint32_t kind = 0;
    std::int64_t whole = 0;
    double real = 0;
    if (!take_text(bytes, name) || !take_bytes(bytes, kind)) return false;
    if (kind == 0 && take_bytes(bytes, whole)) {
        arguments.emplace_back(std::move(name), whole);
    } else if (kind == 1 && take_bytes(bytes, real)) {
        arguments.emplace_back(std::move(name), real);
    } else if (kind == 2 && take_text(bytes, words)) {
        arguments.emplace_back(std::move(name), std::move(words));
    } else {
        return false;
    }
    return true;
}

bool take_fact(std::string_view& bytes, Fact& fact) {
    std::uint32_t count = 0;
    if (!take_text(bytes, fact.code) || !take_text(bytes, fact.text) || !take_count(bytes, count))
        return false;
    for (; count > 0; --count)
        if (!take_argument(bytes, fact.arguments)) return false;
    return true;
}

}  // namespace

std::string pack_error(const InputError& error) {
    std::string bytes;
    put_fact(bytes, error.fact());
    put_bytes(bytes, std::uint32_t(error.context().size()));
    for (const Fact& outer : error.context()) put_fact(bytes, outer);
    return bytes;
}

std::optional<InputError> unpack_error(std::string_view bytes) {
    Fact fact;
    std::uint32_t count = 0;
    if (!take_fact(bytes, fact) || !take_count(bytes, count)) return std::nullopt;
    std::vector<Fact> context(count);
    for (Fact& outer : context)
        if (!take_fact(bytes, outer)) return std::nullopt;
    if (!bytes.empty()) return std::nullopt;
    return InputError(std::move(fact), std::move(context));
}

}  // namespace beltgrinding
