#include "meshio/mesh_writer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

TEST(DeviationPly, HasTheSizeThatItsHeaderSays) {
    const HeightField field = testing::plate(4.0, 3.0, 1.0, 0.2);
    const std::string ply = deviation_ply(field, {}, true);
    const std::size_t body = ply.find("end_header\n") + 11;
    EXPECT_EQ(ply.size() - body, 20 * field.size() + 13 * field.triangles.size());
    EXPECT_NE(ply.find("property float deviation"), std::string::npos);
    float z = 0;
    std::memcpy(&z, ply.data() + body + 8, 4);
    EXPECT_FLOAT_EQ(z, 0.2F);
    const std::string plain = mesh_ply(field, false);
    std::memcpy(&z, plain.data() + plain.find("end_header\n") + 11 + 8, 4);
    EXPECT_FLOAT_EQ(z, 0.0F);
}

}  // namespace
}  // namespace beltgrinding
