// Tests of the program under `mpirun`: campaigns and many problems have the same results as in one
// process, whichever rank is killed or gets a signal. The tests are skipped without Open MPI.
#include <chrono>
#include <csignal>
#include <random>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/campaign_fixture.h"

namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/// Open MPI refuses to run as root unless these environment variables are set.
const char* const kAllowRoot =
    "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 && ";

class MpiCommand : public corridor::test::CampaignTest {
 protected:
  void SetUp() override {
    if (std::system("command -v mpirun >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "mpirun is needed (Debian's openmpi-bin)";
    if (!fs::exists(fs::path(CORRIDOR_PROGRAM).parent_path() / "libcorridor_mpi.so"))
      GTEST_SKIP() << "the program was built without MPI (Debian's libboost-mpi-dev and "
                      "libopenmpi-dev), or with a sanitizer";
  }
  static std::string mpirun(int ranks) {
    return kAllowRoot + ("mpirun --oversubscribe -n " + std::to_string(ranks)) + " ";
  }
  Result runRanks(int ranks, const std::string& arguments) const {
    return run(arguments, mpirun(ranks));
  }

  /// Starts `mpirun` with the program. @returns the process id of mpirun.
  pid_t start(int ranks, const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && " + kAllowRoot +
                                "exec mpirun --oversubscribe -n " + std::to_string(ranks) +
                                " '" CORRIDOR_PROGRAM "' " + arguments + " >out.txt 2>err.txt";
    const pid_t id = ::fork();
    if (id == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      ::_exit(1);
    }
    return id;
  }
  static int end(pid_t id) {
    int status = 0;
    ::waitpid(id, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Returns the process ids of the ranks, which are children of mpirun, in the order of ranks.
  static std::vector<pid_t> ranksOf(pid_t mpirun) {
    std::vector<std::pair<int, pid_t>> ranks;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != name.npos) continue;
      const std::string stat = corridor::test::contents(entry.path() / "stat");
      const auto at = stat.rfind(')');
      if (at == stat.npos || std::atoi(stat.c_str() + at + 3) != mpirun) continue;
      const std::string environment = corridor::test::contents(entry.path() / "environ");
      const std::string key = "OMPI_COMM_WORLD_RANK=";
      const auto found = environment.find(key);
      if (found == environment.npos) continue;
      ranks.emplace_back(std::atoi(environment.c_str() + found + key.size()),
                         std::atoi(name.c_str()));
    }
    std::sort(ranks.begin(), ranks.end());
    std::vector<pid_t> ids;
    for (const auto& [rank, id] : ranks) ids.push_back(id);
    return ids;
  }
  /// Waits, at most a minute, until several runs were stored.
  void awaitRuns(const std::string& folder) const {
    const int before = runsIn(folder);
    for (int i = 0; i < 6000 && runsIn(folder) < before + 4; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  static std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++n;
    return n;
  }
};

TEST_F(MpiCommand, CampaignsHaveTheRowsOfOneProcess) {
  ASSERT_EQ(run("benchmark campaign.yaml --runs 5 -o whole").status, 0);
  for (const auto& [ranks, options] :
       {std::pair(1, ""), std::pair(4, ""), std::pair(3, "--jobs 2")}) {
    const std::string folder = "r" + std::to_string(ranks);
    const Result result = runRanks(
        ranks, std::string("benchmark campaign.yaml --runs 5 ") + options + " -o " + folder);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");  // rank 0 alone prints
    EXPECT_EQ(lines(result.out).size(), 7u) << result.out;
    EXPECT_EQ(repeatable(folder), repeatable("whole"));
  }
  EXPECT_EQ(run("benchmark campaign.yaml --runs 5 --jobs 2 -o jobs").status, 0);
  EXPECT_EQ(repeatable("jobs"), repeatable("whole"));
  EXPECT_THAT(read("r3/report.html"), HasSubstr("30 runs, 4 at a time"));
  // A shard under mpirun, and more runs of a finished campaign.
  EXPECT_EQ(runRanks(3, "benchmark campaign.yaml --runs 2 --shard 1/2 -o s1").status, 0);
  EXPECT_EQ(run("benchmark campaign.yaml --runs 2 --shard 2/2 -o s2").status, 0);
  EXPECT_EQ(runRanks(2, "benchmark --merge s1 s2 -o merged").status, 0);
  EXPECT_EQ(runRanks(3, "benchmark campaign.yaml --runs 5 --resume -o merged").status, 0);
  EXPECT_EQ(repeatable("merged"), repeatable("whole"));
}

/// Kills ranks at random moments, and resumes. No stored run may be lost, and none may be stored
/// twice.
TEST_F(MpiCommand, ResumesAfterRanksWereKilled) {
  const int kills = std::getenv("CORRIDOR_STRESS") ? 10 : 2, runsOfCell = 20 * kills;
  const std::string campaign = "benchmark campaign.yaml --runs " + std::to_string(runsOfCell);
  ASSERT_EQ(run(campaign + " --jobs 2 -o whole").status, 0);
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  int last = 0;
  for (int kill = 0; kill < kills; ++kill) {
    const pid_t id = start(4, campaign + " -o killed --resume");
    awaitRuns("killed");
    std::this_thread::sleep_for(
        std::chrono::milliseconds(std::uniform_int_distribution(0, 50)(random)));
    const std::vector<pid_t> ranks = ranksOf(id);
    const int victim = std::uniform_int_distribution(0, 3)(random);
    EXPECT_EQ(ranks.size(), 4u);
    if (ranks.size() == 4) ::kill(ranks[static_cast<std::size_t>(victim)], SIGKILL);
    const int status = end(id);
    const int runs = runsIn("killed");
    std::printf("rank %d of %zu killed: mpirun returns %d, %d runs are stored\n", victim,
                ranks.size(), status, runs);
    EXPECT_NE(status, 0);
    EXPECT_GE(runs, last);  // equal only if the rank was killed before the first run ended
    last = runs;
  }
  EXPECT_GT(last, 0);
  EXPECT_LT(last, 6 * runsOfCell);
  const Result result = runRanks(4, campaign + " -o killed --resume");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(repeatable("killed"), repeatable("whole"));
  EXPECT_EQ(runsIn("killed"), 6 * runsOfCell);
  for (const char* of : {"runs", "(SELECT DISTINCT experimentid, plannerid, seed FROM runs)"})
    EXPECT_EQ(query("killed", std::string("SELECT count(*) FROM ") + of),
              std::to_string(6 * runsOfCell));
}

/// A batch system, or a user, sends a signal to any rank, or to mpirun.
TEST_F(MpiCommand, SignalsLeaveAResumableCampaign) {
  struct Case {
    int signal, rank;  // rank −1: mpirun
  };
  for (const auto& [signal, rank] :
       {Case{SIGTERM, 0}, Case{SIGINT, 2}, Case{SIGTERM, -1}, Case{SIGUSR1, -1}}) {
    const std::string folder = "f" + std::to_string(signal) + "_" + std::to_string(rank + 1);
    SCOPED_TRACE(folder);
    const pid_t id = start(3, "benchmark campaign.yaml --runs 20000 -o " + folder);
    awaitRuns(folder);
    const std::vector<pid_t> ranks = ranksOf(id);
    if (ranks.size() != 3) {
      ADD_FAILURE() << ranks.size() << " ranks: " << read("err.txt");
      ::kill(id, SIGKILL);
      end(id);
      continue;
    }
    ::kill(rank < 0 ? id : ranks[static_cast<std::size_t>(rank)], signal);
    const int status = end(id);
    const int runs = runsIn(folder);
    EXPECT_GT(runs, 0);
    EXPECT_LT(runs, 20000 * 6);
    // mpirun itself kills the ranks a second after SIGTERM, which may be too early for the reports.
    if (rank < 0 && signal == SIGTERM) {
      EXPECT_NE(status, 0);
      continue;
    }
    EXPECT_EQ(status, 128 + signal) << read("err.txt");
    EXPECT_EQ(count(read("err.txt"), "interrupted: the results cover the finished runs"), 1u);
    EXPECT_EQ(lines(read(folder + "/runs.csv")).size(), static_cast<std::size_t>(runs) + 1);
    EXPECT_TRUE(fs::exists(folder_ / folder / "report.html"));
  }
}

/// The job script gets SIGTERM from Slurm before the wall time, and sends SIGUSR1 to mpirun. If the
/// script is submitted again, the campaign continues.
TEST_F(MpiCommand, TheJobScriptEndsInTime) {
  fs::create_symlink(CORRIDOR_PROGRAM, folder_ / "corridor");
  std::string text = read("campaign.yaml");
  text.replace(text.find("runs: 12"), 8, "runs: 20000");
  write("campaign.yaml", text);
  const std::string script = CORRIDOR_SOURCE_DIR "/problems/campaigns/slurm.sh";
  int before = 0;
  for (int job = 0; job < 2; ++job) {
    const std::string command = "cd '" + folder_.string() + "' && " + kAllowRoot +
                                "export MPIRUN_OPTIONS='--oversubscribe -n 3' && exec bash '" +
                                script + "' campaign.yaml r >out.txt 2>err.txt";
    const pid_t id = ::fork();
    if (id == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      ::_exit(1);
    }
    awaitRuns("r");
    ::kill(id, SIGTERM);
    EXPECT_EQ(end(id), 128 + SIGUSR1) << read("err.txt");
    const int runs = runsIn("r");
    EXPECT_GT(runs, before);
    EXPECT_EQ(lines(read("r/runs.csv")).size(), static_cast<std::size_t>(runs) + 1);
    before = runs;
  }
}

TEST_F(MpiCommand, FaultsAreReportedOnce) {
  for (const auto& [arguments, fault] :
       {std::pair("benchmark campaign.yaml --resume",
                  "--resume: needs -o with the folder of the campaign\n"),
        std::pair("benchmark missing.yaml -o r", "missing.yaml: no such file\n"),
        std::pair("benchmark campaign.yaml --runs x -o r", "--runs: a whole number from 1")}) {
    const Result result = runRanks(3, arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(count(result.err, fault), 1u) << result.err;
    EXPECT_EQ(result.out, "");
  }
  // A rank that sees other files than the first one.
  write("other.sh",
        "if [ \"$OMPI_COMM_WORLD_RANK\" = 2 ]; then cd other; fi\nexec '" CORRIDOR_PROGRAM
        "' \"$@\"\n");
  fs::create_directory(folder_ / "other");
  for (const char* file : {"robot.yaml", "hall.yaml", "campaign.yaml"})
    fs::copy_file(folder_ / file, folder_ / "other" / file);
  std::ofstream(folder_ / "other/hall.yaml", std::ios::app) << "margin: 0.001\n";
  const auto runOther = [&](const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && " + mpirun(3) + "sh other.sh " +
                                arguments + " >out.txt 2>err.txt";
    return WEXITSTATUS(std::system(command.c_str()));
  };
  EXPECT_EQ(runOther("benchmark campaign.yaml -o " + (folder_ / "r").string()), 2);
  EXPECT_THAT(read("err.txt"), HasSubstr("rank 2: "));
  EXPECT_THAT(read("err.txt"), HasSubstr(": its campaign is not the first rank's; all machines "
                                         "need the same files and packages\n"));
  EXPECT_FALSE(fs::exists(folder_ / "r"));  // no run was made
  fs::remove(folder_ / "other/robot.yaml");
  EXPECT_EQ(runOther("benchmark campaign.yaml -o " + (folder_ / "r").string()), 2);
  EXPECT_THAT(read("err.txt"), HasSubstr("rank 2: "));
  EXPECT_THAT(read("err.txt"), HasSubstr("robot.yaml: no such file"));
}

TEST_F(MpiCommand, ManyProblemsHaveTheSameSolutions) {
  std::string problems;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "p" + std::to_string(i) + ".yaml";
    fs::copy_file(folder_ / "hall.yaml", folder_ / name);
    std::ofstream(folder_ / name, std::ios::app) << "seed: " << i + 1 << "\n";
    problems += " " + name;
  }
  write("bad.yaml", "format: corridor-problem-1\nrobot: none.yaml\n");
  problems += " bad.yaml";
  const Result one = run("solve" + problems + " -o one --json --jobs 2"),
               many = runRanks(4, "solve" + problems + " -o many --json");
  EXPECT_EQ(one.status, 2);
  EXPECT_EQ(many.status, 2) << many.err;
  EXPECT_EQ(count(many.err, "bad.yaml:2: "), 1u) << many.err;
  auto a = nlohmann::json::parse(one.out)["problems"],
       b = nlohmann::json::parse(many.out)["problems"];
  ASSERT_EQ(a.size(), 7u);
  ASSERT_EQ(b.size(), 7u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(a[i]["path"]["rows"], b[i]["path"]["rows"]);
    const std::string file = "/p" + std::to_string(i) + ".solution.yaml";
    EXPECT_EQ(run("verify p" + std::to_string(i) + ".yaml many" + file).status, 0);
  }
  EXPECT_EQ(a[6], b[6]);
  // Rank 0 solves a single problem alone.
  const Result single = runRanks(2, "solve p0.yaml -o single.yaml");
  EXPECT_EQ(single.status, 0) << single.err;
  EXPECT_EQ(count(single.out, "certified"), count(run("solve p0.yaml").out, "certified"));
}

TEST_F(MpiCommand, AnInterruptOfManyProblems) {
  // The wall closes the hall, so there is no path, and each problem takes all of its time.
  std::string wall = read("hall.yaml");
  wall.replace(wall.find("[0.01, 6, 1]"), 12, "[0.01, 60, 1]");
  write("closed.yaml", wall);
  const pid_t id = start(3, "solve hall.yaml closed.yaml closed.yaml closed.yaml --time 60 -o out");
  for (int i = 0; i < 3000 && !fs::exists(folder_ / "out/hall.solution.yaml"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const std::vector<pid_t> ranks = ranksOf(id);
  ASSERT_EQ(ranks.size(), 3u);
  ::kill(ranks[1], SIGTERM);
  EXPECT_EQ(end(id), 128 + SIGTERM);
  EXPECT_THAT(read("out.txt"), HasSubstr("hall: solved, "));
  EXPECT_THAT(read("out.txt"), HasSubstr("problems: 1 of 1 solved, 1 certified\n"));
  EXPECT_EQ(count(read("err.txt"), "interrupted: 3 of 4 problems were not solved"), 1u);
}

/// Without the module, one line reports what to install.
TEST(MpiModule, IsNeededUnderMpirun) {
  if (fs::exists(fs::path(CORRIDOR_PROGRAM).parent_path() / "libcorridor_mpi.so"))
    GTEST_SKIP() << "the program was built with MPI; builds with a sanitizer test this";
  const std::string command =
      "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 '" CORRIDOR_PROGRAM
      "' benchmark none.yaml 2>&1 | grep -qx 'mpirun: Corridor was built without MPI; install "
      "libboost-mpi-dev and libopenmpi-dev, and build again by calling ./corridor --version "
      "without mpirun'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
