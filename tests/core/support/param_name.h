#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace beltgrinding {

/// A file's name without its folder and its ending, as GoogleTest takes it for a parameter's name:
/// "cad/blade.step" is "blade".
inline std::string param_name(const std::string& file) {
    std::string name = std::filesystem::path(file).stem().string();
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
}

}  // namespace beltgrinding
