#include "elastic/rim_cache.h"

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/whole_file.h"

namespace beltgrinding {
namespace {

namespace fs = std::filesystem;
// Another number for another way to compute them: what older programs have kept is then computed
// anew.
constexpr std::string_view kMagic = "beltgrinding wheel rim 1\n";

std::uint64_t fnv1a(std::string_view data) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : data) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    }
    return hash;
}

std::string hex(std::uint64_t value) {
    std::ostringstream text;
    text << std::hex << value;
    return text.str();
}

void put(std::string& to, const void* data, std::size_t size) {
    to.append(static_cast<const char*>(data), size);
}

class Reader {
  public:
    explicit Reader(std::string_view data) : data_(data) {}
    bool take(void* to, std::size_t size) {
        if (data_.size() < size) return false;
        if (size > 0) std::memcpy(to, data_.data(), size);
        data_.remove_prefix(size);
        return true;
    }
    bool expect(std::string_view text) {
        if (!data_.starts_with(text)) return false;
        data_.remove_prefix(text.size());
        return true;
    }
    bool take(std::vector<Eigen::MatrixXd>& matrices) {
        std::uint64_t count = 0, size = 0;
        if (!take(&count, sizeof(count)) || !take(&size, sizeof(size))) return false;
        const std::uint64_t bytes = size * size * sizeof(double);
        if (size > 0xffff || count > 0xffff || data_.size() < count * bytes) return false;
        matrices.assign(count, Eigen::MatrixXd(static_cast<Eigen::Index>(size),
                                               static_cast<Eigen::Index>(size)));
        for (Eigen::MatrixXd& matrix : matrices) take(matrix.data(), bytes);
        return true;
    }
    bool done() const { return data_.empty(); }

  private:
    std::string_view data_;
};

}  // namespace

std::string rim_cache_name(const std::string& key) {
    return hex(fnv1a(key));
}

FolderRimCache::FolderRimCache(fs::path folder) : folder_(std::move(folder)) {}

fs::path FolderRimCache::path(const std::string& key) const {
    return folder_ / ("rim-" + rim_cache_name(key));
}

std::optional<RimSamples> FolderRimCache::read(const std::string& key) const {
    std::string data;
    if (read_whole(path(key).string(), data)) return std::nullopt;
    if (data.size() < sizeof(std::uint64_t)) return std::nullopt;
    const std::string_view body(data.data(), data.size() - sizeof(std::uint64_t));
    std::uint64_t sum = 0;
    std::memcpy(&sum, data.data() + body.size(), sizeof(sum));
    if (sum != fnv1a(body)) return std::nullopt;
    Reader reader(body);
    RimSamples found;
    if (!reader.expect(kMagic) || !reader.expect(key) || !reader.take(found.even) ||
        !reader.take(found.odd) || !reader.done()) {
        return std::nullopt;
    }
    return found;
}

void FolderRimCache::write(const std::string& key, const RimSamples& samples) {
    std::string data(kMagic);
    data += key;
    for (const auto* matrices : {&samples.even, &samples.odd}) {
        const std::uint64_t count = matrices->size();
        const auto size = static_cast<std::uint64_t>(count > 0 ? matrices->front().rows() : 0);
        put(data, &count, sizeof(count));
        put(data, &size, sizeof(size));
        for (const Eigen::MatrixXd& matrix : *matrices) {
            put(data, matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
        }
    }
    const std::uint64_t sum = fnv1a(data);
    put(data, &sum, sizeof(sum));
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    (void)write_whole(path(key).string(), data);  // what cannot be kept is computed again
}

}  // namespace beltgrinding
