#include "inspection/waviness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/large_memory.h"
#include "base/parallel.h"
#include "beltgrinding/error.h"
#include "inspection/section.h"
#include "point_grid.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kProfiles = 16;   // in each direction, at most, of a face
constexpr double kShortCutoff = 0.2;    // of the pass distance: 97 % of such a wave come through
constexpr double kLongCutoff = 2.5;     // of the pass distance: 99 %
constexpr double kLeastSpacings = 3.0;  // the short cutoff is not shorter
constexpr double kLeastSamplesAPass = 6.0;       // or the marks cannot be seen
constexpr std::size_t kLeastPasses = 3;          // whose widths are known
constexpr double kLeastWidth = 2.0;              // spacings; narrower is the raggedness of a border
constexpr double kSameDirection = 0.8660254038;  // cosine of 30 degrees
constexpr double kAcrossDirection = 0.5;         // and its sine
constexpr double kStraight = 1.2;                // way of the path by distance, within one pass
constexpr double kNearest = 1.5;    // spacings within which a profile's point has a sample
constexpr double kOffPlane = 1.01;  // of that distance, for what rounding puts off the plane
constexpr double kNoLength = 1e-9;  // mm

/// What the path says of each motion.
class Feed {
  public:
    explicit Feed(const std::vector<MotionEnd>& ends) : ends_(ends), way_(ends.size(), 0.0) {
        direction_.assign(ends.size(), Vec3::Zero());
        for (std::size_t m = 1; m < ends.size(); ++m) {
            way_[m] = way_[m - 1];
            if (ends[m].begins) {
                way_[m] = std::numeric_limits<double>::infinity();
                continue;
            }
            const Vec3 travel = ends[m].point - ends[m - 1].point;
            if (std::isinf(way_[m])) way_[m] = 0.0;
            way_[m] += travel.norm();
            if (travel.norm() > kNoLength) direction_[m] = travel.normalized();
        }
    }
    std::size_t size() const { return ends_.size(); }
    /// Unit, tangential to the surface; none: not known, or along the normal.
    std::optional<Vec3> direction(std::uint32_t motion, const Vec3& normal) const {
        if (motion >= size()) return {};
        const Vec3 tangential = direction_[motion] - direction_[motion].dot(normal) * normal;
        if (tangential.norm() < kAcrossDirection) return {};
        return tangential.normalized();
    }
    /// Whether one pass leads on from the one motion to the other.
    bool same_pass(std::uint32_t a, std::uint32_t b) const {
        if (a == b) return true;
        if (a > b) std::swap(a, b);
        if (b >= size()) return false;
        for (std::uint32_t m = a + 1; m <= b; ++m) {
            if (ends_[m].begins) return false;
            if (direction_[m].dot(direction_[a]) < kAcrossDirection) return false;
        }
        return way_[b] - way_[a] <= kStraight * (ends_[b].point - ends_[a].point).norm();
    }

  private:
    const std::vector<MotionEnd>& ends_;
    std::vector<double> way_;  // mm along the path, since the last program's begin
    std::vector<Vec3> direction_;
};

/// The faces of a field, each of which is made a field of its own when it is asked for.
class Faces {
  public:
    explicit Faces(const HeightField& field) : field_(field) {
        const std::uint32_t last = *std::max_element(field.face.begin(), field.face.end());
        std::vector<std::size_t> samples(std::size_t{last} + 1, 0), triangles(samples.size(), 0);
        for (const std::uint32_t face : field.face) ++samples[face];
        for (const Triangle& t : field.triangles) ++triangles[field.face[t[0]]];
        std::vector<std::size_t> next(samples.size()), next_triangle(samples.size());
        Part at{};
        for (std::size_t face = 0; face < samples.size(); ++face) {
            if (samples[face] == 0) continue;
            next[face] = at.sample;
            next_triangle[face] = at.triangle;
            at.samples = samples[face];
            at.triangles = triangles[face];
            parts_.push_back(at);
            at.sample += at.samples;
            at.triangle += at.triangles;
        }
        if (size() == 1) return;
        resize_large(sample_, field.size());
        resize_large(place_, field.size());
        resize_large(triangle_, field.triangles.size());
        std::vector<std::size_t> first(next);
        for (std::uint32_t i = 0; i < field.size(); ++i) {
            const std::uint32_t face = field.face[i];
            place_[i] = static_cast<std::uint32_t>(next[face] - first[face]);
            sample_[next[face]++] = i;
        }
        for (std::uint32_t t = 0; t < field.triangles.size(); ++t)
            triangle_[next_triangle[field.face[field.triangles[t][0]]]++] = t;
    }
    std::size_t size() const { return parts_.size(); }

