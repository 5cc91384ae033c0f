// Tests of solution files: they read back bit for bit, reading is strict, and OMPL.app's .path
// files are supported.
#include "planner/solve/solution.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "collision/core/whole_file.h"
#include "planner/solve/state_rows.h"
#include "planner/solve/verify_solution.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Rigid;
using testing::HasSubstr;

class SolutionFile : public testing::Test {
 protected:
  ~SolutionFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string complaint(const std::string& name, const std::string& text,
                        Rigid kind = Rigid::SE3) const {
    return complaint(name, text, test::rigidProblem(kind).model.space);
  }
  std::string complaint(const std::string& name, const std::string& text,
                        const ConfigurationSpace& space) const {
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
  static Solution example(const ConfigurationSpace& space) {
    Solution s;
    s.problem = "a \"quoted\" \\ name.yaml";
    s.digest = "0042";
    s.space = rigidSpaceOf(space);
    s.numbers = space.numberNames();
    s.planner = "RRTConnect";
    s.seed = 18446744073709551615u;
    s.certified = true;
    s.checker = "certified";
    s.tolerance = 1.0 / 3;
    s.margin = 0.1;
    const auto size = static_cast<Eigen::Index>(space.size());
    s.tube = Configuration::Zero(size);
    for (const Coordinate& c : space.coordinates())
      s.tube[static_cast<Eigen::Index>(c.first)] =
          c.kind == Coordinate::Kind::line && !c.angular ? 1e-300 : 5e-12;
    for (const double v : {0.1, 1.0 / 3, -1e-310}) {
      Configuration q(size);
      for (Eigen::Index i = 0; i < size; ++i) q[i] = v / static_cast<double>(i + 1);
      s.path.push_back(q);
    }
    return s;
  }
  std::filesystem::path folder_ = test::newFolder();
};

TEST_F(SolutionFile, RoundTripIsBitForBit) {
  for (const ConfigurationSpace& space :
       {test::rigidProblem(Rigid::SE2).model.space, test::rigidProblem(Rigid::SE3).model.space,
        test::armProblem().model.space}) {
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
    EXPECT_EQ(read.tube, wrote.tube);
    EXPECT_EQ(read.space, wrote.space);
    EXPECT_EQ(read.numbers, wrote.numbers);
    EXPECT_THAT(read.problem, HasSubstr("a \"quoted\" \\ name.yaml"));
    ASSERT_EQ(read.path.size(), wrote.path.size());
    for (std::size_t i = 0; i < read.path.size(); ++i) EXPECT_EQ(read.path[i], wrote.path[i]);
  }
}

TEST_F(SolutionFile, RigidBodiesNameTheirSpace) {
  EXPECT_EQ(rigidSpaceOf(test::rigidProblem(Rigid::SE2).model.space), "SE2");
  EXPECT_EQ(rigidSpaceOf(test::rigidProblem(Rigid::SE3).model.space), "SE3");
  EXPECT_EQ(rigidSpaceOf(test::armProblem().model.space), "");
}

TEST_F(SolutionFile, LeavesNoFileIfItCannotBeWritten) {
  EXPECT_THROW(writeSolution(example(test::rigidProblem(Rigid::SE3).model.space),
                             folder_ / "nowhere" / "s.yaml"),
               InputError);
  writeSolution(example(test::rigidProblem(Rigid::SE3).model.space), folder_ / "s.yaml");
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
  EXPECT_EQ(complaint("s.yaml", head + "path: [[0, 0, 0]]\n", Rigid::SE2),
            "s.yaml:2: space: the problem is in SE2, this solution in SE3");
  EXPECT_THAT(complaint("s.yaml", "format: corridor-problem-1\n"),
              HasSubstr("corridor-solution-1"));
  EXPECT_THAT(complaint("s.yaml", ""), HasSubstr("empty"));
}

TEST_F(SolutionFile, JointsAreNamed) {
  const ConfigurationSpace space = test::armProblem().model.space;
  const std::string head = "format: corridor-solution-1\njoints: [shoulder, elbow, wrist]\n";
  EXPECT_EQ(complaint("s.yaml", head + "path:\n  - [0, 1, 2]\n", space), "");
  EXPECT_EQ(complaint("s.yaml", head + "path:\n  - [0, 1]\n", space),
            "s.yaml:4: path: a list of 3 numbers is needed, not a list of 2");
  EXPECT_EQ(
      complaint("s.yaml", "format: corridor-solution-1\nspace: SE3\npath: [[0, 0, 0]]\n", space),
      "s.yaml:2: space: the problem is in the joints [\"shoulder\", \"elbow\", \"wrist\"], "
      "this solution in SE3");
  EXPECT_EQ(complaint("s.yaml",
                      "format: corridor-solution-1\njoints: [elbow, shoulder, wrist]\npath: [[0, "
                      "0, 0]]\n",
                      space),
            "s.yaml:2: joints: the problem is in the joints [\"shoulder\", \"elbow\", \"wrist\"], "
            "this solution in [\"elbow\", \"shoulder\", \"wrist\"]");
  EXPECT_EQ(complaint("s.yaml", head + "path: [[0, 1, 2]]\ntube: [0, -1, 0]\n", space),
            "s.yaml:4: tube: numbers of at least 0 are needed");
}

TEST_F(SolutionFile, StateRowsTakeCommasAndComments) {
  const ConfigurationSpace space = test::armProblem().model.space;
  std::vector<Note> notes;
  const auto rows = readStateRows(
      write("s.txt", "# shoulder elbow wrist\n1, 2,3\n\n-1 0 .5 # low\n"), space, notes);
  EXPECT_TRUE(notes.empty());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].q, Vec3(1, 2, 3));
  EXPECT_EQ(rows[1].q, Vec3(-1, 0, 0.5));
  EXPECT_EQ(rows[1].line, 4);
  EXPECT_EQ(complaint("a.path", "1 2 3\n1 2\n", space),
            "a.path:2: a state has 3 numbers (shoulder elbow wrist), not 2");
}

