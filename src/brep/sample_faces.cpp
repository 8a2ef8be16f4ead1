#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "base/large_memory.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "crowns.h"
#include "face_sampler.h"
#include "heightfield/edge_rays.h"
#include "shape_impl.h"

namespace beltgrinding {
namespace {

constexpr double kZeroArea = 1e-9;    // mm2
constexpr double kMostSamples = 4e9;  // indices are 32 bits wide
// Held while sampling: the field's arrays with two triangles a sample, and the face's own before
// they are copied into it.
constexpr double kBytesPerSample = 2 * (57 + 2 * sizeof(Triangle)) + 110;
constexpr double kFitMargin = 1.02;        // the spacing that is proposed must really fit
constexpr double kAreaDisagreement = 0.1;  // between integration and samples: worth a warning
constexpr std::size_t kEnoughSamples = 200;
constexpr int kMostRefinements = 4;

double perimeter(const TopoDS_Face& face) {
    try {
        GProp_GProps p;
        BRepGProp::LinearProperties(face, p);
        return std::abs(p.Mass());
    } catch (const Standard_Failure&) {
        return 0;
    }
}

void refuse_if_too_large(double area, double length, double spacing, std::size_t max_bytes) {
    const double limit = max_bytes > 0 ? double(max_bytes) : 0.5 * double(usable_memory());
    const auto bytes = [&](double h) {
        return (area / (h * h) + 2 * length / h) * kBytesPerSample;
    };
    const auto fits = [&](double h) {
        return bytes(h) <= limit && area / (h * h) + 2 * length / h < kMostSamples;
    };
    if (fits(spacing)) return;
    double fitting = spacing;
    while (!fits(fitting)) fitting *= kFitMargin;
    // Rounded up to two digits.
    const double unit = std::pow(10.0, std::floor(std::log10(fitting)) - 1);
    fitting = std::ceil(fitting / unit) * unit;
    throw InputError("brep.out_of_memory",
                     "a spacing of {spacing:.3g} mm needs about {needed:.3g} GB of memory, more "
                     "than the {allowed:.3g} GB allowed; a spacing of {fitting:.3g} mm would fit",
                     {{"spacing", spacing},
                      {"needed", bytes(spacing) / 1e9},
                      {"allowed", limit / 1e9},
                      {"fitting", fitting}});
}

struct Job {
    std::size_t face = 0;
    double area = 0;
    FaceSamples samples;
    std::optional<Fact> warning;
};

void append_all(std::vector<Job>& jobs, HeightField& field, const RunContext& context) {
    std::vector<std::size_t> first(jobs.size() + 1, 0);
    for (std::size_t i = 0; i < jobs.size(); ++i)
        first[i + 1] = first[i] + jobs[i].samples.point.size();
    const std::size_t n = first.back();
    if (jobs.size() == 1) {
        FaceSamples& s = jobs[0].samples;
        field.point = std::move(s.point);
        field.normal = std::move(s.normal);
        field.area = std::move(s.area);
        field.flags = std::move(s.flags);
        field.triangles = PackedTriangles(s.triangles);
        s.triangles = {};
        reserve_large(field.face, n);
        field.face.assign(n, static_cast<std::uint32_t>(jobs[0].face));
    } else {
        resize_large(field.point, n);
        resize_large(field.normal, n);
        resize_large(field.area, n);
        resize_large(field.face, n);
        field.flags.resize(n);
        parallel_blocks(jobs.size(), 1, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                FaceSamples& s = jobs[i].samples;
                const auto at = static_cast<std::ptrdiff_t>(first[i]);
                std::copy(s.point.begin(), s.point.end(), field.point.begin() + at);
                std::copy(s.normal.begin(), s.normal.end(), field.normal.begin() + at);
                std::copy(s.area.begin(), s.area.end(), field.area.begin() + at);
                std::copy(s.flags.begin(), s.flags.end(), field.flags.begin() + at);
                std::fill_n(field.face.begin() + at, s.point.size(),
                            static_cast<std::uint32_t>(jobs[i].face));
                const auto base = static_cast<std::uint32_t>(first[i]);
                for (Triangle& t : s.triangles) t = {t[0] + base, t[1] + base, t[2] + base};
                s.point = {};
                s.normal = {};
                s.area = {};
                s.flags = {};
            }
        });
        for (Job& job : jobs) {  // one list, whose end moves on
            for (const Triangle& t : job.samples.triangles) field.triangles.push_back(t);
            job.samples.triangles = {};
        }
        field.triangles.shrink_to_fit();
    }
    resize_large(field.stock_height, n);
    resize_large(field.height, n);
}

