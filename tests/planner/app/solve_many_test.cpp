// Tests of the program `corridor solve` with several problems, and with several tries.
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class SolveMany : public corridor::test::ArmTest {
 protected:
  /// Writes a set of MotionBenchMaker that has problems with these indices.
  void writeSet(const std::string& name, const std::vector<int>& indices) {
    write("arm.srdf", "<robot name=\"arm\"/>\n");
    json set = {{"format", "mbm-scene-1"},
                {"urdf", "arm.urdf"},
                {"srdf", "arm.srdf"},
                {"joint_names", {"shoulder", "elbow"}},
                {"problems", json::array()}};
    for (const int index : indices)
      set["problems"].push_back({{"index", index},
                                 {"start", {0, 0}},
                                 {"goals", {{2.8, 0.1 * index}}},
                                 {"objects",
                                  {{{"id", "post"},
                                    {"type", "sphere"},
                                    {"position", {0, 1.5, 0}},
                                    {"orientation_xyzw", {0, 0, 0, 1}},
                                    {"radius", 0.1}}}}});
    write(name, set.dump());
  }
  /// Closes the gap beside the wall, so that problem.yaml has no solution.
  void closeWall() {
    write("wall.obj", "v 0 -5 -5\nv 0 5 -5\nv 0 5 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
  }
  /// Runs the program, and after some seconds a command of the shell; $pid is the program.
  Result runAndSignal(const std::string& arguments, double seconds, const std::string& command) {
    return run(arguments + " & pid=$!; sleep " + std::to_string(seconds) + "; " + command +
               "; wait $pid; exit $?;");
  }
  std::vector<std::string> filesIn(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / folder))
      names.insert(entry.path().filename().string());
    return {names.begin(), names.end()};
  }
  static std::vector<json> linesOf(const std::string& text) {
    std::vector<json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
    return lines;
  }
};

TEST_F(SolveMany, ExitsWithTheWorstStatus) {
  EXPECT_EQ(run("solve problem.yaml problem.yaml --quiet").status, 0);
  const Result result = run("solve problem.yaml none.yaml arm.yaml");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, StartsWith("none.yaml: "));
  EXPECT_THAT(result.out, HasSubstr("\narm: solved, "));
  EXPECT_THAT(result.out, HasSubstr("\nnone: bad input: none.yaml: "));
  EXPECT_THAT(result.out, HasSubstr("\nproblems: 2 of 3 solved, 2 certified\n"));
  EXPECT_THAT(result.out, testing::ContainsRegex("  medians: reading [0-9.]+ ms, set-up "));
  EXPECT_EQ(run("solve problem.yaml none.yaml --quiet").out, "");
  EXPECT_EQ(run("solve problem.yaml arm.yaml --planner RRT --time 1e-9 --quiet").status, 1);
}

TEST_F(SolveMany, SaysWhereTargetsAreMissed) {
  write("short.yaml", read("arm.yaml") + "prefer: {clearance: 0.3, detour: 0}\n");
  const Result result = run("solve arm.yaml short.yaml");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, testing::ContainsRegex("\nshort: solved, .* mm \\(targets kept on "
                                                 "[0-9.]+ % of the length\\), certified"));
  EXPECT_THAT(result.out, testing::ContainsRegex("arm: solved, .*, clearance [0-9.]+ mm, cert"));
}

TEST_F(SolveMany, TrajectoriesInAFolder) {
  const Result result = run("solve problem.yaml arm.yaml --trajectory made -o solved");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, testing::ContainsRegex("\narm: solved, .*, trajectory of [0-9.]+ s, "));
  EXPECT_THAT(result.out, testing::ContainsRegex("  medians: .*, trajectory [0-9.]+ ms"));
  EXPECT_THAT(filesIn("made"), ElementsAre("arm.csv", testing::StartsWith("corridor_test")));
  EXPECT_EQ(run("verify arm.yaml made/arm.csv").status, 0);
  expectFault("solve problem.yaml arm.yaml --trajectory made.csv",
              "--trajectory: names one file, but there are 2 problems; name a folder");
  // A trajectory that can't be made is not a success.
  const Result none =
      run("solve problem.yaml arm.yaml --trajectory made --rate 1 --deviation 1e-9");
  EXPECT_EQ(none.status, 1) << none.err;
  EXPECT_THAT(none.out, HasSubstr("trajectory"));
}

