#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "beltgrinding/deviation.h"
#include "beltgrinding/height_field.h"
#include "beltgrinding/zones.h"

namespace beltgrinding {

/// The place that lies farthest beyond its limit or, where all is good, nearest to it.
struct WorstPoint {
    std::uint32_t sample = 0;
    double value = 0.0;   ///< deviation, mm
    double limit = 0.0;   ///< mm, the one that it lies beyond or next to
    double beyond = 0.0;  ///< mm beyond the limit; negative: what is left to it
};

/// What is to be said of a part of the surface. Every sample is judged by its own zone's band.
/// Areas mm2, volumes mm3, deviations mm. A missed sample has an area but no deviation.
struct RegionVerdict {
    std::uint32_t region = 0;  ///< face, from 0; or number of the zone
    std::size_t samples = 0, missed = 0, defective = 0;
    double area = 0, missed_area = 0, above_area = 0, below_area = 0;
    double untouched_area = 0;  ///< the wheel was never there; only with a removal trace
    double stock_volume = 0;    ///< above the design before grinding
    double removed_volume = 0;
    double excess_volume = 0;  ///< above the design now
    double gouge_volume = 0;   ///< missing below the design now
    double min = 0, max = 0, mean = 0, rms = 0;
    std::optional<WorstPoint> worst;  ///< none: no sample has a deviation

    bool passed() const { return worst && above_area == 0.0 && below_area == 0.0; }
};

/// A motion's part in a cluster.
struct MotionShare {
    std::uint32_t motion = 0;
    double share = 0;  ///< of the cluster's area
    double depth = 0;  ///< mm, most that it removed from a sample as the dominant motion
};

/// Connected area out of tolerance, all above or all below.
struct Cluster {
    bool above = false;
    std::size_t samples = 0;
    double area = 0, volume = 0;  ///< volume: beyond the limits, along the normals
    WorstPoint worst;
    Vec3 centroid = Vec3::Zero();      ///< by area, mm
    Box box;                           ///< mm, work frame
    double extent = 0, width = 0;      ///< mm along its two longest principal axes
    std::vector<std::uint32_t> faces;  ///< from 0, ascending
    std::vector<std::uint32_t> zones;  ///< ascending
    double untouched_area = 0;         ///< mm2
    /// Largest share first. Below: by the dominant motion of each sample, which made the gouge.
    /// Above: every motion that removed there first, last or most; the shares may add up to more
    /// than 1.
    std::vector<MotionShare> motions;
};

struct Verdict {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    RegionVerdict whole;
    std::vector<RegionVerdict> faces;    ///< ascending by face
    std::vector<RegionVerdict> zones;    ///< as given, and the rest at the end
    std::vector<Cluster> clusters;       ///< largest area first
    std::vector<std::uint32_t> zone;     ///< of every sample
    std::vector<std::uint32_t> cluster;  ///< of every sample, or kNone
};

/// Judges the deviations of all samples by the zones' bands, and by `rest` where no zone is; finds
/// the clusters: samples on the same side that the triangles join, over borders of faces by
/// nearness. Linear in the samples but for the clusters' order. Throws InputError for a bad zone.
Verdict judge(const HeightField& field, const std::vector<ToleranceZone>& zones,
              const Tolerance& rest);

}  // namespace beltgrinding
