#pragma once

#include <cstdint>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// How the second body of a pair goes against the first. A place is a number i + u: the share u of
/// the way from the path's moment i to the next.
class PairMotion {
  public:
    struct Stretch {
        double begin, end;
    };

    virtual ~PairMotion() = default;

    /// What is followed, in order, each by itself; what lies between two of them is not known.
    virtual std::vector<Stretch> stretches() const = 0;
    /// mm by which points of the second body can have moved against the first between two places;
    /// linear between two moments.
    virtual double way(double begin, double end) const = 0;
    virtual Frame first_from_second(double place) const = 0;
    virtual Frame work_from_first(double place) const = 0;
    virtual std::uint32_t pose(double place) const = 0;  ///< that the motion leads to, from 0

    /// The place where half of the way is done.
    double middle(double begin, double end) const;
};

/// From place to place, whole moments at most `block` apart.
void add_stretches(std::vector<PairMotion::Stretch>& stretches, std::size_t begin, std::size_t end,
                   std::size_t block);

/// A sum up to each moment, at a place: linear in between.
double sum_at(const std::vector<double>& sums, double place);

}  // namespace beltgrinding
