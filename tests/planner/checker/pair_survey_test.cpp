#include "planner/checker/pair_survey.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "planner/model/model_builder.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Verdict = NeverInContactResult::Verdict;

std::string ballAt(const std::string& name, const std::string& at, double radius) {
  return "<link name='" + name + "'><collision><origin xyz='" + at +
         "'/><geometry><sphere radius='" + std::to_string(radius) +
         "'/></geometry></collision></link>";
}

std::string jointAt(const std::string& type, const std::string& parent, const std::string& child,
                    const std::string& at, double limit = 0) {
  return "<joint name='to " + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='0 0 1'/>" +
         (limit == 0 ? ""
                     : "<limit lower='-" + std::to_string(limit) + "' upper='" +
                           std::to_string(limit) + "' effort='1' velocity='1'/>") +
         "</joint>";
}

/// Arms of two links of length 1 stand in a row, 10 m apart. Each arm has one ball at its base and
/// one at its hand. If the elbow is at φ, the centres of these balls are 2·cos(φ/2) apart; the
/// elbow reaches 2.5 rad. @param gaps the smallest gap between the two balls of each arm, in
/// metres. Negative: the balls are in contact in some states.
Model armsWith(const std::vector<double>& gaps) {
  std::string text = "<link name='root'/>";
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const std::string n = std::to_string(i);
    const double radius = std::cos(2.5 / 2) - gaps[i] / 2;
    text += ballAt("base" + n, "0 0 0", radius) + "<link name='upper" + n + "'/>" +
            ballAt("hand" + n, "1 0 0", radius) +
            jointAt("fixed", "root", "base" + n, "0 " + std::to_string(10 * i) + " 0") +
            jointAt("revolute", "base" + n, "upper" + n, "0 0 0", 0.5) +
            jointAt("revolute", "upper" + n, "hand" + n, "1 0 0", 2.5);
  }
  const std::filesystem::path folder = test::newFolder();
  std::ofstream(folder / "arms.urdf") << "<robot name='arms'>" << text << "</robot>";
  Model model = ModelBuilder().addRobot(folder / "arms.urdf").build();
  std::filesystem::remove_all(folder);
  return model;
}

bool all(std::size_t, std::size_t) {
  return true;
}

/// Returns the pairs that were proved, such as "base0 hand0".
std::set<std::string> provedPairs(const Model& model, const std::vector<SurveyedPair>& pairs) {
  std::set<std::string> names;
  for (const SurveyedPair& pair : pairs)
    if (pair.proof && pair.proof->verdict == Verdict::proved)
      names.insert(model.bodies[pair.a].name + " " + model.bodies[pair.b].name);
  return names;
}

PairSurveyOptions optionsFor(std::uint64_t work) {
  PairSurveyOptions options;
  options.work = work;
  options.samples = 50;
  return options;
}

TEST(PairSurvey, CountsContactsAndProvesTheOthers) {
  // At the elbow's limit the balls of arm 1 overlap by 0.6 m, so they are in contact in many
  // states. Links of different arms are always far from each other.
  const Model model = armsWith({0.1, -0.6});
  const Checker checker(model);
  const std::vector<SurveyedPair> pairs = surveyPairs(checker, optionsFor(1'000'000), all);
  // Pairs of two balls that no joint moves against each other are not tested.
  ASSERT_EQ(pairs.size(), 5u);
  for (const SurveyedPair& pair : pairs) {
    const bool touches =
        model.bodies[pair.a].name == "base1" && model.bodies[pair.b].name == "hand1";
    EXPECT_EQ(pair.contacts > 0, touches);
    EXPECT_LT(pair.contacts, 50u);
    EXPECT_EQ(pair.proof.has_value(), !touches);
    EXPECT_FALSE(pair.movesFreely);
    if (pair.proof) {
      EXPECT_EQ(pair.proof->verdict, Verdict::proved);
    }
  }
}

TEST(PairSurvey, TriesOnlyTheWantedProofs) {
  const Model model = armsWith({0.1, 0.1});
  const Checker checker(model);
  const auto pairs = surveyPairs(checker, optionsFor(1'000'000), [&](std::size_t a, std::size_t b) {
    return model.bodies[a].name == "base0" && model.bodies[b].name == "hand0";
  });
  EXPECT_EQ(provedPairs(model, pairs), std::set<std::string>{"base0 hand0"});
  for (const SurveyedPair& pair : surveyPairs(checker, optionsFor(0), all))
    EXPECT_FALSE(pair.proof) << "no work is allowed";
}

