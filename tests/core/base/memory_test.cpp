#include "base/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace beltgrinding {
namespace {

namespace fs = std::filesystem;

/// A folder that stands for the machine's root.
class UsableMemory : public ::testing::Test {
  protected:
    void SetUp() override {
        root_ = fs::temp_directory_path() / ("beltgrinding-memory-" + std::to_string(::getpid()));
        put("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable:    4000 kB\n");
    }
    void TearDown() override { fs::remove_all(root_); }
    void put(const std::string& file, const std::string& text) const {
        fs::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }
    std::size_t kibibytes() const { return usable_memory(root_.string()) / 1024; }

    fs::path root_;
};

TEST_F(UsableMemory, IsWhatIsAvailableWithoutALimit) {
    EXPECT_EQ(kibibytes(), 4000u);
    put("proc/self/cgroup", "0::/a/b\n4:memory:/c\n");
    put("sys/fs/cgroup/a/b/memory.max", "max\n");
    put("sys/fs/cgroup/memory/c/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(kibibytes(), 4000u);
}

TEST_F(UsableMemory, IsTheLeastOfAGroupAndOfThoseAroundIt) {
    put("proc/self/cgroup", "0::/a/b\n");
    put("sys/fs/cgroup/a/b/memory.max", "max\n");
    put("sys/fs/cgroup/a/memory.max", std::to_string(3000 * 1024));
    EXPECT_EQ(kibibytes(), 3000u);
    put("sys/fs/cgroup/memory.max", std::to_string(2000 * 1024));  // a container's own root
    EXPECT_EQ(kibibytes(), 2000u);
    put("sys/fs/cgroup/a/b/memory.max", std::to_string(1000 * 1024));
    EXPECT_EQ(kibibytes(), 1000u);
}

TEST_F(UsableMemory, KnowsTheFirstVersionToo) {
    put("proc/self/cgroup", "9:name=systemd:/\n4:memory:/box/one\n0::/\n");
    put("sys/fs/cgroup/memory/memory.limit_in_bytes", std::to_string(1500 * 1024));
    EXPECT_EQ(kibibytes(), 1500u);  // the host's path, a container's mount
    put("sys/fs/cgroup/memory/box/one/memory.limit_in_bytes", std::to_string(500 * 1024));
    EXPECT_EQ(kibibytes(), 500u);
}

TEST_F(UsableMemory, FindsTheMemoryAmongOtherKinds) {
    put("proc/self/cgroup", "4:cpu,memory,pids:/one\n");
    put("sys/fs/cgroup/memory/one/memory.limit_in_bytes", std::to_string(700 * 1024));
    EXPECT_EQ(kibibytes(), 700u);
    put("proc/self/cgroup", "4:cpu,memory2:/one\n");
    EXPECT_EQ(kibibytes(), 4000u);
}

TEST_F(UsableMemory, IsTheMachinesWhereNothingIsSaid) {
    fs::remove_all(root_);
    EXPECT_GT(kibibytes(), 0u);
}

}  // namespace
}  // namespace beltgrinding
