#include "base/stopwatch.h"
#include "dict.h"
#include "simulation_settings.h"
#include "surrogate/surrogate.h"
#include "training/train_regression.h"

namespace beltgrinding::python {
namespace {

using Cells = py::array_t<double, py::array::c_style | py::array::forcecast>;

ContactGrid grid_of(const Cells& gap, double ds, double width) {
    if (gap.ndim() != 2 || gap.size() == 0) {
        throw InputError("call.contact_arrays",
                         "contact: gap and coverage must be arrays (ny, nx)");
    }
    ContactGrid grid;
    grid.nx = static_cast<int>(gap.shape(1));
    grid.ny = static_cast<int>(gap.shape(0));
    grid.ds = ds;
    grid.dy = width / grid.ny;
    return grid;
}

ContactProblem problem_from(const Cells& gap, const Cells& coverage) {
    if (gap.ndim() != 2 || coverage.ndim() != 2 || gap.size() != coverage.size()) {
        throw InputError("call.contact_arrays",
                         "contact: gap and coverage must be arrays (ny, nx)");
    }
    ContactProblem problem;
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
        [](const Cells& gap, const Cells& coverage, double ds, const py::object& wheel,
           const py::object& elasticity, double force, double tolerance) {
            const ContactWheel shape = wheel_from(Record(wheel));
            const ContactGrid grid = grid_of(gap, ds, shape.width);
            ContactProblem problem = problem_from(gap, coverage);
            problem.force = force;
            problem.tolerance = tolerance;
            const auto elastic = compliance_from(Record(elasticity), shape, force);
            ContactSolution solution;
            double seconds = 0.0;
            std::string model;
            {
                const py::gil_scoped_release release;
                const auto prepared = elastic->prepare(grid);
                model = prepared->describe();
                const Stopwatch watch(seconds);
                solution = prepared->solve(problem);
            }
            py::dict d = contact_to_dict(grid, solution);
            d["gap"] = cells(grid, problem.gap);
            d["coverage"] = cells(grid, problem.coverage);
            d["beyond_placed"] = solution.approach;
            d["time"] = seconds;
            d["model"] = model;
            return d;
        },
        py::arg("gap"), py::arg("coverage"), py::arg("ds"), py::arg("wheel"), py::arg("elasticity"),
        py::arg("force"), py::arg("tolerance") = 1e-3,
        "The contact at a gap given cell by cell: gap (ny, nx) mm from the wheel where it stands "
        "undeformed (inf: nothing there), coverage (ny, nx) in [0, 1], ds mm along the "
        "circumference, dy what divides the wheel's width. Gives what single_contact does; "
        "approach counts from where the wheel stands.");
    m.def(
        "surrogate_features",
        [](const Cells& gap, const Cells& coverage, double ds, double width, double approach,
           double cell, double rim_thickness) {
            const ContactGrid grid = grid_of(gap, ds, width);
            grid.validate();
            const ContactProblem problem = problem_from(gap, coverage);
            problem.validate(grid);
            const ContactFeatures features{cell, rim_thickness};
            if (!(approach > problem.gap.minCoeff())) {
                throw InputError("call.approach",
                                 "surrogate: the approach must exceed the smallest gap");
            }
            std::vector<int> cells = features.candidates(grid, problem, approach);
            const Eigen::MatrixXf values = features.of(grid, problem, approach, cells).transpose();
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
        "a surrogate has as 'regression'.");
}

}  // namespace beltgrinding::python
