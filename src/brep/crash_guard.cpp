#include "crash_guard.h"

#include <array>
#include <csetjmp>
#include <csignal>
#include <vector>

namespace beltgrinding {
namespace {

constexpr std::array kSignals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL};
constexpr std::size_t kHandlerStack = 1 << 16;  // bytes; a fault may be the end of the stack itself

thread_local sigjmp_buf* t_way_out = nullptr;

extern "C" void leave(int number) {
    if (t_way_out != nullptr) siglongjmp(*t_way_out, 1);
    std::signal(number, SIG_DFL);  // another thread's fault: it comes again, and is not ours
}

class Handlers {
  public:
    explicit Handlers(sigjmp_buf& way_out) : stack_(kHandlerStack) {
        stack_t stack{};
        stack.ss_sp = stack_.data();
        stack.ss_size = stack_.size();
        sigaltstack(&stack, &old_stack_);
        struct sigaction action {};
        action.sa_handler = leave;
        action.sa_flags = SA_ONSTACK;
        sigemptyset(&action.sa_mask);
        for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &old_[i]);
        t_way_out = &way_out;
    }
    ~Handlers() {
        t_way_out = nullptr;
        for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &old_[i], nullptr);
        sigaltstack(&old_stack_, nullptr);
    }
    Handlers(const Handlers&) = delete;
    Handlers& operator=(const Handlers&) = delete;

  private:
    std::vector<char> stack_;
    stack_t old_stack_{};
    std::array<struct sigaction, kSignals.size()> old_{};
};

}  // namespace

bool survives(const std::function<void()>& work) {
    sigjmp_buf way_out;
    const Handlers handlers(way_out);
    if (sigsetjmp(way_out, 1) != 0) return false;
    work();
    return true;
}

}  // namespace beltgrinding
