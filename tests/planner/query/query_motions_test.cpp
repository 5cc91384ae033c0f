// Tests of `corridor query --motions`: the first contact along each motion.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/transform.h"
#include "tests/planner/app/program_test.h"
#include "tests/support/support.h"

namespace {

using corridor::Mat3;
using corridor::Vec3;
using corridor::test::ProgramTest;

const std::string kIdentity = "1 0 0 0 1 0 0 0 1 ";  // the identity
const std::string kHeader =
    "motion,verdict,t0,t1,gap,triangle_a,triangle_b,bv_tests,triangle_tests,splits";

/// A row of the CSV: the value of each column, by the column's name.
using Row = std::map<std::string, std::string>;

std::vector<std::string> wordsOf(const std::string& line, char separator) {
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; std::getline(in, word, separator);) words.push_back(word);
  return words;
}

std::vector<Row> rowsOf(const std::string& csv) {
  const std::vector<std::string> lines = wordsOf(csv, '\n');
  EXPECT_FALSE(lines.empty());
  if (lines.empty()) return {};
  EXPECT_EQ(lines[0], kHeader);
  const std::vector<std::string> keys = wordsOf(lines[0], ',');
  std::vector<Row> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> values = wordsOf(lines[i], ',');
    EXPECT_EQ(values.size(), keys.size()) << lines[i];
    Row row;
    for (std::size_t k = 0; k < std::min(keys.size(), values.size()); ++k) row[keys[k]] = values[k];
    EXPECT_EQ(row["motion"], std::to_string(i - 1));
    rows.push_back(row);
  }
  return rows;
}

class QueryMotions : public ProgramTest {
 protected:
  QueryMotions() {
    // a is a floor; b is a needle that points down at the floor. The needle's tip is at b's origin.
    write("a.obj", "v 9 9 9\nv 9 9 8\nv 9 8 9\nv -4 -4 0\nv 4 -4 0\nv 0 4 0\nf 1 2 3\nf 4 5 6\n");
    write("b.obj", "v 0 0 0\nv 0.1 0 1\nv -0.1 0 1\nf 1 2 3\n");
  }
  Result query(const std::string& motions, const std::string& more = "") const {
    write("motions.txt", motions);
    return run("query a.obj b.obj --motions motions.txt " + more);
  }
};

TEST_F(QueryMotions, ClosedForms) {
  // The first motion goes down through the floor at t = 1/3, the second passes above it. The third
  // keeps the tip at 0.5 m and rotates the needle by 180° − asin 0.6 about x: its upper end swings
  // down into the floor.
  const Result result = query("# from, to\n" + kIdentity + "0 0 1 " + kIdentity + "0 0 -2\n" +
                              kIdentity + "-1 0 1e-3, " + kIdentity + "1 0 1e-3\n" + kIdentity +
                              "0 0 0.5 1 0 0 0 -0.8 -0.6 0 0.6 -0.8 0 0 0.5\n");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<Row> rows = rowsOf(result.out);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("verdict"), "contact");
  EXPECT_LE(std::stod(rows[0].at("t0")), 1.0 / 3);
  EXPECT_GE(std::stod(rows[0].at("t1")), 1.0 / 3);
  EXPECT_LE(std::stod(rows[0].at("t1")) - std::stod(rows[0].at("t0")), 1.0 / 1024);
  EXPECT_EQ(rows[0].at("triangle_a"), "1");
  EXPECT_EQ(rows[0].at("triangle_b"), "0");
  EXPECT_EQ(rows[1].at("verdict"), "free");
  EXPECT_EQ(rows[1].at("t0"), "1");
  EXPECT_EQ(rows[1].at("t1"), "-1");
  EXPECT_EQ(rows[1].at("triangle_a"), "-1");
  // The upper end is at height 0.5 + cos φ, which is 0 at φ = 120°; the whole angle is acos(−0.8).
  const double t = 2 * std::acos(-1.0) / 3 / std::acos(-0.8);
  EXPECT_EQ(rows[2].at("verdict"), "contact");
  EXPECT_LE(std::stod(rows[2].at("t0")), t);
  EXPECT_GE(std::stod(rows[2].at("t1")), t);
  EXPECT_THAT(result.err, testing::HasSubstr("motions=3\nfree=1\nhits=2\nundecided=0\n"));
  for (const char* key : {"edges=certified", "volume=obb\n", "fit=triangles", "overlap=sat",
                          "build=top-down\n", "median_ns=", "mean_ns=", "p95_ns=", "bv_tests=",
                          "triangle_tests=", "build_ms_a=", "bytes_b=", "simd=", "tolerance="})
    EXPECT_THAT(result.err, testing::HasSubstr(key));
}