TEST_F(SolveMany, ARangeOfASet) {
  writeSet("set.json", {1, 2, 3, 5});
  const Result result = run("solve set.json#1-3 -o out --picture pictures --jobs 2 --json");
  ASSERT_EQ(result.status, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["format"], "corridor-solve-report-2");
  ASSERT_EQ(report["problems"].size(), 3u);
  for (int i = 0; i < 3;
       ++i) {  // results are in the order of the problems, whichever was solved first
    EXPECT_EQ(report["problems"][i]["problem"], "set.json#" + std::to_string(i + 1));
    EXPECT_EQ(report["problems"][i]["result"], "solved");
  }
  EXPECT_THAT(filesIn("out"),
              ElementsAre("set-1.solution.yaml", "set-2.solution.yaml", "set-3.solution.yaml"));
  EXPECT_THAT(filesIn("pictures"), ElementsAre("set-1.svg", "set-2.svg", "set-3.svg"));
  EXPECT_EQ(run("verify 'set.json#2' out/set-2.solution.yaml").status, 0);
  // Each path equals that of a call with this problem alone.
  EXPECT_EQ(run("solve 'set.json#3' -o alone.yaml --quiet").status, 0);
  EXPECT_EQ(read("alone.yaml").substr(read("alone.yaml").find("path:")),
            read("out/set-3.solution.yaml").substr(read("out/set-3.solution.yaml").find("path:")));
  // A gap in the indices is no fault.
  EXPECT_EQ(json::parse(run("solve set.json#2-5 --json").out)["problems"].size(), 3u);
  // A range of one problem is a range: its results have the same form.
  EXPECT_EQ(run("solve set.json#5-5 -o one --quiet").status, 0);
  EXPECT_THAT(filesIn("one"), ElementsAre("set-5.solution.yaml"));
}

/// One process solves one problem after the other.
TEST_F(SolveMany, NoPathDependsOnEarlierProblems) {
  writeSet("set.json", {1, 2, 3});
  const auto pathIn = [&](const std::string& file) {
    return read(file).substr(read(file).find("path:"));
  };
  for (const std::string seed : {"0", "1", "7"}) {
    const std::string options = " --seed " + seed + " --quiet -o ";
    EXPECT_EQ(run("solve 'set.json#1' none.yaml 'set.json#2-3'" + options + "out").status, 2);
    for (const std::string number : {"1", "2", "3"}) {
      EXPECT_EQ(run("solve 'set.json#" + number + "'" + options + "alone.yaml").status, 0);
      EXPECT_EQ(pathIn("alone.yaml"), pathIn("out/set-" + number + ".solution.yaml"));
    }
  }
}

TEST_F(SolveMany, AFolderOfFolders) {
  for (const char* name : {"b", "a"}) {
    for (const char* all : {"all/", "more/"})
      std::filesystem::create_directories(folder_ / (std::string(all) + name));
    write(std::string("all/") + name + "/problem.yaml",
          "format: corridor-problem-1\nrobot: ../../arm.urdf\nworld: {post: {sphere: 0.1, at: [0, "
          "1.5, 0]}}\nstart: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
    write(std::string("more/") + name + "/problem.yaml", read("all/a/problem.yaml") + "seed: 2\n");
  }
  write("all/notes.txt", "");
  const Result result = run("solve all more/a --json-lines -o out/solutions");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<json> lines = linesOf(result.out);
  ASSERT_EQ(lines.size(), 3u);
  for (const json& line : lines) EXPECT_EQ(line["result"], "solved");
  EXPECT_EQ(lines[0]["problem"], "all/a");
  // Two problems have the name a, so the names of the folders above their folders are added.
  EXPECT_THAT(filesIn("out/solutions"),
              ElementsAre("all-a.solution.yaml", "b.solution.yaml", "more-a.solution.yaml"));
  EXPECT_THAT(run("solve sub").err, HasSubstr("sub: "));
}

TEST_F(SolveMany, OneLineForASingleProblem) {
  const std::vector<json> lines = linesOf(run("solve arm.yaml --json-lines").out);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["result"], "solved");
}

