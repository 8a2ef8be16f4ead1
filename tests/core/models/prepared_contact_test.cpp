// What a model prepares is of one grid: it takes nothing of another, and stays as it is.
#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "beltgrinding/belt_machine.h"
#include "beltgrinding/error.h"
#include "elastic/half_space.h"
#include "elastic/wheel_rim.h"
#include "surrogate/surrogate.h"

namespace beltgrinding {
namespace {

const Elasticity kRubber{5.0, 0.45};
const ContactGrid kGrid{17, 11, 1.0, 2.0};

WheelRimDesign rim() {
    WheelRimDesign design;
    design.outer_radius = 60.0;
    design.width = 22.0;
    design.layers = {{10.0, kRubber}};
    return design;
}

std::vector<std::unique_ptr<ElasticModel>> elastic_models() {
    std::vector<std::unique_ptr<ElasticModel>> all;
    all.push_back(std::make_unique<ElasticFoundation>(0.5));
    all.push_back(std::make_unique<HalfSpace>(kRubber));
    all.push_back(std::make_unique<BondedLayer>(kRubber, 15.0));
    all.push_back(std::make_unique<WheelRim>(rim()));
    return all;
}

constexpr ContactFeatures kFeatures{1.0, 4.0};

/// A regression of a single vector: its values are of no use, its sizes are right.
Surrogate surrogate() {
    TrainedRegression regression;
    const int n = kFeatures.size();
    regression.vectors = Eigen::MatrixXf::Zero(n, 1);
    regression.coefficients = Eigen::VectorXf::Ones(1);
    regression.mean = Eigen::VectorXf::Zero(n);
    regression.deviation = Eigen::VectorXf::Ones(n);
    regression.gamma = 0.01;
    return Surrogate(kFeatures, regression, "test");
}

ContactProblem ball_on(const ContactGrid& grid) {
    ContactProblem problem;
    problem.gap.resize(grid.cells());
    for (int c = 0; c < grid.cells(); ++c) {
        const double s = grid.s(c % grid.nx), y = grid.y(c / grid.nx);
        problem.gap[c] = (s * s + y * y) / 100.0;
    }
    problem.coverage = Eigen::ArrayXd::Ones(grid.cells());
    problem.force = 20.0;
    return problem;
}

const std::array<ContactGrid, 5> kOthers = {
    {{16, 11, 1.0, 2.0}, {33, 11, 1.0, 2.0}, {17, 10, 1.0, 2.0}, {17, 40, 1.0, 2.0}, {1, 1, 1, 1}}};

TEST(PreparedContact, RefusesAProblemOfAnotherGrid) {
    std::vector<std::unique_ptr<PreparedContact>> all;
    for (const auto& model : elastic_models()) all.push_back(model->prepare(kGrid));
    all.push_back(surrogate().prepare(kGrid));
    for (const auto& contact : all) {
        SCOPED_TRACE(contact->describe());
        EXPECT_EQ(contact->grid(), kGrid);
        const ContactProblem good = ball_on(kGrid);
        const ContactSolution solution = contact->solve(good);
        EXPECT_EQ(solution.pressure.size(), kGrid.cells());
        for (const ContactGrid& other : kOthers) {
            const Eigen::ArrayXd values = Eigen::ArrayXd::Ones(other.cells());
            EXPECT_THROW(contact->solve(ball_on(other)), InputError);
            ContactProblem problem = good;
            problem.coverage = values;
            EXPECT_THROW(contact->solve(problem), InputError);
            EXPECT_THROW(contact->solve(good, &values), InputError);
        }
        EXPECT_EQ(contact->solve(good).pressure.matrix(), solution.pressure.matrix());
    }
}

TEST(PreparedContact, IsCancelledWhileItIsSolvedAndSolvesAnew) {
    std::vector<std::unique_ptr<PreparedContact>> all;
    for (const auto& model : elastic_models()) all.push_back(model->prepare(kGrid));
    BeltMachine machine;
    machine.belt.width = 22.0;
    for (const auto kind : {BeltMachine::Kind::kFreeBelt, BeltMachine::Kind::kPlaten}) {
        machine.kind = kind;
        machine.platen.layers = {{5.0, 2.0, 0.4}};
        all.push_back(make_belt_contact(machine)->prepare(kGrid));
    }
    for (const auto& contact : all) {
        SCOPED_TRACE(contact->describe());
        const ContactProblem good = ball_on(kGrid);
        const ContactSolution truth = contact->solve(good);
        ContactProblem cancelled = good;
        cancelled.context = {};
        cancelled.context.cancel();
        EXPECT_THROW(contact->solve(cancelled), Cancelled);
        EXPECT_THROW(contact->solve(cancelled, &truth.pressure), Cancelled);
        EXPECT_EQ(contact->solve(good).pressure.matrix(), truth.pressure.matrix());
    }
}

TEST(PreparedContact, AnOperatorRefusesArraysOfAnotherSize) {
    const Eigen::ArrayXd good = Eigen::ArrayXd::Ones(kGrid.cells());
    for (const auto& model : elastic_models()) {
        SCOPED_TRACE(model->describe());
        const auto compliance = model->compliance(kGrid);
        Eigen::ArrayXd u, again;
        compliance->apply(good, good, u);
        EXPECT_EQ(u.size(), kGrid.cells());
        for (const ContactGrid& other : kOthers) {
            const Eigen::ArrayXd bad = Eigen::ArrayXd::Ones(other.cells());
            EXPECT_THROW(compliance->apply(bad, good, again), std::invalid_argument);
            EXPECT_THROW(compliance->apply(good, bad, again), std::invalid_argument);
            EXPECT_THROW(compliance->apply(bad, bad, again), std::invalid_argument);
        }
        EXPECT_THROW(compliance->apply({}, {}, again), std::invalid_argument);
        again.resize(3);  // what comes out takes the operator's size
        compliance->apply(good, good, again);
        EXPECT_EQ(u.matrix(), again.matrix());
        again = good;  // in place
        compliance->apply(again, good, again);
        EXPECT_EQ(u.matrix(), again.matrix());
    }
}

TEST(PreparedContact, TheFeaturesOfASurrogateRefuseAnotherGrid) {
    const ContactProblem problem = ball_on(kGrid);
    const std::vector<int> cells = kFeatures.candidates(kGrid, problem, 0.5);
    EXPECT_EQ(kFeatures.of(kGrid, problem, 0.5, cells).cols(), std::ssize(cells));
    for (const ContactGrid& other : kOthers) {
        EXPECT_THROW(kFeatures.candidates(other, problem, 0.5), std::invalid_argument);
        EXPECT_THROW(kFeatures.of(other, problem, 0.5, {0}), std::invalid_argument);
    }
    EXPECT_THROW(kFeatures.of(kGrid, problem, 0.5, {-1}), std::invalid_argument);
    EXPECT_THROW(kFeatures.of(kGrid, problem, 0.5, {kGrid.cells()}), std::invalid_argument);
}

TEST(PreparedContact, AnotherGridChangesNothingAndTheModelMayGo) {
    const Eigen::ArrayXd pressure = Eigen::ArrayXd::LinSpaced(kGrid.cells(), 0.0, 1.0);
    const Eigen::ArrayXd coverage = Eigen::ArrayXd::Ones(kGrid.cells());
    for (auto& model : elastic_models()) {
        SCOPED_TRACE(model->describe());
        const auto compliance = model->compliance(kGrid);
        Eigen::ArrayXd before, after;
        compliance->apply(pressure, coverage, before);
        for (const ContactGrid& other : kOthers) {
            const auto prepared = model->compliance(other);
            Eigen::ArrayXd u;
            prepared->apply(Eigen::ArrayXd::Ones(other.cells()),
                            Eigen::ArrayXd::Ones(other.cells()), u);
        }
        compliance->apply(pressure, coverage, after);
        EXPECT_EQ(before.matrix(), after.matrix());
        model.reset();
        compliance->apply(pressure, coverage, after);
        EXPECT_EQ(before.matrix(), after.matrix());
    }
}

TEST(PreparedContact, IsTheSameFromAnyThread) {
    for (const auto& model : elastic_models()) {
        SCOPED_TRACE(model->describe());
        const auto apply = [](const ContactModel& on, const ContactGrid& grid) {
            return on.prepare(grid)->solve(ball_on(grid)).pressure;
        };
        std::vector<Eigen::ArrayXd> found(16);
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < 4; ++t) {
            threads.emplace_back([&, t] {
                for (std::size_t k = t; k < found.size(); k += 4) {
                    found[k] = apply(
                        *model, {17 + 8 * static_cast<int>(k % 3), k % 2 == 0 ? 11 : 9, 1.0, 2.0});
                }
            });
        }
        for (std::thread& thread : threads) thread.join();
        for (std::size_t k = 0; k < found.size(); ++k) {
            const ContactGrid grid{17 + 8 * static_cast<int>(k % 3), k % 2 == 0 ? 11 : 9, 1.0, 2.0};
            EXPECT_EQ(found[k].matrix(), apply(*model, grid).matrix()) << k;
        }
    }
}

TEST(PreparedContact, RefusesAGridThatIsNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::unique_ptr<ContactModel>> models;
    for (auto& model : elastic_models()) models.push_back(std::move(model));
    models.push_back(std::make_unique<Geometric>());
    for (const auto& model : models) {
        for (const ContactGrid& none :
             {ContactGrid{}, ContactGrid{-3, 5, 1.0, 1.0}, ContactGrid{5, 0, 1.0, 1.0},
              ContactGrid{5, 5, 0.0, 1.0}, ContactGrid{5, 5, 1.0, nan},
              ContactGrid{1 << 20, 1 << 20, 1.0, 1.0}}) {
            EXPECT_THROW(model->prepare(none), InputError) << model->describe();
        }
    }
    EXPECT_THROW(ElasticFoundation(0.5).compliance({}), InputError);
}

/// Keeps samples in memory, and gives what it is told to.
class MemoryCache final : public RimCache {
  public:
    std::optional<RimSamples> read(const std::string& key) const override {
        const auto found = kept.find(key);
        if (found == kept.end()) return std::nullopt;
        return found->second;
    }
    void write(const std::string& key, const RimSamples& samples) override {
        ++writes;
        kept[key] = samples;
    }
    std::map<std::string, RimSamples> kept;
    int writes = 0;
};

TEST(RimCache, ARimReadsAndWritesOnlyWhatItIsGiven) {
    namespace fs = std::filesystem;
    const Eigen::ArrayXd ones = Eigen::ArrayXd::Ones(kGrid.cells());
    Eigen::ArrayXd plain, cached;
    const WheelRim alone(rim());
    const auto prepared = alone.compliance(kGrid);
    EXPECT_EQ(prepared->describe(), alone.describe());
    prepared->apply(ones, ones, plain);

    const auto cache = std::make_shared<MemoryCache>();
    for (int time = 0; time < 2; ++time) {  // computed, then read
        const auto compliance = WheelRim(rim(), {}, cache).compliance(kGrid);
        EXPECT_NE(compliance->describe().find(rim_cache_name(cache->kept.begin()->first)),
                  std::string::npos);
        compliance->apply(ones, ones, cached);
        EXPECT_EQ(plain.matrix(), cached.matrix());
    }
    EXPECT_EQ(cache->writes, 1);
    // A cache that gives the samples of another rim is not believed.
    RimSamples& samples = cache->kept.begin()->second;
    const RimSamples good = samples;
    const auto damage = [&](auto&& spoil) {
        samples = good;
        spoil();
        WheelRim(rim(), {}, cache).compliance(kGrid)->apply(ones, ones, cached);
        EXPECT_EQ(plain.matrix(), cached.matrix());
    };
    damage([&] { samples.even.pop_back(); });
    damage([&] { samples.odd[3].resize(1, 1); });
    damage([&] { samples.even[20] = Eigen::MatrixXd::Zero(6, 5); });
    damage([&] { samples.even[7](2, 2) = std::numeric_limits<double>::quiet_NaN(); });
    EXPECT_EQ(cache->writes, 5);
}

TEST(RimCache, WithoutOneNothingIsWritten) {
    namespace fs = std::filesystem;
    const fs::path home = fs::temp_directory_path() / ("home" + std::to_string(::getpid()));
    fs::create_directories(home);
    std::vector<std::pair<const char*, std::optional<std::string>>> before;
    for (const char* name : {"HOME", "XDG_CACHE_HOME"}) {
        const char* value = std::getenv(name);
        before.emplace_back(name, value ? std::optional<std::string>(value) : std::nullopt);
        ::setenv(name, home.c_str(), 1);
    }
    WheelRim(rim()).prepare(kGrid);
    EXPECT_TRUE(fs::is_empty(home));
    for (const auto& [name, value] : before) {
        value ? ::setenv(name, value->c_str(), 1) : ::unsetenv(name);
    }
    fs::remove_all(home);
}

TEST(RimCache, AFolderThatCannotBeWrittenIsNoError) {
    const auto cache = std::make_shared<FolderRimCache>("/dev/null/nowhere");
    EXPECT_NO_THROW(WheelRim(rim(), {}, cache).prepare(kGrid));
    EXPECT_FALSE(cache->read("anything").has_value());
}

}  // namespace
}  // namespace beltgrinding
