#include "arrays.h"
#include "hdf5_files.h"
#include "recorders/recording.h"

namespace beltgrinding::python {

void bind_recording(py::module_& m) {
    py::class_<Recording> bound(
        m, "Recording",
        "What simulations did to the heights, step by step; give it to simulate, "
        "path after path. Frame k is the state after the k-th block of steps, "
        "frame 0 the start; see simulation/recording.h.");
    bound
        .def(py::init<std::size_t>(), py::arg("max_bytes") = Recording::kMaxBytes,
             "max_bytes: of the frames; when they hold more, each two become one.")
        .def_property_readonly("samples", &Recording::samples)
        .def_property_readonly("last", &Recording::last, "number of the last frame")
        .def_property_readonly("steps_per_frame", &Recording::steps_per_frame)
        .def_property_readonly("key_frames", &Recording::key_frames)
        .def_property_readonly("changes", &Recording::changes)
        .def_property_readonly("bytes", &Recording::bytes)
        .def_property_readonly("duration", &Recording::duration, "s, of all paths")
        .def(
            "times", [](const Recording& r) { return own(std::vector<double>(r.times())); },
            "(last + 1,): s when the frames are reached")
        .def(
            "steps", [](const Recording& r) { return own(std::vector<std::uint32_t>(r.steps())); },
            "(last + 1,): steps done until the frames")
        .def("frame_at", &Recording::frame_at, py::arg("time"),
             "Number of the last frame that is reached at time, s.")
        .def(
            "heights_at",
            [](const Recording& r, std::size_t frame) { return own(r.heights_at(frame)); },
            py::arg("frame"), "(samples,) float32, mm.")
        .def(
            "advance",
            [](const Recording& r, std::size_t from, std::size_t to) {
                Recording::Changes changes = r.advance(from, to);
                return py::make_tuple(own(std::move(changes.sample)),
                                      own(std::move(changes.height)));
            },
            py::arg("from_frame"), py::arg("to_frame"),
            "(samples (k,) uint32 ascending, their heights at to_frame (k,) float32 mm): what may "
            "differ between two frames, in either order.");
    bind_hdf5<Recording>(bound, "Returns (Recording, attributes).", &read_recording,
                         &read_recording_image);
}

}  // namespace beltgrinding::python
