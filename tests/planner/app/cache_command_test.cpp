// Tests of the cache as users meet it: `corridor cache`, and that answers do not depend on it.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"
#include "tests/support/meshes.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;

/// An arm whose lower link is a mesh of 1,728 triangles, and a post beside it.
class CacheCommand : public ArmTest {
 protected:
  CacheCommand() {
    std::ofstream out(folder_ / "lower.obj");
    const TriangleMesh cube = tessellatedCube(12);
    for (const Vec3& v : cube.vertices) out << "v " << v.transpose() << '\n';
    for (const auto& t : cube.triangles)
      out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    out.close();
    std::string urdf = read("arm.urdf");
    const std::string box = "<box size=\"0.8 0.1 0.1\"/>";
    urdf.replace(urdf.rfind(box), box.size(),
                 "<mesh filename=\"lower.obj\" scale=\"0.4 0.05 0.05\"/>");
    write("arm.urdf", urdf);
    cache_ = folder_ / "cache";
  }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::directory_iterator(cache_)) all.push_back(entry);
    return all;
  }
  /// Solves the problem, and returns the solution's file.
  std::string solution() const {
    const Result result = run("solve arm.yaml --seed 3 -o s.yaml");
    EXPECT_EQ(result.status, 0) << result.err;
    return read("s.yaml");
  }
};

TEST_F(CacheCommand, AnswersAreTheSameWithAnyCache) {
  const std::string folder = cache_;
  cache_ = "off";
  const std::string without = solution();
  EXPECT_FALSE(std::filesystem::exists(folder));
  cache_ = folder;
  EXPECT_EQ(solution(), without) << "an empty cache";
  EXPECT_EQ(files().size(), 3u) << "the mesh, its tree, its hull";
  EXPECT_EQ(solution(), without) << "a full cache";
  for (const auto& file : files()) {
    const std::string bytes = contents(file);
    std::string damaged = bytes;
    damaged[damaged.size() / 2] ^= 1;
    std::ofstream(file, std::ios::binary) << damaged;
    const Result result = run("solve arm.yaml --seed 3 -o s.yaml");
    EXPECT_EQ(read("s.yaml"), without);
    EXPECT_THAT(result.out, HasSubstr("note: in the cache " + cache_ +
                                      ", 1 file had damaged contents, which are not used (\"" +
                                      file.filename().string() + "\")"));
    EXPECT_EQ(contents(file), bytes) << "it was written anew";
  }
}

TEST_F(CacheCommand, SolvingManyProblemsFillsItAndPrintsItsNotesOnce) {
  EXPECT_EQ(run("solve arm.yaml arm.yaml --jobs 2 --seed 3").status, 0);
  EXPECT_EQ(files().size(), 3u) << "children write, too";
  std::filesystem::permissions(cache_, std::filesystem::perms::others_write,
                               std::filesystem::perm_options::add);
  const Result result = run("solve arm.yaml arm.yaml --seed 3 --json");
  EXPECT_EQ(result.status, 0);
  const std::string note = "the cache in " + cache_ + " is not used: other users may write to it";
  const auto first = result.err.find("corridor: note: " + note);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(result.err.find(note, first + note.size()), std::string::npos) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  for (const auto& report : json["problems"]) {
    EXPECT_FALSE(report.contains("cache_notes"));
    EXPECT_THAT(report["notes"].back().get<std::string>(), HasSubstr(note));
  }
}

TEST_F(CacheCommand, VerifyDoesNotReadIt) {
  solution();
  for (const auto& file : files()) {  // verify would print notes on these
    std::ofstream(file, std::ios::binary) << "damaged";
  }
  const Result result = run("verify arm.yaml s.yaml");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out + result.err, testing::Not(HasSubstr("damaged")));
  for (const auto& file : files()) EXPECT_EQ(contents(file), "damaged");
}

TEST_F(CacheCommand, BuildsShowsAndClears) {
  for (const std::string file : {"arm.urdf", "arm.yaml", "."}) {
    if (file == ".") {
      write("robot.yaml", "format: corridor-robot-1\nurdf: arm.urdf\n");
      std::filesystem::remove(folder_ / "problem.yaml");
    }
    EXPECT_THAT(run("cache build " + file).out,
                testing::MatchesRegex(file + ": 3 files added in [0-9.]+ s\n"));
    EXPECT_EQ(run("cache build " + file).out, file + ": nothing to add\n");
    EXPECT_THAT(run("cache").out,
                testing::MatchesRegex("folder: " + cache_ +
                                      "\nfiles: 3\nsize: [0-9.]+ kB of at most 1 GB\n"));
    EXPECT_EQ(run("cache clear").out, "3 files removed\n");
  }
  EXPECT_EQ(run("cache clear").out, "0 files removed\n");
}

