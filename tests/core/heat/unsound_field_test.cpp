#include <gtest/gtest.h>

#include "plate.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

TEST(UnsoundField, IsRefusedByPartHeat) {
    testing::expect_unsound_refused(testing::plate(4.0, 3.0, 1.0, 0.2),
                                    [](HeightField& field) { PartHeat(field, 2.0, steel()); });
}

TEST(UnsoundField, IsRefusedWhereHeatIsKept) {
    const HeightField sound = testing::plate(4.0, 3.0, 1.0, 0.2);
    const PartHeat heat(sound, 2.0, steel());
    testing::expect_unsound_refused(sound, [&](HeightField& field) { heat.keep(field); });
}

}  // namespace
}  // namespace beltgrinding
