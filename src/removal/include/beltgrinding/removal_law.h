#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "beltgrinding/curve.h"
#include "beltgrinding/fact.h"

namespace beltgrinding {

/// State of the process at a step, as a law sees it.
struct ProcessState {
    double belt_speed = 20000.0;  ///< V_b, mm/s
    double belt_wear = 1.0;       ///< k_t, share of a fresh belt's cut that remains
    double feed = 50.0;           ///< V_w, mm/s
    double force = 0.0;           ///< F_A, N
    double contact_area = 0.0;    ///< mm2
};

/// A quantity beyond the range that a law was measured in.
struct OutsideRange {
    Fact fact;           ///< what lies outside
    std::string unit;    ///< of the values
    double value = 0.0;  ///< of the quantity
    double limit = 0.0;  ///< the end of the range that it is beyond
};

/// A process law: how fast the surface recedes under each cell.
class RemovalLaw {
  public:
    virtual ~RemovalLaw() = default;
    /// rate (mm/s) per cell from `pressure` (MPa) per cell; cells without pressure get 0.
    virtual void rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
                      Eigen::ArrayXd& rate) const = 0;
    /// What lies outside the range that the law was measured in, the first of several.
    virtual std::optional<OutsideRange> outside(double, const ProcessState&) const { return {}; }
    /// Name and parameters, for the report.
    virtual std::string describe() const = 0;
};

/// What makes up the local law. The defaults are the linear one.
struct LocalLawParameters {
    double coefficient = 1.25e-4;      ///< K = C_A K_A, mm2/N
    double pressure_threshold = 0.0;   ///< MPa, below which nothing is cut
    double pressure_exponent = 1.0;    ///< alpha
    double reference_pressure = 0.1;   ///< MPa, where alpha has no effect
    double saturation_pressure = 0.0;  ///< MPa, which the cutting pressure approaches; 0: none
    double speed_exponent = 1.0;       ///< beta
    double reference_speed = 20000.0;  ///< mm/s
    double feed_exponent = 0.0;        ///< gamma
    double reference_feed = 50.0;      ///< mm/s
    double land_share = 1.0;           ///< of a serrated wheel's surface that bears
    Curve pressure_curve =
        {};                  ///< MPa -> cut as a share of that at the reference pressure, for g_p
    Curve speed_curve = {};  ///< mm/s -> share of the cut at the reference speed, for g_b
    Curve feed_curve = {};   ///< mm/s -> share of the cut at the reference feed, for g_w
    Curve land_curve = {};   ///< land share -> cut as a share of a plain wheel's, a further factor
};

/// The local law: dh/dt = K k_t g_b(V_b) g_w(V_w) g_p(p), with g_b = V_ref (V_b / V_ref)^beta, g_w
/// = (V_w / V_w,ref)^gamma, g_p = p_ref (q / p_ref)^alpha, q = max(p - threshold, 0), saturating
/// as q -> p_s (1 - exp(-q / p_s)). With alpha = beta = 1 and gamma = 0 it is the linear law dh/dt
/// = K k_t V_b p, which integrates to Hammann's over a pass (Ren, Kuhlenkötter and Müller, Int. J.
/// Machine Tools and Manufacture 46, 2006); the exponents are those of power-law fits of belt
/// grinding (docs/methods.md). On a serrated wheel the lands bear the whole force: the cut is
/// land_share g_p(p / land_share).
class LocalLaw final : public RemovalLaw {
  public:
    /// Throws InputError for invalid parameters.
    explicit LocalLaw(LocalLawParameters parameters);
    void rate(const Eigen::ArrayXd& pressure, const ProcessState& state,
              Eigen::ArrayXd& rate) const override;
    std::optional<OutsideRange> outside(double peak_pressure,
                                        const ProcessState& state) const override;
    std::string describe() const override;

  private:
    LocalLawParameters parameters_;
    double serration_ = 1.0;  // factor of the land curve
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

/// The law that is named: "local" (LocalLaw) or "hammann" (HammannLaw, of the coefficient alone).
/// Throws InputError for another name, or invalid parameters.
std::unique_ptr<RemovalLaw> make_removal_law(const std::string& name,
                                             const LocalLawParameters& parameters);

}  // namespace beltgrinding
