// beltgrinding-cad-reader PARENT MEMORY TASK [PATH]: does a task (tasks.h) on a file, or on the
// standard input, with MEMORY bytes at most, and answers on descriptor 3 with what was made of it,
// or with what stands against it (foreign/answer.h). Started by foreign/reader.cpp; its faults are
// its own.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <new>
#include <string>
#include <string_view>

#include "beltgrinding/error.h"
#include "foreign/answer.h"
#include "tasks.h"

namespace {

using namespace beltgrinding;

constexpr std::array kFaults = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr std::size_t kHandlerStack = 1 << 16;  // bytes; a fault may be the end of the stack itself

void send(const char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t n = write(kAnswerDescriptor, bytes, size);
        if (n < 0 && errno != EINTR) _exit(1);  // nobody listens any more
        if (n <= 0) continue;
        bytes += n;
        size -= std::size_t(n);
    }
}

/// Answers and ends: no destructor of a damaged shape, no static's of a library, is run any more.
[[noreturn]] void answer(AnswerKind kind, std::string_view body = {}) {
    AnswerHead head;
    head.kind = kind;
    head.size = body.size();
    head.check = answer_check(body);
    send(reinterpret_cast<const char*>(&head), sizeof head);
    send(body.data(), body.size());
    _exit(0);
}

extern "C" void tell_fault(int number) {
    AnswerHead head;
    head.kind = AnswerKind::kSignal;
    head.signal = number;
    head.check = answer_check({});
    send(reinterpret_cast<const char*>(&head), sizeof head);
    _exit(1);
}

/// The host may reap its children by itself, and then never learns what ended this one.
void catch_faults() {
    static std::array<char, kHandlerStack> memory;
    stack_t stack{};
    stack.ss_sp = memory.data();
    stack.ss_size = memory.size();
    sigaltstack(&stack, nullptr);
    struct sigaction action {};
    action.sa_handler = tell_fault;
    action.sa_flags = SA_ONSTACK | SA_RESETHAND;
    sigemptyset(&action.sa_mask);
    for (const int number : kFaults) sigaction(number, &action, nullptr);
}

[[noreturn]] void tell_memory() {
    answer(AnswerKind::kMemory);
}

/// No core file, and no more memory than allowed: damaged files ask for any amount. What is counted
/// is what is asked for, not the addresses that each thread's heap keeps free.
void limit([[maybe_unused]] unsigned long long bytes) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    // Libraries take a failed allocation for a file that is not theirs, or for nothing at all.
    std::set_new_handler(tell_memory);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they map terabytes
    rlimit memory{};
    getrlimit(RLIMIT_DATA, &memory);
    memory.rlim_cur = std::min(memory.rlim_max, rlim_t(bytes));
    setrlimit(RLIMIT_DATA, &memory);
#endif
}

std::string standard_input() {
    return std::string(std::istreambuf_iterator<char>(std::cin), {});
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 4 || fcntl(kAnswerDescriptor, F_GETFD) < 0) {
        std::cerr << "This program is beltgrinding's own: it reads CAD files for it.\n";
        return 2;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != std::atoi(arguments[1])) return 1;  // the host had ended before
    catch_faults();
    limit(std::strtoull(arguments[2], nullptr, 10));
    try {
        const std::string input = count > 4 ? std::string() : standard_input();
        const auto body = do_task(arguments[3], count > 4 ? arguments[4] : "", input);
        if (!body) return 2;  // another build's task
        answer(AnswerKind::kDone, *body);
    } catch (const InputError& error) {
        answer(AnswerKind::kRefused, pack_error(error));
    } catch (const std::bad_alloc&) {
        answer(AnswerKind::kMemory);
    } catch (const std::exception& error) {
        answer(AnswerKind::kRefused,
               pack_error(InputError("cad.exception", "it cannot be read: {reason}",
                                     {{"reason", error.what()}})));
    }
}
