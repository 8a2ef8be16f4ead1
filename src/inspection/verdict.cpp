#include "beltgrinding/verdict.h"

#include <algorithm>
#include <cmath>

#include "beltgrinding/error.h"
#include "clusters.h"
#include "heightfield/sound_field.h"
#include "inspection/zones.h"

namespace beltgrinding {
namespace {

/// The deviation against the limit that it lies beyond or, inside of the band, nearest to.
WorstPoint against(std::uint32_t sample, double value, const Tolerance& band) {
    const double above = value - band.upper, below = band.lower - value;
    return above >= below ? WorstPoint{sample, value, band.upper, above}
                          : WorstPoint{sample, value, band.lower, below};
}

/// Sums up one region sample by sample.
void add(RegionVerdict& r, const HeightField& field, const WorstPoint& judged) {
    const std::uint32_t i = judged.sample;
    const double a = field.area[i], h = field.height[i];
    ++r.samples;
    r.area += a;
    r.stock_volume += a * std::max(field.stock_height[i], 0.0F);
    if ((field.flags[i] & kDefective) != 0) ++r.defective;
    if ((field.flags[i] & kMissed) != 0) {
        ++r.missed;
        r.missed_area += a;
        return;
    }
    if (!field.trace.empty() && !field.trace.touched(i)) r.untouched_area += a;
    r.removed_volume += a * removed_from(field, i);
    r.excess_volume += a * std::max(h, 0.0);
    r.gouge_volume += a * std::max(-h, 0.0);
    if (judged.beyond > 0.0) (h > judged.limit ? r.above_area : r.below_area) += a;
    r.min = r.worst ? std::min(r.min, h) : h;
    r.max = r.worst ? std::max(r.max, h) : h;
    r.mean += a * h;
    r.rms += a * h * h;
    if (!r.worst || judged.beyond > r.worst->beyond) r.worst = judged;
}

void finish(RegionVerdict& r) {
    const double inspected = r.area - r.missed_area;
    if (!(inspected > 0.0)) return;
    r.mean /= inspected;
    r.rms = std::sqrt(r.rms / inspected);
}

}  // namespace

Verdict judge(const HeightField& field, const std::vector<ToleranceZone>& zones,
              const Tolerance& rest) {
    field.validate();
    if (!std::isfinite(rest.lower) || !std::isfinite(rest.upper) || rest.lower > rest.upper) {
        throw InputError("inspection.tolerance",
                         "tolerance: the lower limit must not lie above the upper one");
    }
    Verdict verdict;
    verdict.zone = zone_of_samples(field, zones);
    verdict.zones.resize(zones.size() + 1);
    for (std::uint32_t z = 0; z < verdict.zones.size(); ++z) verdict.zones[z].region = z;
    const std::uint32_t last_face =
        field.size() > 0 ? *std::max_element(field.face.begin(), field.face.end()) : 0;
    std::vector<RegionVerdict> faces(std::size_t{last_face} + 1);

    const auto judged = [&](std::uint32_t i) {
        const std::uint32_t z = verdict.zone[i];
        return against(i, field.height[i], z < zones.size() ? zones[z].tolerance : rest);
    };
    std::vector<double> beyond(field.size(), 0.0);
    for (std::uint32_t i = 0; i < field.size(); ++i) {
        const WorstPoint found = judged(i);
        add(verdict.whole, field, found);
        add(verdict.zones[verdict.zone[i]], field, found);
        add(faces[field.face[i]], field, found);
        if (found.beyond > 0.0 && (field.flags[i] & kMissed) == 0) {
            beyond[i] = found.value > found.limit ? found.beyond : -found.beyond;
        }
    }
    finish(verdict.whole);
    for (RegionVerdict& zone : verdict.zones) finish(zone);
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        if (faces[f].samples == 0) continue;
        faces[f].region = f;
        finish(faces[f]);
        verdict.faces.push_back(faces[f]);
    }
    find_clusters(field, beyond, judged, verdict);
    return verdict;
}

}  // namespace beltgrinding
