#include "shape_answer.h"

#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <limits>
#include <string>

#include "beltgrinding/error.h"
#include "beltgrinding/shape.h"
#include "shape_impl.h"
#include "shape_transfer.h"

namespace beltgrinding {
namespace {

/// The code of the error with which a box is sampled of whose first face the reader says `area`.
std::string code_for(double area) {
    TriedShape tried;
    tried.valid = true;
    tried.areas = {area, 200.0, 200.0, 200.0, 200.0, 200.0};
    tried.signs = {1};
    const std::string answer =
        pack_tried(tried) + pack_shape(BRepPrimAPI_MakeBox(10.0, 20.0, 10.0).Shape());
    SamplingOptions options;
    options.spacing = 2.0;
    try {
        (void)sample_faces(unpack_shape_answer(answer, "box"), {0}, options);
    } catch (const InputError& error) {
        return error.code();
    }
    return "";
}

TEST(ShapeAnswer, AnAreaThatWasNotFoundInTimeIsToldApartFromOneThatIsNoNumber) {
    EXPECT_EQ(code_for(200.0), "");
    EXPECT_EQ(code_for(kEndlessArea), "brep.area_endless");
    EXPECT_EQ(code_for(std::numeric_limits<double>::quiet_NaN()), "brep.area_not_finite");
}

}  // namespace
}  // namespace beltgrinding
