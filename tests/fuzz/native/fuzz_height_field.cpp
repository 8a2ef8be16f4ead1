// read_hdf5 (src/heightfield/height_field_file.cpp).

#include "beltgrinding/error.h"
#include "beltgrinding/height_field.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beltgrinding;
    try {
        std::string attributes;
        const HeightField field = read_hdf5(as_file(data, size, ".h5"), &attributes);
        const std::size_t n = field.point.size();
        must(field.normal.size() == n && field.height.size() == n && field.flags.size() == n);
        for (const Triangle& t : field.triangles)
            for (const std::uint32_t corner : t) must(corner < n);
    } catch (const InputError&) {
    }
    return 0;
}
