// Comments and headers of text files of points, which may say that the columns are not x, y, z in
// metres.
#include "collision/geometry/point_cloud.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

class NamesOfColumns : public MeshFileTest {
 protected:
  /// Reads a cloud of one point after a line.
  PointCloud read(const std::string& line, const MeshFileOptions& options = {}) const {
    return readPointCloud(write("a.xyz", line + "\n1 2 3 4\n"), options);
  }
  std::string complaint(const std::string& line, const MeshFileOptions& options = {}) const {
    return complaintOf([&] { read(line, options); });
  }
};

const std::string otherOrder =
    "a.xyz:1: names x, y and z in another order or place than the first three columns, which are "
    "read as x, y, z; put these columns first, or remove the line if it is wrong";

/// @param named how to state the unit, if problems have a name for it.
std::string otherUnit(const std::string& said, const std::string& used, const std::string& named) {
  return "a.xyz:1: says that a unit is " + said + " m, but coordinates are read with a unit of " +
         used + " m; state the unit" + named + ", or remove the line if it is wrong";
}

TEST_F(NamesOfColumns, InTheOrderThatIsRead) {
  for (const std::string line : {"# x y z", "//X Y Z R G B", "#X,Y,Z", "# x[m] y[m] z[m] intensity",
                                 "# XYZ rgb", "# columns: x; y; z; t", "# x_m y_m z_m", "# 4 5 6",
                                 "#", "//", "# x y z in metres", "x y z", "X,Y,Z,intensity"}) {
    EXPECT_EQ(complaint(line), "no complaint") << line;
    EXPECT_EQ(read(line).comment, 0) << line;
    EXPECT_EQ(read(line).points, std::vector<Vec3>{Vec3(1, 2, 3)}) << line;
  }
}

TEST_F(NamesOfColumns, InAnotherOrder) {
  for (const std::string line :
       {"# y x z", "// y x z", "//Y X Z", "# z y x", "# id x y z", "#intensity,x,y,z",
        "# r g b xyz", "# zyx", "# columns: id x y z", "# .xyz y x z", "# x: right y: up z: back"})
    EXPECT_EQ(complaint(line), otherOrder) << line;
  EXPECT_EQ(complaint("# made by hand\n# y x z").substr(0, 13), "a.xyz:2: name");
}

TEST_F(NamesOfColumns, InAnotherUnit) {
  for (const std::string line : {"# x[mm] y[mm] z[mm]", "// X_mm, Y_mm, Z_mm", "# units mm",
                                 "# Unit: Millimeters", "x y z mm", "# x y z (millimetres)"}) {
    EXPECT_EQ(complaint(line), otherUnit("0.001", "1", " (unit: mm)")) << line;
    EXPECT_EQ(complaint(line, {0.001, {}}), "no complaint") << line;
    EXPECT_EQ(complaint(line, {0.01, {}}), otherUnit("0.001", "0.01", " (unit: mm)")) << line;
  }
  EXPECT_EQ(complaint("# x [in] y [in] z [in]"), otherUnit("0.0254", "1", " (unit: in)"));
  EXPECT_EQ(complaint("# x[m] y[m] z[mm]"), otherUnit("0.001", "1", " (unit: mm)"));
  EXPECT_EQ(complaint("# x[m] y[m] z[m]", {0.001, {}}), otherUnit("1", "0.001", " (unit: m)"));
  EXPECT_EQ(complaint("# x [\u00b5m] y [\u00b5m] z [\u00b5m]"), otherUnit("1e-06", "1", ""));
}

/// The first comment of other words is reported by its line. Comments among the points are not.
TEST_F(NamesOfColumns, OtherComments) {
  EXPECT_EQ(read("# made by hand").comment, 1);
  EXPECT_EQ(read("# x y z\n\n// sensor at 5 mm\n# more").comment, 3);
  EXPECT_EQ(read("# x and z").comment, 1);
  EXPECT_EQ(read("1 2 3\n# made by hand\n# x y z").comment, 0);
}

/// A file of several scans may have a header for each.
TEST_F(NamesOfColumns, AmongThePoints) {
  EXPECT_EQ(complaint("1 2 3\n//Z Y X\n6 5 4"), "a.xyz:2" + otherOrder.substr(7));
  EXPECT_EQ(complaint("//X[m] Y[m] Z[m]\n1 2 3\n//X[mm] Y[mm] Z[mm]\n4 5 6"),
            "a.xyz:3" + otherUnit("0.001", "1", " (unit: mm)").substr(7));
  EXPECT_EQ(complaint("//X Y Z\n1 2 3\n//X Y Z\n# 4 5 6\n# scan 2, gap of 5 mm"), "no complaint");
  EXPECT_EQ(complaint("1 2 3 # z y x\n4 5 6 // x y z in mm"), "no complaint")
      << "comments beside a point are about this point";
}

TEST_F(NamesOfColumns, Headers) {
  const auto header = [](const std::string& first) {
    return "a.xyz:1: is a header that begins with \"" + first +
           "\", not with x y z; put the columns x, y and z first, and name them in this way";
  };
  EXPECT_EQ(complaint("id,x,y,z"), header("id"));
  EXPECT_EQ(complaint("y x z"), header("y"));
  EXPECT_EQ(complaint("\"id\",\"x\",\"y\",\"z\""), header("\"id\""));
  EXPECT_EQ(complaint("x2,y,z"), header("x2"));
  EXPECT_EQ(complaint("x-y,z,w"), header("x-y"));
  EXPECT_EQ(complaint("x_raw,y,z"), header("x_raw"));
  EXPECT_EQ(complaint("\"x\",\"y\",\"z\",\"label\""), "no complaint");
  for (const std::string line : {"x[mm];y[mm];z[mm]", "x[mm],y[mm],z[mm]", "x [mm], y [mm], z [mm]",
                                 "\"x (mm)\",\"y (mm)\",\"z (mm)\"", "X_mm Y_mm Z_mm"}) {
    EXPECT_EQ(complaint(line), otherUnit("0.001", "1", " (unit: mm)")) << line;
    EXPECT_EQ(complaint(line, {0.001, {}}), "no complaint") << line;
  }
  // Here "#" names the first column, which is an index.
  EXPECT_EQ(complaint("#,x,y,z"), otherOrder);
  EXPECT_EQ(complaint("1,2,x"),
            "a.xyz:1: coordinate \"x\" is not a number; write decimal numbers such as -1.25e-3");
}

}  // namespace
}  // namespace corridor::test
