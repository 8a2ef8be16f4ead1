#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace beltgrinding {

struct Checkpoint;

/// States of a simulation on its way along a path, from which one along another path that begins
/// the same goes on: it gives what it would from its start, to the last bit. Whether two paths
/// begin the same is decided step by step by what the engine sees of them (place, times, feed,
/// force, the parts that steps are cut into), as far as the state was taken; all else, the field,
/// the settings and the part's heat, must be the same, which its owner vouches for.
///
/// They hold what changed between them, are shared by copies, and never change. Bounded: of more
/// than `kMost`, or of more bytes than are allowed, neighbours become one.
class Checkpoints {
  public:
    static constexpr std::size_t kMost = 16;

    /// `max_bytes`: of all; none are kept where not even one fits.
    explicit Checkpoints(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    std::size_t count() const { return kept_.size(); }
    /// Planned steps before each, rising.
    std::vector<std::size_t> steps() const;
    std::size_t bytes() const;
    /// Others with the same states, as many as `max_bytes` hold.
    Checkpoints within(std::size_t max_bytes) const;
    /// Forgets all.
    void clear();

  private:
    friend class CheckpointKeeper;
    /// Makes neighbours one until there are few enough.
    void thin();

    std::size_t max_bytes_;
    std::vector<std::string> kinds_;  // of what they are states of
    std::vector<std::shared_ptr<const Checkpoint>> kept_;
    std::size_t end_ = 0;  // planned steps of the whole path; 0: it has not come to its end
};

}  // namespace beltgrinding
