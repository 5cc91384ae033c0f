// Tests of the key `trajectories` of campaign files, and of campaigns with trajectories: all
// figures, and resuming.
#include "planner/benchmark/campaign_trajectories.h"

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sys/time.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "planner/benchmark/campaign_spec.h"
#include "planner/benchmark/campaign_yaml.h"
#include "planner/benchmark/ompl_database.h"
#include "planner/benchmark/report.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/benchmark/run_file.h"
#include "planner/benchmark/run_record.h"
#include "planner/benchmark/trajectory_rows.h"
#include "tests/planner/benchmark/hall_campaign.h"

namespace corridor {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class CampaignWithTrajectories : public testing::Test {
 protected:
  ~CampaignWithTrajectories() override { std::filesystem::remove_all(folder_); }

  /// Returns the text of a campaign file: these problems of the folder problems/, then the lines
  /// `more`.
  static std::string of(const std::vector<std::string>& problems, const std::string& more) {
    std::string list;
    for (const std::string& problem : problems)
      list += (list.empty() ? "" : ", ") + (CORRIDOR_SOURCE_DIR "/problems/" + problem);
    return "format: corridor-campaign-1\nproblems: [" + list + "]\ncheckers: {a: {}}\n" + more;
  }
  Campaign read(const std::string& text) const {
    std::ofstream(folder_ / "c.yaml") << text;
    return readCampaign(folder_ / "c.yaml");
  }
  /// Returns the faults, without the folder's name.
  std::vector<std::string> faults(const std::string& text) const {
    std::vector<std::string> all;
    try {
      checkCampaign(read(text));
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults()) {
        all.push_back(fault.str());
        if (const auto at = all.back().find(folder_.string() + "/"); at != std::string::npos)
          all.back().erase(at, folder_.string().size() + 1);
      }
    }
    return all;
  }
  std::vector<std::string> faultsOfTwoArms(const std::string& more) const {
    return faults(of({"two_arms"}, more));
  }
  /// Returns the index of the entry of a configuration that has this name.
  static Eigen::Index number(const Problem& problem, const std::string& name) {
    const auto names = problem.model.space.numberNames();
    const auto found = std::find(names.begin(), names.end(), name);
    EXPECT_NE(found, names.end()) << name;
    return found - names.begin();
  }
  /// Returns all columns except those of measured times.
  static std::string repeatable(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
    std::vector<Row> rows = runRows(campaign, cells);
    for (Row& row : rows)
      std::erase_if(row, [](const auto& column) {
        const std::string& name = column.first;
        return name.ends_with("_s") && !name.ends_with("duration_s") &&
               !name.ends_with("optimum_s");
      });
    return csvOf(rows);
  }

  std::filesystem::path folder_ = test::newFolder();
};

TEST_F(CampaignWithTrajectories, AListOfMakers) {
  const Campaign c = read(of({"two_arms"}, "trajectories: [spline, blends]\n"));
  EXPECT_THAT(c.trajectories.makers, ElementsAre(TrajectoryMaker::spline, TrajectoryMaker::blends));
  ASSERT_EQ(c.trajectories.limits.size(), 1u);
  EXPECT_EQ(c.trajectories.limits[0].name, "");
  EXPECT_EQ(c.trajectories.limits[0].ofProblem[0].velocity, c.problems[0].task.limits.velocity);
  EXPECT_THAT(c.notes, Contains(HasSubstr("trajectories: limits: no acceleration is given for")));
  EXPECT_THAT(read(of({"two_arms"}, "")).trajectories.makers, IsEmpty());
  EXPECT_EQ(read(of({"two_arms"}, "trajectories: {}\n")).trajectories.makers.size(), 4u);
}

