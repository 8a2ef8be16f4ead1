#pragma once

#include <Eigen/Core>
#include <string>

#include "contact/compliance.h"

namespace beltgrinding {

/// State of the process at a step, as a law sees it.
struct ProcessState {
    double belt_speed = 20000.0;  ///< V_b, mm/s
    double belt_wear = 1.0;       ///< k_t, share of a fresh belt's cut that remains
    double feed = 50.0;           ///< V_w, mm/s
    double force = 0.0;           ///< F_A, N
    double contact_area = 0.0;    ///< mm2
};

/// A process law: how fast the surface recedes under each cell.
class RemovalLaw {
  public:
    virtual ~RemovalLaw() = default;
    /// rate (mm/s) per cell from `pressure` (MPa) per cell; cells without pressure get 0.
    virtual void rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
                      Eigen::ArrayXd& rate) const = 0;
    virtual std::string describe() const = 0;
};

/// Local linear law: dh/dt = K k_t V_b p, with K = C_A K_A in mm2/N. Integrated over a pass it is
/// Hammann's law.
class LocalLinearLaw final : public RemovalLaw {
  public:
    explicit LocalLinearLaw(double coefficient);  ///< K, mm2/N
    void rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
              Eigen::ArrayXd& rate) const override;
    std::string describe() const override;

  private:
    double coefficient_;
};

/// Hammann's global linear law, r = C_A K_A k_t V_b F_A / (V_w l_w): the force distribution does
/// not matter, the whole contact recedes at the one rate K k_t V_b F_A / A, A the contact area;
/// over a pass at V_w that is r for a contact of width l_w.
class HammannLaw final : public RemovalLaw {
  public:
    explicit HammannLaw(double coefficient);  ///< K = C_A K_A, mm2/N
    void rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
              Eigen::ArrayXd& rate) const override;
    std::string describe() const override;

  private:
    double coefficient_;
};

/// r of Hammann's law, mm: K (mm2/N), V_b and V_w (mm/s), F_A (N), l_w (mm).
double hammann_depth(double coefficient, double wear, double belt_speed, double force, double feed,
                     double contact_width);

}  // namespace beltgrinding
