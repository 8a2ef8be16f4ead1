#include <gtest/gtest.h>

#include "heightfield/sound_field.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

TEST(ValidateHeightField, EveryArrayIsNamed) {
    testing::expect_unsound_refused(testing::plate(4.0, 3.0, 1.0, 0.2),
                                    [](HeightField& field) { field.validate(); });
}

TEST(ValidateHeightField, WhatIsWrittenIsCheckedAsAFaultOfTheProgram) {
    for (const testing::Unsound& one : testing::unsound()) {
        HeightField field = testing::plate(4.0, 3.0, 1.0, 0.2);
        one.spoil(field);
        EXPECT_THROW(hdf5_image(field, ""), std::logic_error) << one.word;
        EXPECT_THROW(write_hdf5(field, "/nowhere/at.h5", ""), std::logic_error) << one.word;
        EXPECT_THROW(write_hdf5(field, -1, ""), std::logic_error) << one.word;
    }
}

TEST(ValidateHeightField, OfSeveralFaultsTheFirstSampleIsNamed) {
    HeightField field = testing::plate(400.0, 400.0, 1.0, 0.2);
    for (const std::size_t i : {150000, 70001, 70000}) field.height[i] = NAN;
    const auto fault = fault_of(field);
    ASSERT_TRUE(fault);
    EXPECT_NE(fault->sentence().find("sample 70000"), std::string::npos) << fault->sentence();
}

}  // namespace
}  // namespace beltgrinding