/// The same options give the same result, and more work proves all that less work proves.
TEST(PairSurvey, SharesTheWorkAmongThePairs) {
  // The pair of arm 0 can't be proved, but is rarely in contact: the balls overlap by 0.01 mm.
  const Model model = armsWith({-1e-5, 0.02, 0.05, 0.1});
  const Checker checker(model);
  std::set<std::string> last;
  for (const std::uint64_t work : {3u, 100u, 1'000u, 3'000u, 10'000u, 1'000'000u}) {
    PairSurveyOptions options = optionsFor(work);
    std::uint64_t used = 0, boxes = 0;
    options.progress = [&](const PairSurveyProgress& p) {
      EXPECT_GE(p.work, used);
      EXPECT_LE(p.work, work);
      EXPECT_LE(p.samples, 50u);
      used = p.work;
    };
    const std::vector<SurveyedPair> pairs = surveyPairs(checker, options, all);
    for (const SurveyedPair& pair : pairs) boxes += pair.proof ? pair.proof->boxes : 0;
    EXPECT_LE(boxes, work);
    EXPECT_GT(boxes, 0u);
    const std::set<std::string> proved = provedPairs(model, pairs);
    if (work >= 3'000) {  // from here on, the first attempt for every pair is the same
      EXPECT_TRUE(std::includes(proved.begin(), proved.end(), last.begin(), last.end()));
      last = proved;
    }
    options.progress = {};
    const std::vector<SurveyedPair> again = surveyPairs(checker, options, all);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      ASSERT_EQ(again[i].proof.has_value(), pairs[i].proof.has_value());
      if (!pairs[i].proof) continue;
      EXPECT_EQ(again[i].proof->verdict, pairs[i].proof->verdict);
      EXPECT_EQ(again[i].proof->boxes, pairs[i].proof->boxes);
      EXPECT_EQ(again[i].proof->tests, pairs[i].proof->tests);
    }
  }
  // With the most work, only the pair that can't be proved is left.
  EXPECT_EQ(last.count("base0 hand0"), 0u);
  for (const std::string n : {"1", "2", "3"}) EXPECT_EQ(last.count("base" + n + " hand" + n), 1u);
}

/// A pair that can't be proved, and comes first, must not use up the work for the pairs after it.
TEST(PairSurvey, StartsWithASmallAttemptForEachPair) {
  const Model model = armsWith({-1e-5, 0.02, 0.6});
  const Checker checker(model);
  // A few hundred boxes for three pairs are sufficient for the arm with the wide gap.
  const auto pairs = surveyPairs(checker, optionsFor(600), [&](std::size_t a, std::size_t b) {
    return model.bodies[a].name.back() == model.bodies[b].name.back();
  });
  EXPECT_EQ(provedPairs(model, pairs).count("base2 hand2"), 1u);
  EXPECT_EQ(provedPairs(model, pairs).count("base0 hand0"), 0u);
}

TEST(PairSurvey, EndsIfInterrupted) {
  const Model model = armsWith({-1e-5, 0.02});
  const Checker checker(model);
  std::atomic<bool> interrupted = true;
  PairSurveyOptions options = optionsFor(1'000'000);
  options.interrupted = &interrupted;
  std::size_t calls = 0;
  options.progress = [&](const PairSurveyProgress&) { ++calls; };
  for (const SurveyedPair& pair : surveyPairs(checker, options, all)) {
    EXPECT_EQ(pair.contacts, 0u);
    EXPECT_FALSE(pair.proof);
  }
  EXPECT_EQ(calls, 0u);
  // This time the survey is interrupted after the first attempt at a proof.
  interrupted = false;
  options.progress = [&](const PairSurveyProgress& p) { interrupted = p.work > 0; };
  std::size_t tried = 0;
  for (const SurveyedPair& pair : surveyPairs(checker, options, all))
    tried += pair.proof.has_value();
  EXPECT_EQ(tried, 1u);
}

}  // namespace
}  // namespace corridor
