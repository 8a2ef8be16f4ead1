#include "base/stopwatch.h"
#include "contact/surrogate.h"
#include "dict.h"
#include "training/train_regression.h"

namespace beltgrinding::python {
namespace {

using Cells = py::array_t<double, py::array::c_style | py::array::forcecast>;

ContactProblem problem_from(const Cells& gap, const Cells& coverage, double ds, double width) {
    if (gap.ndim() != 2 || coverage.ndim() != 2 || gap.size() != coverage.size()) {
        throw InputError("call.contact_arrays",
                         "contact: gap and coverage must be arrays (ny, nx)");
    }
    ContactProblem problem;
    problem.grid.nx = static_cast<int>(gap.shape(1));
    problem.grid.ny = static_cast<int>(gap.shape(0));
    problem.grid.ds = ds;
    problem.grid.dy = width / problem.grid.ny;
    problem.gap = Eigen::Map<const Eigen::ArrayXd>(gap.data(), gap.size());
    problem.coverage = Eigen::Map<const Eigen::ArrayXd>(coverage.data(), gap.size());
    return problem;
}

py::dict to_dict(const TrainedRegression& r) {
    py::dict d;
    d["vectors"] = Eigen::MatrixXf(r.vectors.transpose());
    d["coefficients"] = r.coefficients;
    d["mean"] = r.mean;
    d["deviation"] = r.deviation;
    d["rho"] = r.rho;
    d["gamma"] = r.gamma;
    d["scale"] = r.scale;
    return d;
}

}  // namespace

TrainedRegression regression_from(const py::dict& given) {
    py::dict d = copy_of(given);
    TrainedRegression r;
    r.vectors = take(d, "vectors", Eigen::MatrixXf()).transpose().eval();
    r.coefficients = take(d, "coefficients", r.coefficients);
    r.mean = take(d, "mean", r.mean);
    r.deviation = take(d, "deviation", r.deviation);
    r.rho = take(d, "rho", r.rho);
    r.gamma = take(d, "gamma", r.gamma);
    r.scale = take(d, "scale", r.scale);
    refuse_rest(d, "regression");
    return r;
}

void bind_surrogate(py::module_& m) {
    m.def(
        "solve_gap",
        [](const Cells& gap, const Cells& coverage, double ds, const py::dict& wheel,
           const py::dict& compliance, double force, double tolerance) {
            const ContactWheel shape = wheel_from(wheel);
            ContactProblem problem = problem_from(gap, coverage, ds, shape.width);
            problem.force = force;
            problem.tolerance = tolerance;
            const auto elastic = compliance_from(compliance, shape, force);
            ContactSolution solution;
            double seconds = 0.0;
            {
                const py::gil_scoped_release release;
                elastic->set_grid(problem.grid);
                const Stopwatch watch(seconds);
                solution = elastic->solve(problem);
            }
            py::dict d = contact_to_dict(problem.grid, solution);
            d["gap"] = cells(problem.grid, problem.gap);
            d["coverage"] = cells(problem.grid, problem.coverage);
            d["beyond_placed"] = solution.approach;
            d["time"] = seconds;
            d["model"] = elastic->describe();
            return d;
        },
        py::arg("gap"), py::arg("coverage"), py::arg("ds"), py::arg("wheel"), py::arg("compliance"),
        py::arg("force"), py::arg("tolerance") = 1e-3,
        "The contact at a gap given cell by cell: gap (ny, nx) mm from the wheel where it stands "
        "undeformed (inf: nothing there), coverage (ny, nx) in [0, 1], ds mm along the "
        "circumference, dy what divides the wheel's width. Gives what single_contact does; "
        "approach counts from where the wheel stands.");
    m.def(
        "surrogate_features",
        [](const Cells& gap, const Cells& coverage, double ds, double width, double approach,
           double cell, double rim_thickness) {
            const ContactProblem problem = problem_from(gap, coverage, ds, width);
            problem.validate();
            const ContactFeatures features{cell, rim_thickness};
            if (!(approach > problem.gap.minCoeff())) {
                throw InputError("call.approach",
                                 "surrogate: the approach must exceed the smallest gap");
            }
            std::vector<int> cells = features.candidates(problem, approach);
            const Eigen::MatrixXf values = features.of(problem, approach, cells).transpose();
            return py::make_tuple(own(std::move(cells)), values);
        },
        py::arg("gap"), py::arg("coverage"), py::arg("ds"), py::arg("width"), py::arg("approach"),
        py::arg("cell"), py::arg("rim_thickness"),
        "What a surrogate sees of a contact: (cells (n,) indices into the flattened grid that may "
        "bear pressure, features (n, m)).");
    m.def(
        "train_regression",
        [](const Eigen::MatrixXf& features, const Eigen::VectorXf& targets, double cost,
           double gamma, double epsilon) {
            TrainedRegression result;
            {
                const py::gil_scoped_release release;
                result = train_regression(features.transpose(), targets, {cost, gamma, epsilon});
            }
            return to_dict(result);
        },
        py::arg("features"), py::arg("targets"), py::arg("cost"), py::arg("gamma"),
        py::arg("epsilon"),
        "Epsilon support-vector regression by libsvm: features (n, m), targets (n,). A dict that "
        "compliance takes as 'regression'.");
}

}  // namespace beltgrinding::python
