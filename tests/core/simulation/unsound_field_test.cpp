// A simulation never follows the indices of a field that is not sound, and leaves it as it was.

#include <gtest/gtest.h>

#include "beltgrinding/contact_factory.h"
#include "beltgrinding/simulation.h"
#include "elastic/half_space.h"
#include "recorders/recording.h"
#include "support/poses.h"
#include "support/unsound_fields.h"

namespace beltgrinding {
namespace {

using testing::pressing_down;

const ToolPath& path() {
    static const ToolPath kPath(
        {pressing_down(10, 10, 0.5, 40.0), pressing_down(25, 10, 0.5, 40.0)}, {});
    return kPath;
}

SimulationOptions options() {
    SimulationOptions o;
    o.process.wheel = {60.0, 20.0, 0.0};
    o.process.force = 40.0;
    o.process.belt_speed = 20000.0;
    return o;
}

TEST(UnsoundField, IsRefusedBySimulate) {
    testing::expect_unsound_refused(testing::plate(40.0, 20.0, 1.0, 0.5), [](HeightField& field) {
        const std::vector<double> before = field.height;
        ElasticFoundation foundation(0.5);
        try {
            simulate(field, path(), foundation, LocalLaw({1e-4}), options());
        } catch (...) {
            if (before.size() == field.height.size()) {
                for (std::size_t i = 0; i < before.size(); ++i) {
                    EXPECT_TRUE(field.height[i] == before[i] || std::isnan(before[i]));
                }
            }
            throw;
        }
    });
}

TEST(UnsoundField, IsRefusedByContactsAtPoses) {
    testing::expect_unsound_refused(testing::plate(40.0, 20.0, 1.0, 0.5), [](HeightField& field) {
        ElasticFoundation foundation(0.5);
        contacts_at(field, path(), {1}, foundation, options().process, options().resolution);
    });
    testing::expect_unsound_refused(testing::plate(40.0, 20.0, 1.0, 0.5), [](HeightField& field) {
        ElasticFoundation foundation(0.5);
        contact_at(field, path(), 1, foundation, options().process, options().resolution);
    });
}

TEST(UnsoundField, IsRefusedByARecording) {
    const HeightField sound = testing::plate(40.0, 20.0, 1.0, 0.5);
    testing::expect_unsound_refused(sound, [](HeightField& field) {
        Recording recording;
        recording.begin(field, 1.0, {});
    });
}

TEST(UnsoundField, NormalsThatPointIntoThePartAreAmongTheReasonsOfNoContact) {
    HeightField field = testing::plate(40.0, 20.0, 1.0, 0.5);
    for (Vec3f& normal : field.normal) normal = -normal;
    ElasticFoundation foundation(0.5);
    try {
        simulate(field, path(), foundation, LocalLaw({1e-4}), options());
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "simulation.never_touches");
        EXPECT_NE(std::string(error.what()).find("normals"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace beltgrinding
