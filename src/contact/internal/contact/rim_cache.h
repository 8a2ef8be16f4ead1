#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace beltgrinding {

/// Compliance matrices of a rim at its sampled wavenumbers.
struct RimSamples {
    std::vector<Eigen::MatrixXd> even, odd;
};

/// A short name for `key`, the text of all that a rim's samples depend on (FNV-1a, 64 bit).
std::string rim_cache_name(const std::string& key);

/// Reads samples from the user's cache ($XDG_CACHE_HOME/beltgrinding, or ~/.cache/beltgrinding).
/// False if there are none, or if the file is damaged or belongs to another key.
bool read_rim_cache(const std::string& key, RimSamples& samples);

/// Writes samples to the cache, whole or not at all. A cache that cannot be written is no error.
void write_rim_cache(const std::string& key, const RimSamples& samples);

}  // namespace beltgrinding
