// Compiled into each program that links beltgrinding::brep or ::stock: a static library does not
// know where it was installed, CMake's package does, whatever the prefix.
namespace beltgrinding {
void set_installed_reader(const char* program);
}

namespace {
[[maybe_unused]] const bool kSaid =
    (beltgrinding::set_installed_reader(BELTGRINDING_INSTALLED_READER), true);
}
