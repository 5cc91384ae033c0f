// Solution files: bit-for-bit round trips, strict reading, OMPL.app's .path.
#include "planner/solve/solution.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::HasSubstr;

class SolutionFile : public testing::Test {
 protected:
  ~SolutionFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string complaint(const std::string& name, const std::string& text,
                        RigidSpace space = RigidSpace::SE3) const {
    try {
      readSolution(write(name, text), space);
    } catch (const InputError& error) {
      std::string what = error.what();
      const std::string prefix = folder_.string() + "/";
      for (auto at = what.find(prefix); at != what.npos; at = what.find(prefix))
        what.erase(at, prefix.size());
      return what;
    }
    return "";
  }
  static Solution example(RigidSpace space) {
    Solution s;
    s.problem = "a \"quoted\" \\ name.yaml";
    s.digest = "0042";
    s.space = space;
    s.planner = "RRTConnect";
    s.seed = 18446744073709551615u;
    s.certified = true;
    s.checker = "certified";
    s.tolerance = 1.0 / 3;
    s.margin = 0.1;
    s.tube = {1e-300, 5e-12};
    for (const double v : {0.1, 1.0 / 3, -1e-310}) {
      RigidState state;
      state.pose.p = {v, -v, space == RigidSpace::SE3 ? 3 * v : 0};
      if (space == RigidSpace::SE3)
        state.pose.q = {1, v, v / 7, -v};
      else
        state.yaw = v / 7;
      s.path.push_back(state);
    }
    return s;
  }
  std::filesystem::path folder_ = test::newFolder();
};

TEST_F(SolutionFile, RoundTripIsBitForBit) {
  for (const RigidSpace space : {RigidSpace::SE2, RigidSpace::SE3}) {
    const Solution wrote = example(space);
    writeSolution(wrote, folder_ / "s.yaml");
    const Solution read = readSolution(folder_ / "s.yaml", space);
    EXPECT_EQ(read.digest, wrote.digest);
    EXPECT_EQ(read.planner, wrote.planner);
    EXPECT_EQ(read.seed, wrote.seed);
    EXPECT_EQ(read.certified, wrote.certified);
    EXPECT_EQ(read.checker, wrote.checker);
    EXPECT_EQ(read.tolerance, wrote.tolerance);
    EXPECT_EQ(read.margin, wrote.margin);
    EXPECT_EQ(read.tube.position, wrote.tube.position);
    EXPECT_EQ(read.tube.rotation, wrote.tube.rotation);
    EXPECT_THAT(read.problem, HasSubstr("a \"quoted\" \\ name.yaml"));
    ASSERT_EQ(read.path.size(), wrote.path.size());
    for (std::size_t i = 0; i < read.path.size(); ++i) {
      EXPECT_EQ(read.path[i].pose.p, wrote.path[i].pose.p);
      EXPECT_EQ(read.path[i].pose.q.coeffs(), wrote.path[i].pose.q.coeffs());
      EXPECT_EQ(read.path[i].yaw, wrote.path[i].yaw);
    }
  }
}

TEST_F(SolutionFile, NothingIsLeftWhereItCantBeWritten) {
  EXPECT_THROW(writeSolution(example(RigidSpace::SE3), folder_ / "nowhere" / "s.yaml"), InputError);
  writeSolution(example(RigidSpace::SE3), folder_ / "s.yaml");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(SolutionFile, DevicesAreWrittenToNotReplaced) {
  std::filesystem::create_symlink("/dev/null", folder_ / "sink");
  writeWhole(folder_ / "sink", "text");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "sink"));
}

TEST_F(SolutionFile, StrictReading) {
  const std::string head = "format: corridor-solution-1\nspace: SE3\n";
  EXPECT_EQ(complaint("s.yaml", head + "path:\n  - [0, 0, 0, 0, 0, 0, 1]\n"), "");
  EXPECT_EQ(complaint("s.yaml", head + "path:\n  - [0, 0, 0, 0, 0, 0, 0]\n"),
            "s.yaml:4: path: a quaternion of zeros is no rotation");
  EXPECT_THAT(complaint("s.yaml", head + "path:\n  - [0, 0, 0]\n"), HasSubstr("s.yaml:4: path"));
  EXPECT_THAT(complaint("s.yaml", head + "path:\n  - [0, 0, nan, 0, 0, 0, 1]\n"),
              HasSubstr("s.yaml:4: path"));
  EXPECT_THAT(complaint("s.yaml", head), HasSubstr("path"));
  EXPECT_THAT(complaint("s.yaml", head + "pth: []\n"), HasSubstr("\"pth\""));
  EXPECT_EQ(complaint("s.yaml", head + "path: [[0, 0, 0]]\n", RigidSpace::SE2),
            "s.yaml:2: space: the problem is in SE2, this solution in SE3");
  EXPECT_THAT(complaint("s.yaml", "format: corridor-problem-1\n"),
              HasSubstr("corridor-solution-1"));
  EXPECT_THAT(complaint("s.yaml", ""), HasSubstr("empty"));
}

TEST_F(SolutionFile, OmplAppPaths) {
  const Solution solution = readSolution(write("a.path", "1 2 0.5 \n\n3 4 -0.25"), RigidSpace::SE2);
  ASSERT_EQ(solution.path.size(), 2u);
  EXPECT_EQ(solution.path[1].xyYaw(), Vec3(3, 4, -0.25));
  EXPECT_TRUE(solution.digest.empty());
  EXPECT_EQ(complaint("a.path", "1 2 3\n1 2\n", RigidSpace::SE2),
            "a.path:2: a state of SE2 has 3 numbers (x y yaw), not 2");
  EXPECT_THAT(complaint("a.path", "1 2 x\n", RigidSpace::SE2), HasSubstr("a.path:1: "));
  EXPECT_EQ(complaint("a.path", "0 0 0 0 0 0 0\n"),
            "a.path:1: a quaternion of zeros is no rotation");
}

}  // namespace
}  // namespace corridor
