// No function of the room follows the indices of a field that is not sound.

#include <gtest/gtest.h>

#include "beltgrinding/deviation.h"
#include "beltgrinding/verdict.h"
#include "inspection/ground_mesh.h"
#include "inspection/section.h"
#include "inspection/waviness.h"
#include "inspection/zones.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

constexpr Tolerance kBand{-0.05, 0.1};
const Vec3 kMiddle(2.1, 1.6, 0.0);

struct Entry {
    const char* name;
    std::function<void(HeightField&)> call;
};

SurfaceMesh surface_of(const HeightField& field) {
    SurfaceMesh mesh;
    mesh.vertices = field.point;
    for (const Triangle& t : field.triangles) mesh.triangles.push_back(t);
    mesh.face.assign(mesh.triangles.size(), 0);
    return mesh;
}

class UnsoundField : public ::testing::TestWithParam<Entry> {};

TEST_P(UnsoundField, IsRefusedByName) {
    testing::expect_unsound_refused(testing::plate(4.0, 3.0, 1.0, 0.2), GetParam().call);
}

INSTANTIATE_TEST_SUITE_P(
    Entries, UnsoundField,
    ::testing::Values(
        Entry{"DeviationStatistics", [](HeightField& f) { deviation_statistics(f, kBand); }},
        Entry{"DeviationColours", [](HeightField& f) { deviation_colours(f, ColourScale{kBand}); }},
        Entry{"UncertaintyColours",
              [](HeightField& f) {
                  if (f.height_sd.empty()) f.height_sd.assign(f.size(), 0.1F);
                  uncertainty_colours(f, 1.0);
              }},
        Entry{"Judge", [](HeightField& f) { judge(f, {}, kBand); }},
        Entry{"ZoneOfSamples", [](HeightField& f) { zone_of_samples(f, {}); }},
        Entry{
            "GroundMesh",
            [](HeightField& f) { ground_mesh(surface_of(testing::plate(4.0, 3.0, 1.0, 0.2)), f); }},
        Entry{"SectionByPlane",
              [](HeightField& f) { section_by_plane(f, kMiddle, Vec3::UnitX()); }},
        Entry{"SectionBetween",
              [](HeightField& f) { section_between(f, Vec3(0.6, 1.6, 0), Vec3(3.2, 1.7, 0)); }},
        Entry{"SectionIndex", [](HeightField& f) { SectionIndex{f}; }},
        Entry{"Waviness", [](HeightField& f) { waviness(f, {}); }}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace beltgrinding
