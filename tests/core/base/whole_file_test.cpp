#include "base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace beltgrinding {
namespace {

namespace fs = std::filesystem;

class WholeFile : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("beltgrinding-whole-" + std::to_string(::getpid()));
        fs::create_directory(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string at(const char* name) const { return (folder_ / name).string(); }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string bytes_of(const std::string& path) {
        std::string bytes;
        EXPECT_FALSE(read_whole(path, bytes));
        return bytes;
    }

    fs::path folder_;
};

TEST_F(WholeFile, TakesThePlaceOfTheOldOne) {
    EXPECT_FALSE(write_whole(at("a"), "old"));
    EXPECT_FALSE(write_whole(at("a"), std::string("n\0w", 3)));
    EXPECT_EQ(bytes_of(at("a")), std::string("n\0w", 3));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WholeFile, ALinkStaysOne) {
    EXPECT_FALSE(write_whole(at("a"), "old"));
    fs::create_symlink("a", folder_ / "link");
    EXPECT_FALSE(write_whole(at("link"), "new"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(bytes_of(at("a")), "new");
}

TEST_F(WholeFile, NothingTakesThePlaceOfAPipeOrAFolder) {
    ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
    EXPECT_EQ(write_whole(at("pipe"), "new"), std::errc::invalid_argument);
    EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
    fs::create_directory(folder_ / "sub");
    EXPECT_EQ(write_whole(at("sub"), "new"), std::errc::is_a_directory);
    EXPECT_EQ(write_whole(at("none/a"), "new"), std::errc::no_such_file_or_directory);
    EXPECT_EQ(entries(), 2u);
    std::string bytes = "as before";
    EXPECT_EQ(read_whole(at("pipe"), bytes), std::errc::invalid_argument);
}

}  // namespace
}  // namespace beltgrinding
