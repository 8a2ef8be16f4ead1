#include "beltgrinding/fact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "beltgrinding/error.h"

namespace beltgrinding {
namespace {

TEST(Fact, FillsItsFormIn) {
    const Fact fact{
        "brep.no_such_face",
        "{shape} has no face {face}; it has {count} faces, {area:.3g} mm2",
        {{"shape", "blade.step"}, {"face", std::size_t{12}}, {"count", 7u}, {"area", 1234.56}}};
    EXPECT_EQ(fact.sentence(), "blade.step has no face 12; it has 7 faces, 1.23e+03 mm2");
}

TEST(Fact, WritesNumbersAsPrintfDoes) {
    const Fact fact{"base.numbers",
                    "{a:f} {b:g} {c:.4g} {d:.0f} {e:.2f} {f:.1f}",
                    {{"a", 1.0 / 3.0},
                     {"b", 1e-7},
                     {"c", 123456.0},
                     {"d", 0.5},
                     {"e", -0.001},
                     {"f", std::nan("")}}};
    EXPECT_EQ(fact.sentence(), "0.333333 1e-07 1.235e+05 0 -0.00 nan");
}

TEST(Fact, TellsItsFormWhereTheArgumentsDoNotFit) {
    EXPECT_EQ((Fact{"base.lacks", "no {what}", {}}).sentence(), "no {what}");
    EXPECT_EQ((Fact{"base.kind", "{what:.3g}", {{"what", "words"}}}).sentence(), "{what:.3g}");
}

TEST(Fact, TakesTextFromOutsideAsItIs) {
    const std::string path = "{0} %s \xff";
    EXPECT_EQ((Fact{"base.path", "{file}: no", {{"file", path}}}).sentence(), path + ": no");
}

TEST(Fact, JoinsSeveral) {
    EXPECT_EQ(sentence({}), "");
    EXPECT_EQ(sentence({{"a.a", "one {n}", {{"n", 1}}}, {"a.b", "two", {}}}), "one 1; two");
}

TEST(InputError, CarriesCodeAndArguments) {
    const InputError error("brep.no_such_face", "{shape} has no face {face}",
                           {{"shape", "blade.step"}, {"face", 3}});
    EXPECT_STREQ(error.what(), "blade.step has no face 3");
    EXPECT_EQ(error.code(), "brep.no_such_face");
    EXPECT_EQ(error.text(), "{shape} has no face {face}");
    EXPECT_EQ(error.culprit(), (Arguments{{"face", 3}}));
    EXPECT_TRUE(error.context().empty());
}

TEST(InputError, IsToldWithinAnother) {
    const InputError inner("path.feed", "feed is {feed:f}", {{"feed", 0.0}, {"file", "inner.src"}});
    const InputError outer =
        inner.within({"path.at_pose", "pose {pose} (line {line}): ", {{"pose", 2}, {"line", 7}}})
            .within({"path.at_file", "{file}: ", {{"file", "outer.src"}}});
    EXPECT_STREQ(outer.what(), "outer.src: pose 2 (line 7): feed is 0.000000");
    EXPECT_EQ(outer.code(), "path.feed");
    ASSERT_EQ(outer.context().size(), 2u);
    EXPECT_EQ(outer.context().front().code, "path.at_file");
    EXPECT_EQ(outer.culprit(), (Arguments{{"file", "inner.src"}, {"pose", 2}, {"line", 7}}));
    EXPECT_STREQ(inner.what(), "feed is 0.000000");
}

}  // namespace
}  // namespace beltgrinding
