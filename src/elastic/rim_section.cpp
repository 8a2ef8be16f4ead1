#include "elastic/rim_section.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr double kGrowth = 1.7;          // of the elements' thickness, from the surface inwards
constexpr double kLargestRatio = 0.499;  // Poisson's
constexpr int kNodes = 8;                // of the serendipity element
constexpr int kDofs = 3 * kNodes;
constexpr double kCoarsest = 1.0 / 6.0;  // widest element, as a share of the rim's thickness
constexpr double kSideDecay = 0.5;       // of the axial displacement, in thicknesses
constexpr double kThinnest = 0.1;        // of the outermost layer that a profile leaves
constexpr double kStill = 1e-9;          // mean square of a mode that moves no cell

using ElementMatrix = Eigen::Matrix<double, kDofs, kDofs>;
using Strains = Eigen::Matrix<double, 6, kDofs>;

// Corners, then the middles of the sides, in the unit square (xi along r, eta along y).
constexpr std::array<std::array<int, 2>, kNodes> kCorner = {
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

void shape_functions(double xi, double eta, std::array<double, kNodes>& n,
                     std::array<double, kNodes>& n_xi, std::array<double, kNodes>& n_eta) {
    for (std::size_t a = 0; a < kNodes; ++a) {
        const double x = kCorner[a][0], e = kCorner[a][1];
        if (kCorner[a][0] != 0 && kCorner[a][1] != 0) {
            n[a] = 0.25 * (1 + x * xi) * (1 + e * eta) * (x * xi + e * eta - 1);
            n_xi[a] = 0.25 * x * (1 + e * eta) * (2 * x * xi + e * eta);
            n_eta[a] = 0.25 * e * (1 + x * xi) * (x * xi + 2 * e * eta);
        } else if (kCorner[a][0] == 0) {
            n[a] = 0.5 * (1 - xi * xi) * (1 + e * eta);
            n_xi[a] = -xi * (1 + e * eta);
            n_eta[a] = 0.5 * e * (1 - xi * xi);
        } else {
            n[a] = 0.5 * (1 + x * xi) * (1 - eta * eta);
            n_xi[a] = 0.5 * x * (1 - eta * eta);
            n_eta[a] = -eta * (1 + x * xi);
        }
    }
}

Eigen::Matrix<double, 6, 6> stiffness(const Elasticity& e) {
    const double nu = e.poissons_ratio;
    const double mu = 0.5 * e.youngs_modulus / (1.0 + nu);
    const double lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
    Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
    d.topLeftCorner<3, 3>().setConstant(lambda);
    d.diagonal() << lambda + 2 * mu, lambda + 2 * mu, lambda + 2 * mu, mu, mu, mu;
    return d;
}

/// The radii of an element's sides, mm: inner and outer one, at its ends along y.
struct Sides {
    std::array<double, 2> inner, outer;
};

/// K0, K1 and K2 of an element: K(n) = K0 + n K1 + n^2 K2.
std::array<ElementMatrix, 3> element(const Sides& sides, double length,
                                     const Eigen::Matrix<double, 6, 6>& d) {
    std::array<ElementMatrix, 3> k;
    for (ElementMatrix& m : k) m.setZero();
    const double half_y = 0.5 * length;
    const double gauss = 1.0 / std::sqrt(3.0);
    std::array<double, kNodes> n{}, n_xi{}, n_eta{};
    for (const double xi : {-gauss, gauss}) {
        for (const double eta : {-gauss, gauss}) {
            shape_functions(xi, eta, n, n_xi, n_eta);
            const double inner = std::lerp(sides.inner[0], sides.inner[1], 0.5 * (1.0 + eta));
            const double outer = std::lerp(sides.outer[0], sides.outer[1], 0.5 * (1.0 + eta));
            const double half_r = 0.5 * (outer - inner), r = 0.5 * (inner + outer) + half_r * xi;
            const double slope = 0.25 * ((1.0 - xi) * (sides.inner[1] - sides.inner[0]) +
                                         (1.0 + xi) * (sides.outer[1] - sides.outer[0]));
            Strains b0 = Strains::Zero(), b1 = Strains::Zero();
            for (int a = 0; a < kNodes; ++a) {
                const auto i = static_cast<std::size_t>(a);
                const double n_r = n_xi[i] / half_r, by_r = n[i] / r;
                const double n_y = (n_eta[i] - n_r * slope) / half_y;
                const int u = 3 * a, v = u + 1, w = u + 2;
                b0(0, u) = n_r;
                b0(1, u) = by_r;
                b1(1, v) = by_r;
                b0(2, w) = n_y;
                b1(3, u) = -by_r;
                b0(3, v) = n_r - by_r;
                b0(4, v) = n_y;
                b1(4, w) = -by_r;
                b0(5, u) = n_y;
                b0(5, w) = n_r;
            }
            const double weight = r * half_r * half_y;
            const Strains d0 = weight * d * b0, d1 = weight * d * b1;
            k[0] += b0.transpose() * d0;
            k[1] += b0.transpose() * d1 + b1.transpose() * d0;
            k[2] += b1.transpose() * d1;
        }
    }
    return k;
}

}  // namespace

