// Tests of `corridor query`: CSV on stdout, key=value on stderr, one line per fault.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/query/query_fixture.h"
#include "tests/support/workload.h"

namespace {

using corridor::test::kStill;
using corridor::test::QueryCommand;
using testing::Eq;
using testing::HasSubstr;

/// Tests the convex hulls of two unit cubes with every method.
TEST_F(QueryCommand, Hulls) {
  std::string cube;
  for (int i = 0; i < 8; ++i)
    cube += "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " +
            std::to_string(i >> 2) + "\n";
  write("a.obj", cube + "v 0.5 0.5 0.5\nf 1 2 3\nf 6 7 8\nf 4 5 9\n");  // one vertex is inside
  write("b.obj", cube + "f 1 2 3\nf 6 7 8\nf 4 5 6\n");
  write("poses.txt", kStill + "1.5 0 0\n" + kStill + "1 1 1\n" + kStill + "0.75 0 0.5\n");
  for (const char* method :
       {"hierarchy", "climbing", "every-vertex", "lp", "vclip", "axes", "barba-langerman"}) {
    const Result result = query(std::string("--poses poses.txt --hulls ") + method);
    EXPECT_EQ(result.status, 0) << result.err;
    const auto rows = lines(result.out);
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0], "pose,hit,steps");
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(rows[i + 1].starts_with(std::array{"0,0,", "1,1,", "2,1,"}[i])) << method;
    const auto figures = summary(result);
    EXPECT_EQ(figures.at("hulls"), method);
    EXPECT_EQ(figures.at("vertices_a"), "8");
    EXPECT_EQ(figures.at("hits"), "2");
  }
  for (const char* method : {"hierarchy", "climbing", "every-vertex", "vclip", "descent"}) {
    const auto d = rows(std::string("--poses poses.txt --query distance --hulls ") + method);
    ASSERT_EQ(d.size(), 3u);
    ASSERT_EQ(d[0].size(), 13u);
    EXPECT_NEAR(d[0][1], 0.5, 1e-15);
    EXPECT_NEAR(d[0][3], 1, 1e-15);  // the normal
    EXPECT_EQ(d[1][1], 0);
    EXPECT_GE(d[0][12], 1);  // steps
    if (std::string(method) == "vclip" || std::string(method) == "descent") continue;
    const auto p = rows(std::string("--poses poses.txt --query depth --hulls ") + method);
    EXPECT_EQ(p[0][2], 0);
    EXPECT_LE(p[1][1], 1e-13);
    EXPECT_LE(p[2][1], 0.25);
    EXPECT_GE(p[2][2], 0.25);
    EXPECT_NEAR(p[2][1], p[2][2], 1e-12);
    EXPECT_NEAR(p[2][3], 1, 1e-15);
  }
}

/// Tests the penetration depth of two unit cubes that are given as meshes.
TEST_F(QueryCommand, DepthOfMeshes) {
  std::string cube;
  for (int i = 0; i < 8; ++i)
    cube += "v " + std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " +
            std::to_string(i >> 2) + "\n";
  cube += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  write("a.obj", cube);
  write("b.obj", cube);
  write("poses.txt", kStill + "1.5 0 0\n" + kStill + "0.75 0.1 0.2\n");
  const auto best = rows("--poses poses.txt --query depth");
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0], (std::vector<double>{0, 0, 0, 0, 0, 0, -1, -1}));
  EXPECT_LE(best[1][1], 0.25);
  EXPECT_GE(best[1][2], 0.25);
  EXPECT_NEAR(best[1][2], 0.25, 1e-4);
  EXPECT_NEAR(best[1][3], 1, 1e-12);
  EXPECT_GE(best[1][6], 0);
  const auto up = rows("--poses poses.txt --query depth --direction 0,0,3");
  EXPECT_NEAR(up[1][2], 0.8, 1e-4);
  EXPECT_EQ(up[1][5], 1);
  for (const std::string method : {"hierarchy", "climbing", "every-vertex", "descent"}) {
    const auto hulls = rows("--poses poses.txt --query depth --direction 0,0,3 --hulls " + method);
    ASSERT_EQ(hulls.size(), 2u);
    EXPECT_EQ(hulls[0][2], 0);
    EXPECT_LE(hulls[1][1], 0.8);
    EXPECT_GE(hulls[1][2], 0.8);
    EXPECT_NEAR(hulls[1][2], 0.8, 1e-8);
    if (method == "descent") {
      EXPECT_EQ(hulls[1][1], 0);  // it proves no lower bound
    } else {
      EXPECT_NEAR(hulls[1][1], hulls[1][2], 1e-8);
    }
    EXPECT_EQ(hulls[1][5], 1);
  }
  const auto fault = [&](const std::string& options) {
    const Result result = query("--poses poses.txt " + options);
    EXPECT_EQ(result.status, 2) << options;
    return result.err;
  };
  EXPECT_EQ(fault("--query depth --direction 0,0,0"),
            "--direction: 0,0,0 is no direction; give a vector x,y,z\n");
  EXPECT_EQ(fault("--direction 0,0,1"), "--direction: needs --query depth\n");
  EXPECT_EQ(fault("--query depth --volume aabb"),
            "--volume: can't be used with --query depth, which chooses its trees\n");
  EXPECT_EQ(fault("--query depth --deform b.obj"),
            "--deform: can't be used with --query depth; use interference, distance or "
            "tolerance\n");
  EXPECT_EQ(fault("--query depth --tolerance 1"),
            "--tolerance: needs --query tolerance or --motions\n");
}

