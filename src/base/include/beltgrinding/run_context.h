#pragma once

#include <atomic>
#include <memory>

#include "beltgrinding/error.h"

namespace beltgrinding {

/// Progress and cancellation of one long call. Copies share their state, so one thread can watch
/// and cancel what another computes. A default-made context is never cancelled by anybody else.
///
/// Every long call checks it at least each 0.1 s of work and throws `Cancelled`.
class RunContext {
  public:
    RunContext() : state_(std::make_shared<State>()) {}

    /// Asks the call to end; safe from any thread.
    void cancel() const { state_->cancelled.store(true, std::memory_order_relaxed); }
    /// Somebody asked for the end.
    bool cancelled() const { return state_->cancelled.load(std::memory_order_relaxed); }
    /// Throws Cancelled if somebody did.
    void throw_if_cancelled() const {
        if (cancelled()) throw Cancelled();
    }

    /// Share of the whole call that is done, in [0, 1]; safe from any thread.
    double progress() const { return state_->progress.load(std::memory_order_relaxed); }
    /// Reports that the share `done` in [0, 1] of this context's own part is done.
    void report(double done) const {
        state_->progress.store(begin_ + done * (end_ - begin_), std::memory_order_relaxed);
    }

    /// A context for a part of the call: its [0, 1] is shown as [begin, end] of this one's.
    RunContext part(double begin, double end) const {
        RunContext p = *this;
        p.begin_ = begin_ + begin * (end_ - begin_);
        p.end_ = begin_ + end * (end_ - begin_);
        return p;
    }

  private:
    struct State {
        std::atomic<bool> cancelled{false};
        std::atomic<double> progress{0.0};
    };
    std::shared_ptr<State> state_;
    double begin_ = 0.0;
    double end_ = 1.0;
};

}  // namespace beltgrinding