double WheelRimDesign::thickness() const {
    double sum = 0.0;
    for (const RimLayer& layer : layers) sum += layer.thickness;
    return sum;
}

double WheelRimDesign::softest() const {
    double compliance = 0.0;
    for (const RimLayer& layer : layers) {
        compliance += layer.thickness / layer.elasticity.youngs_modulus;
    }
    return 1.0 / compliance;
}

double WheelRimDesign::drop_at(double y) const {
    if (drop.empty()) return 0.0;
    const auto last = static_cast<double>(drop.size() - 1);
    const double at = std::min(2.0 * std::abs(y) / width, 1.0) * last;
    const auto k = static_cast<std::size_t>(at);
    const double here = drop[k], next = drop[std::min(k + 1, drop.size() - 1)];
    return std::lerp(here, next, at - std::floor(at));
}

void WheelRimDesign::validate() const {
    const auto positive = [](double value, const char* code, const char* form) {
        if (!std::isfinite(value) || value <= 0.0) throw InputError(code, form, {{"value", value}});
    };
    positive(outer_radius, "rim.outer_radius",
             "wheel rim: the outer radius is {value:f} mm; give a positive one");
    positive(width, "rim.width", "wheel rim: the width is {value:f} mm; give a positive one");
    if (layers.empty()) throw InputError("rim.no_layer", "wheel rim: it has no layer of rubber");
    for (const RimLayer& layer : layers) {
        positive(layer.thickness, "rim.thickness",
                 "wheel rim: the thickness is {value:f} mm; give a positive one");
        layer.elasticity.validate(kLargestRatio);
    }
    for (const double d : drop) {
        if (!std::isfinite(d) || d < 0.0) throw std::invalid_argument("WheelRimDesign: drop");
    }
    if (thickness() >= outer_radius) {
        throw InputError(
            "rim.no_core",
            "wheel rim: its {thickness:.4g} mm leave no core in a wheel of {radius:.4g} "
            "mm radius; lower the rim's thickness, or take a larger wheel",
            {{"thickness", thickness()}, {"radius", outer_radius}});
    }
}

SideMode::SideMode(double width, double thickness, int cells, bool outwards)
    : half_width_(0.5 * width), decay_(kSideDecay * thickness), other_(outwards ? -1.0 : 1.0) {
    double square = 0.0;
    for (int j = 0; j < cells; ++j) {
        const double value = form((j + 0.5) * width / cells - half_width_);
        square += value * value;
    }
    scale_ = square > kStill * cells ? 1.0 / std::sqrt(square) : 0.0;
}

double SideMode::form(double y) const {
    return std::exp((y - half_width_) / decay_) + other_ * std::exp(-(y + half_width_) / decay_);
}

RimSection::RimSection(const WheelRimDesign& design, int cells, double finest)
    : radius_(design.outer_radius), cells_(cells) {
    design.validate();
    make_mesh(design, finest);
    even_ = assemble(design, true);
    odd_ = assemble(design, false);
}

