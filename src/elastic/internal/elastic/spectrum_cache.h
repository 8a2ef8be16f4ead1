#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// What an operator needs on a grid and is dear to build, by a length that changes from step to
/// step (the padded one of its Fourier transforms). Kept while the cells are the same: their number
/// across the wheel and their sides. Safe from several threads.
template <class Spectrum>
class SpectrumCache {
  public:
    using Pointer = std::shared_ptr<const Spectrum>;

    /// What is kept for the cells of `grid` and `length`, or else what `build()` gives.
    template <class Build>
    Pointer get(const ContactGrid& grid, int length, Build&& build) {
        if (Pointer known = find(grid, length)) return known;
        // Not under the lock: it may wait for other threads. The first that is done is kept.
        auto built = std::make_shared<const Spectrum>(build());
        const std::scoped_lock lock(mutex_);
        return same_cells(grid) ? spectra_.try_emplace(length, built).first->second : built;
    }

  private:
    bool same_cells(const ContactGrid& grid) const {
        return grid.ny == ny_ && grid.dy == dy_ && grid.ds == ds_;
    }
    Pointer find(const ContactGrid& grid, int length) {
        const std::scoped_lock lock(mutex_);
        if (!same_cells(grid)) {
            spectra_.clear();
            ny_ = grid.ny;
            dy_ = grid.dy;
            ds_ = grid.ds;
        }
        const auto known = spectra_.find(length);
        return known != spectra_.end() ? known->second : nullptr;
    }

    std::mutex mutex_;
    int ny_ = 0;
    double dy_ = 0.0, ds_ = 0.0;
    std::map<int, Pointer> spectra_;
};

}  // namespace beltgrinding