/// A box of many faces moves past another box in small steps. With --coherent the answers must be
/// the same, and take fewer steps.
TEST_F(QueryCommand, CoherentHulls) {
  std::string rings, poses;
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.1 * i, tilt = 0.37 * i;
    rings += "v " + std::to_string(std::cos(angle) * std::sin(tilt)) + " " +
             std::to_string(std::sin(angle) * std::sin(tilt)) + " " +
             std::to_string(std::cos(tilt)) + "\n";
  }
  for (int i = 1; i <= 198; ++i)
    rings +=
        "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  write("a.obj", rings);
  write("b.obj", rings);
  for (int i = 0; i < 100; ++i)
    poses += kStill + std::to_string(2.2 - 0.01 * i) + " " + std::to_string(0.01 * i) + " 0.3\n";
  write("poses.txt", poses);
  for (const std::string method : {"climbing", "vclip", "axes"})
    for (const std::string query : {"interference", "distance"}) {
      if (method == "axes" && query == "distance") continue;
      const std::string options = "--poses poses.txt --hulls " + method + " --query " + query;
      const Result cold = this->query(options), warm = this->query(options + " --coherent");
      ASSERT_EQ(warm.status, 0) << warm.err;
      const auto coldRows = lines(cold.out), warmRows = lines(warm.out);
      ASSERT_EQ(warmRows.size(), 101u);
      for (std::size_t i = 1; i <= 100; ++i) {
        const auto second = [](const std::string& row) {
          return std::stod(row.substr(row.find(',') + 1));
        };
        EXPECT_NEAR(second(coldRows[i]), second(warmRows[i]), 1e-11) << method << query << i;
      }
      const auto coldFigures = summary(cold), warmFigures = summary(warm);
      EXPECT_EQ(warmFigures.at("hits"), coldFigures.at("hits"));
      EXPECT_EQ(warmFigures.at("coherent"), "1");
      EXPECT_EQ(coldFigures.at("coherent"), "0");
      if (method == "climbing" && query == "interference") continue;
      EXPECT_LT(std::stod(warmFigures.at("steps")), std::stod(coldFigures.at("steps"))) << method;
    }
}

/// The triangles of the fixture are flat hulls: GJK and linear programming take them.
TEST_F(QueryCommand, FlatHulls) {
  for (const std::string method : {"hierarchy", "climbing", "every-vertex", "lp"}) {
    const Result result = query("--poses poses.txt --hulls " + method);
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> hits;
    for (const std::string& row : lines(result.out)) hits.push_back(row.substr(0, 3));
    EXPECT_EQ(hits, (std::vector<std::string>{"pos", "0,1", "1,1", "2,0", "3,1"})) << method;
    EXPECT_EQ(result.err.starts_with("note: a.obj: the hull is flat, so every vertex is tested"),
              method == "hierarchy" || method == "climbing")
        << result.err;
  }
  const auto distances = rows("--poses poses.txt --hulls hierarchy --query distance");
  EXPECT_NEAR(distances[2][1], 1e-7, 1e-15);
}

