#include "gap/edge_profiles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gap/gap_map.h"
#include "support/blocks.h"
#include "support/synthetic_field.h"

namespace beltgrinding {
namespace {

constexpr double kHalf = 5.0;            // mm, of a plate's width
constexpr EdgeSoftness kSoft{0.1, 0.1};  // mm/MPa
constexpr double kTouch = 0.02;          // mm: the wheel is nearly flat

/// MPa, the mean from one place to another under a flat punch of the plate's width, whose mean is
/// 1 MPa, `from` and `to` from its middle, mm (Johnson, Contact Mechanics, 1985, section 2.8).
double punch(double from, double to) {
    const auto load = [](double y) {
        return 2.0 * kHalf / M_PI * std::asin(std::clamp(y / kHalf, -1.0, 1.0));
    };
    return (load(to) - load(from)) / (to - from);
}

/// A wheel over the whole width of a plate, the middle of which is y = 0 on its grid.
struct Plate {
    HeightField field = testing::plate(20.0, 2.0 * kHalf, 0.5);
    SampleBlocks blocks{field};
    GapMap map{{5000.0, 20.0, 0.0}, 1.0};
    Frame pose = Frame::Identity();

    Plate() {
        pose.linear() = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
        pose.translation() = Vec3(10.0, kHalf, 0.0);
        update();
    }
    void update() { map.update(blocks, testing::all_of(blocks), pose, kTouch); }
    /// Of the punch, by cell.
    Eigen::ArrayXd pressure() const {
        const ContactGrid& grid = map.grid();
        Eigen::ArrayXd result = Eigen::ArrayXd::Zero(grid.cells());
        for (int cell = 0; cell < grid.cells(); ++cell) {
            const double y = grid.y(cell / grid.nx);
            if (map.coverage()[cell] > 0.0)
                result[cell] = punch(std::max(y - 0.5, -kHalf), std::min(y + 0.5, kHalf));
        }
        return result;
    }
    /// Calls visit(mm from the border, MPa) for samples in the middle of the pressed length.
    template <class Visit>
    void for_middle(const Eigen::ArrayXd& cells, Visit visit) const {
        DisplacedPressure pressed;
        pressed.pressure = cells;
        map.for_pressed(pressed, [&](std::size_t position, double value) {
            const Vec3& at = field.point[blocks.sample(position)];
            if (std::abs(at.x() - 10.0) < 3.0) visit(std::min(at.y(), 2.0 * kHalf - at.y()), value);
        });
    }
};

TEST(EdgeProfiles, RisesToAnEdgeAsUnderAFlatPunch) {
    Plate plate;
    const Eigen::ArrayXd pressure = plate.pressure();
    plate.map.sharpen_edges(plate.blocks, pressure, kSoft);
    int seen = 0;
    plate.for_middle(pressure, [&](double away, double value) {
        const double from = std::max(away - 0.25, 0.0);
        const double wanted = punch(from - kHalf, away + 0.25 - kHalf);
        if (away < 0.8) {
            EXPECT_NEAR(value, wanted, 0.09 * wanted) << away;
            ++seen;
        }
        if (away > 3.0) {
            EXPECT_NEAR(value, wanted, 0.02 * wanted) << away;
        }
    });
    EXPECT_GT(seen, 20);
}

TEST(EdgeProfiles, FallsToAnEdgeThatIsWornRound) {
    Plate plate;
    for (std::size_t k = 0; k < plate.field.size(); ++k) {
        const double y = plate.field.point[plate.blocks.sample(k)].y();
        if (std::min(y, 2.0 * kHalf - y) < 0.1) plate.blocks.lower(k, 0.4);
    }
    plate.update();
    const Eigen::ArrayXd pressure = plate.pressure();
    plate.map.sharpen_edges(plate.blocks, pressure, kSoft);
    double outermost = 0.0, next = 0.0;
    plate.for_middle(pressure, [&](double away, double value) {
        if (away < 0.1) outermost = std::max(outermost, value);
        if (away > 0.4 && away < 0.6) next = std::max(next, value);
    });
    EXPECT_GT(next, 0.0);
    EXPECT_LT(outermost, 0.8 * next);
}

TEST(EdgeProfiles, IsTheSameWhenItIsAskedForTwice) {
    Plate plate;
    const Eigen::ArrayXd pressure = plate.pressure();
    std::vector<double> once, twice;
    plate.map.sharpen_edges(plate.blocks, pressure, kSoft);
    plate.for_middle(pressure, [&](double, double value) { once.push_back(value); });
    plate.map.sharpen_edges(plate.blocks, pressure, kSoft);
    plate.for_middle(pressure, [&](double, double value) { twice.push_back(value); });
    EXPECT_EQ(once, twice);
}

TEST(EdgeProfiles, LeavesAFoundationAsItIs) {
    Plate plate;
    const Eigen::ArrayXd pressure = plate.pressure();
    std::vector<double> before, after;
    plate.for_middle(pressure, [&](double, double value) { before.push_back(value); });
    plate.map.sharpen_edges(plate.blocks, pressure, {});
    plate.for_middle(pressure, [&](double, double value) { after.push_back(value); });
    EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace beltgrinding
