// read_ply (src/meshio/ply_reader.cpp).

#include <algorithm>

#include "beltgrinding/error.h"
#include "beltgrinding/mesh_reader.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beltgrinding;
    try {
        const RawMesh mesh = read_ply(as_file(data, size, ".ply"));
        must(mesh.vertices.size() <= size);  // each has three numbers of a byte at least
        for (const Triangle& t : mesh.triangles)
            must(std::max({t[0], t[1], t[2]}) < mesh.vertices.size());
    } catch (const InputError&) {
    }
    return 0;
}
