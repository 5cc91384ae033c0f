// Tests of `corridor inspect A --against B`: counts equal those of queries; times are above 0.
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "collision/hierarchy/tree_kinds.h"
#include "tests/planner/app/program_test.h"

namespace {

using corridor::test::ProgramTest;
using testing::HasSubstr;

class InspectCost : public ProgramTest {
 protected:
  InspectCost() {
    write("a.obj", bumps(12));
    write("b.obj", bumps(9));
    write("empty.obj", "v 0 0 0\nv 1 0 0\n");
    std::string poses;
    for (int i = 0; i < 12; ++i)
      poses += "1 0 0 0 1 0 0 0 1 0.01 " + std::to_string(0.02 * i) + " " +
               std::to_string(0.3 - 0.03 * i) + "\n";
    write("poses.txt", poses + "1 0 0 0 1 0 0 0 1 9 9 9  # far\n");
  }
  /// Returns an OBJ file of a wavy sheet of n × n squares.
  static std::string bumps(int n) {
    std::ostringstream out;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        out << "v " << double(i) / n << " " << double(j) / n << " "
            << 0.1 * std::sin(7.0 * i / n) * std::cos(5.0 * j / n) << "\n";
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const int at = i * (n + 1) + j + 1;
        out << "f " << at << " " << at + n + 1 << " " << at + n + 2 << "\nf " << at << " "
            << at + n + 2 << " " << at + 1 << "\n";
      }
    return out.str();
  }
};

/// The names of all volumes.
const std::vector<std::string> kVolumes = [] {
  std::vector<std::string> names;
  for (const corridor::VolumeKind& kind : corridor::volumeKinds()) names.push_back(kind.name);
  return names;
}();

TEST_F(InspectCost, JsonHasTheCountsOfQueries) {
  const Result result = run("inspect a.obj --against b.obj --poses poses.txt --json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["format"], "corridor-inspect-cost-1");
  EXPECT_EQ(json["a"], "a.obj");
  EXPECT_EQ(json["b"], "b.obj");
  EXPECT_EQ(json["triangles_a"], 288);
  EXPECT_EQ(json["triangles_b"], 162);
  EXPECT_EQ(json["poses"], 13);
  EXPECT_GE(json["rejected_by_root"], 1);
  EXPECT_GT(json["hits"], 1);
  ASSERT_EQ(json["volumes"].size(), std::size(kVolumes));
  // The expected counts are those of `corridor query`, for the poses at which the root OBBs
  // overlap.
  const auto counts = [&](const std::string& volume) {
    std::istringstream csv(run("query a.obj b.obj --poses poses.txt --volume " + volume).out);
    std::vector<std::pair<double, double>> all;
    std::string line;
    for (std::getline(csv, line); std::getline(csv, line);) {
      int pose = 0, hit = 0;
      double v = 0, p = 0;
      EXPECT_EQ(std::sscanf(line.c_str(), "%d,%d,%lf,%lf", &pose, &hit, &v, &p), 4) << line;
      all.emplace_back(v, p);
    }
    return all;
  };
  const auto reference = counts("obb-binary");
  ASSERT_EQ(reference.size(), 13u);
  for (std::size_t i = 0; i < std::size(kVolumes); ++i) {
    const auto& row = json["volumes"][i];
    EXPECT_EQ(row["volume"], kVolumes[i]);
    const auto all = counts(kVolumes[i]);
    double boxes = 0, triangles = 0;
    int kept = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (reference[k].first == 1 && reference[k].second == 0) continue;
      boxes += all[k].first, triangles += all[k].second;
      ++kept;
    }
    EXPECT_EQ(json["poses"].get<int>() - json["rejected_by_root"].get<int>(), kept);
    EXPECT_NEAR(row["bv_tests"].get<double>(), boxes / kept, 1e-9 * boxes) << kVolumes[i];
    EXPECT_NEAR(row["triangle_tests"].get<double>(), triangles / kept, 1e-9 * (triangles + 1));
    for (const char* key : {"predicted_ns", "measured_ns", "ratio", "bytes", "build_ms"})
      EXPECT_GT(row[key].get<double>(), 0) << key << ", " << kVolumes[i];
    EXPECT_GE(row["call_ns"], 0);
    for (const char* key : {"bv_test_ns", "triangle_test_ns"}) {
      if (kVolumes[i] == "obb") {  // the costs of `obb` are fitted, and may be unknown
        EXPECT_TRUE(row[key].is_null() || row[key].get<double>() > 0) << key;
      } else {
        EXPECT_GT(row[key].get<double>(), 0) << key << ", " << kVolumes[i];
      }
    }
    EXPECT_EQ(row["traversal_ns"].is_null(), kVolumes[i] == "obb");
    EXPECT_LE(row["ratio_p5"], row["ratio_median"]);
    EXPECT_LE(row["ratio_median"], row["ratio_p95"]);
  }
}

TEST_F(InspectCost, PrintsATableOverAGridWithoutPoses) {
  const Result result = run("inspect a.obj --against b.obj");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("meshes: a.obj, 288 triangles; b.obj, 162 triangles\n"));
  EXPECT_THAT(result.out, HasSubstr("poses: 864, "));
  std::istringstream lines(result.out);
  std::string line;
  while (std::getline(lines, line) && !line.starts_with("volume")) {
  }
  for (const char* column :
       {"N_v", "N_p", "call", "C_v", "C_p", "traversal", "predicted", "measured", "bytes", "build"})
    EXPECT_THAT(line, HasSubstr(column));
  for (const std::string& volume : kVolumes) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_THAT(line, testing::StartsWith(volume));
    EXPECT_THAT(line, HasSubstr(" .. "));
  }
}

TEST_F(InspectCost, BadInputIsOneLineAndExit2) {
  write("one.txt", "1 0 0 0 1 0 0 0 1 0 0 0\n");
  write("bad.txt", "1 0 0 0 1 0 0 0 1 0 0\n");
  write("arm.urdf", "<robot name=\"arm\"/>");
  write("problem.yaml", "format: corridor-problem-1\n");
  const auto fault = [&](const std::string& arguments, const std::string& message) {
    expectFault("inspect " + arguments, message);
  };
  fault("a.obj --against", "--against: 1 required TEXT missing; see corridor inspect --help");
  fault("a.obj --against none.obj", "none.obj: no such file");
  fault("none.obj --against a.obj", "none.obj: no such file");
  fault("a.obj --against empty.obj",
        "empty.obj: the mesh has no faces; triangles or polygons are needed, lines and points are "
        "not read");
  fault("a.obj --poses poses.txt", "--poses: needs --against, which is not given");
  fault("a.obj --against b.obj --pairs", "--pairs: needs a problem, and a.obj is a mesh");
  fault("a.obj --against b.obj --poses none.txt", "none.txt: no such file");
  fault("a.obj --against b.obj --poses bad.txt",
        "bad.txt:1: a pose has 12 numbers (r00 r01 r02 r10 r11 r12 r20 r21 r22 tx ty tz), not 11");
  fault("a.obj --against b.obj --poses one.txt",
        "one.txt: at least two poses are needed at which the meshes' bounding boxes overlap; they "
        "overlap at 1 of 1 pose");
  fault("arm.urdf --against b.obj", "--against: needs two meshes, and arm.urdf is a robot");
  fault("problem.yaml --against b.obj",
        "--against: needs two meshes, and problem.yaml is a problem");
}

}  // namespace