TEST_F(QueryMotions, EveryMethodFindsTheFirstContact) {
  // The first motion goes down through the floor at t = 1/3, the second passes above it.
  for (const std::string edges : {"certified", "adaptive", "advancement"}) {
    const Result result = query(kIdentity + "0 0 1 " + kIdentity + "0 0 -2\n" + kIdentity +
                                    "-1 0 0.1 " + kIdentity + "1 0 0.1\n",
                                "--edges " + edges);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr("edges=" + edges + "\n"));
    const std::vector<Row> rows = rowsOf(result.out);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].at("verdict"), "contact") << edges;
    EXPECT_LE(std::stod(rows[0].at("t0")), 1.0 / 3);
    EXPECT_GE(std::stod(rows[0].at("t1")), 1.0 / 3);
    EXPECT_LE(std::stod(rows[0].at("t1")) - std::stod(rows[0].at("t0")), 1.0 / 1024);
    EXPECT_EQ(rows[1].at("verdict"), "free") << edges;
  }
}

TEST_F(QueryMotions, EveryVolumeFindsTheFirstContact) {
  const std::string motions = kIdentity + "0 0 1 " + kIdentity + "0 0 -2\n" + kIdentity +
                              "-1 0 0.1 " + kIdentity + "1 0 0.1\n";
  std::set<std::string> tests;
  for (const std::string trees : {"obb",
                                  "obb-binary",
                                  "obb-binary --overlap gjk",
                                  "obb-binary --overlap lp --fit hull",
                                  "obb-binary --overlap edge-face",
                                  "aabb",
                                  "sphere",
                                  "rss --fit vertices",
                                  "kdop14",
                                  "kdop18",
                                  "kdop26",
                                  "shell",
                                  "ellipsoid --fit hull",
                                  "hull",
                                  "sphere --edges adaptive",
                                  "kdop18 --edges advancement",
                                  "shell --edges adaptive",
                                  "ellipsoid --edges advancement",
                                  "rss --build bottom-up",
                                  "aabb --build median --edges adaptive"}) {
    SCOPED_TRACE(trees);
    const Result result = query(motions, "--volume " + trees);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err,
                testing::HasSubstr("volume=" + trees.substr(0, trees.find(' ')) + "\n"));
    const std::vector<Row> rows = rowsOf(result.out);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].at("verdict"), "contact");
    EXPECT_LE(std::stod(rows[0].at("t0")), 1.0 / 3);
    EXPECT_GE(std::stod(rows[0].at("t1")), 1.0 / 3);
    EXPECT_LE(std::stod(rows[0].at("t1")) - std::stod(rows[0].at("t0")), 1.0 / 1024);
    EXPECT_EQ(rows[1].at("verdict"), "free");
    tests.insert(result.out);
  }
  EXPECT_GT(tests.size(), 4u) << "the volumes must differ in their tests";
}

/// For a half turn, both senses of rotation are equally short. So the verdict is undecided, and the
/// row has no time, gap or triangles.
TEST_F(QueryMotions, HalfTurnsAreUndecided) {
  for (const std::string edges : {"certified", "adaptive", "advancement"}) {
    const Result result =
        query(kIdentity + "0 0 1 -1 0 0 0 -1 0 0 0 1 0 0 1\n", "--edges " + edges);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, kHeader + "\n0,undecided,0,-1,0,-1,-1,0,0,0\n") << edges;
  }
}

