#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "beltgrinding/geometry.h"

namespace beltgrinding {

/// A list of triangles in a third of their memory, for long lists whose neighbours name vertices of
/// similar numbers, such as a lattice's: each 64 are stored as what they exceed their least corners
/// by, in as many bits as that takes (frame of reference; Goldstein, Ramakrishnan, Shaft:
/// Compressing relations and indexes, 1998). Any one is read in the same short time; none can be
/// changed.
class PackedTriangles {
  public:
    /// Of a list that is read from the begin to the end.
    class Iterator {
      public:
        using iterator_category = std::input_iterator_tag;  ///< it gives values
        using value_type = Triangle;                        ///< by value
        using difference_type = std::ptrdiff_t;             ///< of two places
        using pointer = void;                               ///< none
        using reference = Triangle;                         ///< a value

        /// Of no list.
        Iterator() = default;
        /// At the triangle number `at` of `list`, which must outlive it.
        Iterator(const PackedTriangles& list, std::size_t at) : list_(&list), at_(at) {}
        /// The triangle there.
        Triangle operator*() const { return (*list_)[at_]; }
        /// On to the next.
        Iterator& operator++() {
            ++at_;
            return *this;
        }
        /// On to the next; returns where it was.
        Iterator operator++(int) {
            const Iterator before = *this;
            ++at_;
            return before;
        }
        /// Whether both are at the same place.
        bool operator==(const Iterator& other) const { return at_ == other.at_; }

      private:
        const PackedTriangles* list_ = nullptr;
        std::size_t at_ = 0;
    };
    using const_iterator = Iterator;  ///< as containers name it
    using value_type = Triangle;      ///< as containers name it

    /// None.
    PackedTriangles() = default;
    /// Of all of `triangles`, in their order.
    explicit PackedTriangles(std::span<const Triangle> triangles);

    /// Puts one more at the end.
    void push_back(const Triangle& triangle);
    /// Gives back memory that was taken for more to come.
    void shrink_to_fit();
    /// How many.
    std::size_t size() const { return blocks_.size() * kTogether + rest_.size(); }
    /// Whether there are none.
    bool empty() const { return size() == 0; }
    /// Number `i` from 0, which must be there.
    Triangle operator[](std::size_t i) const {
        const std::size_t number = i / kTogether, k = i % kTogether;
        if (number == blocks_.size()) return rest_[k];
        const Block& block = blocks_[number];
        std::uint64_t at = block.begin + k * (block.bits[0] + block.bits[1] + block.bits[2]);
        Triangle triangle = block.least;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            triangle[corner] += more(at, block.bits[corner]);
            at += block.bits[corner];
        }
        return triangle;
    }
    /// The first one.
    Iterator begin() const { return {*this, 0}; }
    /// Behind the last one.
    Iterator end() const { return {*this, size()}; }
    /// All of them, unpacked.
    std::vector<Triangle> unpacked() const;
    /// The same triangles in the same order.
    bool operator==(const PackedTriangles& other) const = default;
    /// Bytes held.
    std::size_t bytes() const;

  private:
    static constexpr std::size_t kTogether = 64;
    struct Block {
        std::uint64_t begin;               // bit of the words
        Triangle least;                    // of each corner
        std::array<std::uint8_t, 3> bits;  // of what a corner exceeds that by, [0, 32]
        bool operator==(const Block&) const = default;
    };

    /// `bits` of the words from the bit `at` on; there is a word behind them.
    std::uint32_t more(std::uint64_t at, unsigned bits) const {
        const std::uint64_t* word = words_.data() + at / 64;
        const unsigned skipped = at % 64;
        std::uint64_t value = word[0] >> skipped;
        if (skipped + bits > 64) value |= word[1] << (64 - skipped);
        return static_cast<std::uint32_t>(value & ((std::uint64_t{1} << bits) - 1));
    }
    void pack(std::span<const Triangle, kTogether> triangles);

    std::vector<Block> blocks_;         // of 64 each
    std::vector<std::uint64_t> words_;  // of all blocks, one after the other, and one more
    std::uint64_t end_ = 0;             // bit
    std::vector<Triangle> rest_;        // fewer than a block
};

}  // namespace beltgrinding
