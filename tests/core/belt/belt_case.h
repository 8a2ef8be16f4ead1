#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "beltgrinding/belt_machine.h"

namespace beltgrinding::testing {

constexpr double kBeside = std::numeric_limits<double>::infinity();  // mm: no work there

/// mm that a circle lies below its highest point.
inline double circle(double radius, double x) {
    return std::abs(x) < radius ? radius - std::sqrt(radius * radius - x * x) : kBeside;
}

/// mm by which a circle of that curvature, 1/mm, has gone down; negative: a hollow, level beyond
/// its radius.
inline double arc(double curvature, double x) {
    if (curvature < 0.0) return std::max(-circle(-1.0 / curvature, x), 1.0 / curvature);
    return curvature > 0.0 ? circle(1.0 / curvature, x) : 0.0;
}

/// The belt of the finite-element references.
inline BeltMachine reference_belt(BeltMachine::Kind kind, BeltRun::Rollers rollers) {
    BeltMachine machine;
    machine.kind = kind;
    machine.belt.surface_stiffness = 200.0;
    machine.run.rollers = rollers;
    machine.platen.layers = {{5.0, 2.0, 0.4}};
    machine.platen.layer_surface_stiffness = 100.0;
    return machine;
}

/// The gap to a surface of which `depth(x, y)` is how far it lies below its highest point, mm.
template <class Depth>
ContactProblem problem_of(const ContactGrid& grid, Depth depth) {
    ContactProblem problem;
    problem.gap.resize(grid.cells());
    problem.coverage = Eigen::ArrayXd::Ones(grid.cells());
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const int cell = j * grid.nx + i;
            problem.gap[cell] = depth(grid.s(i), grid.y(j));
            if (!std::isfinite(problem.gap[cell])) problem.coverage[cell] = 0.0;
        }
    }
    problem.tolerance = 1e-4;
    problem.max_iterations = 60;
    return problem;
}

template <class Depth>
ContactProblem at_depth(const ContactGrid& grid, double approach, Depth depth) {
    ContactProblem problem = problem_of(grid, depth);
    problem.force_control = false;
    problem.approach = approach;
    return problem;
}

/// A belt's contact by finite elements: forces of rows of 1 mm, of a quarter.
struct BeltReference {
    double force = 0.0;               // N
    double x_max = 0.0, y_max = 0.0;  // mm
    std::vector<double> by_x, by_y;   // N, of both sides of the other axis
};

inline std::filesystem::path reference_file(const std::string& name) {
    const char* root = std::getenv("BELTGRINDING_SHARED");
    return std::filesystem::path(root != nullptr ? root : "../shared") / "reference" / name;
}

inline BeltReference read_reference(const std::filesystem::path& path) {
    BeltReference reference;
    std::ifstream file(path);
    std::string line;
    int rows = 0;
    while (std::getline(file, line)) {
        if (line.rfind("# approach", 0) == 0) {
            const auto number = [&](const std::string& after) {
                return std::stod(line.substr(line.find(after) + after.size()));
            };
            reference.force = number("force F=");
            reference.x_max = number("extent x -");
            reference.y_max = number("y -");
        } else if (line.rfind("# row forces", 0) == 0) {
            std::istringstream words(line.substr(line.find("): ") + 3));
            std::vector<double>& to = rows++ == 0 ? reference.by_x : reference.by_y;
            std::string word;
            while (words >> word) to.push_back(std::stod(word.substr(word.find(':') + 1)));
        }
    }
    return reference;
}

/// Forces of rows of the solution on one side of the middle, N, and how far it reaches, mm.
struct BeltRows {
    std::vector<double> by_x, by_y;
    double x_max = 0.0, y_max = 0.0;
};

inline BeltRows rows_of(const ContactGrid& grid, const ContactSolution& solution, double row) {
    BeltRows rows;
    const auto add = [row](std::vector<double>& to, double at, double force) {
        const auto k = static_cast<std::size_t>(at / row);
        if (to.size() <= k) to.resize(k + 1, 0.0);
        to[k] += force;
    };
    for (int j = 0; j < grid.ny; ++j) {
        for (int i = 0; i < grid.nx; ++i) {
            const double force = solution.pressure[j * grid.nx + i] * grid.cell_area();
            if (!(force > 0.0)) continue;
            const double x = grid.s(i), y = grid.y(j);
            if (x > 0.0) add(rows.by_x, x, force);
            if (y > 0.0) add(rows.by_y, y, force);
            rows.x_max = std::max(rows.x_max, std::abs(x) + 0.5 * grid.ds);
            rows.y_max = std::max(rows.y_max, std::abs(y) + 0.5 * grid.dy);
        }
    }
    return rows;
}

/// Of 1 mm, in rows of 2 mm.
inline std::vector<double> in_pairs(const std::vector<double>& rows) {
    std::vector<double> pairs((rows.size() + 1) / 2, 0.0);
    for (std::size_t k = 0; k < rows.size(); ++k) pairs[k / 2] += rows[k];
    return pairs;
}

/// Every row within `share` of its force; a row that carries less than a fifth of the largest one,
/// which is where the contact ends within it, within that share of the largest.
inline void expect_rows(const std::vector<double>& ours, const std::vector<double>& truth,
                        double share) {
    double largest = 0.0;
    for (const double force : truth) largest = std::max(largest, force);
    for (std::size_t k = 0; k < std::max(ours.size(), truth.size()); ++k) {
        const double a = k < ours.size() ? ours[k] : 0.0, b = k < truth.size() ? truth[k] : 0.0;
        EXPECT_NEAR(a, b, share * (b < 0.2 * largest ? largest : b)) << "row " << k;
    }
}

}  // namespace beltgrinding::testing
