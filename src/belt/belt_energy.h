#pragma once

#include <Eigen/Core>

#include "belt_basis.h"
#include "belt_stress.h"
#include "belt_support.h"
#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// What presses the work on the belt.
struct BeltDrive {
    const ContactProblem& problem;
    double depth;  ///< mm that the work has been raised by already

    /// The depth is not given, but what a force or a robot that gives way makes of it.
    bool yields() const { return problem.force_control || problem.robot_compliance > 0.0; }
    /// N that the work is pressed with where it has been lifted by so much.
    double commanded(double lift) const;
};

/// A deflection, the work's lift, what they strain.
struct BeltIterate {
    Eigen::MatrixXd deflection;  // (splines, columns), mm
    Eigen::MatrixXd bent;        // N that bending resists it with
    Eigen::ArrayXXd cells;       // mm of the face, (rows, columns)
    double lift = 0.0;           // mm
    BeltModes strain, stress;
    BeltStress::Shape shape;
    Eigen::MatrixXd smooth;  // N on the splines of all but the contact
};

/// What the energy falls by where the belt and the work give way, and where it touches.
struct BeltUnbalanced {
    Eigen::MatrixXd belt;      // N, (splines, columns)
    double work = 0.0;         // N, along z
    BeltSupport::Borne borne;  // by the springs

    /// N in all.
    double left() const;
};

/// A way of the belt and the work, mm.
struct BeltStep {
    Eigen::MatrixXd deflection;
    double lift = 0.0;
};

/// The energy of a belt about a path: of bending, stress, face springs and the work's lift.
class BeltEnergy {
  public:
    /// Keeps references to all.
    BeltEnergy(const BeltBasis& basis, BeltSupport& support, const BeltStress& stress,
               const BeltPath& path, const BeltDrive& drive);

    const BeltDrive& drive() const { return drive_; }
    const BeltStress& stress() const { return stress_; }
    const BeltColumns& columns() const { return path_.columns; }
    /// All of a deflection, its face's and a lift.
    void complete(BeltIterate& at) const;
    /// `bonded`: as of `BeltSupport::bear`.
    BeltUnbalanced unbalanced(const BeltIterate& at, bool bonded);
    /// Goes along the step, up to its end, where the energy is least; the share of it. `off`: at
    /// the beginning, then where it leads. `whole`: to its end in any case.
    double go(const BeltStep& step, bool whole, BeltIterate& at, BeltUnbalanced& off);

  private:
    /// Strain, stress and what they and the bending push with, of the deflection and its shape.
    void strain(BeltIterate& at) const;
    /// The share of the step at which the energy is least, which falls at its beginning and rises
    /// by `end` mm N at its end.
    double least_along(const BeltIterate& at, const BeltIterate& change, double first,
                       double end) const;

    const BeltBasis& basis_;
    BeltSupport& support_;
    const BeltStress& stress_;
    const BeltPath& path_;
    const BeltDrive& drive_;
    Eigen::MatrixXd path_load_;  // (splines, columns), N
};

}  // namespace beltgrinding
