// Tests of the cache as users meet it: `corridor cache`, and that answers do not depend on it.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    EXPECT_THAT(result.out, HasSubstr("note: " + file.string() + " is damaged, and is not used"));
    EXPECT_EQ(contents(file), bytes) << "it was written anew";
  }
  ASSERT_EQ(run("cache clear").out, "3 files removed\n");
  EXPECT_EQ(run("solve arm.yaml arm.yaml --jobs 2 --seed 3").status, 0);
  EXPECT_EQ(files().size(), 3u) << "children write, too";
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
  for (const char* const file : {"arm.urdf", "arm.yaml", "."}) {
    if (std::string(file) == ".") {
      write("robot.yaml", "format: corridor-robot-1\nurdf: arm.urdf\n");
      std::filesystem::remove(folder_ / "problem.yaml");
    }
    EXPECT_EQ(run("cache build " + std::string(file)).out,
              "0 results were in the cache, 3 were added\n");
    EXPECT_EQ(run("cache build " + std::string(file)).out,
              "3 results were in the cache, 0 were added\n");
    EXPECT_THAT(run("cache").out, testing::MatchesRegex("folder: " + cache_ +
                                                        "\nfiles: 3\nsize: [0-9.]+ MB of at most "
                                                        "[0-9.]+ MB\n"));
    EXPECT_EQ(run("cache clear").out, "3 files removed\n");
  }
  EXPECT_EQ(run("cache clear").out, "0 files removed\n");
}

TEST_F(CacheCommand, BadInputIsOneLineAndExit2) {
  expectFault("cache build none.urdf", "none.urdf: no such file");
  expectFaultThatBegins("cache build", "FILE is required");
  cache_ = "off";
  expectFaultThatBegins("cache",
                        "CORRIDOR_CACHE: there is no cache, since this variable is \"off\"");
  write("file", "x");
  cache_ = folder_ / "file";
  for (const char* const command : {"cache", "cache clear", "cache build arm.urdf"})
    expectFault(command,
                "CORRIDOR_CACHE: the cache in " + cache_ + " is not used: it is not a folder");
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
  expectFaultThatBegins(arguments + " --cache", "CORRIDOR_CACHE: there is no cache");
}

TEST_F(CacheCommand, IsInTheUsersFolderByDefault) {
  const auto runIn = [&](const std::string& variables) {
    return run("cache", "unset CORRIDOR_CACHE XDG_CACHE_HOME; export " + variables + "; ");
  };
  EXPECT_THAT(runIn("HOME=/h XDG_CACHE_HOME=/x").out, HasSubstr("folder: /x/corridor\n"));
  EXPECT_THAT(runIn("HOME=/h").out, HasSubstr("folder: /h/.cache/corridor\n"));
  EXPECT_THAT(runIn("HOME=/h XDG_CACHE_HOME=relative").out,
              HasSubstr("folder: /h/.cache/corridor\n"));
}

}  // namespace
}  // namespace corridor::test
