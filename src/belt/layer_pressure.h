#pragma once

#include <Eigen/Core>
#include <vector>

namespace beltgrinding {

/// Finds a pressure that becomes itself, by Anderson's mixing of the last ones (Journal of the ACM
/// 12, 1965): what is off is made as small as those before, and what became of them, can tell.
class PressureMixing {
  public:
    /// The pressure to look at next, MPa, none below 0: `given` has become `became`.
    Eigen::ArrayXd next(const Eigen::ArrayXd& given, const Eigen::ArrayXd& became);

  private:
    void add_change(Eigen::ArrayXd off, Eigen::ArrayXd became);
    /// Products of the changes of what was off with another one.
    Eigen::VectorXd along(const Eigen::ArrayXd& other) const;

    // The last time: what was off, what it became; how both have changed, the oldest change first.
    Eigen::ArrayXd last_off_, last_became_;
    std::vector<Eigen::ArrayXd> off_, became_;
    Eigen::MatrixXd products_;  // of `off_` with each other
};

/// The layers' pressure of the last contacts, MPa, each of which started from the one before.
class LastLayers {
  public:
    /// To start the next one from: as it has changed so far, where that would have been nearer the
    /// last time, else the last one. Empty: there was none.
    Eigen::ArrayXd next() const;
    void add(const Eigen::ArrayXd& pressure);
    /// Of memory, about.
    std::size_t bytes() const {
        return static_cast<std::size_t>(last_.size() + before_.size()) * sizeof(double);
    }

  private:
    Eigen::ArrayXd changed_as_before() const { return (2.0 * last_ - before_).max(0.0); }

    Eigen::ArrayXd last_, before_;
    bool goes_on_ = false;
};

}  // namespace beltgrinding