    /// What `work(field)` returns of the `number`th face, by ascending numbers of faces: a field of
    /// nothing else, with what profiles ask for.
    template <class Work>
    auto with(std::size_t number, Work&& work) const {
        return size() == 1 ? work(field_) : work(only(parts_[number]));
    }

  private:
    struct Part {
        std::size_t sample, samples, triangle, triangles;  // in the lists below
    };

    HeightField only(const Part& part) const {
        HeightField one;
        one.spacing = field_.spacing;
        const auto samples = std::span(sample_).subspan(part.sample, part.samples);
        const auto take = [&samples](const auto& from, auto& to) {
            reserve_large(to, samples.size());
            for (const std::uint32_t i : samples) to.push_back(from[i]);
        };
        take(field_.point, one.point);
        take(field_.normal, one.normal);
        take(field_.area, one.area);
        take(field_.stock_height, one.stock_height);
        take(field_.height, one.height);
        take(field_.face, one.face);
        take(field_.flags, one.flags);
        take(field_.trace.last, one.trace.last);
        take(field_.trace.dominant, one.trace.dominant);
        for (const std::uint32_t t : std::span(triangle_).subspan(part.triangle, part.triangles)) {
            const Triangle& corners = field_.triangles[t];
            one.triangles.push_back({place_[corners[0]], place_[corners[1]], place_[corners[2]]});
        }
        return one;
    }

    const HeightField& field_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> sample_, triangle_;  // face by face, each ascending
    std::vector<std::uint32_t> place_;              // of each sample in its face
};

/// A profile of one face, in one direction.
struct Profile {
    std::vector<double> s, height;      // mm
    std::vector<std::uint32_t> motion;  // the last one on each point
};

class FaceProfiles {
  public:
    FaceProfiles(const HeightField& face, const Feed& feed)
        : face_(face), feed_(feed), index_(face) {
        for (std::uint32_t i = 0; i < face.size(); ++i) {
            if (feed_at(i)) ground_.push_back(i);
        }
    }

    /// Profiles through samples spread over the face.
    std::vector<Profile> profiles(bool along, const RunContext& context) const {
        const std::size_t count = std::min(kProfiles, ground_.size());
        std::vector<Profile> found(count);
        parallel_blocks(count, 1, context, [&](std::size_t k, std::size_t) {
            found[k] = through(ground_[(2 * k + 1) * ground_.size() / (2 * count)], along);
        });
        std::erase_if(found, [](const Profile& profile) { return profile.s.size() < 2; });
        return found;
    }

  private:
    double reach() const { return kNearest * face_.spacing; }
    std::optional<Vec3> feed_at(std::uint32_t i) const {
        if ((face_.flags[i] & kMissed) != 0) return {};
        return feed_.direction(face_.trace.dominant[i], face_.normal[i].cast<double>());
    }
    std::optional<std::uint32_t> nearest(const PointGrid& grid, const Vec3& p) const {
        std::optional<std::uint32_t> best;
        grid.near(p, [&](std::uint32_t i) {
            const auto distance = [&](std::uint32_t j) {
                return (face_.point[j] - p).squaredNorm();
            };
            if (!best || distance(i) < distance(*best)) best = i;
        });
        return best;
    }
    Profile through(std::uint32_t seed, bool along) const;

    const HeightField& face_;
    const Feed& feed_;
    SectionIndex index_;
    std::vector<std::uint32_t> ground_;  // samples whose feed is known
};

