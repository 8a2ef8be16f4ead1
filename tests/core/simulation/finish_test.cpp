#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "beltgrinding/error.h"
#include "beltgrinding/simulation.h"
#include "elastic/wheel_rim.h"
#include "support/poses.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFeed = 40.0;  // mm/s

HeightField plate() {
    return testing::plate(60.0, 40.0, 0.5, 0.2);
}

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    o.finish.wanted = true;
    return o;
}

/// One pass along x over the plate's middle, beyond both of its ends.
ToolPath pass(double y = 20.0, double feed = kFeed) {
    return ToolPath({pressing_down(-20, y, 0.2, feed), pressing_down(80, y, 0.2, feed)}, {});
}

SimulationResult grind(HeightField& field, const ToolPath& path, const SimulationOptions& o) {
    ElasticFoundation foundation(0.5);
    return simulate(field, path, foundation, LocalLaw({1e-6}), o);
}

bool under(const Vec3& p) {
    return std::abs(p.y() - 20.0) < 8.0 && std::abs(p.x() - 30.0) < 20.0;
}

TEST(Finish, WithoutTheWishNothingIsKeptAndHeightsAreTheSame) {
    HeightField with = plate(), without = plate();
    SimulationOptions o = options();
    grind(with, pass(), o);
    o.finish.wanted = false;
    grind(without, pass(), o);
    EXPECT_TRUE(without.finish.empty());
    ASSERT_EQ(with.finish.settled.size(), with.size());
    EXPECT_EQ(with.height, without.height);
    EXPECT_EQ(with.trace.last, without.trace.last);
}

TEST(Finish, OnePassScratchesAlongTheBeltAndLeavesTheRestAsItWas) {
    HeightField field = plate();
    SimulationOptions o = options();
    o.finish.before = 3.2;
    o.outputs.first_motion = 5;
    grind(field, pass(), o);
    int ground = 0, beside = 0;
    for (std::size_t s = 0; s < field.size(); ++s) {
        const Vec3& p = field.point[s];
        if (under(p)) {
            ++ground;
            EXPECT_EQ(field.finish.passes[s], 1u);
            EXPECT_EQ(field.finish.motion[s], 6u);
            EXPECT_NEAR(std::abs(field.finish.lay[s].x()), 1.0, 1e-5);
            EXPECT_TRUE(std::isnan(field.finish.crossing[s]));
            // There is no model: what was there is gone, and what came is not known.
            EXPECT_TRUE(std::isnan(field.finish.roughness(s)));
        } else if (std::abs(p.y() - 20.0) > 11.0) {
            ++beside;
            EXPECT_EQ(field.finish.passes[s], 0u);
            EXPECT_EQ(field.finish.motion[s], FinishTrace::kNever);
            EXPECT_FLOAT_EQ(field.finish.roughness(s), 3.2f);
            EXPECT_TRUE(field.finish.lay[s].isZero());
        }
    }
    EXPECT_GT(ground, 2000);
    EXPECT_GT(beside, 1000);
}

TEST(Finish, RoughnessIsThePowerOfThePassesState) {
    HeightField field = plate();
    SimulationOptions o = options();
    o.process.belt_speed = 30e3;
    o.process.belt_wear = 0.5;
    o.finish.roughness = 0.8;
    o.finish.speed_exponent = -0.4;
    o.finish.feed_exponent = 0.3;
    o.finish.cut_exponent = 0.6;
    grind(field, pass(), o);
    const double expected =
        0.8 * std::pow(1.5, -0.4) * std::pow(kFeed / 50.0, 0.3) * std::pow(0.5, 0.6);
    for (std::size_t s = 0; s < field.size(); ++s) {
        if (under(field.point[s])) {
            EXPECT_NEAR(field.finish.roughness(s), expected, 1e-5);
        }
        if (field.finish.passes[s] == 0) {
            EXPECT_TRUE(std::isnan(field.finish.roughness(s)));
        }
    }
}

