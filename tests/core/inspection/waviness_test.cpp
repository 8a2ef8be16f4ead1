#include "inspection/waviness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beltgrinding/error.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

TEST(GaussianFilter, AWaveAsLongAsTheCutoffComesThroughByHalf) {
    const double step = 0.05;
    for (const double ratio : {0.5, 1.0, 3.0}) {  // wavelength by cutoff
        std::vector<double> wave(4000);
        for (std::size_t i = 0; i < wave.size(); ++i) {
            wave[i] = std::sin(2.0 * M_PI * static_cast<double>(i) * step / (10.0 * ratio));
        }
        const std::vector<double> low = gaussian_filter(wave, step, 10.0);
        double peak = 0.0;
        for (std::size_t i = 1000; i < 3000; ++i) peak = std::max(peak, std::abs(low[i]));
        EXPECT_NEAR(peak, std::exp2(-1.0 / (ratio * ratio)), 2e-3) << ratio;
    }
    const std::vector<double> flat = gaussian_filter(std::vector<double>(50, 3.0), step, 10.0);
    for (const double v : flat) EXPECT_NEAR(v, 3.0, 1e-12);
    EXPECT_THROW(gaussian_filter(flat, 0.0, 1.0), InputError);
}

/// Passes along x, to and fro, `distance` apart in y; each the last one on its own strip of a plate
/// with waves across it of that length, and longer ones that are form.
struct Raster {
    Raster(double length_x, double length_y, double spacing, double distance, double amplitude) {
        field = testing::plate(length_x, length_y, spacing);
        const int passes = static_cast<int>(std::lround(length_y / distance));
        for (int k = 0; k < passes; ++k) {
            const double y = (k + 0.5) * distance;
            const bool fro = k % 2 == 1;
            ends.push_back({Vec3(fro ? length_x : 0.0, y, 0.0), k == 0});
            for (int part = 1; part <= 4; ++part) {
                const double x = length_x * 0.25 * part;
                ends.push_back({Vec3(fro ? length_x - x : x, y, 0.0), false});
            }
        }
        field.trace.reset(field.size());
        for (std::size_t i = 0; i < field.size(); ++i) {
            const Vec3& p = field.point[i];
            const int pass = std::min(passes - 1, static_cast<int>(p.y() / distance));
            const int quarter = std::min(3, static_cast<int>(4.0 * p.x() / length_x));
            const auto motion =
                static_cast<std::uint32_t>(5 * pass + 1 + (pass % 2 == 1 ? 3 - quarter : quarter));
            field.trace.first[i] = field.trace.dominant[i] = field.trace.last[i] = motion;
            field.trace.peak_pressure[i] = 0.1F;
            field.height[i] = amplitude * std::sin(2.0 * M_PI * p.y() / distance) +
                              0.05 * std::sin(2.0 * M_PI * p.y() / (40.0 * distance)) +
                              1e-4 * p.x();
        }
    }
    HeightField field;
    std::vector<MotionEnd> ends;
};

TEST(Waviness, AKnownWaveAcrossTheFeedComesBack) {
    const double amplitude = 0.012;
    for (const double distance : {6.0, 9.0}) {
        const Raster raster(80.0, 72.0, 0.4, distance, amplitude);
        const std::vector<FaceWaviness> found = waviness(raster.field, raster.ends);
        ASSERT_EQ(found.size(), 1u);
        const FaceWaviness& face = found[0];
        EXPECT_EQ(face.reason, "");
        EXPECT_NEAR(face.pass_distance, distance, 0.41);
        EXPECT_NEAR(face.long_cutoff, 2.5 * face.pass_distance, 1e-9);
        ASSERT_TRUE(face.across);
        ASSERT_TRUE(face.along);
        EXPECT_GT(face.across->profiles, 8u);
        // 95 % to 97 % of the wave come through both filters.
        EXPECT_NEAR(face.across->mean, 2.0 / M_PI * amplitude, 0.06 * amplitude);
        EXPECT_NEAR(face.across->total, 2.0 * amplitude, 0.12 * amplitude);
        EXPECT_LT(face.along->mean, 0.01 * amplitude);
        EXPECT_LT(face.along->total, 0.02 * amplitude);
    }
}

