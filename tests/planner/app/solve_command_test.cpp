// Tests of the program `corridor solve`.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

using SolveCommand = corridor::test::CubeTest;
using SolveArm = corridor::test::ArmTest;

TEST_F(SolveCommand, SolveThenVerify) {
  const Result solved = run("solve problem.yaml -o s.yaml --picture p.svg");
  EXPECT_EQ(solved.status, 0) << solved.err;
  EXPECT_THAT(solved.out, HasSubstr("result: solved\n"));
  EXPECT_THAT(solved.out, HasSubstr("certified: yes\n"));
  EXPECT_THAT(solved.out, testing::ContainsRegex("path length: [0-9.]+ m, turning [0-9.]+ rad\n"));
  EXPECT_EQ(solved.err, "");
  EXPECT_THAT(read("p.svg"), StartsWith("<svg"));
  EXPECT_LT(std::filesystem::file_size(folder_ / "p.svg"), 400'000u);
  const Result verified = run("verify problem.yaml s.yaml");
  EXPECT_EQ(verified.status, 0) << verified.err << verified.out;
  EXPECT_THAT(verified.out, HasSubstr("verdict: proved\n"));
  EXPECT_THAT(verified.out, HasSubstr("clearance: proved: "));
}

TEST_F(SolveArm, SolveThenVerify) {
  const Result solved = run("solve arm.yaml -o s.yaml --picture p.svg");
  EXPECT_EQ(solved.status, 0) << solved.err;
  EXPECT_THAT(solved.out, HasSubstr("certified: yes\n"));
  EXPECT_THAT(solved.out,
              testing::ContainsRegex("path length: [0-9.]+ rad \\(sum over the joints\\)\n"));
  EXPECT_THAT(read("s.yaml"), HasSubstr("joints: [\"shoulder\", \"elbow\"]\n"));
  EXPECT_THAT(read("p.svg"), StartsWith("<svg"));
  const Result verified = run("verify arm.yaml s.yaml");
  EXPECT_EQ(verified.status, 0) << verified.err << verified.out;
  write("s.yaml",
        "format: corridor-solution-1\njoints: [shoulder, elbow]\npath: [[0, 0], [2.8, 0.5]]\n");
  const Result refuted = run("verify arm.yaml s.yaml");
  EXPECT_EQ(refuted.status, 1);
  EXPECT_THAT(refuted.out, HasSubstr("\"lower\" and \"post\""));
  EXPECT_THAT(refuted.out, HasSubstr("; at shoulder = "));
}

TEST_F(SolveArm, WritesTheSolutionToStandardOutput) {
  const Result solved = run("solve arm.yaml -o -");
  EXPECT_EQ(solved.status, 0) << solved.err;
  EXPECT_THAT(solved.out, StartsWith("# "));
  write("piped.yaml", solved.out);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "-"));
  EXPECT_THAT(run("verify arm.yaml piped.yaml").out, HasSubstr("verdict: proved\n"));
  EXPECT_THAT(run("solve arm.yaml --picture -").out, StartsWith("<svg"));
  const Result none = run("solve arm.yaml -o - --planner RRT --time 1e-9");
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.out, "");
  EXPECT_THAT(none.err, HasSubstr("not found"));
  EXPECT_EQ(run("solve arm.yaml -o - --json").err,
            "--output: the standard output has the report of --json already; name a file\n");
  EXPECT_EQ(run("solve arm.yaml -o - --picture -").err,
            "--picture: the standard output has the solution already\n");
  EXPECT_EQ(run("solve arm.yaml --picture a.png").status, 0);
  EXPECT_THAT(read("a.png"), StartsWith("\x89PNG"));
  const Result ompl = run("solve arm.yaml -o one.path");
  EXPECT_EQ(ompl.status, 2);
  EXPECT_EQ(ompl.err,
            "--output: one.path: solutions are written as YAML, so a name that ends in .yaml is "
            "needed; --trajectory writes CSV\n");
  EXPECT_THAT(run("solve arm.yaml --picture a.pdf").err,
              StartsWith("--picture: a.pdf: pictures are SVG or PNG, so a name that ends in"));
  const Result same = run("solve arm.yaml -o one --picture ./one");
  EXPECT_EQ(same.status, 2);
  EXPECT_EQ(same.err, "--picture: is the file of --output; name another one\n");
}