/// Limits are given by the name of a robot, and apply to both robots that have this name.
TEST_F(CampaignWithTrajectories, LimitsOfRobots) {
  const Campaign c = read(of({"two_arms", "gantry_bins", "snake_posts"},
                             "trajectories:\n"
                             "  makers: [stop]\n"
                             "  limits:\n"
                             "    own: {}\n"
                             "    maker-2:\n"
                             "      arm6:\n"
                             "        default: {velocity: 1.5, acceleration: 3}\n"
                             "        joints: {elbow: {velocity: 9, jerk_deg: 180}}\n"
                             "        link_speed: {hand: 0.25}\n"
                             "      gantry: {slides: {velocity: 0.5, acceleration: 4}}\n"));
  const std::vector<CampaignLimits>& sets = c.trajectories.limits;
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].name, "own");
  EXPECT_EQ(sets[1].name, "maker-2");
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(sets[0].ofProblem[p].velocity, c.problems[p].task.limits.velocity);
    EXPECT_EQ(sets[0].ofProblem[p].acceleration, c.problems[p].task.limits.acceleration);
  }
  const JointLimits &arms = sets[1].ofProblem[0], &gantry = sets[1].ofProblem[1];
  for (const std::string robot : {"left/", "right/"}) {
    const Eigen::Index elbow = number(c.problems[0], robot + "elbow"),
                       pan = number(c.problems[0], robot + "pan");
    EXPECT_EQ(arms.velocity[elbow], 9);  // also above the URDF's 2 rad/s
    EXPECT_EQ(arms.acceleration[elbow], 3);
    EXPECT_DOUBLE_EQ(arms.jerk[elbow], M_PI);
    EXPECT_EQ(arms.velocity[pan], 1.5);
    EXPECT_EQ(arms.acceleration[pan], 3);
    EXPECT_FALSE(std::isfinite(arms.jerk[pan]));
  }
  ASSERT_EQ(arms.links.size(), 2u);
  EXPECT_EQ(arms.links[0].link, "left/hand");
  EXPECT_EQ(arms.links[1].link, "right/hand");
  const Eigen::Index x = number(c.problems[1], "x"), turn = number(c.problems[1], "turn");
  EXPECT_EQ(gantry.velocity[x], 0.5);
  EXPECT_EQ(gantry.acceleration[x], 4);
  EXPECT_EQ(gantry.velocity[turn], c.problems[1].task.limits.velocity[turn]);
  EXPECT_EQ(gantry.acceleration[turn], kAssumedAcceleration);
  // The set has no limits for the snake, so the snake keeps the limits of its problem.
  EXPECT_EQ(sets[1].ofProblem[2].acceleration, c.problems[2].task.limits.acceleration);
  EXPECT_THAT(c.notes, Contains(HasSubstr("trajectories, maker-2: limits: the velocity of "
                                          "left/elbow, 9, is above the URDF's 2")));
  EXPECT_THAT(c.notes, Contains(HasSubstr("maker-2: limits: no acceleration is given for turn;")));
  EXPECT_THAT(c.notes, Not(Contains(HasSubstr("maker-2: limits: no acceleration is given for "
                                              "left/"))));
}

