#include <array>
#include <optional>
#include <span>

#include "arrays.h"
#include "beltgrinding/deviation.h"
#include "inspection/colour_map.h"
#include "meshio/mesh_writer.h"

namespace beltgrinding::python {
namespace {

/// Colours inside, above and below the band, or none.
using Choice = std::optional<std::array<std::uint32_t, 3>>;

ColourScale scale_of(double lower, double upper, double limit, int bands = 0,
                     const Choice& choice = {}) {
    ColourScale scale{{lower, upper}, limit, bands, {}};
    if (choice) scale.choice = {(*choice)[0], (*choice)[1], (*choice)[2]};
    return scale;
}

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
std::span<const T> values_of(const Array<T>& array) {
    return {array.data(), static_cast<std::size_t>(array.size())};
}

}  // namespace

void bind_inspection(py::module_& m) {
    m.def(
        "deviation_statistics",
        [](const HeightField& field, double lower, double upper) {
            const DeviationStatistics s = deviation_statistics(field, {lower, upper});
            py::dict d;
            d["samples"] = s.samples;
            d["missed"] = s.missed;
            d["defective"] = s.defective;
            d["min"] = s.min;
            d["max"] = s.max;
            d["mean"] = s.mean;
            d["rms"] = s.rms;
            d["p05"] = s.p05;
            d["p50"] = s.p50;
            d["p95"] = s.p95;
            d["in_tolerance_share"] = s.in_tolerance_share;
            d["above_share"] = s.above_share;
            d["below_share"] = s.below_share;
            if (!field.height_sd.empty()) {
                d["sd_mean"] = s.sd_mean;
                d["sd_p95"] = s.sd_p95;
                d["expected_in_tolerance_share"] = s.expected_in_tolerance_share;
            }
            d["design_area"] = s.design_area;
            d["stock_volume"] = s.stock_volume;
            d["removed_volume"] = s.removed_volume;
            return d;
        },
        py::arg("field"), py::arg("lower"), py::arg("upper"),
        "Area-weighted statistics of the deviation, mm, mm2, mm3.");
    m.def(
        "deviation_colours",
        [](const HeightField& field, double lower, double upper, double limit, int bands,
           const Choice& colours) {
            return own(deviation_colours(field, scale_of(lower, upper, limit, bands, colours)));
        },
        py::arg("field"), py::arg("lower"), py::arg("upper"), py::arg("limit"),
        py::arg("bands") = 0, py::arg("colours") = py::none(),
        "(n,) uint32, 0xRRGGBBAA. bands: steps of each ramp; 0: none. colours: in, above and below "
        "the tolerance; None: the standard ones.");
    m.def(
        "uncertainty_colours",
        [](const HeightField& field, double limit) {
            return own(uncertainty_colours(field, limit));
        },
        py::arg("field"), py::arg("limit"),
        "(n,) uint32, 0xRRGGBBAA of the samples' standard deviation, up to limit mm.");
    m.def(
        "height_colours",
        [](const Array<double>& heights, const Array<std::uint8_t>& flags, double lower,
           double upper, double limit, int bands, const Choice& colours) {
            return own(deviation_colours(values_of(heights), values_of(flags),
                                         scale_of(lower, upper, limit, bands, colours)));
        },
        py::arg("heights"), py::arg("flags"), py::arg("lower"), py::arg("upper"), py::arg("limit"),
        py::arg("bands") = 0, py::arg("colours") = py::none(),
        "(n,) uint32, 0xRRGGBBAA of deviations in mm; on all threads. bands and colours as for "
        "deviation_colours.");
    m.def(
        "magnitude_colours",
        [](const Array<double>& values, const Array<std::uint8_t>& flags, double limit) {
            return own(magnitude_colours(values_of(values), values_of(flags), limit));
        },
        py::arg("values"), py::arg("flags"), py::arg("limit"),
        "(n,) uint32, 0xRRGGBBAA of values without a sign, light at 0, dark at limit.");
    m.def(
        "face_colours",
        [](const Array<std::uint32_t>& faces) { return own(face_colours(values_of(faces))); },
        py::arg("faces"), "(n,) uint32, 0xRRGGBBAA, another colour for every face.");
    m.def(
        "uncertainty_scale",
        [](double limit, const std::vector<double>& values) {
            std::vector<std::uint32_t> colours;
            colours.reserve(values.size());
            for (const double v : values) colours.push_back(uncertainty_colour(v, limit));
            return own(std::move(colours));
        },
        py::arg("limit"), py::arg("values"), "Colours of standard deviations, for a legend.");
    m.def(
        "colour_scale",
        [](double lower, double upper, double limit, const std::vector<double>& values, int bands,
           const Choice& choice) {
            std::vector<std::uint32_t> colours;
            colours.reserve(values.size());
            const ColourScale scale = scale_of(lower, upper, limit, bands, choice);
            for (const double v : values) colours.push_back(scale.colour(v));
            return own(std::move(colours));
        },
        py::arg("lower"), py::arg("upper"), py::arg("limit"), py::arg("values"),
        py::arg("bands") = 0, py::arg("colours") = py::none(),
        "Colours 0xRRGGBBAA of deviations, for a legend.");
    m.def(
        "deviation_ply",
        [](const HeightField& field, double lower, double upper, double limit, bool ground,
           const std::string& run) {
            const ColourScale scale = scale_of(lower, upper, limit);
            return bytes_from([&](const FileMemory& memory) {
                deviation_ply(field, scale, ground, run, memory);
            });
        },
        py::arg("field"), py::arg("lower"), py::arg("upper"), py::arg("limit"),
        py::arg("ground") = true, py::arg("run") = "");
    m.def(
        "deviation_ply_into",
        [](int file, const HeightField& field, double lower, double upper, double limit,
           bool ground, const std::string& run) {
            const ColourScale scale = scale_of(lower, upper, limit);
            bytes_into(file, [&](const FileMemory& memory) {
                deviation_ply(field, scale, ground, run, memory);
            });
        },
        py::arg("file"), py::arg("field"), py::arg("lower"), py::arg("upper"), py::arg("limit"),
        py::arg("ground") = true, py::arg("run") = "",
        "The bytes of deviation_ply to an open file, by its descriptor, a piece at a time. Raises "
        "OSError.");
    m.def(
        "mesh_ply",
        [](const HeightField& field, bool ground) {
            return bytes_from([&](const FileMemory& memory) { mesh_ply(field, ground, memory); });
        },
        py::arg("field"), py::arg("ground") = true);
}

}  // namespace beltgrinding::python