Profile FaceProfiles::through(std::uint32_t seed, bool along) const {
    const Vec3 p = face_.point[seed], n = face_.normal[seed].cast<double>();
    const Vec3 feed = *feed_at(seed);
    Section section;
    try {
        section = index_.section_by_plane(p, along ? n.cross(feed) : feed);
    } catch (const InputError&) {
        return {};  // a sliver without a triangle
    }
    const std::vector<SectionPiece>& pieces = section.pieces;
    std::size_t best = 0, at = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        for (std::size_t i = 0; i < pieces[k].point.size(); ++i) {
            const double distance = (pieces[k].point[i] - p).squaredNorm();
            if (distance < least) least = distance, best = k, at = i;
        }
    }
    if (pieces.empty()) return {};
    const SectionPiece& piece = pieces[best];
    const std::size_t count = piece.point.size();
    // The profile lies in the plane: only samples near that can be near the profile.
    const PointGrid grid(face_.point,
                         index_.near_plane(section.origin, section.normal, kOffPlane * reach()),
                         reach());
    // The motion that was last on point i, if the profile may go there.
    const auto motion = [&](std::size_t i) -> std::optional<std::uint32_t> {
        if (std::isnan(piece.height[i])) return {};
        const auto sample = nearest(grid, piece.point[i]);
        const auto direction = sample ? feed_at(*sample) : std::nullopt;
        if (!direction) return {};
        const Vec3 tangent =
            (piece.point[std::min(i + 1, count - 1)] - piece.point[i > 0 ? i - 1 : 0]);
        const double cosine = std::abs(direction->dot(tangent.normalized()));
        if (along ? cosine < kSameDirection : cosine > kAcrossDirection) return {};
        return face_.trace.last[*sample];
    };
    std::vector<std::uint32_t> before, after;
    std::size_t first = at, last = at;
    for (std::size_t i = at; i < count; ++i) {
        const auto m = motion(i);
        if (!m) break;
        after.push_back(*m);
        last = i;
    }
    if (after.empty()) return {};
    for (std::size_t i = at; i-- > 0;) {
        const auto m = motion(i);
        if (!m) break;
        before.push_back(*m);
        first = i;
    }
    Profile profile;
    profile.motion.assign(before.rbegin(), before.rend());
    profile.motion.insert(profile.motion.end(), after.begin(), after.end());
    const auto from = static_cast<std::ptrdiff_t>(first),
               to = static_cast<std::ptrdiff_t>(last) + 1;
    profile.s.assign(piece.arc_length.begin() + from, piece.arc_length.begin() + to);
    profile.height.assign(piece.height.begin() + from, piece.height.begin() + to);
    return profile;
}

/// Widths of the passes that lie side by side on the profile, but for the outermost two.
void append_widths(const Profile& profile, const Feed& feed, double spacing,
                   std::vector<double>& widths) {
    struct Arc {
        std::uint32_t motion;
        double from, to;
    };
    std::vector<Arc> arcs;
    const auto extend = [&](std::vector<Arc>& to, const Arc& arc) {
        if (!to.empty() && feed.same_pass(to.back().motion, arc.motion)) {
            to.back().to = arc.to;
            to.back().motion = arc.motion;
        } else {
            to.push_back(arc);
        }
    };
    for (std::size_t i = 0; i < profile.s.size(); ++i) {
        // A point stands for the half ways to its neighbours.
        const double from = i > 0 ? 0.5 * (profile.s[i - 1] + profile.s[i]) : profile.s[i];
        const double to =
            i + 1 < profile.s.size() ? 0.5 * (profile.s[i] + profile.s[i + 1]) : profile.s[i];
        extend(arcs, {profile.motion[i], from, to});
    }
    std::vector<Arc> wide;
    for (const Arc& arc : arcs) {
        if (arc.to - arc.from >= kLeastWidth * spacing) extend(wide, arc);
    }
    for (std::size_t k = 1; k + 1 < wide.size(); ++k) widths.push_back(wide[k].to - wide[k].from);
}

/// The profile's heights at equal steps of about `step` mm, which is changed to fit.
std::vector<double> resample(const Profile& profile, double& step) {
    const double length = profile.s.back() - profile.s.front();
    const auto count = static_cast<std::size_t>(std::ceil(length / step)) + 1;
    if (count < 2) return {};
    step = length / static_cast<double>(count - 1);
    std::vector<double> values(count);
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double s = profile.s.front() + static_cast<double>(i) * step;
        while (k + 2 < profile.s.size() && profile.s[k + 1] < s) ++k;
        const double part = profile.s[k + 1] - profile.s[k];
        const double share = part > 0.0 ? std::clamp((s - profile.s[k]) / part, 0.0, 1.0) : 0.0;
        values[i] = (1.0 - share) * profile.height[k] + share * profile.height[k + 1];
    }
    return values;
}