TEST_F(SolveMany, RefusesWhatCantBe) {
  writeSet("set.json", {1, 2, 3});
  for (const auto& [arguments, complaint] :
       std::initializer_list<std::pair<const char*, const char*>>{
           {"set.json#3-1",
            "set.json: \"#3-1\" is not a range of 1 to 1000 problems, such as #1-10\n"},
           {"set.json#2-9",
            "set.json#2-9: the set has no problem #9; its indices are from 1 to 3\n"},
           {"set.json#0-2",
            "set.json#0-2: the set has no problem #0; its indices are from 1 to 3\n"},
           {"set.json#1-2 -o one.yaml",
            "--output: names one file, but there are 2 problems; name a folder\n"},
           {"set.json#1-2 -o -",
            "--output: names one file, but there are 2 problems; name a folder\n"},
           {"set.json#1-2 -o arm.urdf",
            "--output: names one file, but there are 2 problems; name a folder\n"},
           {"set.json#1-2 --picture one.svg",
            "--picture: names one file, but there are 2 problems; name a folder\n"},
           {"set.json#1-2 -o arm.urdf/sub",
            "--output: the folder arm.urdf/sub can't be made: Not a directory\n"},
           {"set.json#1-2 --jobs 0",
            "--jobs: a whole number from 1 to 1024 is needed, not \"0\"; see corridor solve "
            "--help\n"},
           {"set.json#1-2 --tries 0",
            "--tries: a whole number from 1 to 1000000 is needed, not \"0\"; see corridor solve "
            "--help\n"},
           {"arm.yaml --keep best",
            "--keep: one of shortest, clearest is needed, not \"best\"; see corridor solve "
            "--help\n"}}) {
    const Result result = run(std::string("solve ") + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.err, complaint) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one.yaml"));
}

TEST_F(SolveMany, AnInterruptEndsAllOfThem) {
  closeWall();
  const Result result =
      runAndSignal("solve arm.yaml problem.yaml problem.yaml --jobs 3 --time 60 -o out > lines.txt",
                   2.5, "kill -INT $pid");
  EXPECT_EQ(result.status, 130);
  EXPECT_THAT(read("lines.txt"), HasSubstr("arm: solved, "));
  EXPECT_THAT(read("lines.txt"), HasSubstr("problems: 1 of 1 solved, 1 certified\n"));
  EXPECT_THAT(filesIn("out"), ElementsAre("arm.solution.yaml"));
}

TEST_F(SolveMany, ACrashCostsItsProblemOnly) {
  if (!std::filesystem::exists("/proc/thread-self/children"))
    GTEST_SKIP() << "this kernel does not list the children of a process";
  closeWall();
  const Result result =
      runAndSignal("solve arm.yaml problem.yaml arm.yaml --time 60 -o out > lines.txt", 2.5,
                   "kill -ABRT $(cut -d' ' -f1 /proc/$pid/task/$pid/children)");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(read("lines.txt"), HasSubstr(": failed: killed by signal 6"));
  EXPECT_THAT(read("lines.txt"), HasSubstr("problems: 2 of 3 solved, 2 certified\n"));
  EXPECT_THAT(filesIn("out"), ElementsAre("arm-2.solution.yaml", "arm.solution.yaml"));
}

TEST_F(SolveMany, ReplacesSolutionsOnly) {
  std::filesystem::create_directories(folder_ / "out");
  EXPECT_EQ(run("solve arm.yaml problem.yaml -o out --quiet").status, 0);
  EXPECT_EQ(run("solve arm.yaml problem.yaml -o out --quiet").status, 0);
  write("out/arm.solution.yaml", "my notes\n");
  const Result refused = run("solve arm.yaml problem.yaml -o out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.err,
            "--output: out/arm.solution.yaml exists, and is no solution; name another folder\n");
  EXPECT_EQ(read("out/arm.solution.yaml"), "my notes\n");
}

TEST_F(SolveMany, AnInterruptOfTriesKeepsTheBestPath) {
  const Result result = runAndSignal(
      "solve arm.yaml --tries 1000000 -o best.yaml --json > report.json", 1, "kill -INT $pid");
  EXPECT_EQ(result.status, 130);
  const json report = json::parse(read("report.json"))["problems"][0];
  EXPECT_EQ(report["result"], "solved");
  EXPECT_GT(report["tries"], 1);
  EXPECT_LT(report["tries"], 1000000);
  EXPECT_EQ(run("verify arm.yaml best.yaml").status, 0);
}

TEST_F(SolveMany, TriesKeepTheShortestOrTheClearest) {
  double shortest = 1e9, clearest = 0;
  for (int seed = 4; seed < 8; ++seed) {
    const json one =
        json::parse(run("solve arm.yaml --json --seed " + std::to_string(seed)).out)["problems"][0];
    double length = 0;  // the length of the path, by the distance of the configuration space
    for (std::size_t i = 1; i < one["path"]["rows"].size(); ++i) {
      const auto &a = one["path"]["rows"][i - 1], &b = one["path"]["rows"][i];
      length += std::hypot(b[0].get<double>() - a[0].get<double>(),
                           b[1].get<double>() - a[1].get<double>());
    }
    if (length < shortest) shortest = length;
    clearest = std::max(clearest, one["clearance"]["proved_clearance_m"].get<double>());
  }
  const auto kept = [&](const std::string& options) {
    return json::parse(
        run("solve arm.yaml --json --seed 4 --tries 4 -o s.yaml " + options).out)["problems"][0];
  };
  const json best = kept(""), clear = kept("--keep clearest");
  EXPECT_EQ(best["tries"], 4);
  double length = 0;
  for (std::size_t i = 1; i < best["path"]["rows"].size(); ++i) {
    const auto &a = best["path"]["rows"][i - 1], &b = best["path"]["rows"][i];
    length += std::hypot(b[0].get<double>() - a[0].get<double>(),
                         b[1].get<double>() - a[1].get<double>());
  }
  EXPECT_EQ(length, shortest);
  EXPECT_EQ(clear["clearance"]["proved_clearance_m"], clearest);
  // A new call with the reported seed must give the same path.
  const json again =
      json::parse(run("solve arm.yaml --json --seed " + std::to_string(best["seed"].get<int>()))
                      .out)["problems"][0];
  EXPECT_EQ(again["path"]["rows"], best["path"]["rows"]);
}

TEST_F(SolveMany, TriesWithAPlannerThatDoesNotRepeatAreNoted) {
  const Result result = run("solve arm.yaml --planner PRM --stop first --tries 2");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("note: the planner does not repeat"));
}

}  // namespace
