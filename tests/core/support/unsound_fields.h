#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "beltgrinding/error.h"
#include "support/synthetic_field.h"

namespace beltgrinding::testing {

/// One fault of a field, and the word that a message about it holds.
struct Unsound {
    const char* word;
    std::function<void(HeightField&)> spoil;
};

/// Every way in which a field can be unsound: each array too short, too long where it may be
/// missing, and with a value that cannot be.
inline std::vector<Unsound> unsound() {
    using F = HeightField;
    return {
        {"'normal'", [](F& f) { f.normal.resize(3); }},
        {"'area'", [](F& f) { f.area.resize(3); }},
        {"'stock_height'", [](F& f) { f.stock_height.pop_back(); }},
        {"'height'", [](F& f) { f.height.pop_back(); }},
        {"'face'", [](F& f) { f.face.clear(); }},
        {"'flags'", [](F& f) { f.flags.clear(); }},
        {"'rays'", [](F& f) { f.rays.assign(2, Vec3f::UnitZ()); }},
        {"'height_sd'", [](F& f) { f.height_sd.assign(f.size() + 1, 0.1F); }},
        {"'height_error'", [](F& f) { f.height_error.assign(2, 0.1F); }},
        {"'measured'", [](F& f) { f.measured.assign(1, 0.0F); }},
        {"'trace.last'",
         [](F& f) {
             f.trace.reset(f.size());
             f.trace.last.pop_back();
         }},
        {"'heat.motion'", [](F& f) { f.heat.rise.assign(f.size(), 0.0F); }},
        {"'finish.unknown'", [](F& f) { f.finish.settled.assign(f.size(), 0.0F); }},
        {"spacing", [](F& f) { f.spacing = 0.0; }},
        {"spacing", [](F& f) { f.depth = NAN; }},
        {"'point'", [](F& f) { f.point[4].y() = NAN; }},
        {"'normal'", [](F& f) { f.normal[4] = Vec3f::Zero(); }},
        {"'normal'", [](F& f) { f.normal[4] *= 2.0F; }},
        {"'area'", [](F& f) { f.area[4] = -1.0F; }},
        {"'stock_height'", [](F& f) { f.stock_height[4] = INFINITY; }},
        {"'height'", [](F& f) { f.height[4] = NAN; }},
        {"'face'", [](F& f) { f.face[4] = 0xFFFFFFFF; }},
        {"'rays'",
         [](F& f) {
             f.rays = f.normal;
             f.rays[4] = -f.rays[4];
         }},
        {"standard deviations", [](F& f) { f.height_sd.assign(f.size(), -1.0F); }},
        {"errors of its heights", [](F& f) { f.height_error.assign(f.size(), NAN); }},
        {"measured heights", [](F& f) { f.measured.assign(f.size(), INFINITY); }},
        {"triangle",
         [](F& f) {
             f.triangles.push_back({0, 1, static_cast<std::uint32_t>(f.size())});
         }},
        {"trace",
         [](F& f) {
             f.trace.reset(f.size());
             f.trace.first[4] = 1;
         }},
        {"temperature",
         [](F& f) {
             f.heat.rise.assign(f.size(), 4.7e11F);
             f.heat.motion.assign(f.size(), 0);
         }},
    };
}

/// `entry` takes the sound field `sound`, and refuses each spoilt copy by an InputError that names
/// what is wrong.
inline void expect_unsound_refused(const HeightField& sound,
                                   const std::function<void(HeightField&)>& entry) {
    HeightField copy = sound;
    EXPECT_NO_THROW(entry(copy));
    for (const Unsound& one : unsound()) {
        copy = sound;
        one.spoil(copy);
        try {
            entry(copy);
            ADD_FAILURE() << "not refused: " << one.word;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(one.word), std::string::npos) << error.what();
            EXPECT_EQ(error.context().front().code, "heightfield.itself");
        }
    }
}

}  // namespace beltgrinding::testing