TEST_F(QueryCommand, HugeHullsAreNoted) {
  write("a.obj", "v 0 0 0\nv 1e140 0 0\nv 0 1e140 0\nv 0 0 1e140\nf 1 2 3\nf 1 2 4\n");
  EXPECT_THAT(query("--poses poses.txt --hulls every-vertex").err,
              HasSubstr("note: a.obj: a coordinate is not within 1e-132 to 1e132 m"));
}

/// Content of a mesh file that is not read is named, as by all commands.
TEST_F(QueryCommand, NotesOnMeshFiles) {
  write("b.obj", "# units: mm\nv 1 1 -1\nv 1 1 1\nv 3 1 1\nf 1 2 3\nl 1 2\n");
  write("motions.txt", kStill + "0 0 9 " + kStill + "0 0 10\n");
  for (const char* const input :
       {"--poses poses.txt", "--motions motions.txt", "--poses poses.txt --hulls every-vertex"}) {
    const std::string err = query(input).err;
    EXPECT_THAT(err, HasSubstr("note: b.obj: lines and points have no volume")) << input;
    EXPECT_THAT(err, HasSubstr("note: b.obj: line 1 says \"units: mm\"")) << input;
  }
}

TEST_F(QueryCommand, HullsOnBadInput) {
  const auto fault = [&](const std::string& options) {
    const Result result = query("--poses poses.txt " + options);
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_EQ(result.out, "") << options;
    return result.err;
  };
  EXPECT_EQ(fault("--hulls vclip"),
            "a.obj: --hulls vclip needs a solid hull: the points of a polytope must not all be on "
            "one plane; use --hulls every-vertex\n");
  EXPECT_THAT(fault("--hulls descent"), HasSubstr("descent needs --query distance"));
  EXPECT_THAT(fault("--hulls descent --query depth"),
              HasSubstr("or --query depth with --direction"));
  EXPECT_THAT(fault("--hulls hirarchy"),
              HasSubstr("--hulls: unknown method \"hirarchy\" (did you mean \"hierarchy\"?)"));
  EXPECT_THAT(fault("--hulls lp --query depth"), HasSubstr("lp needs --query interference"));
  EXPECT_THAT(fault("--hulls axes --query distance"), HasSubstr("axes needs --query interference"));
  EXPECT_THAT(fault("--hulls barba-langerman --query distance"),
              HasSubstr("barba-langerman needs --query interference"));
  EXPECT_EQ(fault("--hulls barba-langerman --coherent"),
            "--coherent: can't be used with --hulls barba-langerman, which keeps nothing from pose "
            "to pose\n");
  EXPECT_THAT(fault("--hulls vclip --query depth"),
              HasSubstr("vclip needs --query interference or distance"));
  EXPECT_EQ(fault("--hulls lp --coherent"),
            "--coherent: can't be used with --hulls lp, which keeps nothing from pose to pose\n");
  EXPECT_EQ(
      fault("--hulls climbing --query depth --coherent"),
      "--coherent: can't be used with --query depth, which keeps nothing from pose to pose\n");
  EXPECT_EQ(fault("--coherent"), "--coherent: needs --hulls, which is not given\n");
  EXPECT_THAT(fault("--hulls climbing --query contacts"),
              HasSubstr("unknown query with --hulls: \"contacts\""));
  EXPECT_EQ(fault("--hulls climbing --volume aabb"),
            "--volume: can't be used with --hulls, which needs no trees\n");
  EXPECT_EQ(fault("--hulls climbing --query depth --direction 0,0,0"),
            "--direction: 0,0,0 is no direction; give a vector x,y,z\n");
  EXPECT_EQ(fault("--hulls climbing --build median"),
            "--build: can't be used with --hulls, which needs no trees\n");
  expectFault("query a.obj b.obj --motions motions.txt --hulls climbing",
              "--hulls: can't be used with --motions; leave one of them out");
}

