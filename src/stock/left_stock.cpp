#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "beltgrinding/stock.h"
#include "heightfield/height_lookup.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr double kSpacingsOff = 1.5;  // farther from the other field's samples is elsewhere
constexpr double kNoWeight = 1e-9;
constexpr double kMostElsewhere = 0.02;  // of the samples: at a border they may be

using Place = HeightLookup::Place;

/// The sample of a place that counts most in it.
std::uint32_t nearest(const Place& place) {
    Eigen::Index at = 0;
    place.weight.maxCoeff(&at);
    return place.samples[static_cast<std::size_t>(at)];
}

void make_room(FinishTrace& finish, std::size_t n) {
    finish.settled.assign(n, 0.0F);
    finish.unknown.assign(n, 1.0F);
    finish.lay.assign(n, Vec3f::Zero());
    finish.crossing.assign(n, std::numeric_limits<float>::quiet_NaN());
    finish.passes.assign(n, 0);
    finish.motion.assign(n, FinishTrace::kNever);
    finish.outside.assign(n, FinishTrace::kInside);
}

/// All but the motion, whose number is another run's.
void copy_finish(FinishTrace& to, std::size_t i, const FinishTrace& from, std::size_t k) {
    to.settled[i] = from.settled[k];
    to.unknown[i] = from.unknown[k];
    to.lay[i] = from.lay[k];
    to.crossing[i] = from.crossing[k];
    to.passes[i] = from.passes[k];
    to.outside[i] = from.outside[k];
}

/// Between the samples of a place that met stock, by their weights; NaN where none did.
template <class Values>
double between(const HeightField& left, const Place& place, const Values& values) {
    double sum = 0.0, weight = 0.0;
    for (std::size_t k = 0; k < place.samples.size(); ++k) {
        const std::uint32_t sample = place.samples[k];
        if ((left.flags[sample] & kMissed) != 0) continue;
        const double own = place.weight[static_cast<Eigen::Index>(k)];
        sum += own * static_cast<double>(values[sample]);
        weight += own;
    }
    return weight > kNoWeight ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

void set_sample(HeightField& field, std::size_t i, const HeightField& left, const Place& place) {
    const double height = between(left, place, left.height);
    const std::uint32_t k = nearest(place);
    const bool met = !std::isnan(height);
    const unsigned kept = field.flags[i] & ~unsigned{kMissed | kDefective};
    const unsigned found = met ? left.flags[k] & unsigned{kDefective} : unsigned{kMissed};
    field.flags[i] = static_cast<std::uint8_t>(kept | found);
    field.height[i] = met ? height : 0.0;
    field.stock_height[i] =
        met ? static_cast<float>(between(left, place, left.stock_height)) : 0.0F;
    if (!field.finish.empty() && !left.finish.empty()) copy_finish(field.finish, i, left.finish, k);
}

}  // namespace

StockReport apply_left(HeightField& field, const HeightField& left, bool finish,
                       const RunContext& context) {
    field.validate();
    left.validate();
    const HeightLookup lookup(left);
    const double most = kSpacingsOff * std::max(field.spacing, left.spacing);
    std::vector<std::optional<Place>> places(field.size());
    parallel_blocks(field.size(), kBlock, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            places[i] = lookup.find(field.face[i], field.point[i]);
    });
    const auto elsewhere = static_cast<std::size_t>(std::count_if(
        places.begin(), places.end(),
        [&](const std::optional<Place>& place) { return !place || place->distance > most; }));
    if (static_cast<double>(elsewhere) > kMostElsewhere * static_cast<double>(field.size())) {
        throw InputError("stock.left_elsewhere",
                         "stock: {count} of {all} samples lie where the earlier run ground "
                         "nothing; it is of another design, or of other faces",
                         {{"count", elsewhere}, {"all", field.size()}});
    }
    field.finish.clear();
    if (finish) make_room(field.finish, field.size());
    StockReport report;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (places[i]) {
            set_sample(field, i, left, *places[i]);
        } else {
            field.flags[i] |= kMissed;
            field.height[i] = 0.0;
            field.stock_height[i] = 0.0F;
        }
        report.missed += (field.flags[i] & kMissed) != 0;
        report.defective += (field.flags[i] & kDefective) != 0;
        report.volume += field.area[i] * std::max<double>(field.stock_height[i], 0.0);
    }
    return report;
}

}  // namespace beltgrinding