/// Matrices with few digits are not quite rotations. If a motion is free, the meshes must touch at
/// neither of its two poses, with exactly the numbers of the file.
TEST_F(QueryMotions, FreeHoldsForBothMapsOfTheFile) {
  // The needle's tip is 7 m from B's origin, so that an error of the matrix moves the tip.
  write("b.obj", "v 7 0 0\nv 7.1 0 1\nv 6.9 0 1\nf 1 2 3\n");
  const Vec3 vertices[] = {{7, 0, 0}, {7.1, 0, 1}, {6.9, 0, 1}};
  std::mt19937_64 random(corridor::test::testSeed(9));
  std::uniform_real_distribution<double> real(-1, 1);
  std::string motions, poses;
  constexpr int kCount = 600;
  for (int n = 0; n < kCount; ++n) {
    const auto rounded = [&](double x) {
      const double digits = n % 2 ? 1e6 : 1e4;
      return std::round(x * digits) / digits;
    };
    std::string line;
    const int close =
        n / 2 %
        3;  // the pose that is close to the floor: the first (0), the last (1), or neither (2)
    const Mat3 turn = Eigen::AngleAxisd(3 * real(random), Vec3::UnitZ()).toRotationMatrix();
    for (int end = 0; end < 2; ++end) {
      Mat3 M = turn * Eigen::AngleAxisd(0.3 * real(random),
                                        Vec3(real(random), real(random), real(random)).normalized())
                          .toRotationMatrix();
      M = M.unaryExpr(rounded);
      // Puts the lowest vertex a little above the floor, or into it.
      double lowest = HUGE_VAL;
      Vec3 low;
      for (const Vec3& v : vertices)
        if ((M * v).z() < lowest) lowest = (M * v).z(), low = M * v;
      const double gap = end == close ? (n % 4 ? 1 : -1) * std::pow(10.0, -3 - n % 9) : 1;
      const Vec3 t(-low.x(), -low.y() - 1, gap - lowest);
      std::ostringstream numbers;
      numbers.precision(17);
      for (int i = 0; i < 9; ++i) numbers << M(i / 3, i % 3) << ' ';
      numbers << t.x() << ' ' << t.y() << ' ' << t.z();
      line += numbers.str() + ' ';
      poses += numbers.str() + '\n';
    }
    motions += line + '\n';
  }
  write("poses.txt", poses);
  const Result hits = run("query a.obj b.obj --poses poses.txt");
  ASSERT_EQ(hits.status, 0) << hits.err;
  const std::vector<std::string> hit = wordsOf(hits.out, '\n');
  for (const std::string edges : {"certified", "adaptive", "advancement"}) {
    const Result result = query(motions, "--tolerance 1e-9 --edges " + edges);
    ASSERT_EQ(result.status, 0) << result.err;
    const std::vector<Row> rows = rowsOf(result.out);
    ASSERT_EQ(rows.size(), std::size_t{kCount});
    int free = 0, touching = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool touches =
          wordsOf(hit[2 * i + 1], ',')[1] == "1" || wordsOf(hit[2 * i + 2], ',')[1] == "1";
      touching += touches;
      if (rows[i].at("verdict") != "free") continue;
      ++free;
      EXPECT_FALSE(touches) << edges << ", motion " << i;
    }
    EXPECT_GT(free, 250) << edges;
    EXPECT_GT(touching, 50);
  }
}

TEST_F(QueryMotions, ClearanceBelowTheToleranceIsUndecided) {
  const std::string along = kIdentity + "-1 0 1e-3 " + kIdentity + "1 0 1e-3\n";
  const auto verdict = [&](const std::string& more) {
    return rowsOf(query(along, more).out).at(0).at("verdict");
  };
  EXPECT_EQ(verdict("--tolerance 1e-4"), "free");
  EXPECT_EQ(verdict("--tolerance 1e-4 --fit hull --repeat 3"), "free");
  EXPECT_NE(verdict("--tolerance 0.1"), "contact");
}

TEST_F(QueryMotions, BadInputIsOneLineAndExit2) {
  const auto fault = [&](const std::string& motion, const std::string& message) {
    const Result result = query(motion + "\n");
    EXPECT_EQ(result.status, 2) << motion;
    EXPECT_EQ(result.err, "motions.txt:1: " + message + "\n");
    EXPECT_EQ(result.out, "");
  };
  fault(
      kIdentity + "0 0 0",
      "a motion has 24 numbers (its first pose, r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz, and "
      "its last), not 12");
  fault(kIdentity + "0 0 0 " + kIdentity + "0 0 inf", "a finite number is needed, not \"inf\"");
  fault(kIdentity + "0 0 0 1 0 0 0 1 0 0 0 -1 0 0 0",
        "last pose: the matrix mirrors (determinant -1); a rotation is needed");
  write("motions.txt", kIdentity + "0 0 1 " + kIdentity + "0 0 2\n");
  const auto option = [&](const std::string& more, const std::string& message) {
    expectFault("query a.obj b.obj --motions motions.txt " + more, message);
  };
  option("--grid 2x2x2", "--grid: applies to poses, not to --motions; leave it out");
  option("--query distance", "--query: applies to poses, not to --motions; leave it out");
  // --motions also refuses the query that is the default for poses.
  option("--query interference", "--query: applies to poses, not to --motions; leave it out");
  option("--volume aabb --overlap gjk",
         "--overlap: \"gjk\" is for volumes obb-binary, hull; volume aabb has: sat");
  option("--volume aabb --fit hull",
         "--fit: \"hull\" is for volumes obb, obb-binary, rss, ellipsoid; volume aabb has: plain");
  option("--volume obb-binary --overlap gjk --edges adaptive",
         "--overlap: \"gjk\" needs --edges certified; adaptive computes distances between volumes");
  for (const std::string given :
       {"--lower 0,0,0", "--upper 0,0,0", "--rotations 2", "--seed 1", "--save-poses p.txt"})
    option(given, given.substr(0, given.find(' ')) + ": needs --grid, which is not given");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.txt"));
  option("--edges adaptiv",
         "--edges: unknown method \"adaptiv\" (did you mean \"adaptive\"?); there are: certified, "
         "adaptive, advancement");
  option("--edges discrete",
         "--edges: unknown method \"discrete\"; there are: certified, adaptive, advancement");
  expectFault("query a.obj b.obj --grid 2x2x2 --edges adaptive",
              "--edges: needs --motions, which is not given");
  option("--tolerance 0", "--tolerance: must be above 0 with --motions");
  write("motions.txt", "# none\n");
  expectFault("query a.obj b.obj --motions motions.txt", "motions.txt: no motions");
}

