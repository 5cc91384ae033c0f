// Compares inspectMesh with tables in the READMEs of the shared data. Other programs computed these
// tables.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "collision/geometry/mesh_file.h"
#include "collision/geometry/mesh_health.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

struct Row {
  std::string file;
  std::size_t triangles = 0, distinct = 0, degenerate = 0, sliver = 0, boundary = 0,
              nonManifold = 0;
  std::array<double, 3> min{}, max{};
};

/// Returns the rows "| file | triangles | distinct | min | max | degenerate | sliver | boundary |
/// non-manifold |" of a Markdown file.
std::vector<Row> rowsOf(const std::filesystem::path& guide) {
  std::ifstream in(guide);
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
    if (cells.size() < 10 || cells[1].find('.') == std::string::npos) continue;
    Row row;
    const auto read = [&](std::size_t cell, auto&... values) {
      std::istringstream words(cells[cell]);
      return static_cast<bool>((words >> ... >> values));
    };
    if (read(1, row.file) && read(2, row.triangles) && read(3, row.distinct) &&
        read(4, row.min[0], row.min[1], row.min[2]) &&
        read(5, row.max[0], row.max[1], row.max[2]) && read(6, row.degenerate) &&
        read(7, row.sliver) && read(8, row.boundary) && read(9, row.nonManifold))
      rows.push_back(row);
  }
  return rows;
}

/// Expects the figures of a row of the table. They have five digits.
void expectRow(const MeshHealth& health, const Row& row) {
  SCOPED_TRACE(row.file);
  EXPECT_EQ(health.triangles, row.triangles);
  EXPECT_EQ(health.distinctTriangles, row.distinct);
  // The table rounds the vertices of Collada to floats, which merges some and flattens slivers.
  const int merged = row.file.ends_with(".dae") ? 2 : 0;
  const auto expectNear = [&](std::size_t found, std::size_t wanted) {
    EXPECT_NEAR(static_cast<double>(found), static_cast<double>(wanted), merged);
  };
  EXPECT_EQ(health.degenerateTriangles + health.sliverTriangles, row.degenerate + row.sliver);
  expectNear(health.degenerateTriangles, row.degenerate);
  expectNear(health.boundaryEdges, row.boundary);
  expectNear(health.nonManifoldEdges, row.nonManifold);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(health.min[i], row.min[i], 6e-5 * std::abs(row.min[i]));
    EXPECT_NEAR(health.max[i], row.max[i], 6e-5 * std::abs(row.max[i]));
  }
}

TEST(InspectMesh, RobotsOfTheSharedData) {
  const auto data = dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  const std::vector<Row> rows = rowsOf(*data / "robots" / "README.md");
  EXPECT_GT(rows.size(), 30U) << "the table's form has changed";
  for (const Row& row : rows) {
    expectRow(inspectMesh(readMeshFile(*data / "robots" / row.file).mesh), row);
  }
}

TEST(InspectMesh, OmplAppMeshes) {
  const auto folder = omplAppFolder();
  const auto data = dataFolder();
  if (!folder || !data)
    GTEST_SKIP() << "set CORRIDOR_DATA, and CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  const std::vector<Row> rows = rowsOf(*data / "omplapp" / "README.md");
  EXPECT_EQ(rows.size(), 16U) << "the table's form has changed";
  for (const Row& row : rows) {
    expectRow(inspectMesh(readOmplAppMesh(*folder / row.file).mesh), row);
  }
}

}  // namespace
}  // namespace corridor::test