TEST_F(CacheCommand, BuildReplacesDamagedFilesAndGoesOnAfterAFault) {
  run("cache build arm.urdf");
  for (const auto& file : files()) {
    std::ofstream(file, std::ios::binary) << "damaged";
  }
  const Result result = run("cache build none.urdf arm.urdf");
  EXPECT_THAT(result.out, testing::MatchesRegex("arm.urdf: 3 files added in [0-9.]+ s\n"));
  EXPECT_THAT(result.err, HasSubstr("3 files had damaged contents"));
  EXPECT_THAT(result.err, HasSubstr("none.urdf: no such file"));
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(run("cache build arm.urdf").out, "arm.urdf: nothing to add\n");
}

TEST_F(CacheCommand, BadInputIsOneLineAndExit2) {
  expectFault("cache build none.urdf", "none.urdf: no such file");
  expectFaultThatBegins("cache build", "ROBOT|PROBLEM is required");
  expectFault("cache build lower.obj",
              "lower.obj: is neither a robot nor a problem; name one that uses it");
  for (const char* const off : {"off", "OFF", "no", "0"}) {
    cache_ = off;
    expectFault("cache",
                "corridor: there is no cache, since the variable CORRIDOR_CACHE turns it off");
  }
  cache_ = "/proc/none/cache";
  expectFaultThatBegins("cache build arm.urdf",
                        "corridor: in the cache /proc/none/cache, 3 files could not be written");
  write("file", "x");
  cache_ = folder_ / "file";
  for (const char* const command : {"cache", "cache clear", "cache build arm.urdf"})
    expectFault(command, "corridor: the cache in " + cache_ + " is not used: it is not a folder");
  const Result result = run("solve arm.yaml");
  EXPECT_EQ(result.status, 0) << "a cache that can't be used is a note";
  EXPECT_THAT(result.out, HasSubstr("note: the cache in " + cache_ + " is not used"));
}

TEST_F(CacheCommand, BenchmarksUseItOnRequest) {
  const std::string arguments = "benchmark arm.yaml --variants certified --runs 1 --json";
  const Result without = run(arguments);
  EXPECT_THAT(without.out, testing::Not(HasSubstr("--cache")));
  EXPECT_FALSE(std::filesystem::exists(cache_));
  const Result with = run(arguments + " --cache");
  EXPECT_EQ(with.status, 0) << with.err;
  EXPECT_THAT(with.out, HasSubstr("filled before the runs (--cache)"));
  EXPECT_EQ(files().size(), 2u) << "tree and hull";
  cache_ = "off";
  expectFaultThatBegins(arguments + " --cache", "corridor: there is no cache");
}

TEST_F(CacheCommand, ACampaignDoesNotMixRunsWithAndWithoutIt) {
  const std::string arguments = "benchmark arm.yaml --variants certified -o results ";
  ASSERT_EQ(run(arguments + "--runs 1 --cache").status, 0);
  const Result mixed = run(arguments + "--runs 2 --resume");
  EXPECT_EQ(mixed.status, 2);
  EXPECT_THAT(mixed.err, HasSubstr("was measured with cache true, not false"));
  EXPECT_EQ(run(arguments + "--runs 2 --resume --cache").status, 0);
}

TEST_F(CacheCommand, IsInTheUsersFolderByDefault) {
  const auto runIn = [&](const std::string& variables) {
    return run("cache", "unset CORRIDOR_CACHE XDG_CACHE_HOME; export " + variables + "; ");
  };
  const std::string home = folder_;
  EXPECT_THAT(runIn("HOME=" + home + " XDG_CACHE_HOME=/x").out, HasSubstr("folder: /x/corridor\n"));
  EXPECT_THAT(runIn("HOME=" + home).out, HasSubstr("folder: " + home + "/.cache/corridor\n"));
  EXPECT_THAT(runIn("HOME=" + home + " XDG_CACHE_HOME=relative").out,
              HasSubstr("folder: " + home + "/.cache/corridor\n"));
  EXPECT_THAT(runIn("HOME=/none").err,
              HasSubstr("there is no cache, since neither CORRIDOR_CACHE nor XDG_CACHE_HOME nor "
                        "HOME names a folder"));
  cache_ = "named";  // in the working directory
  EXPECT_THAT(run("cache build arm.urdf").out, HasSubstr("3 files added"));
  EXPECT_THAT(run("cache").out, HasSubstr("folder: " + home + "/named\n"));
}

}  // namespace
}  // namespace corridor::test
