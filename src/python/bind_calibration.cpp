#include "base/student.h"
#include "dict.h"
#include "removal/calibration.h"

namespace beltgrinding::python {
namespace {

constexpr std::array<const char*, kGrindParameters> kNames{
    "ln_coefficient",     "pressure_exponent", "speed_exponent", "feed_exponent",
    "time_exponent",      "area_exponent",     "ln_wear_scale",  "wear_rest",
    "pressure_threshold", "ln_saturation",     "wear_exponent",  "grit_exponent",
    "cut_exponent",       "first_share",       "ln_first_ratio", "loading_share"};

MeasuredGrinds grinds_from(const py::dict& given) {
    py::dict d = copy_of(given);
    MeasuredGrinds g;
    g.force = take(d, "force", Eigen::ArrayXd());
    g.area = take(d, "area", Eigen::ArrayXd());
    g.speed = take(d, "speed", Eigen::ArrayXd());
    g.feed = take(d, "feed", Eigen::ArrayXd());
    g.time = take(d, "time", Eigen::ArrayXd());
    g.wear = take(d, "wear", Eigen::ArrayXd());
    g.spread = take(d, "spread", Eigen::ArrayXd());
    g.measured = take(d, "measured", Eigen::ArrayXd());
    g.relative = take(d, "relative", Eigen::ArrayXXd());
    g.grit = take(d, "grit", Eigen::ArrayXd());
    g.cut = take(d, "cut", Eigen::ArrayXd());
    g.loading = take(d, "loading", Eigen::ArrayXd());
    g.areas = take(d, "areas", Eigen::ArrayXd());
    refuse_rest(d, "grinds");
    g.validate();
    return g;
}

GrindReferences references_from(const py::dict& given) {
    py::dict d = copy_of(given);
    GrindReferences r;
    r.pressure = take(d, "pressure", r.pressure);
    r.speed = take(d, "speed", r.speed);
    r.feed = take(d, "feed", r.feed);
    r.time = take(d, "time", r.time);
    r.area = take(d, "area", r.area);
    r.grit = take(d, "grit", r.grit);
    refuse_rest(d, "references");
    return r;
}

}  // namespace

void bind_calibration(py::module_& m) {
    m.def("student_quantile", py::vectorize(student_quantile), py::arg("share"), py::arg("freedom"),
          "The t below which a share lies, of Student's t; freedom inf: the normal distribution.");
    m.attr("GRIND_PARAMETERS") = py::cast(kNames);
    m.def(
        "log_grinds",
        [](const GrindVector& parameters, const py::dict& grinds, const py::dict& references) {
            const MeasuredGrinds g = grinds_from(grinds);
            const GrindReferences r = references_from(references);
            const Eigen::Index n = g.measured.size();
            Eigen::VectorXd values(n);
            Eigen::MatrixXd gradients(n, static_cast<int>(kGrindParameters));
            GrindVector gradient;
            for (Eigen::Index i = 0; i < n; ++i) {
                values[i] = log_grind(parameters, r, g, i, g.area[i], &gradient);
                gradients.row(i) = gradient;
            }
            return py::make_tuple(values, gradients);
        },
        py::arg("parameters"), py::arg("grinds"), py::arg("references"),
        "ln of what is removed (n,) and its gradient (n, parameters), by GRIND_PARAMETERS; "
        "grinds: dict of arrays (n,) force N, area mm2, speed mm/s, feed mm/s (0: stationary), "
        "time s, wear, spread mm2 (1: volumes; nan: depth over the area), measured, relative (n, "
        "m) "
        "pressure over the mean on equal shares of the contact, grit, cut (share of a fresh "
        "belt's that remains) and loading (mean over the grind), each of which may be missing.");
    m.def(
        "calibrate",
        [](const py::dict& grinds, const py::dict& references, const GrindVector& start,
           const GrindVector& lower, const GrindVector& upper,
           const std::array<bool, kGrindParameters>& free, const GrindVector& prior_mean,
           const GrindVector& prior_deviation) {
            const MeasuredGrinds g = grinds_from(grinds);
            const GrindReferences r = references_from(references);
            const CalibrationSettings settings{start, lower,      upper,
                                               free,  prior_mean, prior_deviation};
            Calibration c;
            {
                const py::gil_scoped_release release;
                c = calibrate(g, r, settings);
            }
            py::dict d;
            d["parameters"] = c.parameters;
            d["covariance"] = c.covariance;
            d["information"] = c.information;
            d["at_bound"] = c.at_bound;
            d["scatter"] = c.scatter;
            d["log_likelihood"] = c.log_likelihood;
            d["residual"] = c.residual;
            d["weight"] = c.weight;
            d["shares"] = c.shares;
            d["posterior"] = c.posterior;
            d["iterations"] = c.iterations;
            d["converged"] = c.converged;
            return d;
        },
        py::arg("grinds"), py::arg("references"), py::arg("start"), py::arg("lower"),
        py::arg("upper"), py::arg("free"), py::arg("prior_mean"), py::arg("prior_deviation"),
        "Robust least squares of ln(measured) with bounds and normal priors (deviation inf: none); "
        "grinds as log_grinds takes them, with "
        "'areas' (k,) mm2 that an unknown (nan) area can be. parameters, covariance, information "
        "(sandwich, and sum of w J J^T), at_bound, scatter, log_likelihood, "
        "residual and weight "
        "(n,), shares (k,), "
        "posterior (n, k), iterations, converged.");
}

}  // namespace beltgrinding::python
