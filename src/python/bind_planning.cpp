#include "arrays.h"
#include "dict.h"
#include "planning/dwell.h"

namespace beltgrinding::python {
namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
std::vector<T> vector_of(const Array<T>& values) {
    return std::vector<T>(values.data(), values.data() + values.size());
}

}  // namespace

void bind_planning(py::module_& m) {
    py::class_<Influence>(m, "Influence", "How much every motion of a path removed where.")
        .def(py::init<>())
        .def(py::init([](const Array<std::size_t>& first, const Array<std::uint32_t>& sample,
                         const Array<float>& depth) {
                 Influence influence;
                 influence.first = vector_of(first);
                 influence.sample = vector_of(sample);
                 influence.depth = vector_of(depth);
                 return influence;
             }),
             py::arg("first"), py::arg("sample"), py::arg("depth"),
             "first (motions + 1,), sample, depth (entries,) mm: column by column.")
        .def("append", &Influence::append, py::arg("next"), "Goes on with the next path's motions.")
        .def(
            "grouped",
            [](const Influence& i, const Array<std::uint32_t>& group, std::size_t count) {
                return i.grouped({group.data(), static_cast<std::size_t>(group.size())}, count);
            },
            py::arg("group"), py::arg("count"),
            "That of groups of motions that change together; group (motions,): each one's number.")
        .def(
            "in_the_end",
            [](const Influence& i, const Influence& removed, const Array<float>& area,
               const Array<std::uint32_t>& group, std::size_t count, const RunContext* context) {
                return i.in_the_end(removed, {area.data(), static_cast<std::size_t>(area.size())},
                                    {group.data(), static_cast<std::size_t>(group.size())}, count,
                                    context != nullptr ? *context : RunContext{});
            },
            py::arg("removed"), py::arg("area"), py::arg("group"), py::arg("count"),
            py::arg("context") = nullptr, py::call_guard<py::gil_scoped_release>(),
            "What is left of it after all motions, by groups as of `grouped`: later motions press "
            "less where earlier ones went deeper. removed: what the same motions removed, with its "
            "feedback; area (samples,) mm2. Raises InputError, Cancelled.")
        .def("__len__", &Influence::motions)
        .def_property_readonly(
            "first", [](const Influence& i) { return own(std::vector<std::size_t>(i.first)); })
        .def_property_readonly(
            "sample", [](const Influence& i) { return own(std::vector<std::uint32_t>(i.sample)); })
        .def_property_readonly("depth",
                               [](const Influence& i) { return own(std::vector<float>(i.depth)); })
        .def_property_readonly(
            "feedback", [](const Influence& i) { return own(std::vector<float>(i.feedback)); },
            "(motions,) 1/mm, or none: how a motion answers what it finds lower.");
    m.def(
        "plan_dwell",
        [](const Influence& influence, const Eigen::ArrayXd& excess, const Eigen::ArrayXd& half,
           const Eigen::ArrayXd& weight, const Eigen::ArrayXd& lower, const Eigen::ArrayXd& upper,
           const Eigen::ArrayXd& pace, const py::dict& given, const RunContext* context,
           const Eigen::ArrayXd& time_cost) {
            const DwellProblem problem{&influence, excess, half, weight,
                                       lower,      upper,  pace, time_cost};
            DwellSettings settings;
            py::dict d = copy_of(given);
            settings.inner_share = take(d, "inner_share", settings.inner_share);
            settings.inner_cost = take(d, "inner_cost", settings.inner_cost);
            settings.smoothing = take(d, "smoothing", settings.smoothing);
            settings.reweightings = take(d, "reweightings", settings.reweightings);
            settings.accuracy = take(d, "accuracy", settings.accuracy);
            settings.iterations = take(d, "iterations", settings.iterations);
            refuse_rest(d, "settings");
            DwellSolution solution;
            {
                const py::gil_scoped_release release;
                solution =
                    plan_dwell(problem, settings, context != nullptr ? *context : RunContext());
            }
            py::dict found;
            found["factor"] = solution.factor;
            found["excess"] = solution.excess;
            found["price"] = solution.price;
            found["residual"] = solution.residual;
            found["objective"] = solution.objective;
            found["iterations"] = solution.iterations;
            return found;
        },
        py::arg("influence"), py::arg("excess"), py::arg("half"), py::arg("weight"),
        py::arg("lower"), py::arg("upper"), py::arg("pace"), py::arg("settings") = py::dict(),
        py::arg("context") = nullptr, py::arg("time_cost") = Eigen::ArrayXd(),
        "How many times as long each motion should take: see planning's dwell.h. Returns "
        "dict(factor, price (motions,), excess (samples,) mm, residual, objective, iterations).");
}

}  // namespace beltgrinding::python
