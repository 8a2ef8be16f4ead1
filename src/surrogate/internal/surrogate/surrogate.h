#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "beltgrinding/contact_model.h"
#include "surrogate/regression.h"

namespace beltgrinding {

/// How a contact is shown to the regression. Around a cell: the interference (approach - gap) over
/// the greatest one, clipped from below, as means over 3 x 3 boxes whose size doubles from `cell`
/// until it reaches the rim's thickness; then the distances to the wheel's two side faces.
struct ContactFeatures {
    double cell = 1.0;            ///< mm, side of the smallest boxes
    double rim_thickness = 15.0;  ///< mm

    int levels() const;
    /// Number of features of a cell.
    int size() const;
    /// Cells that may bear pressure: where the interference is not far below zero. Throws
    /// std::invalid_argument for a problem of another grid.
    std::vector<int> candidates(const ContactGrid& grid, const ContactProblem& problem,
                                double approach) const;
    /// (size(), cells.size()); `approach` must exceed the smallest gap. Throws
    /// std::invalid_argument for a problem or cells of another grid.
    Eigen::MatrixXf of(const ContactGrid& grid, const ContactProblem& problem, double approach,
                       const std::vector<int>& cells) const;
};

/// The pressure predicted by support-vector regression from solved contacts, after Zhang,
/// Kuhlenkötter and Kneupner, An efficient method for solving the Signorini problem in the
/// simulation of free-form surfaces produced by belt grinding, Int. J. Machine Tools & Manufacture
/// 45 (2005). It holds for the wheel and the kind of contacts that it was trained on.
///
/// The contact is homogeneous: gap and approach n times as large give n times the pressure. So the
/// regression learns pressure over greatest interference (MPa/mm). The approach that gives the
/// commanded force is searched for; a solution's `iterations` counts predictions.
class Surrogate final : public ContactModel {
  public:
    /// `name`: for the report. Throws InputError if the regression does not fit the features.
    Surrogate(ContactFeatures features, TrainedRegression regression, std::string name);

    std::string describe() const override { return name_; }
    double thickness() const override { return features_.rim_thickness; }

  private:
    std::unique_ptr<PreparedContact> do_prepare(const ContactGrid& grid) const override;

    ContactFeatures features_;
    std::shared_ptr<const TrainedRegression> regression_;
    std::string name_;
};

}  // namespace beltgrinding
