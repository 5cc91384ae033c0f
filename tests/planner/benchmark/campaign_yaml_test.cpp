// Tests of campaign files: all keys are read, and all faults are reported at once with their lines.
#include "planner/benchmark/campaign_yaml.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "planner/benchmark/competitors.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class CampaignYaml : public testing::Test {
 protected:
  CampaignYaml() {
    write("robot.yaml",
          "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
    for (const char* name : {"hall", "room"})
      write(name + std::string(".yaml"),
            "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.01, 6, 1], "
            "at: [0, -1, 0]}\nstart: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], "
            "[4, 4]]}\n");
  }
  ~CampaignYaml() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Campaign read(const std::string& text) const {
    write("c.yaml", text);
    return readCampaign(folder_ / "c.yaml");
  }
  /// Returns the faults, without the folder's name.
  std::vector<std::string> faults(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      std::vector<std::string> all;
      for (const Fault& fault : error.faults()) {
        std::string one = fault.str();
        for (auto at = one.find(folder_.string() + "/"); at != std::string::npos;
             at = one.find(folder_.string() + "/"))
          one.erase(at, folder_.string().size() + 1);
        all.push_back(one);
      }
      return all;
    }
    return {};
  }
  static std::vector<std::string> variants(const Campaign& campaign) {
    std::vector<std::string> names;
    for (const Variant& variant : campaign.variants) names.push_back(variant.name);
    return names;
  }

  std::filesystem::path folder_ = test::newFolder();
};

const char* const kStart = "format: corridor-campaign-1\nproblems: [hall.yaml]\n";

TEST_F(CampaignYaml, EveryKey) {
  const Campaign c = read(
      "format: corridor-campaign-1\n"
      "problems: [hall.yaml, room.yaml, hall.yaml]\n"
      "planners: [RRTConnect, {name: RRT, label: short, params: {range: 0.2}}, {name: PRM, "
      "simplify: ompl}]\n"
      "checkers:\n"
      "  certified: {edges: certified, tolerance: 1e-6}\n"
      "  sampled: {edges: discrete, resolution: [0.1, 0.01], fit: [hull, vertices]}\n"
      "runs: 7\nseed: 3\nlimits: {time: 2.5, memory_mb: 512}\nsimplify: false\nverify: false\n");
  EXPECT_EQ(c.name, "c");
  EXPECT_THAT(c.problemNames, ElementsAre("hall", "room", "hall-2"));
  ASSERT_EQ(c.planners.size(), 3u);
  EXPECT_EQ(c.planners[0].label, "RRTConnect");
  EXPECT_FALSE(c.planners[0].params);
  EXPECT_EQ(c.planners[1].label, "short");
  EXPECT_EQ(c.planners[1].name, "RRT");
  EXPECT_EQ(c.planners[1].params->at("range"), "0.2");
  EXPECT_EQ(c.planners[2].label, "PRM");
  EXPECT_THAT(variants(c), ElementsAre("certified", "sampled 0.1 hull", "sampled 0.1 vertices",
                                       "sampled 0.01 hull", "sampled 0.01 vertices"));
  CheckerSettings checker;
  c.variants[0].apply(checker);
  EXPECT_EQ(checker.tolerance, 1e-6);
  checker = {};
  c.variants[4].apply(checker);
  EXPECT_EQ(checker.edges, EdgeMethod::discrete);
  EXPECT_EQ(checker.resolution, 0.01);
  EXPECT_EQ(checker.trees.fit, "vertices");
  EXPECT_EQ(c.runs, 7u);
  EXPECT_EQ(c.seed, 3u);
  EXPECT_EQ(c.time, 2.5);
  EXPECT_EQ(c.limits.memory, 512);
  EXPECT_EQ(c.simplify, Simplifier::none);
  EXPECT_FALSE(c.verify);
  const Problem planned = problemOfRun(c, cellsOf(c)[0], 9);
  EXPECT_EQ(planned.settings.simplify, Simplifier::none);
  EXPECT_EQ(problemOfRun(c, cellsOf(c)[8], 9).settings.simplify, Simplifier::none);
  ASSERT_EQ(cellsOf(c)[10].planner.name, "PRM");
  EXPECT_EQ(problemOfRun(c, cellsOf(c)[10], 9).settings.simplify, Simplifier::ompl);
  EXPECT_EQ(planned.settings.planner.time, 2.5);
  EXPECT_EQ(planned.settings.seed, 9u);
}

