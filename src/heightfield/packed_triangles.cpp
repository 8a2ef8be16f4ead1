#include "beltgrinding/packed_triangles.h"

#include <algorithm>
#include <bit>

namespace beltgrinding {

PackedTriangles::PackedTriangles(std::span<const Triangle> triangles) {
    blocks_.reserve(triangles.size() / kTogether);
    for (; triangles.size() >= kTogether; triangles = triangles.subspan(kTogether))
        pack(triangles.first<kTogether>());
    rest_.assign(triangles.begin(), triangles.end());
    shrink_to_fit();
}

void PackedTriangles::push_back(const Triangle& triangle) {
    rest_.push_back(triangle);
    if (rest_.size() < kTogether) return;
    pack(std::span<const Triangle, kTogether>(rest_));
    rest_.clear();
}

void PackedTriangles::shrink_to_fit() {
    blocks_.shrink_to_fit();
    words_.shrink_to_fit();
    rest_.shrink_to_fit();
}

std::vector<Triangle> PackedTriangles::unpacked() const {
    return {begin(), end()};
}

std::size_t PackedTriangles::bytes() const {
    return blocks_.capacity() * sizeof(Block) + words_.capacity() * sizeof(std::uint64_t) +
           rest_.capacity() * sizeof(Triangle);
}

void PackedTriangles::pack(std::span<const Triangle, kTogether> triangles) {
    Block block{end_, triangles[0], {}};
    Triangle most = triangles[0];
    for (const Triangle& t : triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            block.least[corner] = std::min(block.least[corner], t[corner]);
            most[corner] = std::max(most[corner], t[corner]);
        }
    }
    std::uint64_t each = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        block.bits[corner] =
            static_cast<std::uint8_t>(std::bit_width(most[corner] - block.least[corner]));
        each += block.bits[corner];
    }
    words_.resize((end_ + kTogether * each) / 64 + 1, 0);
    for (const Triangle& t : triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint64_t value = t[corner] - block.least[corner];
            const unsigned skipped = end_ % 64;
            words_[end_ / 64] |= value << skipped;
            if (skipped + block.bits[corner] > 64) words_[end_ / 64 + 1] |= value >> (64 - skipped);
            end_ += block.bits[corner];
        }
    }
    blocks_.push_back(block);
}

}  // namespace beltgrinding