TEST(Finish, ThePressureIsTheMeanOfThePass) {
    HeightField field = plate();
    SimulationOptions o = options();
    o.finish.roughness = 1.0;
    o.finish.pressure_exponent = 1.0;
    o.finish.reference_pressure = 1.0;
    const SimulationResult result = grind(field, pass(), o);
    // Across the foundation the pressure is even, along it a pass sees all of it: F / A.
    double area = 0.0;
    for (const StepRecord& step : result.steps)
        area = std::max(area, static_cast<double>(step.contact_area));
    double sum = 0.0;
    int count = 0;
    for (std::size_t s = 0; s < field.size(); ++s) {
        if (!under(field.point[s])) continue;
        sum += field.finish.roughness(s);
        ++count;
    }
    EXPECT_NEAR(sum / count, 40.0 / area, 0.06 * 40.0 / area);
}

TEST(Finish, PassesBringItGeometricallyFromWhatWasToTheirOwn) {
    for (const double before : {3.2, kNan}) {
        HeightField field = plate();
        SimulationOptions o = options();
        o.finish.roughness = 0.5;
        o.finish.before = before;
        o.finish.rest = 0.4;
        double expected = before;
        for (int n = 1; n <= 5; ++n) {
            grind(field, pass(), o);
            expected = 0.5 + 0.4 * (expected - 0.5);
            std::size_t seen = 0;
            for (std::size_t s = 0; s < field.size(); ++s) {
                if (!under(field.point[s])) continue;
                ++seen;
                EXPECT_EQ(field.finish.passes[s], static_cast<std::uint32_t>(n));
                const float is = field.finish.roughness(s);
                if (!std::isnan(before)) {
                    EXPECT_NEAR(is, expected, 1e-5) << n;
                } else if (std::pow(0.4, n) > FinishTrace::kMostUnknown) {
                    EXPECT_TRUE(std::isnan(is)) << n;
                } else {  // what was there hardly matters any more
                    EXPECT_NEAR(is, 0.5, 1e-5) << n;
                }
            }
            EXPECT_GT(seen, 2000u);
        }
    }
}

TEST(Finish, ScratchesOfAnotherDirectionCross) {
    HeightField field = plate();
    const SimulationOptions o = options();
    grind(field, pass(), o);
    const double turn = M_PI / 3.0;
    const Vec3 along(std::cos(turn), std::sin(turn), 0.0);
    const auto pose = [&](double way) {
        return pressing_down(30 + way * along.x(), 20 + way * along.y(), 0.2, kFeed, turn);
    };
    grind(field, ToolPath({pose(-60.0), pose(60.0)}, {}), o);
    int crossed = 0, once = 0;
    for (std::size_t s = 0; s < field.size(); ++s) {
        if (field.finish.passes[s] == 2) {
            ++crossed;
            EXPECT_NEAR(field.finish.crossing[s], turn, 1e-3);
            EXPECT_NEAR(std::abs(field.finish.lay[s].cast<double>().dot(along)), 1.0, 1e-5);
        } else {
            ++once;
            EXPECT_TRUE(std::isnan(field.finish.crossing[s]));
        }
    }
    EXPECT_GT(crossed, 1000);
    EXPECT_GT(once, 1000);
}

TEST(Finish, ComingBackOverAPlaceIsAnotherPassAndStayingIsNot) {
    HeightField field = plate();
    // There, back, and on over a place in the middle; poses within a pass end nothing.
    grind(field,
          ToolPath({pressing_down(-20, 20, 0.2, kFeed), pressing_down(25, 20, 0.2, kFeed),
                    pressing_down(35, 20, 0.2, 20), pressing_down(80, 20, 0.2, kFeed),
                    pressing_down(-20, 20, 0.2, kFeed), pressing_down(80, 20, 0.2, kFeed)},
                   {}),
          options());
    for (std::size_t s = 0; s < field.size(); ++s) {
        if (under(field.point[s])) {
            EXPECT_EQ(field.finish.passes[s], 3u) << field.point[s].transpose();
        }
    }
}