TEST_F(SolveArm, JsonHasThePathAndThePhases) {
  const Result solved = run("solve arm.yaml --json");
  const auto report = nlohmann::json::parse(solved.out)["problems"][0];
  EXPECT_EQ(report["numbers"], (std::vector<std::string>{"shoulder", "elbow"}));
  const auto rows = report["path"]["rows"].get<std::vector<std::vector<double>>>();
  ASSERT_EQ(rows.size(), report["path"]["states"].get<std::size_t>());
  EXPECT_EQ(rows.front(), (std::vector<double>{0, 0}));
  EXPECT_EQ(rows.back(), (std::vector<double>{2.8, 0.5}));
  double sum = 0;
  for (const char* const phase : {"set_up_s", "search_s", "simplify_s", "certify_s"}) {
    EXPECT_GE(report["phases"][phase], 0) << phase;
    sum += report["phases"][phase].get<double>();
  }
  EXPECT_NEAR(sum, report["time_s"], 1e-9);
  EXPECT_GE(report["phases"]["read_s"], 0);
  EXPECT_THAT(run("solve arm.yaml").out,
              testing::ContainsRegex(
                  "time: reading .* ms, set-up .* ms, search .* ms, simplification .* ms, "
                  "certification .* ms\n"));
}

/// The written trajectory is the one that was proved: `verify` proves it, and that it keeps its
/// limits, from both kinds of files.
TEST_F(SolveArm, WritesATrajectory) {
  for (const std::string file : {"t.csv", "t.yaml"}) {
    const Result solved = run("solve arm.yaml --trajectory " + file);
    EXPECT_EQ(solved.status, 0) << solved.err << solved.out;
    EXPECT_THAT(solved.out, testing::ContainsRegex("trajectory: [0-9.]+ s, [0-9]+ rows, cubic "
                                                   "between rows; [0-9]+ of [0-9]+ corners?"));
    EXPECT_THAT(solved.out, HasSubstr("trajectory proved: yes, as it is written\n"));
    EXPECT_THAT(solved.out, HasSubstr("limits: kept at every instant; velocity "));
    EXPECT_THAT(solved.out, HasSubstr("trajectory file: " + file + "\n"));
    const Result verified = run("verify arm.yaml " + file + " --limits");
    EXPECT_EQ(verified.status, 0) << verified.err << verified.out;
    EXPECT_THAT(verified.out, HasSubstr("limits over time: kept at every instant"));
  }
  const Result solved = run("solve arm.yaml --trajectory t.csv --rate 100 --json");
  const auto report = nlohmann::json::parse(solved.out)["problems"][0]["trajectory"];
  EXPECT_EQ(report["clearance"]["share_on_target"], 1);
  EXPECT_GT(report["clearance"]["proved_clearance_m"], 0);
  EXPECT_EQ(report["proved"], true);
  EXPECT_EQ(report["limits"], "kept");
  EXPECT_GE(report["rows"].get<double>(), 100 * report["duration_s"].get<double>());
  EXPECT_LE(report["acceleration_share"].get<double>(), 1);
}

/// A trajectory has two rows so close in time that velocities and accelerations exceed their
/// limits. The verdict on the path stays "proved", but `--limits` gives the exit status 1.
TEST_F(SolveArm, ExceededLimitsOfATrajectory) {
  write("fast.csv",
        "time,shoulder,elbow,shoulder_velocity,elbow_velocity\n0,0,0,0,0\n0.1,0.5,0.1,0,0\n");
  const Result verified = run("verify arm.yaml fast.csv");
  EXPECT_EQ(verified.status, 0) << verified.out;
  EXPECT_THAT(verified.out, HasSubstr("limits over time: exceeded; velocity 750"));
  EXPECT_EQ(run("verify arm.yaml fast.csv --limits").status, 1);
  EXPECT_THAT(run("verify arm.yaml fast.csv --json").out, HasSubstr("\"limits\": \"exceeded\""));
  write("path.csv", "shoulder,elbow\n0,0\n0.5,0.1\n");
  expectFault("verify arm.yaml path.csv --limits",
              "--limits: path.csv has no times, so it has no speed");
}

