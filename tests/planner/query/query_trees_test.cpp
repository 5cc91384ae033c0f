// Tests of the trees of `corridor query`: how they are built, octrees, and trees that are refitted
// to a mesh that deforms.
#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/query/query_fixture.h"

namespace {

using corridor::test::kStill;

class QueryTrees : public corridor::test::QueryCommand {};

TEST_F(QueryTrees, OctreesHaveInterferenceOnly) {
  const Result result = query("--poses poses.txt --volume octree --repeat 2");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "pose,hit,bv_tests,triangle_tests\n0,1,1,1\n1,1,1,1\n2,0,1,1\n3,1,1,1\n");
  auto figures = summary(result);
  EXPECT_EQ(figures["volume"] + " " + figures["fit"] + " " + figures["overlap"] + " " +
                figures["build"] + " " + figures["hits"],
            "octree plain sat top-down 3");
  // Meshes of many triangles, at poses with and without contact.
  std::string ribbon[2];  // one ribbon is below the other; they cross at right angles
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i <= 60; ++i) {
      const std::string along = std::to_string(i * 0.05 - 1.5);
      for (const std::string across : {"-0.2", "0.2"})
        ribbon[k] += "v " + (k ? across + " " + along : along + " " + across) + " " +
                     std::to_string((i % 3) * 0.01) + "\n";
    }
    for (int i = 1; i <= 120; ++i)
      ribbon[k] += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " +
                   std::to_string(i + 2) + "\n";
  }
  write("a.obj", ribbon[0]);
  write("b.obj", ribbon[1]);
  const std::string grid =
      "--grid 4x4x7 --lower=-1,-1,-0.05 --upper 1,1,0.05 --rotations 2 --volume ";
  const Result cells = query(grid + "octree"), boxes = query(grid + "aabb");
  EXPECT_EQ(cells.status, 0) << cells.err;
  const auto a = lines(cells.out), b = lines(boxes.out);
  ASSERT_EQ(a.size(), 225u);
  ASSERT_EQ(b.size(), 225u);
  const auto verdict = [](const std::string& line) {
    return line.substr(0, line.find(',', line.find(',') + 1));
  };
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(verdict(a[i]), verdict(b[i]));
  EXPECT_NE(cells.out, boxes.out) << "the trees must differ in their tests";
  EXPECT_GT(std::stoi(summary(cells).at("hits")), 20);
  EXPECT_LT(std::stoi(summary(cells).at("hits")), 200);
}

TEST_F(QueryTrees, OctreesRefuseOtherQueries) {
  write("motions.txt", kStill + "0 0 1 " + kStill + "0 0 2\n");
  const auto refused = [&](const std::string& more, const std::string& asked) {
    expectFault("query a.obj b.obj --volume octree " + more,
                "--volume: octree supports only --query interference at poses, not " + asked +
                    "; choose another volume, such as aabb");
  };
  for (const std::string asked : {"distance", "contacts", "tolerance"})
    refused("--poses poses.txt --query " + asked, asked);
  refused("--motions motions.txt", "--motions");
  const auto fault = [&](const std::string& option, const std::string& only) {
    const auto at = option.find(' ');
    expectFault("query a.obj b.obj --poses poses.txt --volume octree " + option,
                option.substr(0, at) + ": \"" + option.substr(at + 1) +
                    "\" is not for octrees; volume octree has: " + only);
  };
  fault("--fit hull", "plain");
  fault("--overlap gjk", "sat");
  fault("--build bottom-up", "top-down");
}

