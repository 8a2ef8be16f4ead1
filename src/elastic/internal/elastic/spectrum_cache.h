#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "beltgrinding/contact_model.h"

namespace beltgrinding {

/// What an operator needs on a grid and is dear to build, by its cells (their number across the
/// wheel and their sides) and by a length that changes from step to step (the padded one of its
/// Fourier transforms). Kept for a few kinds of cells, between which a wheel changes on noses. Safe
/// from several threads.
template <class Spectrum>
class SpectrumCache {
  public:
    using Pointer = std::shared_ptr<const Spectrum>;

    /// What is kept for the cells of `grid` and `length`, or else what `build()` gives.
    template <class Build>
    Pointer get(const ContactGrid& grid, int length, Build&& build) {
        const Cells cells(grid.ny, grid.dy, grid.ds);
        if (Pointer known = find(cells, length)) return known;
        // Not under the lock: it may wait for other threads. The first that is done is kept.
        auto built = std::make_shared<const Spectrum>(build());
        const std::scoped_lock lock(mutex_);
        if (spectra_.size() >= kMost && !spectra_.contains(cells)) spectra_.clear();
        return spectra_[cells].try_emplace(length, built).first->second;
    }

  private:
    using Cells = std::tuple<int, double, double>;
    static constexpr std::size_t kMost = 16;

    Pointer find(const Cells& cells, int length) {
        const std::scoped_lock lock(mutex_);
        const auto same = spectra_.find(cells);
        if (same == spectra_.end()) return nullptr;
        const auto known = same->second.find(length);
        return known != same->second.end() ? known->second : nullptr;
    }

    std::mutex mutex_;
    std::map<Cells, std::map<int, Pointer>> spectra_;
};

}  // namespace beltgrinding
