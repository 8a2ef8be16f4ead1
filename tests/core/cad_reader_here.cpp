#include <cstdlib>

namespace {

[[maybe_unused]] const int kTold =
    setenv("BELTGRINDING_CAD_READER", BELTGRINDING_CAD_READER_HERE, /*overwrite=*/0);

}  // namespace
