#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "beltgrinding/run_context.h"
#include "collision/arm_scene.h"

namespace beltgrinding {

struct LinkOptions {
    double clearance = 5.0;           ///< mm between bodies on the way
    double resolution = 0.5;          ///< mm; below the clearance, for no collision to be missed
    std::uint32_t seed = 1;           ///< the same gives the same way
    std::size_t iterations = 20'000;  ///< of the search, at most
    std::size_t shortcuts = 200;      ///< that are tried
};

/// Joint motions from one place to another, external axes with them.
struct Link {
    std::vector<Coordinates> joints;  ///< both ends among them
    double clearance = 0.0;           ///< mm that is kept; less than asked where an end is nearer
    bool straight = false;            ///< the straight way of the joints is free
};

/// A way of the joints on which no bodies come nearer than the clearance: straight where that is
/// free, else by RRT-Connect (J. J. Kuffner, S. M. LaValle, RRT-Connect: an efficient approach to
/// single-query path planning, ICRA 2000; of OMPL), shortened by random shortcuts. Where an end is
/// nearer, half of the clearance is kept, and so on down to an eighth. None: an end collides, or no
/// way was found. Throws InputError for options that are no positive numbers, Cancelled.
std::optional<Link> find_link(const ArmScene& scene, const Coordinates& from, const Coordinates& to,
                              const LinkOptions& options, const RunContext& context = {});

/// The tool's straight way.
struct Straight {
    std::vector<Coordinates> joints;  ///< of equal parts, both ends among them
    bool whole = true;  ///< else a joint jumps, the arm is out of reach, or a limit is passed
};

/// The joints on the straight way of the tool from the place of `q` to another, linear in position
/// and slerp in orientation, in its configuration; in parts of at most `step` mm and `turn` rad.
/// External axes go evenly to what the rows of `end` behind the joints say, in such parts, too.
Straight straight_way(const ArmScene& scene, const Coordinates& q, const Frame& base_from_tcp,
                      const Coordinates& end, double step, double turn);
/// The same with external axes that stand still.
Straight straight_way(const ArmScene& scene, const Coordinates& q, const Frame& base_from_tcp,
                      double step, double turn);

}  // namespace beltgrinding
