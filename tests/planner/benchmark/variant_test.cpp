// Tests of the values of `--variants`.
#include "planner/benchmark/variant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/problem/keys.h"

namespace corridor {
namespace {

std::string complaintOf(const std::string& text,
                        const std::vector<BenchmarkCompetitor>& competitors = {}) {
  try {
    readVariant(text, competitors);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

CheckerSettings settingsOf(const Variant& variant) {
  CheckerSettings checker;
  variant.apply(checker);
  return checker;
}

TEST(Variant, SetsTheKnobOfItsKind) {
  CheckerSettings checker;
  readVariant("discrete:0.005").apply(checker);
  EXPECT_EQ(checker.edges, EdgeMethod::discrete);
  EXPECT_EQ(checker.resolution, 0.005);
  EXPECT_FALSE(checker.tolerance);
  checker = {};
  readVariant("certified:1e-6").apply(checker);
  EXPECT_EQ(checker.edges, EdgeMethod::certified);
  EXPECT_EQ(checker.resolution, CheckerSettings{}.resolution);
  EXPECT_EQ(checker.tolerance, 1e-6);
}

TEST(Variant, WithoutAKnobTheProblemsValueStays) {
  CheckerSettings checker;
  checker.resolution = 0.02;
  checker.tolerance = 1e-5;
  for (const char* name : {"certified", "discrete"}) {
    readVariant(name).apply(checker);
    EXPECT_EQ(wordOf(checker.edges), name);
    EXPECT_EQ(checker.resolution, 0.02);
    EXPECT_EQ(checker.tolerance, 1e-5);
  }
}

TEST(Variant, EveryEdgeMethodIsAVariant) {
  for (const std::string& edges : problemChoices().at("checker.edges")) {
    EXPECT_EQ(wordOf(settingsOf(readVariant(edges)).edges), edges);
    const CheckerSettings checker = settingsOf(readVariant(edges + ":0.001"));
    EXPECT_EQ(edges == "discrete" ? checker.resolution : checker.tolerance.value_or(0), 0.001);
  }
}

TEST(Variant, CompetitorsSampleEdges) {
  const std::vector<BenchmarkCompetitor> competitors{{"other", {}}};
  const Variant variant = readVariant("other:0.1", competitors);
  EXPECT_EQ(settingsOf(variant).edges, EdgeMethod::discrete);
  EXPECT_EQ(settingsOf(variant).resolution, 0.1);
  ASSERT_TRUE(variant.competitor);
  EXPECT_EQ(variant.competitor->name, "other");
  EXPECT_FALSE(readVariant("discrete:0.1", competitors).competitor);
}

TEST(Variant, BadOnesAreReportedInOneLine) {
  const std::string names = joined(problemChoices().at("checker.edges"));
  EXPECT_EQ(complaintOf("certifed"),
            "--variants: unknown variant \"certifed\" (did you mean "
            "\"certified\"?); there are: " +
                names + "; a resolution or tolerance may follow: discrete:0.01");
  EXPECT_THAT(complaintOf("other:0.1"), testing::StartsWith("--variants: unknown variant"));
  EXPECT_THAT(complaintOf(""), testing::StartsWith("--variants: unknown variant \"\""));
  for (const char* knob : {"", "1", "0", "-0.1", "1e-10", "nan", "fine", "0.1abc", "0.1:0.2"})
    EXPECT_EQ(complaintOf(std::string("discrete:") + knob),
              std::string("--variants: \"discrete:") + knob +
                  "\": a resolution from 1e-09 to below 1 is needed, not \"" + knob + "\"");
  for (const char* knob : {"", "0", "-1e-7", "inf", "small"})
    EXPECT_EQ(complaintOf(std::string("certified:") + knob),
              std::string("--variants: \"certified:") + knob +
                  "\": a tolerance above 0, in metres, is needed, not \"" + knob + "\"");
}

}  // namespace
}  // namespace corridor