/// The triangle A is higher in each successive shape of --deform, so that b crosses it, touches it,
/// or is clear of it.
TEST_F(QueryTrees, DeformRunsTheQueryForEachShape) {
  write("a1.obj", "v 0 0 1\nv 4 0 1\nv 0 4 1\nf 1 2 3\n");
  write("a2.obj", "v 0 0 1.5\nv 4 0 1.5\nv 0 4 1.5\nf 1 2 3\n");
  write("poses.txt", kStill + "0 0 0\n" + kStill + "0 0 0.25\n");
  const std::string deform = "--poses poses.txt --deform a1.obj a2.obj ";
  for (const std::string trees :
       {"", "--volume obb-binary --overlap gjk --build bottom-up", "--volume aabb",
        "--volume sphere --build median", "--volume rss --fit hull", "--volume kdop18"}) {
    SCOPED_TRACE(trees);
    const Result result = query(deform + trees);
    ASSERT_EQ(result.status, 0) << result.err;
    const auto found = lines(result.out);
    ASSERT_EQ(found.size(), 7u);
    EXPECT_EQ(found[0], "frame,pose,hit,bv_tests,triangle_tests,refit_ms,query_ns");
    const char* verdicts[] = {"0,0,1,", "0,1,1,", "1,0,1,", "1,1,1,", "2,0,0,", "2,1,0,"};
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_THAT(found[i + 1], testing::StartsWith(verdicts[i]));
      std::string words = found[i + 1];
      std::replace(words.begin(), words.end(), ',', ' ');
      std::istringstream in(words);
      const std::vector<double> numbers{std::istream_iterator<double>(in),
                                        std::istream_iterator<double>()};
      ASSERT_EQ(numbers.size(), 7u);
      EXPECT_EQ(numbers[5] > 0, i >= 2) << "only the first frame's tree is built";
      EXPECT_GT(numbers[6], 0);
    }
    const auto figures = summary(result);
    EXPECT_EQ(figures.at("frames"), "3");
    EXPECT_EQ(figures.at("poses"), "2");
    EXPECT_EQ(figures.at("hits"), "4");
    EXPECT_GT(std::stod(figures.at("refit_ms")), 0);
  }
  const auto near = lines(query(deform + "--query distance").out);
  ASSERT_EQ(near.size(), 7u);
  EXPECT_EQ(near[0], "frame,pose,distance,ax,ay,az,bx,by,bz,nx,ny,nz,refit_ms,query_ns");
  EXPECT_THAT(near[3], testing::StartsWith("1,0,0,"));
  EXPECT_THAT(near[5], testing::StartsWith("2,0,0.5,"));
  EXPECT_THAT(near[6], testing::StartsWith("2,1,0.25,"));
  const auto closer = lines(query(deform + "--query tolerance --tolerance 0.3").out);
  ASSERT_EQ(closer.size(), 7u);
  EXPECT_EQ(closer[0], "frame,pose,closer,refit_ms,query_ns");
  EXPECT_THAT(closer[5], testing::StartsWith("2,0,0,"));
  EXPECT_THAT(closer[6], testing::StartsWith("2,1,1,"));
  EXPECT_EQ(run("query --deform a1.obj a2.obj --poses poses.txt a.obj b.obj").status, 0);
}

TEST_F(QueryTrees, DeformOnBadInput) {
  write("two.obj", "v 0 0 1\nv 4 0 1\nv 0 4 1\nf 1 2 3\nf 1 3 2\n");
  write("motions.txt", kStill + "0 0 1 " + kStill + "0 0 2\n");
  const std::string deform = "query a.obj b.obj --poses poses.txt --deform b.obj ";
  expectFault(deform + "two.obj",
              "two.obj: has 2 triangles, but a.obj has 1; --deform needs the same triangles, with "
              "moved vertices");
  expectFault(deform + "none.obj", "none.obj: no such file");
  expectFault(deform + "--query contacts",
              "--query: contacts can't be used with --deform; use interference, distance or "
              "tolerance");
  expectFault(deform + "--volume octree",
              "--volume: an octree can't be refitted, as --deform needs; choose another volume, "
              "such as aabb");
  expectFault("query a.obj b.obj --motions motions.txt --deform b.obj",
              "--deform: applies to poses, not to --motions; leave it out");
  expectFault(deform + "--hulls climbing",
              "--deform: can't be used with --hulls, which needs no trees");
  expectFault(
      "query a.obj b.obj --grid 2x2x2 --save-poses two.obj --deform two.obj",
      "--save-poses: two.obj belongs to the query and would be overwritten; name another file");
}

TEST_F(QueryTrees, AllWaysOfBuildingGiveTheSameAnswers) {
  for (const char* asked : {"", " --query contacts", " --query distance"})
    for (const char* volume : {"obb-binary", "aabb", "sphere", "kdop14"}) {
      const std::string options = std::string("--poses poses.txt --volume ") + volume + asked;
      const auto hits = summary(query(options)).at("hits");
      for (const std::string build : {"top-down", "median", "bottom-up"}) {
        const Result result = query(options + " --build " + build);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(summary(result).at("hits"), hits) << options << build;
        EXPECT_EQ(summary(result).at("build"), build);
      }
    }
}

}  // namespace