/// A short file with many lists could describe more variants than memory or time allow.
TEST_F(CampaignYaml, CombinationsHaveALimit) {
  const auto list = [](int count) {
    std::string text = "[";
    for (int i = 1; i <= count; ++i) text += (i > 1 ? ", 0." : "0.") + std::to_string(1000 + i);
    return text + "]";
  };
  const auto checkers = [&](int a, int b) {
    return std::string(kStart) + "checkers:\n  mine: {resolution: " + list(a) +
           ", tolerance: " + list(b) + "}\n  other: {}\n";
  };
  EXPECT_EQ(read(checkers(27, 37)).variants.size(), 1000u);
  for (const auto& [a, b, line] : {std::tuple(40, 25, 5), std::tuple(40, 26, 4)}) try {
      read(checkers(a, b));
      ADD_FAILURE() << a << ", " << b;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("more than 1000 variants"));
      EXPECT_EQ(error.faults().front().line, line);
    }
  std::string many = std::string(kStart) + "checkers: {mine: {";
  for (const char* key : {"edges", "resolution", "tolerance", "volume", "fit", "overlap", "build"})
    many += std::string(key) + ": " + list(100) + ", ";
  EXPECT_THROW(read(many + "peer: fcl}}\n"), InputError);
}

TEST_F(CampaignYaml, NamesMustBeOneLine) {
  for (const char* wrong : {"checkers: {\"a\\nb\": {}}\n", "checkers: {\"\": {}}\n",
                            "checkers: {a: {}}\nplanners: [{name: RRT, label: \"x\\ty\"}]\n"})
    EXPECT_THROW(read(kStart + std::string(wrong)), InputError) << wrong;
}

TEST_F(CampaignYaml, UnknownSimplifiers) {
  EXPECT_THAT(faults(std::string(kStart) + "checkers: {a: {}}\nsimplify: fast\n"
                                           "planners: [{name: RRT, simplify: omlp}]\n"),
              ElementsAre("c.yaml:4: simplify: one of true, false, ompl is needed, not \"fast\"",
                          "c.yaml:5: planners[].simplify: one of true, false, ompl is needed, not "
                          "\"omlp\" (did you mean \"ompl\"?)"));
}

TEST_F(CampaignYaml, MemoryHasARange) {
  for (const char* wrong : {"1.0e-300", "0.5", "1.0e+300"})
    EXPECT_THROW(
        read(std::string(kStart) + "checkers: {a: {}}\nlimits: {memory_mb: " + wrong + "}\n"),
        InputError)
        << wrong;
}

/// `runs` and `seed` have ranges of their own, and a bad value is reported exactly once.
TEST_F(CampaignYaml, RunsAndSeedsHaveRanges) {
  const std::string start = std::string(kStart) + "checkers: {a: {}}\n";
  for (const std::string wrong :
       {"-2", "1.5", "0", "1000001", "1e3", "many", "99999999999999999999"})
    EXPECT_THAT(faults(start + "runs: " + wrong + "\n"),
                ElementsAre("c.yaml:4: runs: a whole number from 1 to 1,000,000 is needed, not \"" +
                            wrong + "\""));
  for (const std::string wrong : {"-1", "1.5", "0", "4294967296"})
    EXPECT_THAT(faults(start + "seed: " + wrong + "\n"),
                ElementsAre("c.yaml:4: seed: a whole number from 1 to 2^32 - 1 is needed, not \"" +
                            wrong + "\""));
  EXPECT_EQ(read(start + "runs: 1000000\nseed: 4294967295\n").runs, 1'000'000u);
  EXPECT_EQ(read(start + "seed: 4294967295\n").seed, 0xffffffffu);
}

TEST_F(CampaignYaml, Defaults) {
  const Campaign c = read(std::string(kStart) + "checkers: {mine: {}}\n");
  EXPECT_THAT(c.planners, IsEmpty());
  EXPECT_EQ(c.runs, 10u);
  EXPECT_EQ(c.seed, 1u);
  EXPECT_FALSE(c.time);
  EXPECT_FALSE(c.simplify);
  EXPECT_TRUE(c.verify);
  EXPECT_EQ(cellsOf(c).size(), 1u);
  EXPECT_EQ(cellsOf(c)[0].planner.name, "RRTConnect");
}

