#include <optional>

#include "arrays.h"
#include "beltgrinding/verdict.h"
#include "dict.h"
#include "inspection/waviness.h"
#include "inspection/zones.h"
#include "thickness/thickness.h"

namespace beltgrinding::python {
namespace {

using Band = std::pair<double, double>;

ToleranceZone zone_from(const py::handle& given) {
    py::dict d = copy_of(given.cast<py::dict>());
    ToleranceZone zone;
    const auto band = take(d, "tolerance", Band{zone.tolerance.lower, zone.tolerance.upper});
    zone.tolerance = {band.first, band.second};
    zone.faces = take(d, "faces", zone.faces);
    zone.edge_radius = take(d, "edge_radius", zone.edge_radius);
    const auto thickness = take(d, "thickness", std::optional<Band>());
    if (thickness) zone.thickness = Tolerance{thickness->first, thickness->second};
    refuse_rest(d, "zone");
    return zone;
}

py::object to_dict(const std::optional<WorstPoint>& worst, const HeightField& field) {
    if (!worst) return py::none();
    py::dict d;
    d["sample"] = worst->sample;
    d["value"] = worst->value;
    d["limit"] = worst->limit;
    d["beyond"] = worst->beyond;
    d["face"] = field.face[worst->sample];
    const Vec3& p = field.point[worst->sample];
    d["point"] = py::make_tuple(p.x(), p.y(), p.z());
    return d;
}

py::dict to_dict(const RegionVerdict& r, const HeightField& field) {
    py::dict d;
    d["region"] = r.region;
    d["passed"] = r.passed();
    d["samples"] = r.samples;
    d["missed"] = r.missed;
    d["defective"] = r.defective;
    d["area"] = r.area;
    d["missed_area"] = r.missed_area;
    d["above_area"] = r.above_area;
    d["below_area"] = r.below_area;
    d["untouched_area"] = r.untouched_area;
    d["stock_volume"] = r.stock_volume;
    d["removed_volume"] = r.removed_volume;
    d["excess_volume"] = r.excess_volume;
    d["gouge_volume"] = r.gouge_volume;
    d["min"] = r.min;
    d["max"] = r.max;
    d["mean"] = r.mean;
    d["rms"] = r.rms;
    d["worst"] = to_dict(r.worst, field);
    return d;
}

py::list to_list(const std::vector<RegionVerdict>& regions, const HeightField& field) {
    py::list list;
    for (const RegionVerdict& region : regions) list.append(to_dict(region, field));
    return list;
}

py::dict to_dict(const Cluster& c, const HeightField& field, std::size_t motions) {
    py::dict d;
    d["above"] = c.above;
    d["samples"] = c.samples;
    d["area"] = c.area;
    d["volume"] = c.volume;
    d["worst"] = to_dict(std::optional(c.worst), field);
    d["centroid"] = py::make_tuple(c.centroid.x(), c.centroid.y(), c.centroid.z());
    const Vec3 low = c.box.min(), high = c.box.max();
    d["box"] = py::make_tuple(py::make_tuple(low.x(), low.y(), low.z()),
                              py::make_tuple(high.x(), high.y(), high.z()));
    d["extent"] = c.extent;
    d["width"] = c.width;
    d["faces"] = c.faces;
    d["zones"] = c.zones;
    d["untouched_area"] = c.untouched_area;
    d["motion_count"] = c.motions.size();
    py::list list;
    for (std::size_t k = 0; k < std::min(motions, c.motions.size()); ++k) {
        py::dict motion;
        motion["motion"] = c.motions[k].motion;
        motion["share"] = c.motions[k].share;
        motion["depth"] = c.motions[k].depth;
        list.append(motion);
    }
    d["motions"] = list;
    return d;
}

py::object to_dict(const std::optional<WavinessFigures>& figures) {
    if (!figures) return py::none();
    py::dict d;
    d["profiles"] = figures->profiles;
    d["mean"] = figures->mean;
    d["total"] = figures->total;
    return d;
}

}  // namespace

void bind_verdict(py::module_& m) {
    m.attr("NO_CLUSTER") = Verdict::kNone;
    m.def(
        "judge",
        [](const HeightField& field, const Band& rest, const py::list& zones, std::size_t clusters,
           std::size_t motions) {
            std::vector<ToleranceZone> given;
            for (const auto& zone : zones) given.push_back(zone_from(zone));
            Verdict verdict;
            {
                const py::gil_scoped_release release;
                verdict = judge(field, given, {rest.first, rest.second});
            }
            py::dict d;
            d["whole"] = to_dict(verdict.whole, field);
            d["faces"] = to_list(verdict.faces, field);
            d["zones"] = to_list(verdict.zones, field);
            py::list listed;
            std::array<std::size_t, 2> count{};
            std::array<double, 2> area{};
            for (const Cluster& cluster : verdict.clusters) {
                if (listed.size() < clusters) listed.append(to_dict(cluster, field, motions));
                ++count[cluster.above ? 1 : 0];
                area[cluster.above ? 1 : 0] += cluster.area;
            }
            d["clusters"] = listed;
            d["cluster_counts"] = py::make_tuple(count[0], count[1]);
            d["cluster_areas"] = py::make_tuple(area[0], area[1]);
            d["zone"] = own(std::move(verdict.zone));
            d["cluster"] = own(std::move(verdict.cluster));
            return d;
        },
        py::arg("field"), py::arg("tolerance"), py::arg("zones") = py::list(),
        py::arg("clusters") = 1000, py::arg("motions") = 100,
        "Judges the deviations: by the bands (mm, lower and upper) of the zones, dicts of "
        "tolerance, "
        "faces (from 0), edge_radius (mm) and thickness, where later ones override earlier ones, "
        "and "
        "by `tolerance` elsewhere. A dict: whole, faces, zones (as given, then the rest), clusters "
        "(at most so many, with at most so many motions), cluster_counts and cluster_areas (below, "
        "above) of all, and zone, cluster (NO_CLUSTER: in tolerance) per sample. mm, mm2, mm3; see "
        "inspection/verdict.h.");
    m.def(
        "zone_of_samples",
        [](const HeightField& field, const py::list& zones) {
            std::vector<ToleranceZone> given;
            for (const auto& zone : zones) given.push_back(zone_from(zone));
            std::vector<std::uint32_t> zone;
            {
                const py::gil_scoped_release release;
                zone = zone_of_samples(field, given);
            }
            return own(std::move(zone));
        },
        py::arg("field"), py::arg("zones"), "(n,) number of the last zone that holds the sample.");
    m.def(
        "measure_thickness",
        [](const HeightField& field, const std::vector<std::uint32_t>& samples,
           const TriangleMesh& others, const RunContext* context) {
            for (const std::uint32_t i : samples) {
                if (i >= field.size())
                    throw InputError("call.no_such_sample", "there is no sample {index}",
                                     {{"index", i}});
            }
            Thickness found;
            {
                const py::gil_scoped_release release;
                found = measure_thickness(field, samples, others,
                                          context != nullptr ? *context : RunContext());
            }
            return py::make_tuple(own(std::move(found.design)), own(std::move(found.deviation)));
        },
        py::arg("field"), py::arg("samples"), py::arg("others"), py::arg("context") = nullptr,
        "(design, deviation): the design's thickness at the samples and how far the ground part's "
        "is from it, mm; NaN where it cannot be measured. others: mesh of the faces that are not "
        "sampled.");
    m.def(
        "gaussian_filter",
        [](const Doubles& values, double step, double cutoff) {
            return own(gaussian_filter({values.data(), static_cast<std::size_t>(values.size())},
                                       step, cutoff));
        },
        py::arg("values"), py::arg("step"), py::arg("cutoff"),
        "Profile filtered by ISO 16610-21's Gaussian low-pass; step and cutoff in mm.");
    m.def(
        "waviness",
        [](const HeightField& field, const Doubles& ends, const Bools& begins,
           const RunContext* context) {
            if (ends.ndim() != 2 || ends.shape(1) != 3 || begins.size() != ends.shape(0)) {
                throw InputError("call.waviness",
                                 "waviness needs ends of shape (m, 3) and m flags");
            }
            std::vector<MotionEnd> motions(static_cast<std::size_t>(ends.shape(0)));
            const auto p = ends.unchecked<2>();
            for (py::ssize_t k = 0; k < ends.shape(0); ++k) {
                motions[static_cast<std::size_t>(k)] = {Vec3(p(k, 0), p(k, 1), p(k, 2)),
                                                        begins.data()[k]};
            }
            std::vector<FaceWaviness> found;
            {
                const py::gil_scoped_release release;
                found = waviness(field, motions, context != nullptr ? *context : RunContext());
            }
            py::list list;
            for (const FaceWaviness& face : found) {
                py::dict d;
                d["face"] = face.face;
                d["pass_distance"] = face.pass_distance;
                d["short_cutoff"] = face.short_cutoff;
                d["long_cutoff"] = face.long_cutoff;
                d["along"] = to_dict(face.along);
                d["across"] = to_dict(face.across);
                d["reason"] = face.reason;
                list.append(d);
            }
            return list;
        },
        py::arg("field"), py::arg("ends"), py::arg("begins"), py::arg("context") = nullptr,
        "Waviness of each face along and across the feed; ends (m, 3): where the motions end, mm; "
        "begins (m,): the motion is a program's first. See inspection/waviness.h.");
}

}  // namespace beltgrinding::python