TEST_F(SolveArm, FaultsOfTrajectories) {
  expectFault("solve arm.yaml --trajectory t.txt",
              "--trajectory: a name that ends in .csv or .yaml is needed");
  expectFault("solve arm.yaml --rate 10", "--rate: needs --trajectory, which is not given");
  expectFault("solve arm.yaml --deviation 1e-3",
              "--deviation: needs --trajectory, which is not given");
  expectFault("solve arm.yaml arm.yaml --trajectory t.csv",
              "--trajectory: names one file, but there are 2 problems; name a folder");
  expectFault("solve arm.yaml -o t.yaml --trajectory t.yaml",
              "--trajectory: is the file of --output; name another one");
  expectFault("solve arm.yaml --trajectory none/t.csv", "--trajectory: there is no folder none");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "t.yaml"));
}

/// Joints may have any names: the joints' types decide whether a problem has a rigid body.
TEST_F(SolveArm, KeepsItsDistance) {
  const Result solved = run("solve arm.yaml -o s.yaml --json");
  ASSERT_EQ(solved.status, 0) << solved.err;
  const auto report = nlohmann::json::parse(solved.out)["problems"][0];
  const auto clearance = report["clearance"];
  const double proved = clearance["proved_clearance_m"];
  EXPECT_GT(proved, 0);
  EXPECT_LE(proved, 0.005);
  EXPECT_GT(clearance["share_on_target"], 0.5);
  EXPECT_THAT(read("s.yaml"), testing::ContainsRegex("\nclearance: 0\\.00[0-9]*  # m\n"));
  const Result verified = run("verify arm.yaml s.yaml --json");
  EXPECT_EQ(verified.err, "");  // no warning: the clearance is proved
  EXPECT_GE(nlohmann::json::parse(verified.out)["proved_clearance_m"], proved);
  // So is that of a trajectory, whose file claims none.
  const Result timed = run("solve arm.yaml --trajectory t.csv --json");
  ASSERT_EQ(timed.status, 0) << timed.err;
  const auto made = nlohmann::json::parse(timed.out)["problems"][0]["trajectory"]["clearance"];
  const auto rows = nlohmann::json::parse(run("verify arm.yaml t.csv --json").out);
  EXPECT_GT(made["proved_clearance_m"], 0);
  EXPECT_GE(rows["proved_clearance_m"], made["proved_clearance_m"]);
  EXPECT_GE(rows["closest_found_m"], rows["proved_clearance_m"]);
  EXPECT_TRUE(made["time_lost_s"].is_number());
  // If the file claims a larger clearance, it is not proved.
  std::string text = read("s.yaml");
  text.replace(text.find("\nclearance: "), 12, "\nclearance: 9");
  write("bold.yaml", text);
  const Result bold = run("verify arm.yaml bold.yaml");
  EXPECT_EQ(bold.status, 0);
  EXPECT_THAT(bold.err, HasSubstr("it claims a clearance of 90.00"));
  EXPECT_THAT(bold.err, HasSubstr(" m is proved\n"));

  EXPECT_THAT(
      run("solve arm.yaml").out,
      testing::ContainsRegex("clearance: proved: [0-9.]+ mm.*\n"
                             "clearance: every pair keeps the preferred distance, as far as "
                             "start and goal allow, on [0-9.]+ % of the "
                             "length\n"));
  const Result shortest = run("solve arm.yaml --clearance 0 -o s.yaml");
  EXPECT_THAT(shortest.out, testing::Not(HasSubstr("clearance")));
  EXPECT_THAT(read("s.yaml"), testing::Not(HasSubstr("clearance")));
}

