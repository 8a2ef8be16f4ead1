#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// Points by the cubes that they lie in: an open-addressed table of cubes, each with the chain of
/// its points in the order in which they came. Most of the cubes that are looked at are empty, so
/// that a look must cost next to nothing.
class PointHash {
  public:
    struct Cube {
        std::int32_t x = 0, y = 0, z = 0;
        bool operator==(const Cube&) const = default;
    };

    /// `side`: mm, of a cube.
    explicit PointHash(double side) : side_(side), slots_(kFirst) {}

    Cube cube(const Vec3& point) const {
        const auto of = [this](double x) {
            return static_cast<std::int32_t>(std::floor(x / side_));
        };
        return {of(point.x()), of(point.y()), of(point.z())};
    }
    void add(std::uint32_t number, const Vec3& point) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        Slot& slot = slots_[place(cube(point))];
        const auto link = static_cast<std::uint32_t>(links_.size());
        links_.push_back({number, kNone});
        if (slot.first == kNone) {
            slot = {cube(point), link, link};
            ++used_;
        } else {
            links_[slot.last].next = link;
            slot.last = link;
        }
    }
    /// Replaces `found` by all in the cube and in those up to `rings` away.
    void near(const Cube& cube, int rings, std::vector<std::uint32_t>& found) const {
        found.clear();
        for (int i = -rings; i <= rings; ++i)
            for (int j = -rings; j <= rings; ++j)
                for (int k = -rings; k <= rings; ++k) {
                    const Slot& slot = slots_[place({cube.x + i, cube.y + j, cube.z + k})];
                    for (std::uint32_t link = slot.first; link != kNone; link = links_[link].next)
                        found.push_back(links_[link].number);
                }
    }
    /// The least of the eight cubes that hold all up to half a side from a point.
    Cube corner(const Vec3& point) const { return cube(point - Vec3::Constant(0.5 * side_)); }
    /// Replaces `found` by all in those.
    void near_corner(const Cube& corner, std::vector<std::uint32_t>& found) const {
        found.clear();
        for (int i = 0; i < 8; ++i) {
            const Cube one{corner.x + (i >> 2), corner.y + (i >> 1 & 1), corner.z + (i & 1)};
            for (std::uint32_t link = slots_[place(one)].first; link != kNone;
                 link = links_[link].next)
                found.push_back(links_[link].number);
        }
    }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    static constexpr std::size_t kFirst = 1024;  // slots; a power of two
    struct Slot {
        Cube cube{};
        std::uint32_t first = kNone, last = kNone;  // links; none: the slot is free
    };
    struct Link {
        std::uint32_t number, next;
    };

    /// The slot of a cube, or the free one where it would be.
    std::size_t place(const Cube& cube) const {
        std::uint64_t h = 0;
        for (const std::int32_t k : {cube.x, cube.y, cube.z})
            h = (h ^ static_cast<std::uint32_t>(k)) * 0x9E3779B97F4A7C15ULL, h ^= h >> 32;
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = static_cast<std::size_t>(h) & mask;
        while (slots_[at].first != kNone && slots_[at].cube != cube) at = (at + 1) & mask;
        return at;
    }
    void grow() {
        std::vector<Slot> before(2 * slots_.size());
        before.swap(slots_);
        for (const Slot& slot : before)
            if (slot.first != kNone) slots_[place(slot.cube)] = slot;
    }

    double side_;
    std::vector<Slot> slots_;
    std::vector<Link> links_;
    std::size_t used_ = 0;
};

}  // namespace beltgrinding
