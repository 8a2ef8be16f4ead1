#include <gtest/gtest.h>

#include "beltgrinding/stock.h"
#include "support/sheets.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

TEST(UnsoundField, IsRefusedByAllStock) {
    const HeightField sound = testing::plate(4.0, 3.0, 1.0, 0.2);
    testing::expect_unsound_refused(sound, [](HeightField& f) { apply_allowance(f, 0.3); });
    testing::expect_unsound_refused(
        sound, [](HeightField& f) { add_stock(f, std::vector<double>(f.size(), 0.3)); });
    testing::expect_unsound_refused(sound, [&](HeightField& f) { apply_left(f, sound); });
    testing::expect_unsound_refused(sound, [](HeightField& f) {
        TriangleMesh mesh;  // a sheet 0.5 mm above
        mesh.vertices = {{-9, -9, 0.5F}, {9, -9, 0.5F}, {0, 20, 0.5F}};
        mesh.triangles = {{0, 1, 2}};
        apply_mesh(f, mesh, {});
    });
}

}  // namespace
}  // namespace beltgrinding
