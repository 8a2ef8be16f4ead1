#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace beltgrinding {

/// Compliance matrices of a rim at its sampled wavenumbers.
struct RimSamples {
    std::vector<Eigen::MatrixXd> even, odd;
};

/// A short name for `key`, the text of all that a rim's samples depend on (FNV-1a, 64 bit).
std::string rim_cache_name(const std::string& key);

/// Where a rim's samples, which take seconds to compute, outlive the process. Called from any
/// thread, several at a time.
class RimCache {
  public:
    virtual ~RimCache() = default;

    /// What was written for `key`; none if there is nothing, or nothing sound.
    virtual std::optional<RimSamples> read(const std::string& key) const = 0;
    /// Keeps the samples. Where they cannot be kept is no error: they are computed again.
    virtual void write(const std::string& key, const RimSamples& samples) = 0;
};

/// A file per key in a folder, which is made when there is something to write. A file is written
/// whole or not at all, and not taken if it is damaged or belongs to another key.
class FolderRimCache final : public RimCache {
  public:
    explicit FolderRimCache(std::filesystem::path folder);
    std::optional<RimSamples> read(const std::string& key) const override;
    void write(const std::string& key, const RimSamples& samples) override;

  private:
    std::filesystem::path path(const std::string& key) const;

    std::filesystem::path folder_;
};

}  // namespace beltgrinding