std::optional<WavinessFigures> figures(const std::vector<Profile>& profiles,
                                       const FaceWaviness& face, double spacing) {
    WavinessFigures result;
    double sum = 0.0;
    std::size_t points = 0;
    for (const Profile& profile : profiles) {
        const double length = profile.s.back() - profile.s.front();
        if (length < face.long_cutoff + face.pass_distance) continue;
        double step = spacing;
        const std::vector<double> values = resample(profile, step);
        const std::vector<double> fine = gaussian_filter(values, step, face.short_cutoff);
        const std::vector<double> form = gaussian_filter(values, step, face.long_cutoff);
        const auto margin = static_cast<std::size_t>(std::ceil(0.5 * face.long_cutoff / step));
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = margin; i + margin < values.size(); ++i) {
            const double w = fine[i] - form[i];
            sum += std::abs(w);
            ++points;
            low = std::min(low, w);
            high = std::max(high, w);
        }
        if (high < low) continue;
        ++result.profiles;
        result.total = std::max(result.total, high - low);
    }
    if (result.profiles == 0) return {};
    result.mean = sum / static_cast<double>(points);
    return result;
}

FaceWaviness of_face(const HeightField& face, const Feed& feed, const RunContext& context) {
    FaceWaviness result;
    result.face = face.face.front();
    const double spacing = face.spacing;
    const FaceProfiles all(face, feed);
    const std::vector<Profile> across = all.profiles(false, context);
    std::vector<double> widths;
    for (const Profile& profile : across) append_widths(profile, feed, spacing, widths);
    if (widths.size() < kLeastPasses) {
        result.reason = "no_passes";
        return result;
    }
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    result.pass_distance = *middle;
    if (result.pass_distance < kLeastSamplesAPass * spacing) {
        result.reason = "too_coarse";
        return result;
    }
    result.short_cutoff = std::max(kShortCutoff * result.pass_distance, kLeastSpacings * spacing);
    result.long_cutoff = kLongCutoff * result.pass_distance;
    result.across = figures(across, result, spacing);
    result.along = figures(all.profiles(true, context), result, spacing);
    if (!result.across || !result.along) result.reason = "too_short";
    return result;
}

}  // namespace

std::vector<double> gaussian_filter(std::span<const double> values, double step, double cutoff) {
    if (!(step > 0.0) || !(cutoff > 0.0) || !std::isfinite(step) || !std::isfinite(cutoff)) {
        throw InputError("inspection.filter", "a Gaussian filter needs a positive step and cutoff");
    }
    const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
    const auto count = static_cast<std::ptrdiff_t>(values.size());
    const auto reach = static_cast<std::ptrdiff_t>(
        std::min(std::floor(cutoff / step), static_cast<double>(values.size())));
    std::vector<double> weight(static_cast<std::size_t>(reach) + 1);
    for (std::ptrdiff_t k = 0; k <= reach; ++k) {
        const double x = static_cast<double>(k) * step / (alpha * cutoff);
        weight[static_cast<std::size_t>(k)] = std::exp(-std::numbers::pi * x * x);
    }
    std::vector<double> result(values.size());
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        double sum = 0.0, weights = 0.0;
        for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(-reach, -i);
             k <= std::min(reach, count - 1 - i); ++k) {
            const double w = weight[static_cast<std::size_t>(std::abs(k))];
            sum += w * values[static_cast<std::size_t>(i + k)];
            weights += w;
        }
        result[static_cast<std::size_t>(i)] = sum / weights;
    }
    return result;
}

std::vector<FaceWaviness> waviness(const HeightField& field, const std::vector<MotionEnd>& ends,
                                   const RunContext& context) {
    field.validate();
    std::vector<FaceWaviness> result;
    if (field.size() == 0) return result;
    if (field.trace.empty()) {
        std::vector<std::uint32_t> faces(field.face);
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        for (const std::uint32_t face : faces) {
            result.emplace_back();
            result.back().face = face;
            result.back().reason = "no_trace";
        }
        return result;
    }
    const Feed feed(ends);
    const Faces faces(field);
    result.resize(faces.size());
    parallel_blocks(faces.size(), 1, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            result[k] = faces.with(
                k, [&](const HeightField& face) { return of_face(face, feed, context); });
    });
    return result;
}

}  // namespace beltgrinding
