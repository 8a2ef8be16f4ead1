#include "crash_guard.h"

#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>

namespace beltgrinding {
namespace {

TEST(CrashGuard, SurvivesAFaultMoreThanOnceAndGivesTheHandlersBack) {
    struct sigaction before {};
    sigaction(SIGSEGV, nullptr, &before);
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(survives([] { std::raise(SIGSEGV); }));
    bool ran = false;
    EXPECT_TRUE(survives([&] { ran = true; }));
    EXPECT_TRUE(ran);
    struct sigaction after {};
    sigaction(SIGSEGV, nullptr, &after);
    EXPECT_EQ(after.sa_handler, before.sa_handler);
}

TEST(CrashGuard, LetsExceptionsPass) {
    EXPECT_THROW(survives([] { throw std::runtime_error("x"); }), std::runtime_error);
    EXPECT_FALSE(survives([] { std::raise(SIGFPE); }));
}

}  // namespace
}  // namespace beltgrinding
