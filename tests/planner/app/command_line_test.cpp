// Tests of what all commands of the program share: usage faults, help, results on stdout, exit
// statuses.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;

using CommandLine = corridor::test::CubeTest;

/// If the reader has wrapped an angle, not only `inspect`, but also `check` and `solve` must report
/// it.
TEST_F(CommandLine, ReportsWrappedAngles) {
  write("arm.urdf",
        "<robot name='arm'><link name='a'/><link name='b'><collision><geometry><box size='1 1 1'/>"
        "</geometry></collision></link><joint name='pan' type='continuous'><parent link='a'/>"
        "<child link='b'/><axis xyz='0 0 1'/></joint></robot>");
  write("arm.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {box: [1, 1, 1], at: [5, 0, "
        "0]}\nstart: {pan: -60}\ngoal: {pan: 0}\n");
  for (const char* command : {"check", "solve", "inspect"}) {
    const Result result = run(command + std::string(" arm.yaml"));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("note: start.pan: -60 is read as 2.83185307179586"))
        << command;
    if (command == std::string("inspect")) continue;
    const Result json = run(command + std::string(" arm.yaml --json"));
    EXPECT_THAT(json.out, HasSubstr("start.pan: -60 is read as 2.83185307179586")) << command;
  }
}

TEST_F(CommandLine, JsonIsVersionedAndComplete) {
  const auto solved = nlohmann::json::parse(run("solve problem.yaml --json -o s.yaml").out);
  EXPECT_EQ(solved["format"], "corridor-solve-report-2");
  EXPECT_EQ(solved["problems"][0]["result"], "solved");
  EXPECT_EQ(solved["problems"][0]["certified"], true);
  EXPECT_EQ(nlohmann::json::parse(run("verify problem.yaml s.yaml --json").out)["verdict"],
            "proved");
  const auto mesh = nlohmann::json::parse(run("inspect cube.obj --json --self-intersections").out);
  EXPECT_EQ(mesh["mesh"]["self_intersections"], nlohmann::json::array());
  EXPECT_EQ(mesh["mesh"]["triangles"], 12);
  EXPECT_EQ(mesh["mesh"]["watertight"], true);
  EXPECT_GT(mesh["tree"]["nodes"], 1);
  EXPECT_GE(mesh["tree"]["binary_depth"], 4);  // twelve leaves need four levels
  EXPECT_EQ(nlohmann::json::parse(run("inspect problem.yaml --json").out)["pairs"]["tested"], 1);
}

/// Opening a pipe waits for a reader. One signal ends the program.
TEST_F(CommandLine, OutputToAPipeWithoutAReader) {
  EXPECT_EQ(run("solve problem.yaml -o pipe", "mkfifo pipe; timeout -k 20 1 ").status, 124);
}

TEST_F(CommandLine, TooFewDescriptors) {
  const Result result = run("benchmark problem.yaml --runs 1 --time 1 -o r",
                            "bash -c 'ulimit -S -n 5; exec \"$0\" \"$@\"' ");
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("; raise the limit on open files (ulimit -n)\n"));
}

/// planner/app/highway_timer.cpp
TEST_F(CommandLine, HighwayMeasuresNoTimer) {
  const std::string bindings = run("--version", "LD_DEBUG=bindings ").err;
  EXPECT_THAT(bindings, testing::ContainsRegex("libhwy.* to [^ ]*/corridor .*TimerResolution"));
  EXPECT_THAT(bindings, testing::Not(testing::ContainsRegex("to [^ ]*libhwy.*TimerResolution")));
}

TEST_F(CommandLine, BadUsageIsExit2) {
  for (const char* arguments :
       {"", "sove problem.yaml", "solve", "solve problem.yaml --edges sampled",
        "solve problem.yaml --time -1", "solve problem.yaml --time nan",
        "solve problem.yaml --time inf", "solve problem.yaml --seed -1",
        "solve problem.yaml --no-such"})
    EXPECT_EQ(run(arguments).status, 2) << arguments;
}

