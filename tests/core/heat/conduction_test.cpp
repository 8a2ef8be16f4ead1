#include "heat/conduction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "beltgrinding/error.h"
#include "plate.h"

namespace beltgrinding {
namespace {

/// N mm: what is stored in plates of the nodes' thickness.
double stored(const PartHeat& part, const HeatState& state) {
    double sum = 0.0;
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const double depth = 1.0 / part.nodes().own[k].modes[0];
        sum += depth * part.nodes().area[k] * state.modes[16 * k];
    }
    return part.material().capacity() * sum;
}

TEST(Conduction, NoHeatIsLostOrMadeWhateverMovesAndWaits) {
    const HeightField field = plate(61, 41, 1.0);
    PartHeat part(field, 1.0, steel());
    std::vector<float> thickness(part.size());
    for (std::uint32_t k = 0; k < part.size(); ++k)
        thickness[k] = static_cast<float>(1.0 + 0.05 * field.point[part.samples()[k]].x());
    part.set_thickness(thickness);
    Conduction conduction(part);
    double in = 0.0;
    for (int step = 0; step < 400; ++step) {
        const double x = 30.0 + 25.0 * std::sin(0.05 * step),
                     y = 20.0 + 15.0 * std::cos(0.02 * step);
        for (std::uint32_t k = 0; k < part.size(); ++k) {
            const Vec3& p = field.point[part.samples()[k]];
            if (std::hypot(p.x() - x, p.y() - y) < 3.0) conduction.add(k, 50.0), in += 50.0 * 0.03;
        }
        conduction.advance(0.03, 1);
        if (step % 100 == 99) conduction.idle(conduction.time() + 7.0);
    }
    EXPECT_NEAR(stored(part, conduction.settle()), in, 1e-4 * in);
}

// Heat that dwells, comes back, and is slow to leave the zone.
TEST(Conduction, WhatIsConductedLaterChangesTheGreatestTemperatureByLittle) {
    for (const double conductivity : {16.0, 160.0}) {
        HeatMaterial m = steel();
        m.conductivity = conductivity;
        const HeightField field = plate(81, 61, 1.0);
        const PartHeat part(field, 1.0, m);
        Conduction zone(part), whole(part, 150);
        for (int step = 0; step < 200; ++step) {
            const double x = 15.0 + 0.6 * std::min(step, 60) - 0.3 * std::max(step - 100, 0);
            for (std::uint32_t k = 0; k < part.size(); ++k) {
                const Vec3& p = field.point[part.samples()[k]];
                if (std::abs(p.x() - x) > 4.0 || std::abs(p.y() - 30.0) > 10.0) continue;
                zone.add(k, 1500.0);
                whole.add(k, 1500.0);
            }
            zone.advance(0.03, 2);
            whole.advance(0.03, 2);
        }
        const HeatState &found = zone.settle(), &sought = whole.settle();
        double most = 0.0;
        for (const float peak : sought.peak) most = std::max<double>(most, peak);
        for (std::size_t k = 0; k < part.size(); ++k)
            EXPECT_NEAR(found.peak[k], sought.peak[k], 0.02 * most) << field.point[k].transpose();
        double greatest = 0.0;
        for (const float peak : found.peak) greatest = std::max<double>(greatest, peak);
        EXPECT_NEAR(greatest, most, 0.01 * most);
    }
}

// Both sides of a thin plate, of which one is heated.
TEST(Conduction, AThinSectionsOtherSideIsHeatedAsItsSeriesSays) {
    const double d = 2.0, flux = 10.0;
    const HeatMaterial m = steel();
    HeightField field = plate(21, 21, 1.0);
    const HeightField top = field;
    for (std::size_t s = 0; s < top.size(); ++s) {
        field.point.emplace_back(top.point[s] - Vec3(0.0, 0.0, d));
        field.normal.emplace_back(-Vec3f::UnitZ());
        field.area.push_back(top.area[s]);
    }
    const std::size_t half = top.size();
    field.resize(2 * half);
    PartHeat part(field, 1.0, m);
    part.set_thickness(std::vector<float>(part.size(), static_cast<float>(d)));
    Conduction conduction(part, 60);
    double time = 0.0;
    for (; time < 0.995; time += 0.01) {
        for (std::uint32_t k = 0; k < part.size(); ++k)
            if (part.samples()[k] < half) conduction.add(k, flux * part.nodes().area[k]);
        conduction.advance(0.01, 5);
    }
    const double tau = m.diffusivity() * time;
    double own = tau / d + d / 3.0, other = tau / d - d / 6.0;
    for (int n = 1; n < 30; ++n) {
        const double rate = std::pow(n * M_PI / d, 2);
        own -= 2.0 / d * std::exp(-rate * tau) / rate;
        other -= 2.0 / d * (n % 2 == 1 ? -1.0 : 1.0) * std::exp(-rate * tau) / rate;
    }
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const double exact = flux / m.conductivity * (part.samples()[k] < half ? own : other);
        EXPECT_NEAR(conduction.rise(k), exact, 0.005 * exact);
        EXPECT_EQ(conduction.settle().source[k], 5u);
    }
}

TEST(PartHeat, EverySampleHasWhatItsNodesHadAndNoMore) {
    const HeightField plain = plate(201, 201, 0.1);
    HeightField field = plain;
    PartHeat part(field, 1.0, steel());
    EXPECT_LT(part.size(), 600u);
    double area = 0.0;
    for (const float one : part.nodes().area) area += one;
    EXPECT_NEAR(area, 20.0 * 20.0, 0.02 * 400.0);
    HeatState state = part.state();
    for (std::uint32_t k = 0; k < part.size(); ++k) {
        const Vec3& p = field.point[part.samples()[k]];
        state.peak[k] = static_cast<float>(100.0 + 3.0 * p.x() - 2.0 * p.y());
        state.source[k] = k;
    }
    part.set_state(state);
    part.keep(field);
    for (std::size_t s = 0; s < field.size(); ++s) {
        const Vec3& p = field.point[s];
        const bool inside = p.x() > 2.0 && p.x() < 18.0 && p.y() > 2.0 && p.y() < 18.0;
        EXPECT_NEAR(field.heat.rise[s], 100.0 + 3.0 * p.x() - 2.0 * p.y(), inside ? 0.3 : 4.0);
        EXPECT_EQ(field.heat.motion[s], part.node_of()[s]);
    }
    state.peak.pop_back();
    EXPECT_THROW(part.set_state(state), InputError);
    EXPECT_THROW(part.set_thickness({1.0f}), InputError);
    EXPECT_THROW(PartHeat(field, 0.0, steel()), InputError);
    EXPECT_THROW(PartHeat(field, 1.0, {0.0, 500.0, 8000.0}), InputError);
}

}  // namespace
}  // namespace beltgrinding