TEST_F(QueryCommand, InterferenceIsOneLineAPose) {
  const Result result = query("--poses poses.txt");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "pose,hit,bv_tests,triangle_tests\n0,1,1,1\n1,1,1,1\n2,0,1,1\n3,1,1,1\n");
  const auto figures = summary(result);
  for (const char* key : {"hits", "median_ns", "mean_ns", "p95_ns", "bv_tests", "triangle_tests",
                          "build_ms_a", "build_ms_b", "bytes_a", "bytes_b", "poses"})
    EXPECT_TRUE(figures.contains(key) && std::stod(figures.at(key)) > 0) << key;
  EXPECT_EQ(figures.at("hits"), "3");
  EXPECT_EQ(figures.at("poses"), "4");
  EXPECT_EQ(figures.at("bv_tests"), "1");
  EXPECT_EQ(figures.at("triangle_tests"), "1");
  EXPECT_EQ(figures.at("query"), "interference");
  EXPECT_EQ(figures.at("volume"), "obb");
  EXPECT_EQ(figures.at("fit"), "triangles");
  EXPECT_EQ(figures.at("overlap"), "sat");
  EXPECT_EQ(figures.at("build"), "top-down");
  EXPECT_FALSE(figures.at("simd").empty());
}

TEST_F(QueryCommand, VariantsAndRepeatsGiveTheSameAnswers) {
  const std::string expected = query("--poses poses.txt").out;
  for (const char* more : {"--repeat 7", "--fit vertices", "--fit hull --volume obb",
                           "--overlap sat --query interference"})
    EXPECT_EQ(query(std::string("--poses poses.txt ") + more).out, expected) << more;
  EXPECT_EQ(run("query a.obj b.obj --poses -", "cat poses.txt | ").out, expected);
}

TEST_F(QueryCommand, ContactsListTrianglesAndSegments) {
  write("a.obj", "v 9 9 9\nv 9 9 8\nv 9 8 9\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 4 5 6\n");
  const Result result = query("--poses poses.txt --query contacts");
  EXPECT_EQ(result.status, 0) << result.err;
  const auto found = lines(result.out);
  ASSERT_EQ(found.size(), 4u) << result.out;
  EXPECT_EQ(found[0], "pose,a,b,px,py,pz,qx,qy,qz");
  EXPECT_THAT(found[1], testing::AnyOf(Eq("0,1,0,1,1,0,2,1,0"), Eq("0,1,0,2,1,0,1,1,0")));
  EXPECT_EQ(found[2], "1,1,0,1,1,0,1,1,0");
  EXPECT_THAT(found[3], testing::AnyOf(Eq("3,1,0,0,1,0,0.5,1,0"), Eq("3,1,0,0.5,1,0,0,1,0")));
  EXPECT_EQ(summary(result).at("hits"), "3");
}

TEST_F(QueryCommand, DistanceAndTolerance) {
  write("poses.txt", "\xEF\xBB\xBF" + kStill + "0 0 0\n" + kStill + "0 0 2\n");
  EXPECT_EQ(lines(query("--poses poses.txt --query distance").out).at(2), "1,1,1,1,0,1,1,1,0,0,1");
  EXPECT_THAT(lines(query("--poses poses.txt --query distance").out).at(1),
              testing::StartsWith("0,0,"));
  const std::string tolerance = "--poses poses.txt --query tolerance --tolerance ";
  EXPECT_EQ(query(tolerance + "0.99").out, "pose,closer\n0,1\n1,0\n");
  EXPECT_EQ(query(tolerance + "1").out, "pose,closer\n0,1\n1,1\n");
}

TEST_F(QueryCommand, AllVolumesGiveTheSameAnswers) {
  for (const char* asked : {"", " --query distance", " --query tolerance --tolerance 0.1"}) {
    const auto hits = summary(query(std::string("--poses poses.txt") + asked)).at("hits");
    for (const char* volume :
         {"aabb", "sphere", "rss", "kdop14", "kdop18", "kdop26", "shell", "ellipsoid", "hull"})
      EXPECT_EQ(
          summary(query(std::string("--poses poses.txt --volume ") + volume + asked)).at("hits"),
          hits)
          << volume << asked;
  }
  // An axis-aligned box of b is not axis-aligned in a's frame, so 15 separating axes are tested.
  EXPECT_EQ(summary(query("--poses poses.txt --volume aabb")).at("overlap"), "sat");
}