TEST_F(CampaignWithTrajectories, Faults) {
  const auto f = [this](const std::string& more) { return faultsOfTwoArms(more); };
  EXPECT_THAT(
      f("trajectories: [blend, stop, stop]\n"),
      ElementsAre("c.yaml:4: trajectories: there is no maker of trajectories \"blend\" (did "
                  "you mean \"blends\"?); there are: blends, stop, spline, inserted",
                  "c.yaml:4: trajectories: \"stop\" is named twice"));
  EXPECT_THAT(f("trajectories: []\n"),
              ElementsAre("c.yaml:4: trajectories: at least one is needed, such as [blends, stop, "
                          "spline, inserted]"));
  EXPECT_THAT(f("trajectories: all\n"),
              ElementsAre("c.yaml:4: trajectories: a list of makers is needed, such as [blends, "
                          "stop, spline, inserted], or a map of makers and limits, not \"all\""));
  EXPECT_THAT(f("trajectories:\n  maker: [stop]\n"),
              ElementsAre(HasSubstr("c.yaml:5: unknown key \"maker\" in trajectories (did you mean "
                                    "\"makers\"?)")));
  EXPECT_THAT(
      f("trajectories:\n  limits: {}\n"),
      ElementsAre("c.yaml:5: trajectories.limits: at least one set is needed, such as {own: "
                  "{}}: each problem's own limits"));
  EXPECT_THAT(
      f("trajectories:\n  limits:\n    my limits: {}\n    fast:\n"),
      ElementsAre(
          "c.yaml:6: trajectories.limits.my limits: the name of a set of limits "
          "begins columns: at most 40 letters, digits, _ and -, the first one a "
          "letter",
          HasSubstr("trajectories.limits.fast: a map (key: value) is needed, not nothing")));
  EXPECT_THAT(f("trajectories:\n  limits:\n    fast:\n      arm7: {default: {velocity: 1}}\n"),
              ElementsAre("c.yaml:7: trajectories.limits.fast.arm7: no problem has a robot of that "
                          "name (did you mean \"arm6\"?) (known: arm6)"));
  // Faults of limits are those of problem files, each reported once.
  EXPECT_THAT(
      faults(of({"arm_at_shelf", "arm_at_shelf"},
                "trajectories:\n  limits:\n    fast:\n      arm7:\n"
                "        joints: {elbo: {velocity: 1}}\n        default: {velocity: -1}\n")),
      testing::UnorderedElementsAre(
          HasSubstr("c.yaml:8: trajectories.limits.fast.arm7.joints.elbo: no planned joint has "
                    "this name (did you mean \"elbow\"?)"),
          HasSubstr("c.yaml:9: trajectories.limits.fast.arm7.default.velocity: ")));
  EXPECT_THAT(f("verify: false\ntrajectories: [stop]\n"),
              ElementsAre("c.yaml:5: trajectories: their verdicts are the verifier's; leave out "
                          "verify: false"));
}

