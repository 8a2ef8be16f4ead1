#include "heightfield/sound_field.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

constexpr std::size_t kBlock = 1 << 16;        // values a task
constexpr float kHottest = 6000.0F;            // K of rise: no metal is left above it
constexpr float kOffUnit = 1e-3F;              // of a normal's squared length
constexpr std::uint32_t kMostFaces = 1 << 22;  // of a shape; what names more is no face

/// Collects the first fault of a field.
class Look {
  public:
    explicit Look(const HeightField& field) : field_(field), count_(field.size()) {}

    std::optional<Fact> fault() && { return std::move(fault_); }

    template <class T>
    void length(const char* array, const std::vector<T>& values) {
        if (fault_ || values.size() == count_) return;
        fault_ = Fact{"heightfield.lengths",
                      "its array '{array}' has {given} values for {count} samples",
                      {{"array", array}, {"given", values.size()}, {"count", count_}}};
    }
    /// Of an array that may be missing.
    template <class T>
    void length_if_any(const char* array, const std::vector<T>& values) {
        if (!values.empty()) length(array, values);
    }
    void require(bool sound, const char* code, const char* form) {
        if (!fault_ && !sound) fault_ = Fact{code, form, {}};
    }
    /// `bad(i)` tells whether sample i is unsound; of several the first is named.
    template <class Bad>
    void samples(const char* code, const char* form, Bad&& bad, const char* array = nullptr) {
        if (fault_) return;
        const std::size_t i = first_where(count_, bad);
        if (i == count_) return;
        Arguments arguments = {{"sample", i}};
        if (array != nullptr) arguments.emplace_back("array", array);
        fault_ = Fact{code, form, std::move(arguments)};
    }
    template <class Bad>
    void values(const char* array, Bad&& bad) {
        samples("heightfield.sample",
                "its array '{array}' has a value that is not possible, at sample {sample}", bad,
                array);
    }
    template <class T>
    void finite(const char* array, const std::vector<T>& given) {
        values(array, [&](std::size_t i) { return !is_finite(given[i]); });
    }

    void sizes();
    void numbers();
    void triangles();
    void trace();
    void heat();
    void finish();

  private:
    static bool is_finite(double value) { return std::isfinite(value); }
    static bool is_finite(const Vec3& value) { return value.allFinite(); }
    static bool is_finite(const Vec3f& value) { return value.allFinite(); }

    /// `count`: none.
    template <class Bad>
    static std::size_t first_where(std::size_t count, Bad&& bad) {
        std::atomic<std::size_t> first = count;
        parallel_blocks(count, kBlock, {}, [&](std::size_t begin, std::size_t end) {
            bool any = false;  // without a way out of it, the loop is of vector instructions
            for (std::size_t i = begin; i < end; ++i) any |= static_cast<bool>(bad(i));
            if (!any) return;
            std::size_t i = begin, found = first;
            while (!bad(i)) ++i;
            while (i < found && !first.compare_exchange_weak(found, i)) {
            }
        });
        return first;
    }

    const HeightField& field_;
    std::size_t count_;
    std::optional<Fact> fault_;
};

/// All lengths come first: what follows reads the arrays together.
void Look::sizes() {
    length("normal", field_.normal);
    length("area", field_.area);
    length("stock_height", field_.stock_height);
    length("height", field_.height);
    length("face", field_.face);
    length("flags", field_.flags);
    length_if_any("rays", field_.rays);
    length_if_any("height_sd", field_.height_sd);
    length_if_any("height_error", field_.height_error);
    length_if_any("measured", field_.measured);
    if (const RemovalTrace& t = field_.trace; !t.empty()) {
        length("trace.first", t.first);
        length("trace.last", t.last);
        length("trace.dominant", t.dominant);
        length("trace.dominant_depth", t.dominant_depth);
        length("trace.peak_pressure", t.peak_pressure);
    }
    if (const HeatTrace& t = field_.heat; !t.empty() || !t.motion.empty()) {
        length("heat.rise", t.rise);
        length("heat.motion", t.motion);
    }
    if (const FinishTrace& f = field_.finish; !f.empty()) {
        length("finish.settled", f.settled);
        length("finish.unknown", f.unknown);
        length("finish.lay", f.lay);
        length("finish.crossing", f.crossing);
        length("finish.passes", f.passes);
        length("finish.motion", f.motion);
        length("finish.outside", f.outside);
    }
}