/// What comments may mean is tested with TableLines.
TEST_F(SolutionFile, CommentsThatMayMeanOtherColumns) {
  const ConfigurationSpace space = test::armProblem().model.space;
  EXPECT_EQ(complaint("a.path", "# shoulder [rad] elbow [rad] wrist [rad]\n1 2 3\n", space),
            "a.path:1: the comment seems to be a header, but is not one; write the names only, "
            "as in \"shoulder,elbow,wrist\" (rad, m), or delete the comment");
  EXPECT_EQ(complaint("a.path", "# in degrees\n1 2 3\n", space).substr(0, 11), "a.path:1: t");
  EXPECT_EQ(complaint("a.path", "1,,2,3\n", space), "a.path:1: the field before comma 2 is empty");
  EXPECT_EQ(complaint("a.path", "Shoulder Elbow Wrist\n1 2 3\n", space).substr(0, 32),
            "a.path:1: the header has the col");
  std::vector<Note> notes;
  const std::string three = "shoulder elbow wrist ", row = "0 0 0 1 1 1\n";
  EXPECT_EQ(readEdgeRows(write("e.txt", "# " + three + three + "\n" + row), space, notes).size(),
            1u);
  EXPECT_THROW(readEdgeRows(write("e.txt", "# wrist elbow shoulder\n" + row), space, notes),
               InputError);
  EXPECT_TRUE(notes.empty());
  readStateRows(write("s.txt", "wrist elbow shoulder\n# a title\n1 2 3 # low\n"), space, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0].text,
              testing::EndsWith(
                  "s.txt: comments are not read: \" a title\" (line 2), \" low\" (line 3); the "
                  "columns are wrist, elbow, shoulder, in this order, in m and rad"));
  EXPECT_EQ(readSolution(write("a.path", "# a title\n1 2 3\n"), space).notes.size(), 1u);
}

TEST_F(SolutionFile, OmplAppPaths) {
  const Solution solution = readSolution(write("a.path", "1 2 0.5 \n\n3 4 -0.25"),
                                         test::rigidProblem(Rigid::SE2).model.space);
  ASSERT_EQ(solution.path.size(), 2u);
  EXPECT_EQ(solution.path[1], Vec3(3, 4, -0.25));
  EXPECT_TRUE(solution.digest.empty());
  EXPECT_EQ(complaint("a.path", "1 2 3\n1 2\n", Rigid::SE2),
            "a.path:2: a state of SE2 has 3 numbers (x y yaw), not 2");
  EXPECT_THAT(complaint("a.path", "1 2 x\n", Rigid::SE2), HasSubstr("a.path:1: "));
  EXPECT_EQ(complaint("a.path", "0 0 0 0 0 0 0\n"),
            "a.path:1: a quaternion of zeros is no rotation");
}

}  // namespace
}  // namespace corridor