void RimSection::make_mesh(const WheelRimDesign& design, double finest) {
    // Across the width: whole elements in every cell of the half.
    const double dy = design.width / cells_;
    const int parts =
        std::max(1, static_cast<int>(std::ceil(dy / (kCoarsest * design.thickness()))));
    y_ = {0.0};
    for (int a = 0; a < even(); ++a) {
        const bool middle = cells_ % 2 == 1 && a == 0;
        cell_width_.push_back(middle ? 0.5 * dy : dy);
        for (int p = 0; p < parts; ++p) {
            y_.push_back(y_.back() + cell_width_.back() / parts);
            cell_.push_back(a);
        }
    }
    // Inwards: fine under the surface, growing with the depth, with a line at every layer's border.
    double outer = design.outer_radius, size = 0.5 * finest;
    std::vector<double> lines = {outer};
    for (std::size_t l = design.layers.size(); l-- > 0;) {
        const double inner = outer - design.layers[l].thickness;
        while (lines.back() > inner) {
            double next = lines.back() - size;
            if (next - inner < 0.6 * size) next = inner;
            lines.push_back(next);
            layer_.push_back(static_cast<int>(l));
            size *= kGrowth;
        }
        outer = inner;
    }
    r_.assign(lines.rbegin(), lines.rend());
    std::reverse(layer_.begin(), layer_.end());
}

/// What can move of the nodes on a grid of half elements (the elements' middles have none),
/// numbered column by column; -1 is held: the core, and what the symmetry holds in the middle
/// plane.
class RimSection::Freedoms {
  public:
    Freedoms(int rows, int columns, bool symmetric)
        : height_(2 * rows + 1),
          number_(3 * static_cast<std::size_t>(height_) * static_cast<std::size_t>(2 * columns + 1),
                  -1) {
        for (int j = 0; j <= 2 * columns; ++j) {
            for (int i = 1; i < height_; ++i) {
                if (i % 2 == 1 && j % 2 == 1) continue;
                for (int c = 0; c < 3; ++c) {
                    const bool axial = c == 2;
                    if (j == 0 && axial == symmetric) continue;
                    number_[index(i, j, c)] = count_++;
                }
            }
        }
    }
    int count() const { return count_; }
    /// Of the node (i, j): 0 radial, 1 along the circumference, 2 axial.
    int at(int i, int j, int c) const { return number_[index(i, j, c)]; }
    /// The same on the surface.
    int on_surface(int j, int c) const { return at(height_ - 1, j, c); }
    /// Those of an element's nodes, one after the other.
    std::array<int, kDofs> of_element(int row, int column) const {
        std::array<int, kDofs> found{};
        for (std::size_t a = 0; a < kNodes; ++a)
            for (int c = 0; c < 3; ++c)
                found[3 * a + static_cast<std::size_t>(c)] =
                    at(2 * row + 1 + kCorner[a][0], 2 * column + 1 + kCorner[a][1], c);
        return found;
    }

  private:
    std::size_t index(int i, int j, int c) const {
        const auto row = static_cast<std::size_t>(j) * static_cast<std::size_t>(height_);
        return 3 * (row + static_cast<std::size_t>(i)) + static_cast<std::size_t>(c);
    }

    int height_;
    std::vector<int> number_;
    int count_ = 0;
};

void RimSection::add_stiffness(const WheelRimDesign& design, const Freedoms& freedoms,
                               Half& half) const {
    const double border = design.outer_radius - design.layers.back().thickness;
    const auto turned = [&](double radius, double y) {
        const double outermost = design.layers.back().thickness;
        const double left = std::max(1.0 - design.drop_at(y) / outermost, kThinnest);
        return radius > border ? border + (radius - border) * left : radius;
    };
    std::array<std::vector<Eigen::Triplet<double>>, 3> triplets;
    for (int i = 0; i + 1 < static_cast<int>(r_.size()); ++i) {
        const auto row = static_cast<std::size_t>(i);
        const auto d = stiffness(design.layers[static_cast<std::size_t>(layer_[row])].elasticity);
        for (int j = 0; j + 1 < static_cast<int>(y_.size()); ++j) {
            const auto column = static_cast<std::size_t>(j);
            const auto at_y = [&](double radius) {
                return std::array{turned(radius, y_[column]), turned(radius, y_[column + 1])};
            };
            const auto k =
                element({at_y(r_[row]), at_y(r_[row + 1])}, y_[column + 1] - y_[column], d);
            const std::array<int, kDofs> map = freedoms.of_element(i, j);
            for (int p = 0; p < kDofs; ++p) {
                for (int q = 0; q < kDofs; ++q) {
                    const int to = map[static_cast<std::size_t>(p)];
                    const int from = map[static_cast<std::size_t>(q)];
                    if (to < 0 || from < 0 || to < from) continue;
                    for (std::size_t m = 0; m < 3; ++m)
                        triplets[m].emplace_back(to, from, k[m](p, q));
                }
            }
        }
    }
    for (const auto& [matrix, list] :
         {std::pair{&half.k0, &triplets[0]}, {&half.k1, &triplets[1]}, {&half.k2, &triplets[2]}}) {
        matrix->resize(freedoms.count(), freedoms.count());
        matrix->setFromTriplets(list->begin(), list->end());
    }
}

