#include "recorders/change_log.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "base/large_memory.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 22;  // most heights that room is made for
constexpr std::size_t kFirst = 1024;                  // the least
constexpr std::size_t kSpare = 8;  // share of the room that is left for a last block

}  // namespace

ChangeLog::ChangeLog(Arrays arrays)
    : blocks_(arrays.ends.size()), changes_(arrays.height.size()), runs_(arrays.runs.size()) {
    if (blocks_ == 0) return;
    pieces_.push_back(
        {0, std::make_shared<Piece>(
                Piece{std::move(arrays.runs), std::move(arrays.height), std::move(arrays.ends)})});
}

std::size_t ChangeLog::bytes() const {
    return runs_ * sizeof(Run) + changes_ * sizeof(float) + blocks_ * sizeof(End);
}

void ChangeLog::shrink_to_fit() {
    if (pieces_.empty() || pieces_.back().of.use_count() > 1) return;
    Piece& last = *pieces_.back().of;
    last.runs.shrink_to_fit();
    last.height.shrink_to_fit();
    last.ends.shrink_to_fit();
}

const ChangeLog::Place& ChangeLog::place_of(std::size_t block) const {
    const auto after = std::upper_bound(
        pieces_.begin(), pieces_.end(), block,
        [](std::size_t number, const Place& place) { return number < place.first; });
    return *std::prev(after);
}

std::size_t ChangeLog::changes(std::size_t block) const {
    const auto& [first, piece] = place_of(block);
    const std::size_t here = block - first;
    return piece->ends[here].height - piece->begin(here).height;
}

void ChangeLog::begin_block() {
    const auto has_room = [](const Place& place) {
        const std::vector<float>& height = place.of->height;
        return place.of.use_count() == 1 &&
               height.size() < height.capacity() - height.capacity() / kSpare;
    };
    if (pieces_.empty() || !has_room(pieces_.back())) {
        // As much again as there is, so that a short log takes little.
        const std::size_t room = std::clamp(changes_, kFirst, kPiece);
        pieces_.push_back({blocks_, std::make_shared<Piece>()});
        std::vector<float>& height = pieces_.back().of->height;
        height.reserve(room);
        expect_large_use(height.data(), room * sizeof(float));
    }
    open_run_ = pieces_.back().of->runs.size();
}

void ChangeLog::end_block() {
    Piece& piece = *pieces_.back().of;
    const End before = piece.begin(piece.ends.size());
    piece.ends.push_back({piece.runs.size(), piece.height.size()});
    ++blocks_;
    changes_ += piece.height.size() - before.height;
    runs_ += piece.runs.size() - before.run;
}

void ChangeLog::append(const ChangeLog& other, std::size_t from) {
    for (const auto& [first, piece] : other.pieces_) {
        const std::size_t skipped = from > first ? from - first : 0;
        if (skipped >= piece->ends.size()) continue;
        const End before = piece->begin(skipped);
        std::shared_ptr<Piece> rest = piece;
        if (skipped > 0) {
            const auto since = [](const auto& all, std::size_t begin) {
                return std::remove_cvref_t<decltype(all)>(
                    all.begin() + static_cast<std::ptrdiff_t>(begin), all.end());
            };
            rest = std::make_shared<Piece>(Piece{since(piece->runs, before.run),
                                                 since(piece->height, before.height),
                                                 since(piece->ends, skipped)});
            for (End& end : rest->ends) {
                end.run -= before.run;
                end.height -= before.height;
            }
        }
        pieces_.push_back({blocks_, rest});
        blocks_ += rest->ends.size();
        changes_ += rest->height.size();
        runs_ += rest->runs.size();
    }
}

void ChangeLog::forget_before(std::size_t block) {
    const auto keep = std::find_if(pieces_.begin(), pieces_.end(), [block](const Place& place) {
        return place.first + place.of->ends.size() > block;
    });
    pieces_.erase(pieces_.begin(), keep);
}

}  // namespace beltgrinding