TEST(Waviness, OfEachFaceIsWhatItIsAlone) {
    const Raster fine(120.0, 60.0, 1.0, 6.0, 0.01), coarse(120.0, 60.0, 1.0, 10.0, 0.02);
    HeightField both;  // samples of the two faces in turns, the larger number first
    both.spacing = 1.0;
    const std::size_t n = fine.field.size();
    ASSERT_EQ(n, coarse.field.size());
    both.resize(2 * n);
    both.trace.reset(2 * n);
    const auto put = [&](const HeightField& from, std::size_t offset, std::uint32_t face,
                         std::uint32_t motions) {
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t to = 2 * i + offset;
            both.point[to] = from.point[i];
            both.normal[to] = from.normal[i];
            both.height[to] = from.height[i];
            both.face[to] = face;
            both.trace.first[to] = both.trace.last[to] = both.trace.dominant[to] =
                from.trace.last[i] + motions;
        }
    };
    put(coarse.field, 0, 9, 0);
    put(fine.field, 1, 4, static_cast<std::uint32_t>(coarse.ends.size()));
    for (std::size_t t = 0; t < fine.field.triangles.size(); ++t) {
        for (const std::uint32_t offset : {0U, 1U}) {
            const Triangle corners = (offset == 0 ? coarse : fine).field.triangles[t];
            both.triangles.push_back(
                {2 * corners[0] + offset, 2 * corners[1] + offset, 2 * corners[2] + offset});
        }
    }
    std::vector<MotionEnd> ends = coarse.ends;
    ends.insert(ends.end(), fine.ends.begin(), fine.ends.end());
    const auto found = waviness(both, ends);
    ASSERT_EQ(found.size(), 2U);
    const FaceWaviness of_fine = waviness(fine.field, fine.ends).front();
    const FaceWaviness of_coarse = waviness(coarse.field, coarse.ends).front();
    for (const auto& [one, alone] : {std::pair(found[0], of_fine), {found[1], of_coarse}}) {
        ASSERT_TRUE(one.across && alone.across);
        EXPECT_EQ(one.pass_distance, alone.pass_distance);
        EXPECT_EQ(one.across->mean, alone.across->mean);
        EXPECT_EQ(one.across->total, alone.across->total);
    }
    EXPECT_EQ(found[0].face, 4U);
    EXPECT_EQ(found[1].face, 9U);
    EXPECT_NE(of_fine.pass_distance, of_coarse.pass_distance);
}

TEST(Waviness, SaysWhyItCannotTell) {
    const auto reason = [](const Raster& raster) {
        const FaceWaviness face = waviness(raster.field, raster.ends).front();
        EXPECT_FALSE(face.across && face.along);
        return face.reason;
    };
    EXPECT_EQ(reason(Raster(40.0, 20.0, 0.5, 10.0, 0.01)), "no_passes");  // two passes only
    EXPECT_EQ(reason(Raster(40.0, 40.0, 0.5, 2.5, 0.01)), "too_coarse");  // five samples a pass
    EXPECT_EQ(reason(Raster(20.0, 72.0, 0.5, 8.0, 0.01)), "too_short");   // along the feed
    Raster raster(40.0, 40.0, 0.5, 5.0, 0.01);
    raster.field.trace.clear();
    EXPECT_EQ(reason(raster), "no_trace");
    // Passes whose motions nobody knows.
    Raster unknown(40.0, 40.0, 0.5, 5.0, 0.01);
    unknown.ends.clear();
    EXPECT_EQ(reason(unknown), "no_passes");
}

TEST(Waviness, OnlyWhereTheWheelWas) {
    Raster raster(80.0, 72.0, 0.4, 6.0, 0.012);
    HeightField& field = raster.field;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field.point[i].y() < 50.0) continue;
        field.height[i] = 3.0;  // stock that nothing touched
        field.trace.first[i] = field.trace.last[i] = field.trace.dominant[i] = RemovalTrace::kNever;
        field.trace.peak_pressure[i] = 0.0F;
    }
    const FaceWaviness face = waviness(field, raster.ends).front();
    ASSERT_TRUE(face.across);
    EXPECT_NEAR(face.across->total, 0.024, 0.002);
}

}  // namespace
}  // namespace beltgrinding
