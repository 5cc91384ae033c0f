// Where lines end: at LF, at CR LF, and at a CR alone, in all text formats.
#include "collision/geometry/point_cloud.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

class LineEnds : public MeshFileTest {
 protected:
  PointCloud points(const std::string& name, const std::string& bytes) const {
    return readPointCloud(write(name, bytes));
  }
};

/// Returns the text with other line ends, which are used in turn.
std::string withEnds(const std::string& text, const std::vector<std::string>& ends) {
  std::string result;
  std::size_t i = 0;
  for (const char c : text)
    if (c == '\n')
      result += ends[i++ % ends.size()];
    else
      result += c;
  return result;
}

const std::vector<std::vector<std::string>> kEnds{
    {"\n"}, {"\r\n"}, {"\r"}, {"\n", "\r"}, {"\r\n", "\r", "\n"}, {"\r", "\r\n"}};

TEST_F(LineEnds, Meshes) {
  const std::string off =
      "OFF # a\n# b\n4 4 0\n0 0 0\n1 0 0 # c\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n"
      "3 1 2 3\n3 0 3 2\n";
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"a.obj", objTetrahedron},
                                   {"a.off", off},
                                   {"a.stl", asciiStlTetrahedron()},
                                   {"a.ply", asciiPlyTetrahedron}}) {
    const MeshFile plain = read(name, text);
    for (const auto& ends : kEnds) {
      const MeshFile file = read(name, withEnds(text, ends));
      EXPECT_EQ(file.mesh.vertices, plain.mesh.vertices) << name;
      EXPECT_EQ(file.mesh.triangles, plain.mesh.triangles) << name;
      EXPECT_EQ(file.mesh.triangles.size(), 4u) << name;
    }
  }
}

TEST_F(LineEnds, Points) {
  const std::string pcd =
      "# .PCD v0.7\n# by hand\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 1\n"
      "DATA ascii\n1 1 1\n0.5 0 0\n2 2 2\n";
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"a.pcd", pcd},
                                   {"a.xyz", "# x y z\n1 1 1\n0.5 0 0\n2 2 2"},
                                   {"a.csv", "x,y,z\n1,1,1\n0.5,0,0\n2,2,2\n"}})
    for (const auto& ends : kEnds)
      EXPECT_EQ(points(name, withEnds(text, ends)).points,
                (std::vector<Vec3>{{1, 1, 1}, {0.5, 0, 0}, {2, 2, 2}}))
          << name;
}

/// A CR in a line that otherwise ends with LF ends the line: what follows is not a part of a name.
TEST_F(LineEnds, AmongOthers) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  EXPECT_EQ(read("a.obj", vertices + "g a\rf 1 2 3\ng b\nf 2 3 4\n").mesh.triangles.size(), 2u);
  EXPECT_EQ(read("a.obj", "# made by hand\rv 9 9 9\n" + vertices + "f 1 2 3\n").mesh.vertices[0],
            Vec3(9, 9, 9));
  EXPECT_EQ(points("a.xyz", "1 1 1\r0.5 0 0\r").points.size(), 2u);
  EXPECT_EQ(points("a.xyz", "# a\r1 1 1\n2 2 2\n").points.size(), 2u);
}

TEST_F(LineEnds, CountTheLines) {
  EXPECT_EQ(complaint("a.obj", "# a\r\rv 0 0 x\r"),
            "a.obj:3: coordinate \"x\" is not a number; write decimal numbers such as -1.25e-3");
  EXPECT_EQ(complaintOf([&] { points("a.xyz", "1 1 1\r\n1 1\r1 1 1\r\n"); }),
            "a.xyz:2: a point has 3 coordinates, found 2");
}

/// Binary data begin behind the end of the header's last line, whatever their first byte is.
TEST_F(LineEnds, BeforeBinaryData) {
  for (const char first : {'\n', '\r', ' '}) {
    std::string data = bytesOf(1.0F) + bytesOf(2.0F) + bytesOf(3.0F);
    data[0] = first;
    const float x = std::bit_cast<float>(0x3F800000U | static_cast<unsigned char>(first));
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      const std::string pcd = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA binary\n";
      EXPECT_EQ(points("a.pcd", withEnds(pcd, {end}) + data).points.at(0), Vec3(x, 2, 3));
      const std::string ply =
          "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty "
          "float y\nproperty float z\nend_header\n";
      EXPECT_EQ(points("a.ply", withEnds(ply, {end}) + data).points.at(0), Vec3(x, 2, 3));
    }
  }
}

}  // namespace
}  // namespace corridor::test
