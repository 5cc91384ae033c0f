// `corridor course`: planes, polygons, linear programs, moving boxes.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/program_test.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class CourseCommand : public ProgramTest {
 protected:
  /// Runs the command, and returns the cells of its CSV.
  std::vector<std::vector<std::string>> table(const std::string& arguments) const {
    const Result result = run("course " + arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::vector<std::string>> all;
    for (const std::string& line : lines(result.out)) {
      all.emplace_back(1);
      for (const char c : line)
        if (c == ',')
          all.back().emplace_back();
        else
          all.back().back() += c;
    }
    return all;
  }
  std::string fault(const std::string& arguments) const {
    const Result result = run("course " + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    return result.err;
  }
};

TEST_F(CourseCommand, PlanesAndACube) {
  std::string cube;
  for (int i = 0; i < 8; ++i)
    cube += "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " +
            std::to_string(i >> 2) + "\n";
  write("cube.obj", cube + "f 1 2 3\nf 6 7 8\nf 4 5 6\n");
  // One plane above the cube, one below, one through its corner (1, 1, 1), one that cuts it.
  write("planes.txt", "0 0 2 4\n0 0 -1 0.5\n1 1 1 3\n1,0,0,0.25\n");
  const auto rows = table("plane cube.obj planes.txt");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0][0], "plane");
  EXPECT_EQ(rows[1][1], "-1");
  EXPECT_NEAR(std::stod(rows[1][2]), 1, 1e-14);
  EXPECT_LE(std::stod(rows[1][2]), 1);
  EXPECT_GE(std::stod(rows[1][3]), 1);
  EXPECT_EQ(rows[2][1], "-1");
  EXPECT_NEAR(std::stod(rows[2][2]), 0.5, 1e-14);
  EXPECT_EQ(rows[3][1], "0");
  EXPECT_EQ(rows[3][6], "7");  // the outermost vertex
  EXPECT_EQ(rows[4][1], "0");
  EXPECT_NEAR(std::stod(rows[4][3]), -0.25, 1e-14);
  EXPECT_EQ(fault("plane cube.obj cube.obj").substr(0, 11), "cube.obj:1:");
  write("planes.txt", "0 0 0 1\n");
  EXPECT_EQ(fault("plane cube.obj planes.txt"), "planes.txt:1: the normal is 0\n");
  write("planes.txt", "0 0 1\n");
  EXPECT_EQ(fault("plane cube.obj planes.txt"),
            "planes.txt:1: a plane has 4 numbers (nx ny nz d), not 3\n");
}

TEST_F(CourseCommand, PolygonsByEachMethod) {
  write("p.txt", "0 0\n1 0\n1 1\n0 1\n0.5 0.5  # inside\n");
  for (const auto& [shift, hit] :
       {std::pair("2", "0"), std::pair("1", "1"), std::pair("0.5", "1")}) {
    write("q.txt", std::string(shift) + " 0.25\n3 0\n3 1\n");
    const auto rows = table("polygons p.txt q.txt");
    ASSERT_EQ(rows.size(), 4u);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(rows[i][1], hit) << rows[i][0] << " " << shift;
  }
  write("q.txt", "0 0\n1 1\n2 2\n");
  EXPECT_THAT(fault("polygons p.txt q.txt"), StartsWith("q.txt: "));
}

TEST_F(CourseCommand, LinearPrograms) {
  // The largest x + 2y with x ≤ 3, y ≤ 4, x + y ≤ 5 is 9, at (1, 4).
  write("lp.txt", "1 2\n1 0 3\n0 1 4\n1 1 5\n-1 0 0\n");
  auto rows = table("program lp.txt");
  EXPECT_EQ(rows[0], (std::vector<std::string>{"status", "optimal"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"value", "9"}));
  EXPECT_EQ(rows[2], (std::vector<std::string>{"x", "1", "4"}));
  ASSERT_EQ(rows[3][0], "weight");
  EXPECT_EQ(rows[5], (std::vector<std::string>{"exact", "1"}));
  write("lp.txt", "1 2 0 0 0 1\n1 0 0 0 0 0 3\n");
  rows = table("program lp.txt");
  EXPECT_EQ(rows[0][1], "unbounded");
  EXPECT_EQ(rows[1][0], "x");
  EXPECT_EQ(rows[2].size(), 7u);
  write("lp.txt", "0 0 0\n1 1 1 1\n-1 -1 -1 -2\n");
  rows = table("program lp.txt");
  EXPECT_EQ(rows[0][1], "infeasible");
  EXPECT_EQ(rows[1][2], rows[2][2]);  // both weights are equal
  write("lp.txt", "1 2 3 4 5 6 7\n1 1\n");
  EXPECT_THAT(fault("program lp.txt"),
              HasSubstr("lp.txt:1: the first line is the goal, with 2 to 6 "
                        "numbers, not 7"));
  write("lp.txt", "1 2\n1 1\n");
  EXPECT_EQ(fault("program lp.txt"),
            "lp.txt:2: a half-space has one number more than the goal (a1 … ad b), not 2\n");
}

TEST_F(CourseCommand, MovingBoxes) {
  write("boxes.txt",
        "0 0 0 0 0 1 1 1\n0 1 1 0 0 2 1 1\n0 2 5 0 0 6 1 1\n"  // 0 and 1 touch
        "1 2 1.5 0 0 2.5 1 1\n"                                // 2 moves onto 1
        "2 0 9 0 0 10 1 1\n2 2 1.6 0 0 2.6 1 1\n");            // 0 leaves
  const auto rows = table("boxes boxes.txt");
  ASSERT_EQ(rows.size(), 4u);
  const auto pairs = [&](std::size_t step) { return rows[step + 1][2]; };
  EXPECT_EQ(pairs(0), "1");
  EXPECT_EQ(pairs(1), "2");
  EXPECT_EQ(pairs(2), "1");
  EXPECT_EQ(rows[3][1], "2");
  write("boxes.txt", "0 0 0 0 0 1 1 1\n0 2 0 0 0 1 1 1\n");
  EXPECT_EQ(fault("boxes boxes.txt"), "boxes.txt:2: box 1 comes next, not 2\n");
  write("boxes.txt", "0 0 0 0 0 1 1 1\n1 1 0 0 0 1 1 1\n");
  EXPECT_EQ(fault("boxes boxes.txt"), "boxes.txt:2: step 0 has no box 1\n");
  write("boxes.txt", "0 0 0 0 0 1 1 1\n2 0 0 0 0 1 1 1\n");
  EXPECT_EQ(fault("boxes boxes.txt"), "boxes.txt:2: the step must be 0 or one more, not 2\n");
  write("boxes.txt", "0 0 0 0 2 1 1 1\n");
  EXPECT_EQ(fault("boxes boxes.txt"),
            "boxes.txt:1: an upper bound is below the lower bound of the same axis\n");
}

TEST_F(CourseCommand, ATopicIsRequired) {
  EXPECT_EQ(run("course").status, 2);
  EXPECT_THAT(run("course --help").out, HasSubstr("polygons"));
  EXPECT_THAT(run("--help").out, HasSubstr("course"));
}

}  // namespace
}  // namespace corridor::test