Fact not_sampled(const Shape::Impl& impl, std::size_t face) {
    return {"brep.not_sampled",
            "face {face} of {shape} cannot be sampled: ",
            {{"face", face + 1}, {"shape", impl.name}}};
}

void refuse(const SamplingOptions& options) {
    if (!(options.spacing > 0) || !std::isfinite(options.spacing))
        throw InputError("brep.spacing", "the spacing must be above 0 mm, not {spacing:.3g}",
                         {{"spacing", options.spacing}});
    for (const double value : {options.precision, options.edge_spacing})
        if (!(value >= 0) || !std::isfinite(value))
            throw InputError("brep.precision",
                             "a precision, and a spacing at edges, must not be below 0 mm, as "
                             "{value:.3g} is",
                             {{"value", value}});
    if (!(options.depth > 0) || !std::isfinite(options.depth))
        throw InputError("brep.depth", "the depth must be above 0 mm, not {depth:.3g}",
                         {{"depth", options.depth}});
}

/// Jobs for the faces, all if none is named, with their areas. `border`: mm, all of their borders'
/// length.
std::vector<Job> jobs_of(const Shape& shape, std::vector<std::size_t> faces, double& border,
                         const RunContext& context) {
    const Shape::Impl& impl = shape.impl();
    if (faces.empty())
        for (std::size_t i = 0; i < shape.face_count(); ++i) faces.push_back(i);
    std::vector<char> chosen(shape.face_count(), 0);
    for (const std::size_t f : faces) {
        if (f >= shape.face_count())
            throw InputError(
                "brep.no_such_face", "{shape} has no face {face}; it has {count} faces",
                {{"shape", impl.name}, {"face", f + 1}, {"count", shape.face_count()}});
        if (chosen[f]++)
            throw InputError("brep.face_twice", "face {face} is chosen twice; once is enough",
                             {{"face", f + 1}});
    }
    std::vector<Job> jobs(faces.size());
    std::vector<double> length(faces.size(), 0.0);
    parallel_blocks(faces.size(), 1, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            jobs[i].face = faces[i];
            jobs[i].area = shape.face_area(faces[i]);
            length[i] = perimeter(impl.face(faces[i]));
        }
    });
    border = std::accumulate(length.begin(), length.end(), 0.0);
    return jobs;
}

/// mm2 of all jobs; refuses what is no area.
double whole_area(const std::vector<Job>& jobs, const Shape::Impl& impl) {
    double area = 0;
    for (const Job& job : jobs) {
        if (std::isinf(job.area))  // so the reader tells what it could not find in time
            throw InputError("brep.area_endless",
                             "the area of face {face} of {shape} was not found in the time that a "
                             "face is given; repair the shape or leave the face out",
                             {{"face", job.face + 1}, {"shape", impl.name}});
        if (!std::isfinite(job.area))
            throw InputError("brep.area_not_finite",
                             "face {face} of {shape} has an area that is not a number: its surface "
                             "evaluates to NaN; repair the shape or leave the face out",
                             {{"face", job.face + 1}, {"shape", impl.name}});
        area += job.area;
    }
    return area;
}

// A nose that turns by more than this between two neighbours, rad, is not seen well enough; where
// it is seen already, samples askew to it may turn by more.
constexpr double kMostTurn = 0.5, kStillHidden = 0.8;
constexpr double kFewHidden = 1e-3;   // of the samples: corners, for which no face is sampled finer
constexpr double kFewerHidden = 0.5;  // of the edges: else they are a crease, which stays one

/// Samples a face again until noses and edge rounds finer than the spacing have a row on each
/// crown: first finer where it bends, then all of it, as long as that shows more of them.
void resolve_crowns(FaceSamples& samples, FaceRequest request, const RunContext& context) {
    const double spacing = request.spacing;
    Crowns crowns = hidden_crowns(samples, spacing, kMostTurn);
    for (int k = 0; k < kMostRefinements && crowns.edges > 0; ++k) {
        const double enough = k > 0 ? kFewHidden * double(samples.point.size()) : 0.0;
        if (double(crowns.edges) <= enough) return;
        const bool all_finer = k > 1;
        // What the first samples saw of a nose is wider than it is; rows may miss it, too.
        request.edge_spacing =
            k > 0 ? std::min(crowns.spacing, 0.5 * request.edge_spacing) : crowns.spacing;
        if (all_finer) request.spacing *= 0.5;
        request.edge_spacing = std::min(request.edge_spacing, request.spacing);
        FaceSamples finer = sample_face(request, context);
        const Crowns still = hidden_crowns(finer, spacing, kStillHidden);
        if (all_finer && double(still.edges) > kFewerHidden * double(crowns.edges)) return;
        samples = std::move(finer);
        crowns = still;
    }
}