TEST(Finish, OutsideOfWhatWasMeasuredNothingIsToldButTheLay) {
    const auto outside_of = [](SimulationOptions o) {
        HeightField field = plate();
        o.finish.roughness = 0.5;
        o.finish.before = 3.2;
        grind(field, pass(), o);
        std::uint8_t told = FinishTrace::kInside;
        for (std::size_t s = 0; s < field.size(); ++s) {
            if (!under(field.point[s])) continue;
            told = field.finish.outside[s];
            EXPECT_EQ(std::isnan(field.finish.roughness(s)), told != FinishTrace::kInside);
            EXPECT_FALSE(field.finish.lay[s].isZero());
        }
        return told;
    };
    SimulationOptions o = options();
    EXPECT_EQ(outside_of(o), FinishTrace::kInside);
    o.finish.pressure = {1.0, 2.0};
    EXPECT_EQ(outside_of(o), FinishTrace::kPressure);
    o.finish.pressure = {0.0, 0.01};
    EXPECT_EQ(outside_of(o), FinishTrace::kPressure);
    o.finish.cut = {0.1, 0.9};
    EXPECT_EQ(outside_of(o), FinishTrace::kBeltWear);
    o.finish.feed = {60.0, 90.0};
    EXPECT_EQ(outside_of(o), FinishTrace::kFeed);
    o.finish.speed = {25e3, 30e3};
    EXPECT_EQ(outside_of(o), FinishTrace::kBeltSpeed);
}

TEST(Finish, TheLightBorderOfAPassLeavesWhatOneBeforeHasFinished) {
    // A crowned wheel presses less towards its sides; the second pass has its border where the
    // first one's middle was.
    SimulationOptions o = options();
    o.process.wheel = {60.0, 20.0, 80.0};
    o.finish.roughness = 0.5;
    HeightField all = plate(), field = plate();
    o.finish.pressure_exponent = 1.0;
    o.finish.reference_pressure = 1.0;
    const auto at = [](const HeightField& f, double y) {
        for (std::size_t s = 0; s < f.size(); ++s)
            if (std::abs(f.point[s].x() - 30.0) < 0.3 && std::abs(f.point[s].y() - y) < 0.3)
                return s;
        return f.size();
    };
    grind(all, pass(14.0), o);
    const std::size_t middle = at(all, 14.0), border = at(all, 21.0);
    const double most = all.finish.roughness(middle) / 0.5;
    const double least = all.finish.roughness(border) / 0.5;
    ASSERT_LT(least, 0.7 * most);
    o.finish.pressure.low = 0.5 * (least + most);
    grind(field, pass(21.0), o);  // its middle lies where the next one has its border
    grind(field, pass(14.0), o);
    EXPECT_EQ(field.finish.passes[border], 1u);
    EXPECT_EQ(field.finish.outside[border], FinishTrace::kInside);
    EXPECT_NEAR(field.finish.roughness(border), 0.5 * most, 0.03);
    // Where only a border was, the light pass is what there is.
    const std::size_t alone = at(field, 7.0);
    EXPECT_EQ(field.finish.outside[alone], FinishTrace::kPressure);
    EXPECT_TRUE(std::isnan(field.finish.roughness(alone)));
}

TEST(Finish, ThatOfAnotherFieldAndWrongSettingsAreRefused) {
    HeightField field = plate();
    SimulationOptions o = options();
    field.finish.settled.assign(3, 0.0f);
    EXPECT_THROW(grind(field, pass(), o), InputError);
    field.finish.clear();
    o.finish.rest = 1.0;
    EXPECT_THROW(grind(field, pass(), o), InputError);
    o = options();
    o.finish.before = -1.0;
    EXPECT_THROW(grind(field, pass(), o), InputError);
    o = options();
    o.finish.feed = {5.0, 4.0};
    EXPECT_THROW(grind(field, pass(), o), InputError);
    o = options();
    o.finish.speed_exponent = kNan;
    EXPECT_THROW(grind(field, pass(), o), InputError);
    o = options();
    o.finish.reference_feed = 0.0;
    EXPECT_THROW(grind(field, pass(), o), InputError);
}

TEST(Finish, AFileKeepsItAndNonsenseInOneIsRefused) {
    HeightField field = plate();
    SimulationOptions o = options();
    o.finish.roughness = 0.5;
    grind(field, pass(), o);
    const HeightField back = read_hdf5_image(hdf5_image(field, ""), "test");
    EXPECT_EQ(back.finish.settled, field.finish.settled);
    EXPECT_EQ(back.finish.unknown, field.finish.unknown);
    EXPECT_EQ(back.finish.lay, field.finish.lay);
    EXPECT_EQ(back.finish.passes, field.finish.passes);
    EXPECT_EQ(back.finish.motion, field.finish.motion);
    EXPECT_EQ(back.finish.outside, field.finish.outside);
    field.finish.unknown[3] = 1.5f;
    EXPECT_THROW(hdf5_image(field, ""), std::logic_error);
}

}  // namespace
}  // namespace beltgrinding