TEST_F(QueryCommand, AllOverlapTestsGiveTheSameAnswers) {
  for (const char* asked : {"", " --query contacts"}) {
    const std::string binary = std::string("--poses poses.txt --volume obb-binary") + asked;
    const Result expected = query(binary);
    EXPECT_EQ(summary(expected).at("overlap"), "sat");
    for (const std::string overlap : {"sat", "gjk", "lp", "edge-face"}) {
      const Result result = query(binary + " --overlap " + overlap);
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(result.out, expected.out) << overlap;
      EXPECT_EQ(summary(result).at("overlap"), overlap);
    }
  }
}

TEST_F(QueryCommand, GridsAreLatticesAndRepeat) {
  const std::string grid = "--grid 3x2x1 --lower -1,-1,0 --upper 1,1,1 --rotations 2 --seed 5 ";
  const Result result = query(grid + "--save-poses saved.txt");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(summary(result).at("poses"), "12");
  const auto poses = lines(read("saved.txt"));
  ASSERT_EQ(poses.size(), 13u);
  // The centre of b's bounds, (2, 1, 0), is put on the points; the first rotation is the identity.
  EXPECT_EQ(poses[1], kStill + "-3 -2 0.5");
  EXPECT_EQ(poses[2], kStill + "-2 -2 0.5");
  EXPECT_EQ(poses[4], kStill + "-3 0 0.5");
  EXPECT_THAT(poses[7], testing::Not(HasSubstr(kStill)));
  EXPECT_EQ(query("--poses saved.txt").out, result.out);
  EXPECT_EQ(query(grid).out, result.out);
  // By default the grid spans the bounds of a, enlarged on each side by half of the diagonal of b,
  // √8/2. So nothing touches at the corners of the grid.
  EXPECT_EQ(query("--grid 2x2x2 --save-poses saved.txt").status, 0);
  EXPECT_THAT(lines(read("saved.txt"))[1], HasSubstr(kStill + "-3.41421356"));
  EXPECT_EQ(summary(query("--grid 2x2x2")).at("hits"), "0");
}

TEST_F(QueryCommand, SharedWorkload) {
  const auto data = corridor::test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  const std::string folder = (*data / "collision").string();
  const auto w = corridor::test::loadWorkload(*data / "collision", "e_touching_boxes");
  std::istringstream pair(corridor::test::contents(folder + "/e_touching_boxes/pair.txt"));
  std::string which, a, b;
  pair >> which >> a >> which >> b;
  const Result result = run("query '" + folder + "/" + a + "' '" + folder + "/" + b +
                            "' --poses '" + folder + "/e_touching_boxes/poses.txt'");
  EXPECT_EQ(result.status, 0) << result.err;
  const auto found = lines(result.out);
  ASSERT_EQ(found.size(), w.hit.size() + 1);
  for (std::size_t i = 0; i < w.hit.size(); ++i)
    EXPECT_THAT(found[i + 1],
                testing::StartsWith(std::to_string(i) + "," + std::to_string(w.hit[i]) + ","));
}

TEST_F(QueryCommand, BadPosesAreOneLineAndExit2) {
  const auto fault = [&](const std::string& pose, const std::string& message) {
    write("bad.txt", kStill + "0 0 0\n" + pose + "\n");
    const Result result = query("--poses bad.txt");
    EXPECT_EQ(result.status, 2) << pose;
    EXPECT_EQ(result.err, "bad.txt:2: " + message + "\n");
    EXPECT_EQ(result.out, "");
  };
  fault(kStill + "0 0 nan", "a finite number is needed, not \"nan\"");
  fault(kStill + "0 -inf 0", "a finite number is needed, not \"-inf\"");
  fault(kStill + "0 1e999 0", "a finite number is needed, not \"1e999\"");
  fault(kStill + "0 0 zero", "a number is needed, not \"zero\"");
  fault("0 0 0 0 0 0 1",
        "a pose has 12 numbers (r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz), not 7");
  fault(kStill + "0 0 0 1",
        "a pose has 12 numbers (r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz), not 13");
  fault("1 0 0 0 1 0 0 0 0 0 0 0", "the matrix is singular (determinant 0); a rotation is needed");
  fault("0 0 0 0 0 0 0 0 0 0 0 0", "the matrix is singular (determinant 0); a rotation is needed");
  fault("1 2 3 4 5 6 7 8 9 0 0 0", "the matrix is singular (determinant 0); a rotation is needed");
  fault("1 0 0 0 1 0 0 0 -1 0 0 0", "the matrix mirrors (determinant -1); a rotation is needed");
  fault("2 0 0 0 2 0 0 0 2 0 0 0",
        "the matrix is not a rotation: RᵀR differs from the identity by 3; at most 0.0002 counts "
        "as rounding");
  fault("1 0.001 0 0 1 0 0 0 1 0 0 0",
        "the matrix is not a rotation: RᵀR differs from the identity by 0.001; at most 0.0002 "
        "counts as rounding");
  // For a matrix with large or overflowing entries, the message must be that the matrix is no
  // rotation, not that it is singular.
  fault("1e9 0 0 0 1 0 0 0 1 0 0 0",
        "the matrix is not a rotation: RᵀR differs from the identity by 1e+18; at most 0.0002 "
        "counts as rounding");
  fault("1e200 0 0 0 1e200 0 0 0 1e200 0 0 0",
        "the matrix is not a rotation: RᵀR differs from the identity by inf; at most 0.0002 "
        "counts as rounding");
  // A matrix with four decimals is accurate enough to be accepted.
  write("fine.txt", "0.8660 -0.5 0 0.5 0.8660 0 0 0 1 0 0 0\n");
  EXPECT_EQ(query("--poses fine.txt").status, 0);
}

