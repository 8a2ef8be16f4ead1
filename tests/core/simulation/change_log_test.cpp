#include "recorders/change_log.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <utility>
#include <vector>

using namespace beltgrinding;

namespace {

using Changes = std::vector<std::pair<std::uint32_t, float>>;

Changes changes_of(const ChangeLog& log, std::size_t block) {
    Changes changes;
    log.visit(block, [&](std::uint32_t sample, float h) { changes.emplace_back(sample, h); });
    return changes;
}

/// Blocks of some hundred changes, enough for several pieces.
struct Logged {
    ChangeLog log;
    std::vector<Changes> blocks;
    std::mt19937 random{7};

    void add(std::size_t count) {
        for (std::size_t b = 0; b < count; ++b) {
            Changes& changes = blocks.emplace_back();
            log.begin_block();
            for (std::uint32_t sample = 0; sample < 500; ++sample) {
                if (random() % 3 == 0) continue;
                changes.emplace_back(sample, static_cast<float>(random() % 1000));
                log.add(sample, changes.back().second);
            }
            log.end_block();
        }
    }
    void expect(const ChangeLog& other, std::size_t from = 0) const {
        ASSERT_EQ(other.blocks(), blocks.size() - from);
        std::size_t all = 0;
        for (std::size_t b = from; b < blocks.size(); ++b) {
            EXPECT_EQ(changes_of(other, b - from), blocks[b]) << b;
            EXPECT_EQ(other.changes(b - from), blocks[b].size());
            all += blocks[b].size();
        }
        EXPECT_EQ(other.changes(), all);
    }
};

}  // namespace

TEST(ChangeLog, GivesBackWhatItWasGiven) {
    Logged made;
    made.add(400);
    made.expect(made.log);
    made.log.shrink_to_fit();
    made.expect(made.log);
}

TEST(ChangeLog, NeighboursAreOneRunHoweverTheyCome) {
    const std::array<double, 3> heights{0.25, 0.5, 0.75};
    ChangeLog one, other;
    one.begin_block();
    one.add(4, heights);
    one.add(7, 1.0F);
    one.end_block();
    other.begin_block();
    for (std::uint32_t k = 0; k < 4; ++k) other.add(4 + k, 0.25F * static_cast<float>(k + 1));
    other.end_block();
    EXPECT_EQ(changes_of(one, 0), changes_of(other, 0));
    EXPECT_EQ(one.bytes(), other.bytes());
    EXPECT_EQ(one.bytes(), sizeof(ChangeLog::Run) + 4 * sizeof(float) + sizeof(ChangeLog::End));
}

TEST(ChangeLog, PartsKeepWhatTheyHadWhileTheLogGoesOn) {
    Logged made;
    made.add(100);
    ChangeLog first, rest, middle;
    first.append(made.log);
    const Logged then = made;
    made.add(150);
    rest.append(made.log, 100);
    middle.append(made.log, 60);  // within a piece
    made.add(30);
    made.expect(made.log);
    then.expect(first);
    ChangeLog both = first;
    both.append(rest);
    ASSERT_EQ(both.blocks(), 250U);
    EXPECT_EQ(middle.blocks(), 190U);
    for (std::size_t b = 0; b < 250; ++b) {
        EXPECT_EQ(changes_of(both, b), made.blocks[b]) << b;
        if (b < 60) continue;
        EXPECT_EQ(changes_of(middle, b - 60), made.blocks[b]) << b;
    }
    // A copy goes on by itself.
    both.begin_block();
    both.add(3, 1.0F);
    both.end_block();
    EXPECT_EQ(changes_of(both, 250), (Changes{{3, 1.0F}}));
    EXPECT_EQ(rest.blocks(), 150U);
}

TEST(ChangeLog, ForgetsPiecesAndKeepsNumbers) {
    Logged made;
    made.add(400);
    made.log.forget_before(250);
    for (std::size_t b = 250; b < 400; ++b) EXPECT_EQ(changes_of(made.log, b), made.blocks[b]);
}

TEST(ChangeLog, ArraysThereAndBack) {
    Logged made;
    made.add(300);
    ChangeLog::Arrays arrays;
    std::size_t pieces = 0;
    made.log.for_pieces([&](auto runs, auto heights, auto ends, ChangeLog::End before) {
        EXPECT_EQ(before.height, arrays.height.size());
        arrays.runs.insert(arrays.runs.end(), runs.begin(), runs.end());
        arrays.height.insert(arrays.height.end(), heights.begin(), heights.end());
        for (const ChangeLog::End& end : ends)
            arrays.ends.push_back({before.run + end.run, before.height + end.height});
        ++pieces;
    });
    EXPECT_GT(pieces, 2U);
    made.expect(ChangeLog(std::move(arrays)));
}