/// Compares motions of the shared data with their known times of first contact.
class SharedMotions : public QueryMotions {
 protected:
  /// Tests the first `most` motions of each set. Expects that each contact is found, that no free
  /// motion is called contact, and that every bracket [t0, t1] contains the true time. @returns how
  /// many motions are undecided.
  std::size_t expectTruth(const std::string& edges, std::size_t most) {
    const auto folder = *corridor::test::dataFolder() / "collision";
    std::size_t undecided = 0;
    for (const std::string name : {"b_bunny_torus", "b_torus1_torus2_mixed"}) {
      std::istringstream pair(corridor::test::contents(folder / "ccd" / name / "pair.txt"));
      std::string which, a, b;
      pair >> which >> a >> which >> b;
      std::istringstream all(corridor::test::contents(folder / "ccd" / name / "motions.txt"));
      std::string motions, line;
      for (std::size_t n = 0; n < most && std::getline(all, line);) {
        motions += line + '\n';
        n += !line.starts_with('#');
      }
      write("motions.txt", motions);
      const Result result = run("query '" + (folder / a).string() + "' '" + (folder / b).string() +
                                "' --motions motions.txt --edges " + edges);
      EXPECT_EQ(result.status, 0) << result.err;
      const std::vector<Row> rows = rowsOf(result.out);
      std::istringstream truth(corridor::test::contents(folder / "ccd" / name / "truth.txt"));
      std::size_t i = 0, contacts = 0;
      while (i < rows.size() && std::getline(truth, line)) {
        if (line.starts_with('#')) continue;
        const Row& row = rows[i++];
        const double t = std::stod(line);
        if (row.at("verdict") == "undecided") {
          ++undecided;
          continue;
        }
        EXPECT_EQ(row.at("verdict"), t < 0 ? "free" : "contact") << name << ' ' << i - 1;
        if (t < 0) continue;
        ++contacts;
        // The true times are known to 1e-6 of the motion.
        EXPECT_LE(std::stod(row.at("t0")), t + 1e-6) << name << ' ' << i - 1;
        EXPECT_GE(std::stod(row.at("t1")), t - 1e-6) << name << ' ' << i - 1;
        EXPECT_LE(std::stod(row.at("t1")) - std::stod(row.at("t0")), 1.0 / 1024);
      }
      EXPECT_EQ(i, rows.size());
      EXPECT_GT(rows.size(), std::min<std::size_t>(most, 500) / 2);
      EXPECT_GT(contacts, rows.size() / 20);
      std::cout << name << ", " << edges << ": "
                << result.err.substr(result.err.find("median_ns"),
                                     result.err.find("p95_ns") - result.err.find("median_ns"));
    }
    return undecided;
  }
};

TEST_F(SharedMotions, FirstContactsAgreeWithTheTruth) {
  if (!corridor::test::dataFolder())
    GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  EXPECT_EQ(expectTruth("certified", 1'000'000), 0u);
}

TEST_F(SharedMotions, FirstContactsWithOtherVolumes) {
  if (!corridor::test::dataFolder())
    GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const std::string volume : {"obb-binary", "obb-binary --overlap lp", "aabb", "sphere", "rss",
                                   "kdop14", "kdop26", "shell", "ellipsoid", "hull"})
    EXPECT_EQ(expectTruth("certified --volume " + volume, 60), 0u);
}

TEST_F(SharedMotions, FirstContactsByDistanceMethods) {
  if (!corridor::test::dataFolder())
    GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const char* edges : {"adaptive", "advancement"}) EXPECT_LE(expectTruth(edges, 60), 2u);
}

}  // namespace
