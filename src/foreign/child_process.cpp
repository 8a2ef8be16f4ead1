#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include "foreign/answer.h"

namespace beltgrinding {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kPoll = 50;            // ms between looks at the clock and at the context
constexpr milliseconds kGrace{500};  // from the end of its answer to the end of a child
constexpr milliseconds kReapPause{1};
constexpr int kFirstDescriptor = 16;  // ours lie above those that the child's actions replace
constexpr int kPipeBytes = 1 << 20;   // fewer changes of process than the usual 64 KiB
constexpr std::size_t kChunk = 1 << 16;

[[noreturn]] void fail(int error, const std::string& what) {
    throw std::system_error(error, std::generic_category(), what);
}

class Descriptor {
  public:
    /// Takes `number` over, moved out of the way of 0 to 15, closed in any program started.
    explicit Descriptor(int number) {
        if (number < 0) fail(errno, "no descriptor");
        number_ = fcntl(number, F_DUPFD_CLOEXEC, kFirstDescriptor);
        const int error = errno;
        close(number);
        if (number_ < 0) fail(error, "no descriptor");
    }
    ~Descriptor() { reset(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    void reset() {
        if (number_ >= 0) close(number_);
        number_ = -1;
    }
    operator int() const { return number_; }

  private:
    int number_ = -1;
};

Descriptor input_of(const std::string& text) {
    Descriptor file(memfd_create("beltgrinding", MFD_CLOEXEC));
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t n = write(file, text.data() + done, text.size() - done);
        if (n < 0 && errno != EINTR) fail(errno, "its input cannot be written");
        if (n > 0) done += std::size_t(n);
    }
    lseek(file, 0, SEEK_SET);
    return file;
}

/// A started program; dead and reaped at the end of its life.
class Child {
  public:
    Child(const ChildRequest& request, int input, int output) {
        std::vector<char*> arguments{const_cast<char*>(request.program.c_str())};
        for (const std::string& one : request.arguments)
            arguments.push_back(const_cast<char*>(one.c_str()));
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, input, 0);
        posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, output, kAnswerDescriptor);
        posix_spawn_file_actions_addclosefrom_np(&actions, kAnswerDescriptor + 1);
        // What a host ignores, a program started by it would ignore as well. That stays so of what
        // a terminal sends: it comes even before the program has a group of its own.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        sigset_t signals;
        sigfillset(&signals);
        for (const int number : {SIGINT, SIGQUIT, SIGHUP}) sigdelset(&signals, number);
        posix_spawnattr_setsigdefault(&attributes, &signals);
        sigemptyset(&signals);
        posix_spawnattr_setsigmask(&attributes, &signals);
        posix_spawnattr_setpgroup(&attributes, 0);
        posix_spawnattr_setflags(
            &attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
        // Not fork: the host has threads, and may be large.
        const int error = posix_spawn(&pid_, request.program.c_str(), &actions, &attributes,
                                      arguments.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0) fail(error, "no child");
    }
    ~Child() { end(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// True when it has ended; `wait` false: only looks.
    bool reap(bool wait) {
        while (!reaped_) {
            int status = 0;
            const pid_t got = waitpid(pid_, &status, wait ? 0 : WNOHANG);
            if (got == 0) return false;
            if (got < 0 && errno == EINTR) continue;
            // An error: the host ignores SIGCHLD or reaps all children itself, and it is gone.
            if (got > 0 && WIFSIGNALED(status)) signal_ = WTERMSIG(status);
            reaped_ = true;
        }
        return true;
    }
    void end() {
        if (reap(false)) return;
        kill(-pid_, SIGKILL);  // its group: a script that stands in for the reader has children
        kill(pid_, SIGKILL);
        reap(true);
    }
    int signal() const { return signal_; }
    /// Memory that it holds and shares with nobody, bytes. The limit that it sets itself counts
    /// what it asks for, and not what every library maps; this is the second line.
    std::size_t memory() const {
        std::ifstream file("/proc/" + std::to_string(pid_) + "/statm");
        std::size_t size = 0, resident = 0, shared = 0;
        if (!(file >> size >> resident >> shared) || resident < shared) return 0;
        return (resident - shared) * std::size_t(sysconf(_SC_PAGE_SIZE));
    }

  private:
    pid_t pid_ = -1;
    bool reaped_ = false;
    int signal_ = 0;
};

}  // namespace

ChildAnswer run_child(const ChildRequest& request, const RunContext& context) {
    context.throw_if_cancelled();
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno, "no pipe");
    Descriptor from_child(ends[0]);
    Descriptor to_host(ends[1]);
    fcntl(from_child, F_SETPIPE_SZ, kPipeBytes);  // a wish
    Descriptor input = input_of(request.input);
    ChildAnswer answer;
    const auto deadline = Clock::now() + std::chrono::duration<double>(request.time_limit);
    Child child(request, input, to_host);
    to_host.reset();
    input.reset();
    std::vector<char> chunk(kChunk);
    auto next_look = Clock::now();
    while (true) {
        pollfd wait{from_child, POLLIN, 0};
        const int ready = poll(&wait, 1, kPoll);
        context.throw_if_cancelled();
        const auto now = Clock::now();
        if (now > deadline) {
            answer.timed_out = true;
            return answer;
        }
        if (now >= next_look) {
            next_look = now + milliseconds(kPoll);
            if (child.memory() > request.memory_limit) {
                answer.out_of_memory = true;
                return answer;
            }
        }
        if (ready <= 0) continue;
        const ssize_t n = read(from_child, chunk.data(), chunk.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        answer.output.append(chunk.data(), std::size_t(n));
        if (answer.output.size() >= request.expected(answer.output)) return answer;
    }
    // It said less than it promised: what ended it is worth to be told.
    for (const auto patience = Clock::now() + kGrace; !child.reap(false);) {
        if (Clock::now() > patience) break;
        std::this_thread::sleep_for(kReapPause);
    }
    answer.signal = child.signal();
    return answer;
}

}  // namespace beltgrinding
