#include "step_queue.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace beltgrinding {

StepQueue::StepQueue(const ToolPath& path, const SteppingOptions& options) : path_(path) {
    const std::vector<PathStep> steps = path.steps(options);
    planned_ = steps.size();
    left_.reserve(planned_);
    put(steps, 1);
}

bool StepQueue::next() {
    if (left_.empty()) return false;
    now_ = left_.back();
    left_.pop_back();
    if (now_.parts == 1) ++begun_;
    return true;
}

void StepQueue::cut(double parts) {
    const int most = kMostParts / now_.parts;
    const int count = parts < most ? std::max(2, static_cast<int>(std::ceil(parts))) : most;
    put(path_.cut(now_.step, count), count * now_.parts);
}

void StepQueue::put(const std::vector<PathStep>& steps, int parts) {
    std::transform(steps.rbegin(), steps.rend(), std::back_inserter(left_),
                   [parts](const PathStep& step) {
                       return Item{step, parts};
                   });
}

double StepQueue::progress() const {
    return begun_ > 0 ? static_cast<double>(begun_ - 1) / static_cast<double>(planned_) : 0.0;
}

}  // namespace beltgrinding