/// FCL is used if it is installed. Otherwise it is left out, with a note.
TEST_F(CampaignYaml, Competitors) {
  const Campaign c = read(std::string(kStart) +
                          "checkers: {fcl: {peer: fcl, edges: discrete, resolution: [0.1, 0.2]}, "
                          "ours: {edges: discrete}}\n");
  if (whyUnavailable("fcl").empty()) {
    EXPECT_THAT(variants(c), ElementsAre("fcl 0.1", "fcl 0.2", "ours"));
    EXPECT_TRUE(c.variants[0].competitor.has_value());
    EXPECT_THAT(c.notes, IsEmpty());
  } else {
    EXPECT_THAT(variants(c), ElementsAre("ours"));
    ASSERT_EQ(c.notes.size(), 2u);
    EXPECT_THAT(c.notes[0], HasSubstr("fcl 0.1 is left out: fcl is not available: "));
  }
  EXPECT_THAT(
      faults(std::string(kStart) + "checkers: {x: {peer: fclo}}\n"),
      ElementsAre("c.yaml:3: checkers.x.peer: unknown competitor \"fclo\" (did you mean \"fcl\"?); "
                  "there are: fcl"));
  EXPECT_THAT(faults(std::string(kStart) + "checkers: {x: {peer: fcl}}\n"),
              ElementsAre("c.yaml:3: checkers.x.peer: fcl tests states only; set edges: discrete"));
}

TEST_F(CampaignYaml, AllFaultsAtOnceWithTheirLines) {
  EXPECT_THAT(
      faults("format: corridor-campaign-1\n"
             "problems: [hall.yaml, nothing.yaml]\n"
             "planer: [RRT]\n"
             "planners: [{label: x}]\n"
             "checkers:\n"
             "  a: {edges: certifed, resolution: [0.1, 2]}\n"
             "  b: certified\n"
             "  c: {resolution: []}\n"
             "  d: {knob: 1}\n"
             "runs: 0\n"
             "limits: {time: -1, memory: 5}\n"),
      ElementsAre(
          "c.yaml:2: problems: no such file or folder: nothing.yaml",
          HasSubstr("c.yaml:3: unknown key \"planer\" (did you mean \"planners\"?)"),
          "c.yaml:4: missing key \"name\" in planners[]: OMPL's name of a planner, such as "
          "RRTConnect",
          HasSubstr("c.yaml:6: checkers.a.edges: "), HasSubstr("c.yaml:6: checkers.a.resolution: "),
          "c.yaml:7: checkers.b: a map is needed, such as {edges: certified}, not \"certified\"",
          "c.yaml:8: checkers.c.resolution: a list must have one or more single values",
          HasSubstr("c.yaml:9: unknown key \"knob\" in checkers.d"),
          "c.yaml:10: runs: a whole number from 1 to 1,000,000 is needed, not \"0\"",
          HasSubstr("c.yaml:11: unknown key \"memory\" in limits (did you mean \"memory_mb\"?)"),
          HasSubstr("c.yaml:11: limits.time: ")));
  EXPECT_THAT(
      faults("format: corridor-campaign-1\n"),
      ElementsAre(HasSubstr("missing key \"problems\""), HasSubstr("missing key \"checkers\"")));
  EXPECT_THAT(faults("format: corridor-problem-1\n"),
              ElementsAre("c.yaml:1: format: corridor-campaign-1 is needed here, not "
                          "\"corridor-problem-1\""));
  EXPECT_THAT(faults(std::string(kStart) + "checkers: {}\n"),
              ElementsAre("c.yaml:3: checkers: at least one is needed"));
  EXPECT_THAT(faults("format: corridor-campaign-1\nproblems: []\ncheckers: {a: {}}\n"),
              ElementsAre("c.yaml:2: problems: at least one is needed"));
  EXPECT_THAT(faults(std::string(kStart) + "planners: []\ncheckers: {a: {}}\n"),
              ElementsAre("c.yaml:3: planners: at least one is needed; without this key each "
                          "problem uses its own"));
}

