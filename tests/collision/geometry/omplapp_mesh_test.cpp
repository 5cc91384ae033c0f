#include <gtest/gtest.h>

#include "collision/geometry/mesh_file.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

struct Centre {
  const char* file;
  double centre[3];
  int importedVertices;
};

constexpr Centre centres[] = {
    {"2D/car1_planar_robot.dae", {0.0250001, 0, 3.93701}, 56},
    {"2D/car2_planar_robot.dae", {0.00999999, -0.15, 3.93701}, 80},
    {"3D/Abstract_robot.dae", {-8.01944, 0, -7.835296}, 112},
    {"3D/Easy_robot.dae", {270.4043, 160.6562, -297.8237}, 112},
    {"3D/Home_robot.dae", {-0.04602013, 0.05111809, 9.192626}, 280},
    {"3D/Twistycool_robot.dae", {270.4043, 160.6562, -297.8237}, 112},
    {"3D/alpha_robot.dae", {-21.90987, -11.10698, -14.13554}, 10248},
    {"3D/cubicles_robot.dae", {-4.958012, -40.62011, 70.56501}, 72},
};

TEST(ReadOmplAppMesh, RobotCentres) {
  const auto folder = omplAppFolder();
  if (!folder) GTEST_SKIP() << "set CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  for (const Centre& row : centres) {
    SCOPED_TRACE(row.file);
    const OmplAppMesh read = readOmplAppMesh(*folder / row.file);
    EXPECT_EQ(read.importedVertices, row.importedVertices);
    // The table has seven digits. The last digit is inexact, because assimp sums in float.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(read.vertexAverage[i], row.centre[i],
                  2e-6 * std::max(1.0, std::abs(row.centre[i])));
  }
}

}  // namespace
}  // namespace corridor::test