TEST_F(QueryCommand, ReportsAllFaultsOfAFileUpToALimit) {
  write("bad.txt", "1\n" + kStill + "0 0 0\n1 x\n");
  EXPECT_EQ(query("--poses bad.txt").err,
            "bad.txt:1: a pose has 12 numbers (r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz), not "
            "1\nbad.txt:3: a number is needed, not \"x\"\n");
  std::string many;
  for (int i = 0; i < 50; ++i) many += "1 2 3\n";
  write("bad.txt", many);
  const auto faults = lines(query("--poses bad.txt").err);
  ASSERT_EQ(faults.size(), 11u);
  EXPECT_EQ(faults[10], "bad.txt:50: and so on: 50 lines are faulty, this is the last");
}

TEST_F(QueryCommand, BadInputIsOneLineAndExit2) {
  write("empty.txt", "");
  write("comments.txt", "# nothing\n\n");
  write("empty.obj", "v 0 0 0\nv 1 0 0\n");
  const auto fault = [&](const std::string& arguments, const std::string& message) {
    expectFault("query " + arguments, message);
  };
  const std::string more = "; see corridor query --help";
  fault("a.obj b.obj", "--poses: one of --poses, --grid and --motions is required");
  fault("a.obj b.obj --poses poses.txt --grid 2x2x2",
        "--grid: can't be used with --poses; give one of the two");
  fault("a.obj b.obj --poses poses.txt --seed 1", "--seed: needs --grid, which is not given");
  fault("a.obj b.obj --poses none.txt", "none.txt: no such file");
  fault("a.obj b.obj --poses .", ".: is a folder; a file is needed");
  fault("a.obj b.obj --poses empty.txt",
        "empty.txt: is empty; a file of poses, one per line, is needed");
  fault("a.obj b.obj --poses comments.txt", "comments.txt: no poses");
  write("comments.txt", "# in mm\n1 0 0 0 1 0 0 0 1 0 0 0\n");
  fault("a.obj b.obj --poses comments.txt",
        "comments.txt:1: the comment says \"mm\", but lengths are read in metres");
  write("comments.txt", "# tx ty tz r00 r01 r02\n1 0 0 0 1 0 0 0 1 0 0 0\n");
  fault(
      "a.obj b.obj --poses comments.txt",
      "comments.txt:1: the comment names the numbers in another order than r00 r01 … r22 tx ty tz, "
      "in which they are read");
  fault("a.obj", "B is required" + more);
  fault("none.obj b.obj --poses poses.txt", "none.obj: no such file");
  fault("empty.obj b.obj --poses poses.txt",
        "empty.obj: the mesh has no faces; triangles or polygons are needed, lines and points are "
        "not read");
  fault("a.obj b.obj --poses poses.txt --query intereference",
        "--query: unknown query \"intereference\" (did you mean \"interference\"?); there are: "
        "interference, contacts, distance, tolerance, depth");
  fault("a.obj b.obj --poses poses.txt --volume obbb",
        "--volume: unknown volume \"obbb\" (did you mean \"obb\"?); there are: obb, obb-binary, "
        "aabb, sphere, "
        "rss, kdop14, kdop18, "
        "kdop26, shell, ellipsoid, hull, octree");
  fault("a.obj b.obj --poses poses.txt --query tolerance",
        "--tolerance: is needed with --query tolerance: a distance in metres");
  fault("a.obj b.obj --poses poses.txt --tolerance 1",
        "--tolerance: needs --query tolerance or --motions");
  fault("a.obj b.obj --poses poses.txt --query tolerance --tolerance nan",
        "--tolerance: a number of metres, 0 or more, is needed, not \"nan\"" + more);
  fault("a.obj b.obj --poses poses.txt --fit moments",
        "--fit: unknown fit \"moments\"; volume obb has: triangles, vertices, hull");
  fault("a.obj b.obj --poses poses.txt --overlap gjk",
        "--overlap: \"gjk\" is for volumes obb-binary, hull; volume obb has: sat");
  fault("a.obj b.obj --poses poses.txt --volume aabb --fit hull",
        "--fit: \"hull\" is for volumes obb, obb-binary, rss, ellipsoid; volume aabb has: plain");
  fault("a.obj b.obj --poses poses.txt --volume aabb --build bottum-up",
        "--build: unknown build \"bottum-up\" (did you mean \"bottom-up\"?); volume aabb has: "
        "top-down, median, bottom-up");
  expectFaultThatBegins("query a.obj b.obj --poses poses.txt --build bottom-up",
                        "--build: \"bottom-up\" is for volumes obb-binary, aabb, ");
  fault("a.obj b.obj --poses poses.txt --volume obb-binary --overlap gkj",
        "--overlap: unknown overlap \"gkj\" (did you mean \"gjk\"?); volume obb-binary has: sat, "
        "gjk, lp, edge-face");
  fault("a.obj b.obj --poses poses.txt --volume obb-binary --overlap lp --query distance",
        "--overlap: \"lp\" needs --query interference or contacts; distance computes distances "
        "between volumes");
  fault("a.obj b.obj --poses poses.txt --repeat 0",
        "--repeat: a whole number from 1 to 1000000 is needed, not \"0\"" + more);
  fault("a.obj b.obj --grid 10x10x11 --repeat 1000000",
        "--repeat: 1,000,000 passes over 1,100 poses are more than 1,000,000,000 queries");
  fault("a.obj b.obj --grid 3x3",
        "--grid: three counts above 0 along x, y and z are needed, as in 10x10x5, not \"3x3\"");
  fault("a.obj b.obj --grid 3x0x3",
        "--grid: three counts above 0 along x, y and z are needed, as in 10x10x5, not \"3x0x3\"");
  fault("a.obj b.obj --grid 1000x1000x11",
        "--grid: more than 10,000,000 poses; use fewer points or rotations");
  fault("a.obj b.obj --grid 2x2x2 --lower 1,2",
        "--lower: three numbers of metres are needed, as in -1,-1,0.5, not \"1,2\"");
  fault("a.obj b.obj --grid 2x2x2 --upper -9,nan,1",
        "--upper: three numbers of metres are needed, as in -1,-1,0.5, not \"-9,nan,1\"");
  fault("a.obj b.obj --grid 2x2x2 --lower 1,1,1 --upper 0,2,2",
        "--lower: [1, 1, 1] is not below --upper, [0, 2, 2]");
  const auto boundsFault = [&](const std::string& arguments, const std::string& message) {
    const Result result = run("query a.obj b.obj --grid 2x2x2 " + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.err.substr(0, message.size()), message) << arguments;
  };
  boundsFault("--lower 99,0,0", "--lower: [99, 0, 0] is not below --upper, by default [");
  boundsFault("--upper -99,0,0", "--upper: [-99, 0, 0] is not above --lower, by default [");
  fault("a.obj b.obj --grid 2x2x2 --save-poses none/p.txt",
        "--save-poses: there is no folder none");
  fault("a.obj b.obj --grid 2x2x2 --save-poses .",
        "--save-poses: . is a folder; a file's name is needed");
  fault("a.obj b.obj --grid 2x2x2 --save-poses b.obj",
        "--save-poses: b.obj belongs to the query and would be overwritten; name another file");
}

}  // namespace