/// A cube in the plane leaves a channel of 0.3 m, and goes up behind its end. The spline through
/// the corner dips into the floor of the channel.
class HallWithTrajectories : public CampaignWithTrajectories {
 protected:
  HallWithTrajectories() {
    write("robot.yaml",
          "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
    write("hall.yaml",
          "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n"
          "  floor: {box: [4, 0.1, 1], at: [-1, -0.05, 0]}\n"
          "  ceiling: {box: [3.7, 2, 1], at: [-1.15, 1.3, 0]}\n"
          "  end: {box: [0.1, 3, 1], at: [-3.05, 1, 0]}\n"
          "start: {at: [-2, 0.15]}\ngoal: {at: [1.5, 1.5]}\nbounds: {at: [[-3, -0.5], [2.5, "
          "2.5]]}\n");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Campaign hall(const std::string& more) const {
    return read(
        "format: corridor-campaign-1\nproblems: [hall.yaml]\nplanners: [RRTConnect]\n"
        "checkers: {a: {}}\nruns: 3\nlimits: {time: 60}\n" +
        more);
  }
  static constexpr const char* kLimits =
      "  limits:\n    own: {}\n    slow: {cube: {position: {velocity: 0.3}, rotation: {velocity: "
      "1, acceleration: 5}}}\n";
};

TEST_F(HallWithTrajectories, EveryMakerWithEverySetOfLimits) {
  const Campaign c = hall(std::string("trajectories:\n") + kLimits);
  checkCampaign(c);
  const CampaignResult result = runCampaign(c);
  ASSERT_EQ(result.cells.size(), 1u);
  ASSERT_EQ(result.cells[0].runs.size(), 3u);
  for (const BenchmarkRun& run : result.cells[0].runs) {
    ASSERT_EQ(run.failure, "");
    ASSERT_EQ(run.verdict, "proved");
    ASSERT_EQ(run.trajectories.size(), 2u);
    for (const LimitedTrajectories& set : run.trajectories) {
      ASSERT_EQ(set.makers.size(), 4u);
      EXPECT_GT(set.optimum, 0);
      for (const TrajectoryRun& one : set.makers) {
        EXPECT_EQ(one.fault, "");
        EXPECT_NE(one.verdict, "");
        EXPECT_LE(one.acceleration, 1 + kLimitSlack);
      }
      EXPECT_EQ(set.makers[0].verdict, "proved");
      EXPECT_EQ(set.makers[1].verdict, "proved");
      EXPECT_GE(set.makers[1].duration, set.optimum * (1 - 1e-9));
    }
    EXPECT_EQ(run.trajectories[0].makers[0].velocity, -1);
    EXPECT_GT(run.trajectories[1].makers[0].velocity, 0.99);
    EXPECT_GT(run.trajectories[1].makers[0].duration, run.trajectories[0].makers[0].duration);
  }
  const TrajectoryScore spline = scoreOf(c, result.cells, 0, 0, 2);
  EXPECT_EQ(spline.made, 3u);
  EXPECT_GT(spline.refuted, 0u);
  // The database has the figures of the trajectories, too.
  writeOmplDatabase(c, result, runsOf(result.cells), folder_ / "campaign.db");
  const std::vector<std::string> columns =
      test::rowsOf(folder_ / "campaign.db", "SELECT name, type FROM pragma_table_info('runs')");
  for (const char* column : {"own_spline_refuted|BOOLEAN", "slow_blends_duration_s|REAL",
                             "own_stop_rows|INTEGER", "slow_optimum_s|REAL"})
    EXPECT_THAT(columns, testing::Contains(column));
  EXPECT_THAT(test::rowsOf(folder_ / "campaign.db", "SELECT sum(own_spline_refuted) FROM runs"),
              testing::ElementsAre(std::to_string(scoreOf(c, result.cells, 0, 0, 2).refuted)));
  // The report has these figures, too.
  writeReport(c, result.cells, folder_);
  const std::string page = test::contents(folder_ / "report.html");
  EXPECT_THAT(page, HasSubstr("<section id=\"trajectories\">"));
  EXPECT_THAT(page,
              HasSubstr("<td>slow</td><td>blends</td><td><span class=\"good\">0 of 3</span>"));
  EXPECT_THAT(page, HasSubstr("<td>own</td><td>spline</td><td><span class=\"bad\">"));
}

/// A campaign that was stopped after two runs and resumed has the figures of an uninterrupted
/// campaign.
TEST_F(HallWithTrajectories, ResumesWithTheSameFigures) {
  const Campaign c = hall(std::string("trajectories:\n  makers: [blends, spline]\n") + kLimits);
  const CampaignResult whole = runCampaign(c);
  for (const int stop : {2, 3}) {
    std::vector<CampaignCell> cells = cellsOf(c);
    const RunFile::Mode mode = stop == 2 ? RunFile::Mode::fresh : RunFile::Mode::resume;
    RunFile file(folder_ / "runs.jsonl", mode, c, cells);
    EXPECT_EQ(cells[0].runs.size(), stop == 2 ? 0u : 2u);
    std::atomic<bool> interrupted = false;
    int done = 0;
    CampaignOptions options;
    options.interrupted = &interrupted;
    options.done = [&](std::size_t cell, const BenchmarkRun& run) {
      file.add(cell, run);
      interrupted = ++done == 2;
    };
    const CampaignResult result = runCampaign(c, options, std::move(cells));
    EXPECT_EQ(result.cells[0].runs.size(), static_cast<std::size_t>(stop));
    if (stop == 3) {
      std::vector<CampaignCell> stored = cellsOf(c);
      file.runs()(0, [&](const BenchmarkRun& run) { stored[0].runs.push_back(run); });
      EXPECT_EQ(repeatable(c, stored), repeatable(c, whole.cells));
      for (const TrajectoryRun& run : result.cells[0].runs[0].trajectories.at(0).makers)
        EXPECT_EQ(run.finding, "") << "runs of earlier sessions have no texts in memory";
    }
  }
  const auto complaint = [&](const Campaign& other) -> std::string {
    std::vector<CampaignCell> cells = cellsOf(other);
    try {
      RunFile(folder_ / "runs.jsonl", RunFile::Mode::resume, other, cells);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(c), "");
  EXPECT_THAT(complaint(hall("")), HasSubstr("was measured with limits over time "));
  EXPECT_THAT(complaint(hall("trajectories: [spline, blends]\n")),
              HasSubstr("hall, a, RRTConnect was measured with "));
  EXPECT_THAT(complaint(hall("trajectories:\n  makers: [blends, spline]\n  limits:\n    own: {}\n"
                             "    slow: {cube: {position: {velocity: 0.4}}}\n")),
              HasSubstr("was measured with limits over time "));
}

/// Without the key, rows, settings and stored runs must be the same as in versions that had no
/// trajectories.
TEST_F(HallWithTrajectories, CampaignsWithoutTrajectoriesAreUnchanged) {
  const Campaign c = hall("");
  EXPECT_THAT(specOf(c, cellsOf(c)[0]), Not(HasSubstr("trajectories")));
  const CampaignResult result = runCampaign(c);
  for (const BenchmarkRun& run : result.cells[0].runs) {
    EXPECT_TRUE(run.trajectories.empty());
    EXPECT_THAT(text(run), Not(HasSubstr("trajectories")));
  }
  const std::string rows = csvOf(runRows(c, result.cells));
  EXPECT_EQ(rows.substr(0, rows.find('\n')),
            "problem,variant,planner,seed,result,certified,verdict,time_s,processor_s,"
            "search_processor_s,set_up_s,planner_s,simplification_s,certification_s,checking_s,"
            "verification_s,states,edges,edges_undecided,box_tests,triangle_tests,"
            "proved_clearance_m,closest_found_m,raw_states,raw_length_m,raw_rotation_rad,"
            "path_states,length_m,rotation_rad,why,finding,failure");
  writeReport(c, result.cells, folder_);
  EXPECT_THAT(test::contents(folder_ / "report.html"), Not(HasSubstr("id=\"trajectories\"")));
}

/// If the process ends while it makes a trajectory, the run, its verdict and the trajectories that
/// were done are kept.
TEST_F(HallWithTrajectories, AnEndedProcessKeepsWhatWasDone) {
  const Campaign c = hall("");
  RunTrajectories trajectories;
  trajectories.makers = {TrajectoryMaker::blends, TrajectoryMaker::spline};
  trajectories.limits.assign(3000, c.problems[0].task.limits);  // takes many seconds
  BenchmarkCompetitor competitor;
  competitor.run = [](const Problem& problem, double, Path& path) {
    Configuration corner = problem.task.start;
    corner[0] = 1;
    path = {problem.task.start, corner, problem.task.goals[0]};
    BenchmarkRun run;
    run.solved = true;
    run.result = "solved";
    itimerval timer{};
    timer.it_value.tv_sec = test::kSlowdown;
    ::setitimer(ITIMER_REAL, &timer, nullptr);  // SIGALRM ends the process
    return run;
  };
  ChildProcess process = startRun(&c.problems[0], problemOfRun(c, cellsOf(c)[0], 1), c.digests[0],
                                  competitor, {}, trajectories);
  while (!process.poll()) ChildProcess::waitForAny({&process}, 100);
  const BenchmarkRun run = runOf(process.end(), 1, trajectories);
  EXPECT_THAT(run.failure, HasSubstr("a trajectory failed: killed by signal 14"));
  EXPECT_EQ(run.verdict, "proved");
  ASSERT_EQ(run.trajectories.size(), 3000u);
  EXPECT_EQ(run.trajectories[0].makers[0].verdict, "proved");
  ASSERT_EQ(run.trajectories[2999].makers.size(), 2u);
  EXPECT_THAT(run.trajectories[2999].makers[1].fault, HasSubstr("not made: a trajectory failed: "));
}

}  // namespace
}  // namespace corridor
