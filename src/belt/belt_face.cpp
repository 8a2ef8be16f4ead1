#include "belt_face.h"

#include <algorithm>

#include "registers.h"

namespace beltgrinding {
namespace {

constexpr int kLocal = BeltFace::kLocal;
constexpr int kFour = 4;
constexpr int kWide = 8;  // of a band's rows: seven diagonals and a zero

/// Rows `begin` to `end` by the splines from `c` on and the curvatures along from `k` on; up to
/// three rows more are written.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx2", "default")))
#endif
void deflect(const double* own, const double* along, std::ptrdiff_t stride, int begin, int end,
             const double* c, const double* k, double* to) {
    for (int row = begin; row < end; row += kFour) {
        Four sum{};
        for (int r = 0; r < kLocal; ++r) {
            sum += read<Four>(own + r * stride + row) * c[r];
            sum += read<Four>(along + r * stride + row) * k[r];
        }
        write<Four>(to + row) = sum;
    }
}

/// What forces on the rows push the splines from `c` on and the curvatures along from `k` on with.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx2", "default")))
#endif
void push_back(const double* own, const double* along, int begin, int end, const double* forces,
               double* c, double* k) {
    Four by_own{}, by_along{};
    for (int row = begin; row < end; ++row) {
        by_own += read<Four>(own + kLocal * row) * forces[row];
        by_along += read<Four>(along + kLocal * row) * forces[row];
    }
    write<Four>(c) += by_own;
    write<Four>(k) += by_along;
}

/// Adds what springs of the rows stiffen the splines by: of two values, of a value (row) and a
/// curvature along (column), of two such curvatures. Band by band, kWide numbers a column.
#ifdef BELTGRINDING_CLONES
__attribute__((target_clones("avx2", "default")))
#endif
void add_springs(const double* own, const double* along, int begin, int end, const double* springs,
                 double* values, double* mixed, double* curvatures) {
    Four vv[kLocal] = {}, vk[kLocal] = {}, kk[kLocal] = {};
    for (int row = begin; row < end; ++row) {
        const double w = springs[row];
        const double *a = own + kLocal * row, *b = along + kLocal * row;
        const Four wa = read<Four>(a) * w, wb = read<Four>(b) * w;
        for (int c = 0; c < kLocal; ++c) {
            vv[c] += wa * a[c];
            vk[c] += wa * b[c];
            kk[c] += wb * b[c];
        }
    }
    for (int c = 0; c < kLocal; ++c) {
        const int at = c * kWide + kLocal - 1 - c;
        write<Four>(values + at) += vv[c];
        write<Four>(mixed + at) += vk[c];
        write<Four>(curvatures + at) += kk[c];
    }
}

}  // namespace

BeltFace::BeltFace(const BeltSpline& spline, const std::vector<BeltRow>& rows, double shear)
    : splines_(spline.count()), rows_(static_cast<int>(rows.size())) {
    own_.setZero(rows_ + kFour, kLocal);
    along_ = own_;
    own_by_row_.setZero(kLocal, rows_);
    along_by_row_ = own_by_row_;
    for (int row = 0; row < rows_; ++row) {
        const BeltSpline::Local local = spline.at(rows[static_cast<std::size_t>(row)].y);
        if (groups_.empty() || groups_.back().spline != local.first)
            groups_.push_back({local.first, row, row});
        groups_.back().end = row + 1;
        for (int r = 0; r < kLocal; ++r) {
            const auto at = static_cast<std::size_t>(r);
            own_(row, r) = own_by_row_(r, row) = local.value[at] - shear * local.curvature[at];
            along_(row, r) = along_by_row_(r, row) = -shear * local.value[at];
        }
    }
}

Eigen::ArrayXXd BeltFace::deflection(const BeltColumns& columns,
                                     const Eigen::MatrixXd& coefficients) const {
    const int n = columns.count();
    Eigen::ArrayXXd result(rows_, n);
    Eigen::ArrayXd column(rows_ + kFour);
    Eigen::VectorXd curved(splines_);
    for (int i = 0; i < n; ++i) {
        const std::array<double, 3> along = columns.curvature(i);
        if (along[1] == 0.0)
            curved.setZero();
        else
            curved = along[0] * coefficients.col(i - 1) + along[1] * coefficients.col(i) +
                     along[2] * coefficients.col(i + 1);
        // A group that ends within a register is put right by the next one.
        for (const Group& g : groups_)
            deflect(own_.data(), along_.data(), own_.rows(), g.begin, g.end,
                    coefficients.col(i).data() + g.spline, curved.data() + g.spline, column.data());
        result.col(i) = column.head(rows_);
    }
    return result;
}

void BeltFace::push(const BeltColumns& columns, const Eigen::ArrayXXd& forces,
                    Eigen::MatrixXd& to) const {
    Eigen::VectorXd own(splines_), curved(splines_);
    for (int i = 0; i < columns.count(); ++i) {
        if ((forces.col(i) == 0.0).all()) continue;
        own.setZero();
        curved.setZero();
        for (const Group& g : groups_)
            push_back(own_by_row_.data(), along_by_row_.data(), g.begin, g.end,
                      forces.col(i).data(), own.data() + g.spline, curved.data() + g.spline);
        to.col(i) += own;
        const std::array<double, 3> along = columns.curvature(i);
        if (along[1] == 0.0) continue;
        for (int p = 0; p < 3; ++p)
            to.col(i - 1 + p) += along[static_cast<std::size_t>(p)] * curved;
    }
}

void BeltFace::stiffen(const BeltColumns& columns, const Eigen::ArrayXXd& springs,
                       BeltBands& to) const {
    using Band = BeltBands::Band;
    using Wide = Eigen::Array<double, kWide, Eigen::Dynamic>;
    std::array<Wide, 3> wide;
    for (Wide& one : wide) one.resize(kWide, splines_);
    // Value with value; value (row) with curvature along, and the other way round; two curvatures.
    Band vv = Band::Zero(splines_, BeltBands::kDiagonals), vk = vv, kv = vv, kk = vv;
    for (int i = 0; i < columns.count(); ++i) {
        if ((springs.col(i) == 0.0).all()) continue;
        for (Wide& one : wide) one.setZero();
        for (const Group& g : groups_) {
            const std::ptrdiff_t at = std::ptrdiff_t{kWide} * g.spline;
            add_springs(own_by_row_.data(), along_by_row_.data(), g.begin, g.end,
                        springs.col(i).data(), wide[0].data() + at, wide[1].data() + at,
                        wide[2].data() + at);
        }
        for (int d = 0; d < BeltBands::kDiagonals; ++d) {
            vv.col(d) = wide[0].row(d).transpose();
            vk.col(d) = wide[1].row(d).transpose();
            kk.col(d) = wide[2].row(d).transpose();
            // Transposed: what column s has in row s + below is what column s + below has in row s.
            const int below = d - kLocal + 1, low = std::max(0, -below),
                      high = std::min(splines_, splines_ - below);
            for (int s = low; s < high; ++s)
                kv(s, d) = wide[1](BeltBands::kDiagonals - 1 - d, s + below);
        }
        const std::array<double, 3> k = columns.curvature(i);
        to.add(i, 0, 1.0, vv, k[1] * k[1], kk);
        if (k[1] == 0.0) continue;
        to.add(i, 0, k[1], vk, k[1], kv);
        to.add(i - 1, 0, k[0] * k[0], kk);
        to.add(i + 1, 0, k[2] * k[2], kk);
        // Rows: the column behind; columns: the one before.
        to.add(i - 1, 1, k[0], vk, k[0] * k[1], kk);
        to.add(i, 1, k[2], kv, k[1] * k[2], kk);
        to.add(i - 1, 2, k[0] * k[2], kk);
    }
}

BeltFace::Form BeltFace::form(const BeltColumns& columns, std::size_t row, int i) const {
    const auto at = static_cast<Eigen::Index>(row);
    Form form;
    for (const Group& g : groups_)
        if (g.begin <= at && at < g.end) form.spline = g.spline;
    const std::array<double, 3> along = columns.curvature(i);
    if (along[1] != 0.0) form.first = 0, form.last = 2;
    for (std::size_t p = 0; p < 3; ++p)
        for (Eigen::Index r = 0; r < kLocal; ++r)
            form.values[p][static_cast<std::size_t>(r)] =
                (p == 1 ? own_by_row_(r, at) : 0.0) + along[p] * along_by_row_(r, at);
    return form;
}

}  // namespace beltgrinding
