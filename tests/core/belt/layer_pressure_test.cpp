// The pressure of a platen's layers from one look to the next, and from one contact to the next.
#include "layer_pressure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beltgrinding {
namespace {

constexpr int kCells = 60;

TEST(PressureMixing, FindsInFewLooksWhatItselfComesToSlowly) {
    Eigen::ArrayXd truth(kCells), slow(kCells);
    for (int k = 0; k < kCells; ++k) {
        truth[k] = 1.0 + std::sin(0.3 * k);
        slow[k] = 0.1 + 0.15 * (k % 5);  // what is left of an error after a look, up to 0.7
    }
    Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(kCells), plain = pressure;
    PressureMixing mixing;
    for (int look = 0; look < 6; ++look) {
        pressure = mixing.next(pressure, truth + slow * (pressure - truth));
        plain = truth + slow * (plain - truth);
    }
    EXPECT_LT((pressure - truth).abs().maxCoeff(), 1e-6);
    EXPECT_GT((plain - truth).abs().maxCoeff(), 1e-2);
    EXPECT_GE(pressure.minCoeff(), 0.0);
}

TEST(LastLayers, GoOnAsTheyChangedWhereThatWasNearer) {
    const auto at = [](double place) {
        Eigen::ArrayXd pressure(kCells);
        for (int k = 0; k < kCells; ++k) pressure[k] = std::exp(-0.01 * std::pow(k - place, 2));
        return pressure;
    };
    LastLayers layers;
    EXPECT_EQ(layers.next().size(), 0);
    layers.add(at(20.0));
    EXPECT_TRUE((layers.next() == at(20.0)).all());
    layers.add(at(21.0));
    EXPECT_TRUE((layers.next() == at(21.0)).all());  // not known yet
    layers.add(at(22.0));
    const double goes_on = (layers.next() - at(23.0)).abs().sum();
    EXPECT_LT(goes_on, 0.3 * (at(22.0) - at(23.0)).abs().sum());
    layers.add(at(21.0));  // turns back
    EXPECT_TRUE((layers.next() == at(21.0)).all());
}

}  // namespace
}  // namespace beltgrinding