/// Takes the samples of a job's face as the request says for all, or says why there are none.
void take_samples(Job& job, FaceRequest request, SampleBudget* budget, const Shape::Impl& impl,
                  bool reversed, const RunContext& context) {
    if (job.area < kZeroArea) {
        job.warning = {"brep.face_without_area",
                       "face {face} of {shape} has no area and is left out",
                       {{"face", job.face + 1}, {"shape", impl.name}}};
        return;
    }
    try {
        request.face = impl.face(job.face);
        request.area = job.area;
        request.reverse = (request.face.Orientation() == TopAbs_REVERSED) != reversed;
        job.samples = sample_face(request, context);
        // It may be said how fine curved places are sampled.
        if (!(request.precision > 0 || request.edge_spacing > 0)) {
            request.budget = budget;
            resolve_crowns(job.samples, request, context);
        }
        if (job.samples.point.size() > kEnoughSamples &&
            std::abs(job.samples.sampled_area / job.area - 1) > kAreaDisagreement)
            job.warning = {"brep.areas_differ",
                           "face {face} of {shape} has an area of {area:.3g} mm2 by "
                           "integration, {sampled:.3g} mm2 by its samples: check the shape",
                           {{"face", job.face + 1},
                            {"shape", impl.name},
                            {"area", job.area},
                            {"sampled", job.samples.sampled_area}}};
    } catch (const Standard_Failure& failure) {
        throw InputError("brep.failure", "{reason}; repair the shape or leave the face out",
                         {{"reason", failure.GetMessageString()}})
            .within(not_sampled(impl, job.face));
    } catch (const InputError& error) {
        throw error.within(not_sampled(impl, job.face));
    }
}

void report_parameters(const std::vector<Job>& jobs, SamplingReport& report) {
    for (const Job& job : jobs) {
        const auto& found = job.samples.parameters;
        report.parameters.insert(report.parameters.end(), found.begin(), found.end());
        report.period.push_back(job.samples.period);
    }
}

}  // namespace

HeightField sample_faces(const Shape& shape, std::vector<std::size_t> faces,
                         const SamplingOptions& options, const RunContext& context,
                         SamplingReport* report) {
    const Shape::Impl& impl = shape.impl();
    refuse(options);
    double border = 0;
    std::vector<Job> jobs = jobs_of(shape, std::move(faces), border, context);
    refuse_if_too_large(whole_area(jobs, impl), border, options.spacing, options.max_bytes);
    SampleBudget budget;
    const double allowed =
        options.max_bytes > 0 ? double(options.max_bytes) : 0.5 * double(usable_memory());
    budget.limit = static_cast<std::size_t>(std::min(allowed / kBytesPerSample, kMostSamples));
    const std::vector<char> reversed = shape.reversed(context);
    context.report(0.05);

    FaceRequest request;
    request.spacing = options.spacing;
    request.precision = options.precision;
    request.edge_spacing = options.edge_spacing;
    if (options.precision > 0 || options.edge_spacing > 0) request.budget = &budget;
    request.parameters = options.parameters && report != nullptr;
    std::atomic<std::size_t> done{0};
    parallel_blocks(jobs.size(), 1, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            take_samples(jobs[i], request, &budget, impl, reversed[jobs[i].face] != 0, context);
            context.report(0.05 + 0.9 * double(++done) / double(jobs.size()));
        }
    });

    if (request.parameters) report_parameters(jobs, *report);
    HeightField field;
    field.spacing = options.spacing;
    field.depth = options.depth;
    append_all(jobs, field, context);
    lean_at_edges(field, context);
    if (field.size() == 0)
        throw InputError("brep.no_area", "{shape}: none of the chosen faces has an area",
                         {{"shape", impl.name}});
    if (report) {
        for (const Job& job : jobs) {
            report->face_area.push_back(job.area);
            if (job.warning) report->warnings.push_back(*job.warning);
        }
    }
    context.report(1.0);
    return field;
}

}  // namespace beltgrinding
