// Units that comments, headers and names state in formats that have no unit.
#include "collision/geometry/stated_unit.h"

#include <gmock/gmock.h>

#include "collision/geometry/point_cloud.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Returns the unit that a text states, or 0.
double unitIn(const std::string& text) {
  std::vector<StatedUnit> units;
  addStatedUnit(text, 1, units);
  return units.empty() ? 0 : units[0].metresPerUnit;
}

TEST(StatedUnits, ClearOnes) {
  for (const std::string text :
       {"unit: cm", "# File units = centimeters", "UNITS=cm", "# Units: Centimetres.",
        "1 unit = 1 cm", "unit: 0.01 m", "unit is 10 mm", "units 0.01m", "centimeters per unit",
        "metres per unit: 0.01", "meters_per_unit 0.01", "[cm] is the unit", "unit size 10 mm",
        "unit length: 10mm", "unit, scale = 10 mm"})
    EXPECT_NEAR(unitIn(text), 0.01, 1e-17) << text;
  EXPECT_EQ(unitIn("units: in"), 0.0254);
  EXPECT_EQ(unitIn("units in mm"), 0.001);
  EXPECT_EQ(unitIn("Units: m"), 1);
  for (const std::string text : {"5 cm", "made in mm", "Unity export, 10 cm", "United Cm",
                                 "unit normals", "units", "units: V", ""})
    EXPECT_EQ(unitIn(text), 0) << text;
}

/// Lengths in a comment on units are no units.
TEST(StatedUnits, BesideLengths) {
  for (const std::string text :
       {"# Units: m; accuracy 5 mm", "# units: metres, resolution 0.005 m", "units = m, 5mm apart",
        "# Unit 7, 12 m above ground", "unit 7: 12m above ground", "units are m, sigma in mm",
        "unit: 1 m, tolerance = 2 mm"})
    EXPECT_EQ(unitIn(text), 1) << text;
  for (const std::string text :
       {"units: m, m, mm", "units: m for x, mm for z", "horizontal units: m, vertical units: mm",
        "units: x m, y m, z mm", "units of points in mm", "units: m; z in mm"})
    EXPECT_EQ(unitIn(text), 0.001) << text;
}

TEST(StatedUnits, Notes) {
  std::vector<StatedUnit> units;
  addStatedUnit("# unit: m", 2, units);
  EXPECT_FALSE(noteOnUnits(units, 1));
  addStatedUnit("# unit: mm", 3, units);
  EXPECT_EQ(noteOnUnits(units, 1),
            "line 3 says \"unit: mm\", but coordinates are read with a unit of 1 m");
  EXPECT_EQ(noteOnUnits(units, 0.001),
            "line 2 says \"unit: m\", but coordinates are read with a unit of 0.001 m");
}

class StatedUnitOf : public MeshFileTest {
 protected:
  /// Expects a note on a mesh file if its stated unit, centimetres, is not the one in use.
  void expectNote(const std::string& name, const std::string& bytes,
                  const std::string& where) const {
    EXPECT_THAT(read(name, bytes).notes,
                ElementsAre(where + ", but coordinates are read with a unit of 1 m"));
    EXPECT_THAT(read(name, bytes, {0.01, {}}).notes, IsEmpty());
  }
};

TEST_F(StatedUnitOf, Meshes) {
  const std::string obj = objTetrahedron;
  expectNote("a.obj", "# File units = centimeters\n" + obj,
             "line 1 says \"File units = centimeters\"");
  expectNote("b.obj", "v 0 0 0 # unit: cm\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
             "line 1 says \"unit: cm\"");
  expectNote("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 # by hand; the unit is cm\n",
             "line 4 says \"by hand; the unit is cm\"");
  for (const std::string keyword : {"comment", "obj_info"}) {
    std::string ply = asciiPlyTetrahedron;
    expectNote("a.ply", ply.insert(21, keyword + " unit: cm\n"), "line 3 says \"unit: cm\"");
  }
  const std::string off = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  expectNote("a.off", "OFF\n# unit: cm\n" + off, "line 2 says \"unit: cm\"");
  expectNote("b.off", "OFF # unit: cm\n" + off, "line 1 says \"unit: cm\"");
  expectNote("c.off", "OFF\n" + off + " 255 0 0 # unit: cm\n", "line 6 says \"unit: cm\"");
  std::string stl = asciiStlTetrahedron();
  expectNote("a.stl", stl.replace(6, 13, "part UNITS=cm"), "line 1 says \"part UNITS=cm\"");
  expectNote("b.stl", binaryStlTetrahedron("by hand UNITS=cm"), "the header says \"UNITS=cm\"");
}

TEST_F(StatedUnitOf, Clouds) {
  const auto stated = [&](const std::string& name, const std::string& bytes) {
    return readPointCloud(write(name, bytes)).statedUnits.at(0);
  };
  const StatedUnit pcd =
      stated("a.pcd", "# .PCD v0.7\n#unit: cm\nFIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_EQ(pcd.line, 2);
  EXPECT_EQ(pcd.metresPerUnit, 0.01);
  EXPECT_EQ(stated("a.ply",
                   "ply\nformat ascii 1.0\ncomment unit: cm\nelement vertex 1\nproperty float x\n"
                   "property float y\nproperty float z\nend_header\n1 2 3\n")
                .line,
            3);
}

}  // namespace
}  // namespace corridor::test
