// replay FOLDER MUTATIONS: runs a fuzz target on each file of a folder and on MUTATIONS copies that
// are damaged at random, the same in every run, without libFuzzer. Each hundred in a process of its
// own: in builds with TARGET_LIBRARY a fault there is counted and passed over, unless it is one of
// `must`.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "target.h"

namespace {

constexpr std::size_t kBatch = 100;
constexpr unsigned kSeconds = 60;  // for a batch
#ifdef TARGET_LIBRARY
constexpr bool kLibrary = true;
constexpr rlim_t kMemory = rlim_t{2} << 30;  // bytes
#else
constexpr bool kLibrary = false;
#endif

std::string mutated(const std::vector<std::string>& corpus, std::size_t number) {
    std::mt19937_64 dice(number);
    const auto below = [&](std::size_t n) { return n == 0 ? std::size_t{0} : dice() % n; };
    std::string bytes = corpus[number % corpus.size()];
    for (std::size_t k = below(4) == 0 ? 1 + below(16) : 1; k > 0; --k) {
        const std::size_t at = below(bytes.size() + 1);
        switch (below(7)) {
            case 0:
            case 1:
                if (at < bytes.size()) bytes[at] = static_cast<char>(dice());
                break;
            case 2:
                if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
                break;
            case 3:
                bytes.erase(at, 1 + below(20));
                break;
            case 4:
                bytes.insert(at, bytes.substr(below(bytes.size() + 1), 1 + below(40)));
                break;
            case 5: {
                constexpr std::array<std::uint64_t, 6> kOdd = {
                    0, 1, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, 0xffffffffffffffff};
                const std::size_t width = std::size_t{1} << below(4);
                if (at + width <= bytes.size())
                    std::memcpy(bytes.data() + at, &kOdd[below(kOdd.size())], width);
                break;
            }
            default:
                bytes.resize(at);
        }
    }
    return bytes;
}

void run(const std::string& bytes) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) {
        std::fprintf(stderr, "usage: %s FOLDER MUTATIONS\n", arguments[0]);
        return 2;
    }
    std::vector<std::string> corpus;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments[1]))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& path : files) {
        std::ifstream file(path, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    if (corpus.empty()) return 2;
    const std::size_t total = corpus.size() + std::strtoull(arguments[2], nullptr, 10);
    auto* done = static_cast<std::size_t*>(mmap(
        nullptr, sizeof(std::size_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    must(done != MAP_FAILED);
    std::size_t faults = 0;
    for (std::size_t at = 0; at < total;) {
        const std::size_t end = std::min(at + kBatch, total);
        const pid_t child = fork();
        if (child == 0) {
#ifdef TARGET_LIBRARY
            const rlimit memory{kMemory, kMemory};
            setrlimit(RLIMIT_DATA, &memory);
            must(std::freopen("/dev/null", "w", stderr) != nullptr);  // what assertions say
#endif
            const rlimit none{0, 0};
            setrlimit(RLIMIT_CORE, &none);
            alarm(kSeconds);
            for (std::size_t i = at; i < end; ++i) {
                *done = i;
                run(i < corpus.size() ? corpus[i] : mutated(corpus, i - corpus.size()));
            }
            std::exit(0);
        }
        int status = 0;
        if (waitpid(child, &status, 0) != child) return 1;
        at = end;
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
        const bool ours = !kLibrary || (WIFEXITED(status) && WEXITSTATUS(status) == kBroken);
        if (ours) {
            std::fprintf(stderr, "input %zu (status %d)\n", *done, status);
            std::ofstream("fault", std::ios::binary)
                << (*done < corpus.size() ? corpus[*done] : mutated(corpus, *done - corpus.size()));
            return 1;
        }
        ++faults;
        at = *done + 1;
    }
    std::printf("%zu inputs, %zu faults of libraries\n", total, faults);
    return 0;
}