void RimSection::add_loads(const WheelRimDesign& design, const Freedoms& freedoms, bool symmetric,
                           Half& half) const {
    const int count = symmetric ? even() : odd();
    half.loads = Eigen::MatrixXd::Zero(freedoms.count(), count + 1);
    const SideMode mode(design.width, design.thickness(), cells_, symmetric);
    for (int j = 0; j + 1 < static_cast<int>(y_.size()); ++j) {
        const auto column = static_cast<std::size_t>(j);
        // The middle cell of an odd number has no antisymmetric part.
        const int load = cell_[column] - (!symmetric && cells_ % 2 == 1 ? 1 : 0);
        const double length = y_[column + 1] - y_[column];
        const double width = cell_width_[static_cast<std::size_t>(cell_[column])];
        const double scale = std::sqrt(radius_ / width);
        // A pair of cells moves as both do, sqrt(2) times each; the middle one is alone.
        const double dy = design.width / cells_;
        const bool middle = cells_ % 2 == 1 && cell_[column] == 0;
        const double y = (cell_[column] + (cells_ % 2 == 1 ? 0.0 : 0.5)) * dy;
        const double moved = mode.at(y) * (middle ? 1.0 : std::sqrt(2.0));
        for (const auto& [offset, share] : {std::pair{0, 1.0 / 6}, {1, 4.0 / 6}, {2, 1.0 / 6}}) {
            const int radial = freedoms.on_surface(2 * j + offset, 0);
            const int axial = freedoms.on_surface(2 * j + offset, 2);
            if (radial >= 0 && load >= 0) half.loads(radial, load) += share * length * scale;
            // Pressure is a load against the radius: so that both have one sign.
            if (axial >= 0) half.loads(axial, count) -= moved * share * length * scale;
        }
    }
}

RimSection::Half RimSection::assemble(const WheelRimDesign& design, bool symmetric) const {
    const Freedoms freedoms(static_cast<int>(r_.size()) - 1, static_cast<int>(y_.size()) - 1,
                            symmetric);
    Half half;
    add_stiffness(design, freedoms, half);
    add_loads(design, freedoms, symmetric, half);
    return half;
}

Eigen::MatrixXd RimSection::solve(const Half& half, double n) {
    Eigen::SparseMatrix<double> k = half.k0;
    const auto values = [](const Eigen::SparseMatrix<double>& m) {
        return Eigen::Map<const Eigen::ArrayXd>(m.valuePtr(), m.nonZeros());
    };
    Eigen::Map<Eigen::ArrayXd>(k.valuePtr(), k.nonZeros()) +=
        n * values(half.k1) + n * n * values(half.k2);
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor(k);
    if (factor.info() != Eigen::Success) {
        throw InputError("rim.not_definite",
                         "wheel rim: its stiffness is not positive definite; check the layers");
    }
    // C = X' X with X = L^-1 P loads.
    const Eigen::MatrixXd permuted = factor.permutationP() * half.loads;
    const Eigen::MatrixXd x = factor.matrixL().solve(permuted);
    return x.transpose() * x;
}

void RimSection::compliance(double k, Eigen::MatrixXd& even, Eigen::MatrixXd& odd) const {
    even = solve(even_, k * radius_);
    odd = solve(odd_, k * radius_);
}

}  // namespace beltgrinding
