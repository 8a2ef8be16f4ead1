#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace beltgrinding {

/// A named value of a fact. Lengths are in mm unless the form names another unit.
struct Argument {
    /// A whole number, a real one, or words.
    using Value = std::variant<std::int64_t, double, std::string>;

    /// A whole number.
    template <std::integral Whole>
    requires(!std::same_as<Whole, bool> && !std::same_as<Whole, char>)
        Argument(std::string name_, Whole number)
        : name(std::move(name_)), value(static_cast<std::int64_t>(number)) {}
    Argument(std::string, bool) = delete;
    Argument(std::string, char) = delete;
    /// A real number.
    Argument(std::string name_, double number) : name(std::move(name_)), value(number) {}
    /// Words.
    Argument(std::string name_, std::string words)
        : name(std::move(name_)), value(std::move(words)) {}
    /// Words.
    Argument(std::string name_, const char* words)
        : name(std::move(name_)), value(std::string(words)) {}

    std::string name;  ///< as the form has it
    Value value;       ///< what stands for it

    /// The same name and value.
    bool operator==(const Argument&) const = default;
};

using Arguments = std::vector<Argument>;  ///< of a fact

/// Something that is told: what it is by a code, and its numbers and names. Whoever shows it makes
/// the sentence, in English from `text`, in other languages from Resources/messages.
struct Fact {
    std::string code;  ///< "room.what", in snake case; never changes once it is published
    /// The English form: a field for each argument in it, as "{shape} has no face {face}", with
    /// format specifications that mean the same to libfmt and to Python's str.format. A real number
    /// always has one, as "{spacing:.4g}"; the argument keeps all its digits.
    std::string text;
    Arguments arguments;  ///< one for each field of the form

    /// The English sentence.
    std::string sentence() const;

    /// The same code, form and arguments.
    bool operator==(const Fact&) const = default;
};

/// Facts of one matter as one line: their English sentences, "; " between them.
std::string sentence(const std::vector<Fact>& facts);

}  // namespace beltgrinding