TEST_F(SolveArm, MarginAndClearanceOfTheCommandLine) {
  const Result kept = run("solve arm.yaml --margin 0.02 -o s.yaml");
  EXPECT_EQ(kept.status, 0) << kept.err;
  EXPECT_THAT(kept.out, testing::Not(HasSubstr("clearance")));
  EXPECT_THAT(read("s.yaml"), HasSubstr("\nmargin: 0.02"));
  const Result verified = run("verify arm.yaml s.yaml --margin 0.02");
  EXPECT_EQ(verified.err, "");
  EXPECT_THAT(verified.out, HasSubstr("verdict: proved\n"));
  EXPECT_THAT(verified.out, HasSubstr("margin: 0.02 m\n"));
  EXPECT_THAT(run("verify arm.yaml s.yaml").err, HasSubstr("it claims a margin of 0.02 m"));

  for (const auto& [options, complaint] :
       std::initializer_list<std::pair<const char*, const char*>>{
           {"--clearance -1",
            "--clearance: a number of metres, 0 or more, is needed, not \"-1\"; see corridor solve "
            "--help\n"},
           {"--margin nan",
            "--margin: a number of metres, 0 or more, is needed, not \"nan\"; see corridor solve "
            "--help\n"},
           {"--margin inf",
            "--margin: a number of metres, 0 or more, is needed, not \"inf\"; see corridor solve "
            "--help\n"},
           {"--margin 0.01 --clearance 0.01",
            "--clearance: can't be used if every pair has a margin; leave one of the two out\n"},
           {"--clearance 0.01 --no-simplify",
            "--clearance: needs Corridor's simplifier; leave out simplify: false or ompl "
            "(--no-simplify, --simplify)\n"},
           {"--clearance 0.01 --edges discrete",
            "--clearance: needs edges that are proved; discrete edges are only sampled\n"},
           {"--keep clearest", "--keep: needs --tries, which is not given\n"},
           {"--keep clearest --tries 2 --clearance 0",
            "--keep: the clearest path needs a preferred clearance, such as --clearance "
            "0.005\n"},
           {"--keep clearest --tries 2 --margin 0.002",
            "--keep: the clearest path needs a preferred clearance, which can't be used with a "
            "margin: --margin 0 --clearance 0.002 replaces it\n"}}) {
    const Result refused = run(std::string("solve arm.yaml -o none.yaml ") + options);
    EXPECT_EQ(refused.status, 2) << options;
    EXPECT_EQ(refused.err, complaint);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.yaml"));
}

TEST_F(SolveArm, AnArmOfJointsCalledXYAndYawIsNoRigidBody) {
  std::string urdf = "<robot name=\"arm\">\n<link name=\"l0\"/>\n", parent = "l0";
  for (const std::string name : {"x", "y", "yaw"}) {
    urdf += "<link name=\"" + name +
            "\"><collision><geometry><sphere radius=\"0.1\"/></geometry>"
            "</collision></link>\n<joint name=\"" +
            name + "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"" + name +
            "\"/><origin xyz=\"0.5 0 0\"/><axis xyz=\"0 0 1\"/>"
            "<limit lower=\"-2\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>\n";
    parent = name;
  }
  write("arm.urdf", urdf + "</robot>\n");
  write(
      "arm.yaml",
      "format: corridor-problem-1\nrobot: arm.urdf\nworld: {post: {sphere: 0.1, at: [0, 1.5, 0]}}\n"
      "start: {x: 0, y: 0, yaw: 0}\ngoal: {x: 1, y: 0, yaw: 0}\n");
  EXPECT_EQ(nlohmann::json::parse(run("inspect arm.yaml --json").out)["space"], "joints");
  // The robot has three joints 0.5 m apart, and a sphere of radius 0.1 m.
  EXPECT_THAT(run("inspect arm.urdf").out,
              HasSubstr("reach: at most 1.6 m from the origin of l0: link yaw\n"));
  EXPECT_EQ(run("solve arm.yaml -o s.yaml").status, 0);
  EXPECT_THAT(read("s.yaml"), HasSubstr("joints: [\"x\", \"y\", \"yaw\"]\n"));
  EXPECT_EQ(run("verify arm.yaml s.yaml").status, 0);
  write("s.yaml", "format: corridor-solution-1\nspace: SE2\npath: [[0, 0, 0], [1, 0, 0]]\n");
  EXPECT_EQ(
      run("verify arm.yaml s.yaml").err,
      "s.yaml:2: space: the problem is in the joints [\"x\", \"y\", \"yaw\"], this solution in "
      "SE2\n");
  write("states.txt", "0 0\n");
  EXPECT_EQ(run("check arm.yaml --states states.txt").err,
            "states.txt:1: a state has 3 numbers (x y yaw), not 2\n");
}

TEST_F(SolveCommand, SameSeedSameFile) {
  EXPECT_EQ(run("solve problem.yaml --seed 5 -o a.yaml").status, 0);
  EXPECT_EQ(run("solve problem.yaml --seed 5 -o b.yaml").status, 0);
  EXPECT_EQ(run("solve problem.yaml --seed 6 -o c.yaml").status, 0);
  EXPECT_EQ(read("a.yaml"), read("b.yaml"));
  EXPECT_NE(read("a.yaml"), read("c.yaml"));
}

TEST_F(SolveCommand, NothingFoundIsExit1AndWritesNothing) {
  write("wall.obj", "v 0 -5 -5\nv 0 5 -5\nv 0 5 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
  const Result result = run("solve problem.yaml --time 0.3 -o s.yaml");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("why: "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.yaml"));
}

TEST_F(SolveCommand, QuietPrintsNothing) {
  EXPECT_EQ(run("solve problem.yaml --quiet").out, "");
}

TEST_F(SolveCommand, InterruptedIsExit130) {
  write("wall.obj", "v 0 -5 -5\nv 0 5 -5\nv 0 5 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
  const Result result =
      run("solve problem.yaml --time 60 -o s.yaml & pid=$!; sleep 0.5; kill -INT $pid; wait $pid; "
          "exit $?;");
  EXPECT_EQ(result.status, 130);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.yaml"));
}

/// A limit on the size of files acts like a full disk; SIGXFSZ must not end the program.
TEST_F(SolveCommand, ReportsAFullDiskAndLeavesNoPartialFile) {
  const Result whole = run("solve problem.yaml --seed 1 --picture p.svg");
  ASSERT_EQ(whole.status, 0) << whole.err;
  ASSERT_GT(std::filesystem::file_size(folder_ / "p.svg"), 1024u);
  std::filesystem::remove(folder_ / "p.svg");
  const Result cut = run("solve problem.yaml --seed 1 --picture p.svg", "ulimit -f 2 && ");
  EXPECT_EQ(cut.status, 2);
  EXPECT_EQ(cut.err,
            "p.svg: can't be written: File too large; raise the limit on the size of files (ulimit "
            "-f)\n");
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find("p.svg"), std::string::npos) << entry.path();
}

TEST_F(SolveCommand, BadInputIsOneLineAndExit2) {
  expectFaultThatBegins("solve none.yaml", "none.yaml: ");
  expectFaultThatBegins("solve problem.yaml --planner RRTx -o s.yaml",
                        "--planner: unknown planner \"RRTx\"");
  expectFaultThatBegins("solve problem.yaml --set rnge=1",
                        "--set: RRTConnect has no parameter \"rnge\" (did you mean \"range\"?)");
  expectFault("solve problem.yaml --set range", "--set: key=value is needed, not \"range\"");
  expectFault("solve problem.yaml --set range=long",
              "--set: RRTConnect's parameter range: \"long\" is not a number");
  expectFault("solve problem.yaml --sampler max_clearence",
              "--sampler: one of uniform, gaussian, obstacle_based, bridge_test, max_clearance is "
              "needed, not \"max_clearence\" (did you mean \"max_clearance\"?)");
  expectFault("solve problem.yaml problem.yaml -o s.yaml",
              "--output: names one file, but there are 2 problems; name a folder");
  expectFault("solve problem.yaml -o none/s.yaml", "--output: there is no folder none");
  for (const char* file : {"problem.yaml", "./robot.yaml"})
    expectFault(std::string("solve problem.yaml --output ") + file,
                std::string("--output: ") + file +
                    " belongs to the problem and would be overwritten; name another file");
  expectFault("solve problem.yaml --from top", "--from: needs --picture, which is not given");
  expectFault(
      "solve problem.yaml --picture p.svg --from tap",
      "--from: one of front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees "
      "(-360 to 360, -90 to 90; such as -60,38) is needed, not \"tap\" (did you mean "
      "\"top\"?)");
  expectFault("solve problem.yaml --picture .",
              "--picture: . is a folder; a file's name is needed");
  expectFaultThatBegins("solve problem.yaml --edges discrete --resolution 1",
                        "--resolution: must be from 1e-9 to below 1, not 1; ");
  write("fine.yaml", problem("-2, 0, 0", "checker: {edges: discrete, resolution: 1e-300}\n"));
  expectFault("solve fine.yaml",
              "fine.yaml:8: checker.resolution: must be from 1e-9 to below 1, not 1e-300");
  write("problem.yaml", problem("0.05, 0, 0"));
  expectFaultThatBegins("solve problem.yaml -o s.yaml",
                        "problem.yaml:5: start: in contact: \"cube\" (triangle ");
  write("problem.yaml", problem("9, 0, 0"));
  expectFaultThatBegins("solve problem.yaml -o s.yaml", "problem.yaml:5: start");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.yaml"));
}

}  // namespace
