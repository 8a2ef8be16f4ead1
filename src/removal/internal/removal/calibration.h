#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

namespace beltgrinding {

/// Parameters of a measured grind's model, in the order of every vector and matrix here.
enum GrindParameter : int {
    kLnCoefficient,      ///< ln K, K in mm2/N
    kPressureExponent,   ///< alpha
    kSpeedExponent,      ///< beta
    kFeedExponent,       ///< gamma, of moving grinds
    kTimeExponent,       ///< tau, of stationary grinds; 1 where removal is linear in time
    kAreaExponent,       ///< delta, beyond what the mean pressure says; 0 in a local law
    kLnWearScale,        ///< ln of the wear over which the cut falls by 1/e; inf: no wear
    kWearRest,           ///< share of the cut that remains in the end
    kPressureThreshold,  ///< MPa
    kLnSaturation,       ///< ln of the saturation pressure in MPa; inf: none
    kWearExponent,       ///< m of a cut that falls as (1 + W / scale)^-m; inf: exponentially
    kGritExponent,       ///< a, of the grain's number or size; 0 where it is not known
    kCutExponent,        ///< f, of the share of a fresh belt's cut that remains; 0 likewise
    kFirstShare,    ///< of what an exponential wear takes, the share that goes first (break-in)
    kLnFirstRatio,  ///< ln of that stage's wear scale over the other's, below 0
    kLoadingShare,  ///< of the cut, that a loaded belt lacks
    kGrindParameters,
};
using GrindVector = Eigen::Matrix<double, kGrindParameters, 1>;
using GrindMatrix = Eigen::Matrix<double, kGrindParameters, kGrindParameters>;

/// Where the powers of a grind's model are 1; all positive.
struct GrindReferences {
    double pressure = 0.1;  ///< MPa
    double speed = 20e3;    ///< mm/s
    double feed = 50.0;     ///< mm/s
    double time = 1.0;      ///< s
    double area = 1.0;      ///< mm2
    double grit = 1.0;      ///< in the unit of `MeasuredGrinds::grit`
};

/// Measured grinds, one a row.
struct MeasuredGrinds {
    Eigen::ArrayXd force;     ///< N
    Eigen::ArrayXd area;      ///< of the contact, mm2; NaN where it is not known
    Eigen::ArrayXd speed;     ///< of the belt, mm/s
    Eigen::ArrayXd feed;      ///< mm/s; 0 of a stationary grind
    Eigen::ArrayXd time;      ///< of contact: grind time, or ground length over feed, s
    Eigen::ArrayXd wear;      ///< of the belt at the start, in any unit
    Eigen::ArrayXd spread;    ///< mm2 over which the volume is spread to a depth; 1: the measured
                              ///< figure is a volume; NaN: a depth over the contact area
    Eigen::ArrayXd measured;  ///< mm3 or mm
    /// (n, m) pressure over the mean F/A on m equal shares of the contact; empty: 1 everywhere.
    Eigen::ArrayXXd relative;
    Eigen::ArrayXd grit;     ///< number or size of the belt's grain, in one unit; empty: not known
    Eigen::ArrayXd cut;      ///< share of a fresh belt's cut that remains; empty: not known
    Eigen::ArrayXd loading;  ///< of the belt, mean over the grind, [0, 1]; empty: 0
    Eigen::ArrayXd areas;    ///< (k,) mm2, what an unknown area can be; empty if all are known

    /// Throws InputError if sizes differ, or a figure is not finite or out of range.
    void validate() const;
};

/// ln of the measured figure that the model says, volume = A t dh/dt with
///   dh/dt = K k_t(W) g_b(V_b) g_w(V_w) <g_p(p)>, <> the mean over the contact, and t, A raised to
/// tau, 1 + delta about their references, times (grit / grit_ref)^a cut^f (1 - loading_share l),
/// grit, cut and l where these are known,
/// for row `i` with contact area `area`; its gradient by the parameters.
double log_grind(const GrindVector& parameters, const GrindReferences& references,
                 const MeasuredGrinds& grinds, Eigen::Index i, double area, GrindVector* gradient);

struct CalibrationSettings {
    GrindVector start, lower, upper;  ///< bounds of free parameters; the start lies between
    std::array<bool, kGrindParameters> free{};
    GrindVector prior_mean = GrindVector::Zero();
    /// Standard deviation of what is known of a free parameter before; inf: nothing.
    GrindVector prior_deviation = GrindVector::Constant(std::numeric_limits<double>::infinity());
};

struct Calibration {
    GrindVector parameters;
    GrindMatrix covariance;   ///< zero for parameters fixed or at a bound
    GrindMatrix information;  ///< sum of w J J^T over the rows; of the free parameters
    std::array<bool, kGrindParameters> at_bound{};
    double scatter = 0.0;  ///< of ln(measured/predicted): the greater of 1.4826 times its median
                           ///< and its rms winsorised at three of these, n/(n - p) corrected
    double log_likelihood = 0.0;      ///< of the rows, without ln sqrt(2 pi) each
    Eigen::ArrayXd residual, weight;  ///< per row, of its likeliest areas on average
    Eigen::ArrayXd shares;            ///< of the areas that an unknown one can take
    Eigen::ArrayXXd posterior;        ///< (n, k) probability of each area; 1 in column 0 if known
    int iterations = 0;
    bool converged = false;
};

/// Robust least squares of ln(measured) against ln(predicted) with normal priors, so that the
/// parameters are the likeliest after the data: Hampel's three-part weights (Hampel, Ronchetti,
/// Rousseeuw and Stahel, Robust Statistics, 1986), which leave the normal scatter of grinds alone
/// and drop blunders, by iteratively reweighted least squares, each solved by Levenberg-Marquardt
/// (Eigen) with bounds by James and Roos's sine transform (Comp. Phys. Comm. 10, 1975). An unknown
/// area is one of `areas`, by Ibrahim's EM by the method of weights (JASA 85, 1990). The covariance
/// is the sandwich of M-estimation (Huber and Ronchetti, Robust Statistics, 2009) with Louis's
/// information where areas are unknown (JRSS B 44, 1982) and MacKinnon and White's leverage
/// correction HC3 (J. Econometrics 29, 1985); with fewer than 6 degrees of freedom, where that is
/// far too wide, the scatter's variance over the information. A prior counts as a further
/// measurement. Throws InputError.
Calibration calibrate(const MeasuredGrinds& grinds, const GrindReferences& references,
                      const CalibrationSettings& settings);

}  // namespace beltgrinding