/// If a key has no effect, a list of its values would give the same variant several times.
TEST_F(CampaignYaml, VariantsDiffer) {
  const auto of = [&](const char* checker) {
    return faults(std::string(kStart) + "checkers:\n  a: " + checker + "\n");
  };
  EXPECT_THAT(of("{edges: certified, resolution: [0.1, 0.01]}"),
              ElementsAre("c.yaml:4: checkers.a: \"a 0.1\" and \"a 0.01\" would be the same "
                          "checker: what differs has no effect"));
  EXPECT_THAT(of("{edges: [certified, discrete], resolution: [0.1, 0.01]}"),
              ElementsAre(HasSubstr("\"a certified 0.1\" and \"a certified 0.01\"")));
  EXPECT_THAT(of("{edges: discrete, tolerance: [0.1, 0.01]}"), SizeIs(1));
  EXPECT_THAT(of("{volume: [aabb, aabb]}"), SizeIs(1));
  EXPECT_THAT(of("{edges: discrete, resolution: [0.1, 0.01], volume: [aabb, sphere]}"), IsEmpty());
  EXPECT_THAT(of("{edges: [certified, adaptive], tolerance: [0.1, 0.01]}"), IsEmpty());
  EXPECT_THAT(of("{resolution: [0.1, 0.01]}"),
              IsEmpty());  // no fault: the problem's edges may be discrete
}

/// Each faulty planner is reported with its own line, along with all other faults.
TEST_F(CampaignYaml, FaultsOfPlannersHaveTheirLines) {
  const std::string start = std::string(kStart) + "checkers: {a: {}}\nplanners:\n";
  EXPECT_THAT(
      faults(start + "  - RRT\n  - RRTConect\n  - label: mine\n    name: PMR\nruns: 0\n"),
      ElementsAre(
          HasSubstr("c.yaml:6: planners: unknown planner \"RRTConect\" (did you mean "
                    "\"RRTConnect\"?); there are: RRTConnect, SlidingConnect, Portfolio, RRT, "),
          HasSubstr("c.yaml:7: planners: unknown planner \"PMR\" (did you mean "
                    "\"PRM\"?)"),
          HasSubstr("c.yaml:9: runs: ")));
  const auto checked = [&](const std::string& planners) -> std::string {
    const Campaign campaign = read(start + planners);
    try {
      checkCampaign(campaign);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(checked("  - RRT\n  - PRM\n  - RRT\n"),
              testing::EndsWith("c.yaml:7: planners: \"RRT\" is named twice"));
  const std::string wrong = checked(
      "  - RRT\n  - {name: RRT, label: a, params: {rnge: 1}}\n"
      "  - {name: RRT, label: b, params: {range: far}}\n");
  EXPECT_THAT(wrong, HasSubstr("c.yaml:6: planners: RRT has no parameter \"rnge\""));
  EXPECT_THAT(wrong,
              HasSubstr("c.yaml:7: planners: RRT's parameter range: \"far\" is not a number"));
  EXPECT_EQ(checked("  - RRT\n  - {name: RRT, label: a, params: {range: 1}}\n"), "");
}

TEST_F(CampaignYaml, FaultsOfProblemsAreReported) {
  write("hall.yaml", "format: corridor-problem-1\nrobbot: robot.yaml\n");
  EXPECT_THAT(faults(std::string(kStart) + "checkers: {a: {}}\n"),
              testing::Contains(HasSubstr("hall.yaml:2: unknown key \"robbot\"")));
}

TEST_F(CampaignYaml, RecognisesCampaignFiles) {
  write("c.yaml", kStart);
  write("newer.yaml", "format: corridor-campaign-2\n");
  write("broken.yaml", "format: [corridor-campaign-1\n");
  EXPECT_TRUE(isCampaignFile(folder_ / "c.yaml"));
  // Reading it then reports the unknown format.
  EXPECT_TRUE(isCampaignFile(folder_ / "newer.yaml"));
  write("bare.yaml", "problems: [hall.yaml]\ncheckers: {a: {}}\n");
  EXPECT_TRUE(isCampaignFile(folder_ / "bare.yaml"));
  for (const char* name : {"hall.yaml", "broken.yaml", "nothing.yaml", "."})
    EXPECT_FALSE(isCampaignFile(folder_ / name)) << name;
}

}  // namespace
}  // namespace corridor
