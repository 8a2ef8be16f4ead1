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

/// One face of a field on its own.
struct Face {
    HeightField field;
    RemovalTrace trace;
};

std::vector<Face> split(const HeightField& field) {
    const std::uint32_t last =
        field.face.empty() ? 0 : *std::max_element(field.face.begin(), field.face.end());
    std::vector<std::size_t> samples(std::size_t{last} + 1, 0), triangles(samples.size(), 0);
    for (const std::uint32_t face : field.face) ++samples[face];
    for (const Triangle& t : field.triangles) ++triangles[field.face[t[0]]];
    std::vector<std::uint32_t> slot(samples.size(), 0), index(field.size());
    std::vector<Face> faces;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const std::uint32_t number = field.face[i];
        std::uint32_t& at = slot[number];
        if (at == 0) {
            faces.emplace_back();
            HeightField& f = faces.back().field;
            f.spacing = field.spacing;
            reserve_large(f.point, samples[number]);
            reserve_large(f.normal, samples[number]);
            reserve_large(f.stock_height, samples[number]);
            reserve_large(f.height, samples[number]);
            reserve_large(f.face, samples[number]);
            f.flags.reserve(samples[number]);
            reserve_large(f.triangles, triangles[number]);
            reserve_large(faces.back().trace.last, samples[number]);
            reserve_large(faces.back().trace.dominant, samples[number]);
            at = static_cast<std::uint32_t>(faces.size());
        }
        Face& face = faces[at - 1];
        HeightField& f = face.field;
        index[i] = static_cast<std::uint32_t>(f.size());
        f.point.push_back(field.point[i]);
        f.normal.push_back(field.normal[i]);
        f.stock_height.push_back(field.stock_height[i]);
        f.height.push_back(field.height[i]);
        f.face.push_back(field.face[i]);
        f.flags.push_back(field.flags[i]);
        face.trace.last.push_back(field.trace.last[i]);
        face.trace.dominant.push_back(field.trace.dominant[i]);
    }
    for (const Triangle& t : field.triangles) {
        faces[slot[field.face[t[0]]] - 1].field.triangles.push_back(
            {index[t[0]], index[t[1]], index[t[2]]});
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.field.face.front() < b.field.face.front();
    });
    return faces;
}

/// A profile of one face, in one direction.
struct Profile {
    std::vector<double> s, height;      // mm
    std::vector<std::uint32_t> motion;  // the last one on each point
};

class FaceProfiles {
  public:
    FaceProfiles(const Face& face, const Feed& feed)
        : face_(face), feed_(feed), index_(face.field) {
        for (std::uint32_t i = 0; i < face.field.size(); ++i) {
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
    double reach() const { return kNearest * face_.field.spacing; }
    std::optional<Vec3> feed_at(std::uint32_t i) const {
        if ((face_.field.flags[i] & kMissed) != 0) return {};
        return feed_.direction(face_.trace.dominant[i], face_.field.normal[i].cast<double>());
    }
    std::optional<std::uint32_t> nearest(const PointGrid& grid, const Vec3& p) const {
        std::optional<std::uint32_t> best;
        grid.near(p, [&](std::uint32_t i) {
            const auto distance = [&](std::uint32_t j) {
                return (face_.field.point[j] - p).squaredNorm();
            };
            if (!best || distance(i) < distance(*best)) best = i;
        });
        return best;
    }
    Profile through(std::uint32_t seed, bool along) const;

    const Face& face_;
    const Feed& feed_;
    SectionIndex index_;
    std::vector<std::uint32_t> ground_;  // samples whose feed is known
};

Profile FaceProfiles::through(std::uint32_t seed, bool along) const {
    const Vec3 p = face_.field.point[seed], n = face_.field.normal[seed].cast<double>();
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
    const PointGrid grid(face_.field.point,
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

FaceWaviness of_face(const Face& face, const Feed& feed, const RunContext& context) {
    FaceWaviness result;
    result.face = face.field.face.front();
    const double spacing = face.field.spacing;
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
    const std::vector<Face> faces = split(field);
    result.resize(faces.size());
    parallel_blocks(faces.size(), 1, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) result[k] = of_face(faces[k], feed, context);
    });
    return result;
}

}  // namespace beltgrinding
