// What the reader's process does with OFF, OBJ, STL and 3MF (src/reader/mesh_tasks.cpp), in this
// one: the first byte says which. The faults of assimp and lib3mf are that process's business:
// libFuzzer is told to go on after a crash, and replay.cpp does so.

#include <array>
#include <cstdio>
#include <new>

#include "beltgrinding/error.h"
#include "meshio/mesh_bytes.h"
#include "target.h"
#include "tasks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beltgrinding;
    constexpr std::array kSuffixes{".off", ".obj", ".stl", ".3mf"};
    if (size == 0) return 0;
    const std::size_t kind = data[0] % kSuffixes.size();
    const std::string& written = as_file(data + 1, size - 1, "");
    const std::string path = written + kSuffixes[kind];
    must(std::rename(written.c_str(), path.c_str()) == 0);
    try {
        const auto answer = do_mesh_task(kind == 3 ? "3MF" : "MESH", path, "");
        must(answer && unpack_mesh(*answer));
    } catch (const InputError&) {
    } catch (const std::bad_alloc&) {
    }
    unlink(path.c_str());
    return 0;
}
