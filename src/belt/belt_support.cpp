#include "belt_support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "belt_springs.h"

namespace beltgrinding {
namespace {

constexpr double kNear = 0.05;  // thicknesses below the highest place: may touch, to begin with

}  // namespace

void BeltSupport::set(const BeltPath& path, const BeltGap& gap, double recession,
                      BeltBacking* backing, const Eigen::ArrayXXd* deflection) {
    const int n = path.columns.count();
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    backing_ = backing;
    reach_.resize(rows, n);
    springs_.resize(rows, n);
    backing_springs_.resize(rows, n);
    cosine_.resize(n);
    const double face = face_.stiffness / (1.0 + face_.stiffness * recession);
    for (int i = 0; i < n; ++i) {
        const auto c = static_cast<std::size_t>(i);
        cosine_[i] = std::cos(path.angle[c]);
        reach_.col(i) = gap.reach.col(i) + face_.shear * path.turn[c];
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const double area = rows_[k].width * path.columns.width[c];
            springs_(row, i) = face * gap.cover(row, i) * area;
            if (backing_ != nullptr) backing_springs_(row, i) = backing_->stiffness() * area;
        }
    }
    set_touching(gap);
    if (backing_ == nullptr) return;
    borne_.assign(touching_.size(), 0);
    for (int i = 0; i < n; ++i)
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const double rest = backing_->rest()(row, i);
            const bool bears =
                deflection != nullptr ? (*deflection)(row, i) > rest : std::isfinite(rest);
            borne_[cell(i, k)] = bears ? 1 : 0;
        }
}

void BeltSupport::set_touching(const BeltGap& gap) {
    const Eigen::Index n = gap.reach.cols();
    const std::size_t all = rows_.size() * static_cast<std::size_t>(n);
    if (touching_.size() != all) {
        touching_.assign(all, 0);
        // What the path's rounded corners lie in; else what is nearest to it.
        const double deepest = gap.reach.maxCoeff();
        const double least = std::min(0.5 * deepest, deepest - kNear * face_.thickness);
        for (Eigen::Index i = 0; i < n; ++i)
            for (std::size_t k = 0; k < rows_.size(); ++k)
                touching_[cell(i, k)] = gap.reach(static_cast<Eigen::Index>(k), i) > least ? 1 : 0;
    }
    for (Eigen::Index i = 0; i < n; ++i)
        for (std::size_t k = 0; k < rows_.size(); ++k)
            if (!std::isfinite(gap.reach(static_cast<Eigen::Index>(k), i)))
                touching_[cell(i, k)] = 0;
}

bool BeltSupport::touches() const {
    return std::find(touching_.begin(), touching_.end(), 1) != touching_.end();
}

std::vector<std::uint8_t> BeltSupport::rows_touched() const {
    std::vector<std::uint8_t> rows(rows_.size(), 0);
    for (std::size_t c = 0; c < touching_.size(); ++c)
        if (touching_[c] != 0) rows[c % rows_.size()] = 1;
    return rows;
}

BeltSupport::Borne BeltSupport::bear(const Eigen::ArrayXXd& deflection, double lift, double pressed,
                                     bool bonded) {
    Borne all;
    all.work = pressed;
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    forces_.resize(rows, deflection.cols());
    backing_forces_.resize(rows);
    for (Eigen::Index i = 0; i < deflection.cols(); ++i) {
        const double raised = lift * cosine_[i];
        const double* u = deflection.col(i).data();
        double* forces = forces_.col(i).data();
        std::uint8_t* touching = &touching_[cell(i, 0)];
        if (bonded) {
            for (Eigen::Index k = 0; k < rows; ++k)
                forces[k] =
                    touching[k] != 0 ? springs_(k, i) * (reach_(k, i) + raised - u[k]) : 0.0;
        } else {
            const bool same = press_springs(static_cast<int>(rows), reach_.col(i).data(), raised, u,
                                            springs_.col(i).data(), forces, touching);
            all.same = all.same && same;
        }
        const double total = sum_apart(static_cast<int>(rows), forces);
        all.total += total;
        all.work -= total * cosine_[i];
        if (backing_ == nullptr) continue;
        const double* rest = backing_->rest().col(i).data();
        std::uint8_t* borne = &borne_[cell(i, 0)];
        if (bonded) {
            for (Eigen::Index k = 0; k < rows; ++k)
                if (borne[k] != 0) forces[k] -= backing_springs_(k, i) * (u[k] - rest[k]);
            continue;
        }
        const bool same =
            press_springs(static_cast<int>(rows), u, 0.0, rest, backing_springs_.col(i).data(),
                          backing_forces_.data(), borne);
        all.borne = all.borne && same;
        forces_.col(i) -= backing_forces_;
        all.behind += backing_forces_.sum();
    }
    return all;
}

Eigen::ArrayXXd BeltSupport::springs_on() const {
    Eigen::ArrayXXd on(springs_.rows(), springs_.cols());
    for (Eigen::Index i = 0; i < on.cols(); ++i) {
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            double spring = touching_[cell(i, k)] != 0 ? springs_(row, i) : 0.0;
            if (backing_ != nullptr && borne_[cell(i, k)] != 0) spring += backing_springs_(row, i);
            on(row, i) = spring;
        }
    }
    return on;
}

Eigen::ArrayXXd BeltSupport::pushed_by_lift(double& own) const {
    Eigen::ArrayXXd forces = Eigen::ArrayXXd::Zero(springs_.rows(), springs_.cols());
    for (Eigen::Index i = 0; i < forces.cols(); ++i) {
        for (Eigen::Index k = 0; k < forces.rows(); ++k) {
            if (touching_[cell(i, static_cast<std::size_t>(k))] == 0) continue;
            const double w = springs_(k, i) * cosine_[i];
            own += w * cosine_[i];
            forces(k, i) = -w;
        }
    }
    return forces;
}

double BeltSupport::add_slope(double slope, const Eigen::ArrayXXd& deflection, double lift,
                              const Eigen::ArrayXXd& change, double change_lift,
                              double share) const {
    for (Eigen::Index i = 0; i < deflection.cols(); ++i) {
        const double raised = (lift + share * change_lift) * cosine_[i];
        const double rising = change_lift * cosine_[i];
        for (Eigen::Index k = 0; k < deflection.rows(); ++k) {
            const double du = change(k, i), u = deflection(k, i) + share * du;
            const double overlap = reach_(k, i) + raised - u;
            if (overlap > 0.0) slope += springs_(k, i) * overlap * (rising - du);
            if (backing_ == nullptr) continue;
            const double in = u - backing_->rest()(k, i);
            if (in > 0.0) slope += backing_springs_(k, i) * in * du;
        }
    }
    return slope;
}

double BeltSupport::short_of_touch(const Eigen::ArrayXXd& deflection, double lift) const {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < deflection.cols(); ++i)
        least = std::min(least, (deflection.col(i) - reach_.col(i)).minCoeff() / cosine_[i] - lift);
    return least;
}

Eigen::ArrayXXd BeltSupport::load(const Eigen::ArrayXXd& deflection, double lift) const {
    Eigen::ArrayXXd load = Eigen::ArrayXXd::Zero(springs_.rows(), springs_.cols());
    for (Eigen::Index i = 0; i < load.cols(); ++i)
        load.col(i) =
            (springs_.col(i) > 0.0)
                .select(springs_.col(i) *
                            (reach_.col(i) + lift * cosine_[i] - deflection.col(i)).max(0.0),
                        0.0);
    return load;
}

}  // namespace beltgrinding
