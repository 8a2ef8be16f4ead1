// Heat that has become smooth, on fewer nodes, against all of it on the part's own.

#include "heat/coarse_heat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "heat/thermal_levels.h"
#include "plate.h"

namespace beltgrinding {
namespace {

constexpr int kAll = 200;  // rings: nothing goes to fewer nodes

HeatMaterial aluminium() {
    return {190.0, 900.0, 2700.0};
}

/// A plate, and one below its end x = `along` - 1 that faces +x.
HeightField corner(int along, int across, int down) {
    HeightField field = plate(along, across, 1.0);
    for (int k = 1; k <= down; ++k) {
        for (int j = 0; j < across; ++j) {
            field.point.emplace_back(along - 1.0, j, -k);
            field.normal.emplace_back(Vec3f::UnitX());
            field.area.push_back(1.0f);
        }
    }
    field.resize(field.point.size());
    return field;
}

TEST(ThermalLevels, LinearFieldsAreInterpolatedAndConductedAsTheyAre) {
    const HeightField field = plate(61, 47, 1.0);
    const PartHeat part(field, 1.0, steel());
    ASSERT_EQ(part.levels().size(), 3u);
    std::vector<Vec3> point = part.nodes().point;
    for (const ThermalLevel& level : part.levels()) {
        EXPECT_LT(level.size(), 0.4 * static_cast<double>(point.size()));
        EXPECT_GT(level.size(), 0.1 * static_cast<double>(point.size()));
        double area = 0.0;
        for (const float one : level.area) area += one;
        EXPECT_NEAR(area, 60.0 * 46.0, 0.03 * 60.0 * 46.0);
        const auto value = [](const Vec3& p) { return 3.0 + 2.0 * p.x() - p.y(); };
        const double edge = 2.0 * level.spacing;
        const auto inside = [edge](const Vec3& p) {
            return p.x() > edge && p.x() < 60.0 - edge && p.y() > edge && p.y() < 46.0 - edge;
        };
        for (std::size_t x = 0; x < point.size(); ++x) {
            const ThermalLevel::Shares& shares = level.shares[x];
            double sum = 0.0, found = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_GE(shares.share[i], -1e-6f);
                sum += shares.share[i];
                found += shares.share[i] * value(level.point[shares.node[i]]);
            }
            EXPECT_NEAR(sum, 1.0, 1e-6);
            if (!inside(point[x])) continue;
            EXPECT_NEAR(found, value(point[x]), 0.15 * level.spacing);
        }
        for (std::uint32_t k = 0; k < level.size(); ++k) {
            double flow = 0.0, most = 0.0;
            for (std::uint32_t e = level.first[k]; e < level.first[k + 1]; ++e) {
                const Vec3& other = level.point[level.neighbour[e]];
                flow += level.conductance[e] * (value(other) - value(level.point[k]));
                most = std::max(most, std::abs(level.conductance[e]) * 2.0 * level.spacing);
            }
            if (!inside(level.point[k])) continue;
            EXPECT_LT(std::abs(flow), 0.3 * most) << level.spacing;
        }
        point = level.point;
    }
}

TEST(ThermalLevels, NothingGetsOverASharpEdge) {
    const HeightField field = corner(31, 25, 20);
    const PartHeat part(field, 1.0, steel());
    ASSERT_FALSE(part.levels().empty());
    std::vector<Vec3f> normal = part.nodes().normal;
    for (const ThermalLevel& level : part.levels()) {
        for (std::size_t x = 0; x < normal.size(); ++x)
            for (std::size_t i = 0; i < 3; ++i)
                if (level.shares[x].share[i] > 0.0f) {
                    EXPECT_GT(normal[x].dot(level.normal[level.shares[x].node[i]]), 0.5f);
                }
        for (std::uint32_t k = 0; k < level.size(); ++k)
            for (std::uint32_t e = level.first[k]; e < level.first[k + 1]; ++e)
                EXPECT_GT(level.normal[k].dot(level.normal[level.neighbour[e]]), 0.5f);
        normal = level.normal;
    }
}

struct Difference {
    double greatest = 0.0;  // K, of all
    double peak = 0.0;      // greatest difference of peaks over the former
    double end = 0.0;       // the same of the rises in the end
    double left = 0.0;      // of these over the greatest of theirs
    double heat = 0.0;      // what is stored over what flowed in
};

/// A spot of 6 mm by 6 mm, which dwells, moves on and comes back, and then `rest` s, both ways.
/// `below`: what is heated is the lower side, in turns.
template <class Heats>
Difference run(const PartHeat& part, double rest, Heats heats) {
    Conduction few(part), all(part, kAll);
    double in = 0.0;
    for (int step = 0; step < 240; ++step) {
        const double x = step < 80 ? 16.0 : step < 160 ? 16.0 + 0.4 * (step - 80) : 40.0;
        for (std::uint32_t k = 0; k < part.size(); ++k) {
            if (!heats(step, x, k)) continue;
            few.add(k, 1500.0);
            all.add(k, 1500.0);
            in += 1500.0 * 0.02;
        }
        few.advance(0.02, 1);
        all.advance(0.02, 1);
    }
    few.idle(few.time() + rest);
    all.idle(all.time() + rest);
    const HeatState &found = few.settle(), &sought = all.settle();
    Difference result;
    double most = 0.0, stored = 0.0;
    for (std::size_t k = 0; k < part.size(); ++k) {
        result.greatest = std::max<double>(result.greatest, sought.peak[k]);
        most = std::max(most, rise(sought, k));
        stored += part.nodes().area[k] / part.nodes().own[k].modes[0] * found.modes[16 * k];
    }
    for (std::size_t k = 0; k < part.size(); ++k) {
        result.peak = std::max<double>(result.peak, std::abs(found.peak[k] - sought.peak[k]));
        result.end = std::max(result.end, std::abs(rise(found, k) - rise(sought, k)));
    }
    result.peak /= result.greatest;
    result.left = result.end / most;
    result.end /= result.greatest;
    result.heat = part.material().capacity() * stored / in;
    return result;
}

TEST(CoarseHeat, WhatSpreadsOverManyNodesIsThatOfAllOfThem) {
    const HeightField field = plate(91, 61, 1.0);
    PartHeat part(field, 1.0, aluminium());
    for (const float thickness : {4.0f, 25.0f, HUGE_VALF}) {
        part.set_thickness(std::vector<float>(part.size(), thickness));
        for (const double rest : {0.0, 3.0}) {
            const Difference found = run(part, rest, [&](int, double x, std::uint32_t k) {
                const Vec3& p = field.point[part.samples()[k]];
                return std::abs(p.x() - x) <= 3.0 && std::abs(p.y() - 30.0) <= 3.0;
            });
            EXPECT_LT(found.peak, 0.02) << thickness << ' ' << rest;
            EXPECT_LT(found.end, 0.02) << thickness << ' ' << rest;
            EXPECT_LT(found.left, 0.06) << thickness << ' ' << rest;
            // Of a half-space it goes into the depth.
            if (!std::isfinite(thickness)) continue;
            EXPECT_NEAR(found.heat, 1.0, 1e-4);
        }
    }
}

TEST(CoarseHeat, AThinPlateIsHeatedFromBothSides) {
    HeightField field = plate(71, 41, 1.0);
    const HeightField top = field;
    for (std::size_t s = 0; s < top.size(); ++s) {
        field.point.emplace_back(top.point[s] - Vec3(0.0, 0.0, 2.0));
        field.normal.emplace_back(-Vec3f::UnitZ());
        field.area.push_back(top.area[s]);
    }
    field.resize(2 * top.size());
    PartHeat part(field, 1.0, aluminium());
    part.set_thickness(std::vector<float>(part.size(), 2.0f));
    const Difference found = run(part, 0.5, [&](int step, double x, std::uint32_t k) {
        const Vec3& p = field.point[part.samples()[k]];
        const bool below = p.z() < -1.0;
        return below == (step % 80 >= 40) && std::abs(p.x() - x) <= 3.0 &&
               std::abs(p.y() - 20.0) <= 3.0;
    });
    EXPECT_LT(found.peak, 0.02);
    EXPECT_LT(found.end, 0.02);
    EXPECT_LT(found.left, 0.06);
}

TEST(CoarseHeat, FromAnEdgeAllGoesBack) {
    const HeightField field = corner(51, 41, 30);
    PartHeat part(field, 1.0, aluminium());
    part.set_thickness(std::vector<float>(part.size(), 10.0f));
    const Difference found = run(part, 1.0, [&](int, double x, std::uint32_t k) {
        const Vec3& p = field.point[part.samples()[k]];
        return std::abs(p.x() - x - 8.0) <= 3.0 && std::abs(p.y() - 20.0) <= 3.0 && p.z() == 0.0;
    });
    EXPECT_LT(found.peak, 0.02);
    EXPECT_LT(found.end, 0.02);
    EXPECT_LT(found.left, 0.06);
    EXPECT_NEAR(found.heat, 1.0, 1e-4);
}

}  // namespace
}  // namespace beltgrinding
