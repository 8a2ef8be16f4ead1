#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace beltgrinding {

/// Blocks of changed samples with their new heights. Neighbouring samples make a run, so that a
/// change costs little more than the four bytes of its height. It is kept in pieces of some
/// megabytes, which copies share and which are never moved once they are full.
class ChangeLog {
  public:
    struct Run {
        std::uint32_t first;  ///< sample
        std::uint32_t count;
    };
    struct End {
        std::size_t run = 0, height = 0;
    };
    /// All of it in three arrays; ends of blocks are counted over the whole.
    struct Arrays {
        std::vector<Run> runs;
        std::vector<float> height;  ///< mm
        std::vector<End> ends;      ///< by block
    };
    ChangeLog() = default;
    /// The arrays must be sound.
    explicit ChangeLog(Arrays arrays);

    std::size_t blocks() const { return blocks_; }
    std::size_t changes() const { return changes_; }
    std::size_t changes(std::size_t block) const;
    std::size_t bytes() const;
    /// Gives back what the last piece does not need.
    void shrink_to_fit();
    /// Begins a block, which `add` fills by ascending samples.
    void begin_block();
    void add(std::uint32_t sample, float height) {
        Piece& piece = *pieces_.back().of;
        lengthen(piece, sample, 1);
        piece.height.push_back(height);
    }
    /// The same of neighbouring samples.
    void add(std::uint32_t first, std::span<const double> heights) {
        Piece& piece = *pieces_.back().of;
        lengthen(piece, first, static_cast<std::uint32_t>(heights.size()));
        piece.height.insert(piece.height.end(), heights.begin(), heights.end());
    }
    void end_block();
    /// Adds the blocks of another from its block number `from` on. Pieces that lie wholly there
    /// are shared.
    void append(const ChangeLog& other, std::size_t from = 0);
    /// Forgets pieces that have only blocks before `block`; those after keep their numbers. Only to
    /// be visited from then on.
    void forget_before(std::size_t block);
    /// Calls visit(sample, height) for the changes of a block, in ascending order.
    template <class Visit>
    void visit(std::size_t block, Visit&& visit) const {
        const auto [first, of] = place_of(block);
        const Piece& piece = *of;
        const std::size_t here = block - first;
        std::size_t h = piece.begin(here).height;
        for (std::size_t r = piece.begin(here).run; r < piece.ends[here].run; ++r) {
            for (std::uint32_t k = 0; k < piece.runs[r].count; ++k) {
                visit(piece.runs[r].first + k, piece.height[h++]);
            }
        }
    }
    /// Calls visit(runs, heights, ends, the end of the piece before) for each piece.
    template <class Visit>
    void for_pieces(Visit&& visit) const {
        End before;
        for (const Place& place : pieces_) {
            const Piece& piece = *place.of;
            visit(std::span<const Run>(piece.runs), std::span<const float>(piece.height),
                  std::span<const End>(piece.ends), before);
            before.run += piece.runs.size();
            before.height += piece.height.size();
        }
    }

  private:
    struct Piece {
        std::vector<Run> runs;
        std::vector<float> height;
        std::vector<End> ends;  // counted within the piece
        End begin(std::size_t here) const { return here == 0 ? End{} : ends[here - 1]; }
    };
    struct Place {
        std::size_t first;          // number of its first block
        std::shared_ptr<Piece> of;  // what others share is not written to any more
    };
    const Place& place_of(std::size_t block) const;
    void lengthen(Piece& piece, std::uint32_t first, std::uint32_t count) {
        if (piece.runs.size() > open_run_ &&
            piece.runs.back().first + piece.runs.back().count == first) {
            piece.runs.back().count += count;
        } else {
            piece.runs.push_back({first, count});
        }
    }

    std::vector<Place> pieces_;
    std::size_t blocks_ = 0, changes_ = 0, runs_ = 0;
    std::size_t open_run_ = 0;
};

}  // namespace beltgrinding
