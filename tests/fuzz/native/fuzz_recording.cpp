// read_recording (src/simulation/recording_file.cpp), and playing what was read.

#include <algorithm>

#include "beltgrinding/error.h"
#include "recorders/recording.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beltgrinding;
    try {
        std::string attributes;
        const Recording recording = read_recording(as_file(data, size, ".h5"), &attributes);
        const std::size_t last = recording.last();
        for (const std::size_t frame : {std::size_t{0}, last / 2, last})
            must(recording.heights_at(frame).size() == recording.samples());
        for (const auto& [from, to] :
             {std::pair{std::size_t{0}, last}, std::pair{last, last / 2}}) {
            const Recording::Changes changes = recording.advance(from, to);
            must(changes.sample.size() == changes.height.size());
            for (const std::uint32_t sample : changes.sample) must(sample < recording.samples());
        }
        must(recording.frame_at(0.5 * recording.duration()) <= last);
    } catch (const InputError&) {
    }
    return 0;
}