TEST_F(CommandLine, BadUsageIsOneLine) {
  const auto said = [&](const std::string& arguments) { return run(arguments).err; };
  EXPECT_EQ(said(""), "A subcommand is required; see corridor --help\n");
  EXPECT_EQ(said("slove problem.yaml"),
            "unknown command \"slove\" (did you mean \"solve\"?); there are: solve, verify, "
            "view, benchmark, check, inspect, pose, query, course, new, cache\n");
  EXPECT_EQ(said("verify problem.yaml"), "FILE is required; see corridor verify --help\n");
  for (const char* time : {"0", "-1", "nan", "inf", "20s"})
    EXPECT_EQ(said(std::string("solve problem.yaml --time ") + time),
              std::string("--time: a number of seconds above 0 is needed, not \"") + time +
                  "\"; see corridor solve --help\n");
  for (const char* seed : {"-1", "1.5", "abc", "18446744073709551616"})
    EXPECT_EQ(said(std::string("solve problem.yaml --seed ") + seed),
              std::string("--seed: a whole number from 0 to 2^64 - 1 is needed, not \"") + seed +
                  "\"; see corridor solve --help\n");
  EXPECT_EQ(run("solve problem.yaml --seed 0").status, 0);
}

/// CLI11's own messages would name the option at the end, or not at all.
TEST_F(CommandLine, ReportsUnknownWordsAndOptions) {
  const auto fault = [&](const std::string& arguments, const std::string& message) {
    expectFault(arguments,
                message + "; see corridor " + arguments.substr(0, arguments.find(' ')) + " --help");
  };
  fault("solve problem.yaml --stopp first",
        "unknown option \"--stopp\" (did you mean \"--stop\"?)");
  fault("solve problem.yaml --tme=3", "unknown option \"--tme\" (did you mean \"--time\"?)");
  fault("verify problem.yaml s.yaml more.yaml", "unexpected word \"more.yaml\"");
  fault("solve problem.yaml -- more.yaml", "unexpected word \"more.yaml\"");
  expectFault("--tme=3 solve problem.yaml",
              "unknown option \"--tme\" (did you mean \"--time\"?); see corridor solve --help");
  expectFault("more solve problem.yaml", "unexpected word \"more\"; see corridor solve --help");
  fault("solve problem.yaml --time 1 --time 2", "--time is given 2 times; once is enough");
  fault("solve problem.yaml -o a.yaml -o a.yaml", "--output is given 2 times; once is enough");
  fault("solve problem.yaml -o ''", "--output: is empty");
  fault("solve ''", "PROBLEM: is empty");
  fault("solve problem.yaml --edges certifed",
        "--edges: one of certified, adaptive, advancement, discrete is needed, not \"certifed\" "
        "(did you mean \"certified\"?)");
  fault("solve problem.yaml --stop frist",
        "--stop: one of first, time is needed, not \"frist\" (did you mean \"first\"?)");
  fault("inspect cube.obj --unit inch", "--unit: one of m, cm, mm, in is needed, not \"inch\"");
  for (const char* edges : {"certified", "adaptive"})
    expectFault(std::string("solve problem.yaml --resolution 0.1 --edges ") + edges,
                std::string("--resolution: needs --edges discrete, and edges are ") + edges);
  expectFault("solve problem.yaml --set range=1 --set range=2", "--set: \"range\" is set twice");
  EXPECT_EQ(run("solve problem.yaml --quiet --quiet").status, 0);
}

/// If results are lost on a full disk, the exit status must not be 0.
TEST_F(CommandLine, ReportsLostOutput) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  write("poses.txt", "1 0 0 0 1 0 0 0 1 0 0 0\n");
  for (const char* command : {"solve problem.yaml", "check problem.yaml --json", "inspect cube.obj",
                              "query cube.obj wall.obj --poses poses.txt",
                              "benchmark problem.yaml --variants certified --runs 1"}) {
    const Result result = run(command + std::string(" >/dev/full 2>stderr.txt; exit $?;"));
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(read("stderr.txt"),
                testing::EndsWith("standard output: can't be written, or not all of it\n"))
        << command;
  }
  EXPECT_EQ(run("solve problem.yaml --quiet >/dev/full; exit $?;").status, 0);
}

TEST_F(CommandLine, HelpHasExamplesAndExitStatus) {
  for (const char* command :
       {"solve", "verify", "check", "inspect", "pose", "query", "benchmark"}) {
    const Result help = run(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr(std::string("Example: corridor ") + command));
    EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done; 1 no"));
  }
}

}  // namespace