void Look::numbers() {
    const HeightField& f = field_;
    // A field without samples has no spacing yet.
    require((count_ == 0 || f.spacing > 0.0) && std::isfinite(f.spacing) &&
                std::isfinite(f.depth) && f.depth >= 0.0,
            "heightfield.spacing", "its spacing or depth is no length");
    finite("point", f.point);
    values("normal", [&](std::size_t i) {
        return !(std::abs(f.normal[i].squaredNorm() - 1.0F) <= kOffUnit);
    });
    values("area", [&](std::size_t i) { return !std::isfinite(f.area[i]) || f.area[i] < 0.0F; });
    finite("stock_height", f.stock_height);
    finite("height", f.height);
    values("face", [&](std::size_t i) { return f.face[i] >= kMostFaces; });
    if (!f.rays.empty()) {
        values("rays", [&](std::size_t i) {
            return !f.rays[i].allFinite() || !(f.rays[i].dot(f.normal[i]) > 0.0F);
        });
    }
    require(std::all_of(f.height_sd.begin(), f.height_sd.end(),
                        [](float sd) { return std::isfinite(sd) && sd >= 0.0F; }),
            "heightfield.deviations", "its standard deviations are no lengths");
    require(std::all_of(f.height_error.begin(), f.height_error.end(),
                        [](float error) { return std::isfinite(error) && error >= 0.0F; }),
            "heightfield.errors", "the errors of its heights are no lengths");
    require(f.sd_freedom > 0.0, "heightfield.freedom",
            "the freedom of its standard deviations is not above 0");
    require(std::none_of(f.measured.begin(), f.measured.end(),
                         [](float height) { return std::isinf(height); }),
            "heightfield.measured", "its measured heights are no lengths");
}

void Look::triangles() {
    if (fault_) return;
    const std::size_t count = field_.triangles.size();
    const std::size_t first = first_where(count, [&](std::size_t k) {
        const Triangle t = field_.triangles[k];
        return std::max({t[0], t[1], t[2]}) >= count_;
    });
    require(first == count, "heightfield.triangle_without_sample",
            "a triangle names a sample that is not there");
}

void Look::trace() {
    const RemovalTrace& t = field_.trace;
    if (t.empty()) return;
    constexpr std::uint32_t kNever = RemovalTrace::kNever;
    samples("heightfield.trace", "the trace of sample {sample} makes no sense", [&](std::size_t i) {
        const bool never = t.first[i] == kNever;
        const float depth = t.dominant_depth[i], pressure = t.peak_pressure[i];
        return (t.last[i] == kNever) != never || (t.dominant[i] == kNever) != never ||
               !std::isfinite(depth) || depth < 0.0F || !std::isfinite(pressure) || pressure < 0.0F;
    });
}

void Look::heat() {
    const HeatTrace& t = field_.heat;
    if (t.empty()) return;
    samples("heightfield.heat", "the temperature of sample {sample} makes no sense",
            [&](std::size_t i) {
                const bool never = t.motion[i] == HeatTrace::kNever;
                return !(t.rise[i] >= 0.0F && t.rise[i] <= kHottest) || (never && t.rise[i] > 0.0F);
            });
}

void Look::finish() {
    const FinishTrace& f = field_.finish;
    if (f.empty()) return;
    samples("heightfield.finish", "the finish of sample {sample} makes no sense",
            [&](std::size_t i) {
                const bool never = f.passes[i] == 0;
                return !std::isfinite(f.settled[i]) || f.settled[i] < 0.0F ||
                       !(f.unknown[i] >= 0.0F && f.unknown[i] <= 1.0F) || !f.lay[i].allFinite() ||
                       f.crossing[i] < 0.0F || std::isinf(f.crossing[i]) ||
                       (never && f.motion[i] != FinishTrace::kNever) ||
                       f.outside[i] > FinishTrace::kBeltWear;
            });
}

}  // namespace

std::optional<Fact> fault_of(const HeightField& field) {
    Look look(field);
    look.sizes();
    look.numbers();
    look.triangles();
    look.trace();
    look.finish();
    look.heat();
    return std::move(look).fault();
}

void HeightField::validate() const {
    if (const auto found = fault_of(*this)) {
        const Fact& fault = *found;
        throw InputError(fault, {{"heightfield.itself", "the height field: ", {}}});
    }
}

void check_sound(const HeightField& field) {
    if (const auto fault = fault_of(field)) {
        throw std::logic_error("a height field that no file can hold: " +
                               std::string(InputError(*fault).what()));
    }
}

}  // namespace beltgrinding
