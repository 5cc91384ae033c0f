#include "collision/geometry/mesh_file.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Expects the tetrahedron of the fixture; the order of its vertices is arbitrary.
void expectTetrahedron(const MeshFile& file) {
  ASSERT_EQ(file.mesh.vertices.size(), 4u);
  const MeshHealth health = inspectMesh(file.mesh);
  EXPECT_EQ(health.distinctTriangles, 4u);
  EXPECT_TRUE(health.watertight);
  EXPECT_DOUBLE_EQ(health.volume.value_or(0), 1.0 / 6);
}

class ReadMeshFile : public MeshFileTest {};

TEST_F(ReadMeshFile, Obj) {
  const MeshFile file = read("a.OBJ", objTetrahedron);
  expectTetrahedron(file);
  EXPECT_EQ(file.format, "OBJ");
  EXPECT_EQ(file.unitRule, "1 m per unit, since neither the format nor the user states one");
  EXPECT_EQ(file.upRule, "coordinates as stored, since no up-axis was requested");
}

TEST_F(ReadMeshFile, BinaryStlIsDetectedByItsSize) {
  MeshFile file = read("a.stl", binaryStlTetrahedron());
  expectTetrahedron(file);
  EXPECT_EQ(file.format, "STL (binary)");
  file = read("b.stl", asciiStlTetrahedron());
  expectTetrahedron(file);
  EXPECT_EQ(file.format, "STL (ASCII)");
}

TEST_F(ReadMeshFile, Ply) {
  MeshFile file = read("a.ply", asciiPlyTetrahedron);
  expectTetrahedron(file);
  EXPECT_EQ(file.format, "PLY (ASCII)");
  file = read("b.ply", binaryPlyTetrahedron(false));
  expectTetrahedron(file);
  EXPECT_EQ(file.format, "PLY (binary, little endian)");
  file = read("c.ply", binaryPlyTetrahedron(true));
  expectTetrahedron(file);
  EXPECT_EQ(file.format, "PLY (binary, big endian)");
}

TEST_F(ReadMeshFile, EveryFormatTakesWindowsLineEnds) {
  const auto windows = [](std::string text) {
    for (auto at = text.find('\n'); at != text.npos; at = text.find('\n', at + 2))
      text.insert(at, "\r");
    return text;
  };
  expectTetrahedron(read("a.obj", windows(objTetrahedron)));
  expectTetrahedron(read("a.stl", windows(asciiStlTetrahedron())));
  expectTetrahedron(read("a.ply", windows(asciiPlyTetrahedron)));
}

TEST_F(ReadMeshFile, WeightsOfVertices) {
  const std::string more = "v 1 0 0 1\nv 0 1 0 0.5 0.5 0.5\nf 1 2 3\n";
  EXPECT_EQ(
      read("a.obj", "v 0 0 2 2\n" + more).notes,
      std::vector<std::string>{"vertices have weights (the fourth number), which are not used"});
  EXPECT_TRUE(read("a.obj", "v 0 0 2 1\n" + more).notes.empty());
}

TEST_F(ReadMeshFile, BinaryStlWhoseHeaderBeginsLikeText) {
  std::string binary = "\xEF\xBB\xBFsolid";
  binary.resize(84 + 50);
  binary[80] = 1;
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::memcpy(binary.data() + 96, corners, sizeof corners);
  EXPECT_EQ(read("a.stl", binary).mesh.triangles.size(), 1u);
}

TEST_F(ReadMeshFile, StlWithAByteOrderMarkAndAnEmptyLine) {
  expectTetrahedron(read("a.stl", "\xEF\xBB\xBF\n" + asciiStlTetrahedron()));
}

TEST_F(ReadMeshFile, ObjWithAByteOrderMarkLosesNoVertex) {
  const std::string text = objTetrahedron;
  expectTetrahedron(read("a.obj", "\xEF\xBB\xBF" + text.substr(text.find("v 0 0 0"))));
}

TEST_F(ReadMeshFile, CoordinatesAreTheNearestDoubles) {
  const MeshFile file = read("a.obj",
                             "v 0.1 1e-50 +3\nv 1e-400 -1e-5000 4.9e-324\nv 1.7976931348623157e308 "
                             "123456789.123456789 .5\nf 1 2 3\n");
  const double tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(file.mesh.vertices[0], Vec3(0.1, 1e-50, 3));
  EXPECT_EQ(file.mesh.vertices[1], Vec3(0, 0, tiny));
  EXPECT_EQ(file.mesh.vertices[2], Vec3(1.7976931348623157e308, 123456789.123456789, 0.5));
}

TEST_F(ReadMeshFile, PolygonsBecomeFans) {
  const Triangles fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(
      read("a.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5").mesh.triangles,
      fan);
  EXPECT_EQ(read("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double "
                 "y\nproperty double z\n"
                 "element face 1\nproperty list uint uint vertex_indices\nend_header\n"
                 "0 0 0 1 0 0 2 1 0 1 2 0 0 2 0 5 0 1 2 3 4")
                .mesh.triangles,
            fan);
}

TEST_F(ReadMeshFile, ObjLinesContinueAndFacesMayComeFirst) {
  const MeshFile file =
      read("a.obj", "f 1 \\\n 2\\\n 3 # done\nv 0 0 0\nv 1 0 0\nv 0 1 \\\n 0\nl 1 2\np 1\n");
  EXPECT_EQ(file.mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(file.mesh.vertices[2], Vec3(0, 1, 0));
}

TEST_F(ReadMeshFile, UnitAndUpAxis) {
  const std::string obj = "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n";
  const auto first = [&](std::optional<double> unit, std::optional<char> up) {
    return Vec3(read("a.obj", obj, {unit, up}).mesh.vertices[0]);
  };
  EXPECT_EQ(first(0.001, {}), Vec3(0.001 * 1, 0.001 * 2, 0.001 * 3));
  EXPECT_EQ(first({}, 'z'), Vec3(1, 2, 3));
  EXPECT_EQ(first({}, 'y'), Vec3(1, -3, 2));
  EXPECT_EQ(first({}, 'x'), Vec3(-2, -3, 1));
  const MeshFile file = read("a.obj", obj, {0.0254, 'y'});
  EXPECT_EQ(file.unitRule, "0.0254 m per unit, as requested");
  EXPECT_EQ(file.upRule, "y is up, as requested: rotated by (x, y, z) -> (x, -z, y)");
  EXPECT_EQ(read("a.obj", obj, {{}, 'x'}).upRule,
            "x is up, as requested: rotated by (x, y, z) -> (-y, -z, x)");
  EXPECT_EQ(read("a.obj", obj, {{}, 'z'}).upRule, "z is up, as requested: not rotated");
}

TEST_F(ReadMeshFile, TurnsAreProper) {
  const char* const tetrahedron =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  for (const char up : {'x', 'y', 'z'}) {
    EXPECT_GT(inspectMesh(read("a.obj", tetrahedron, {{}, up}).mesh).volume.value_or(0), 0) << up;
  }
}

// Bad input. The tests compare whole messages.

class MeshFileComplaint : public MeshFileTest {};

TEST_F(MeshFileComplaint, FilesThatCannotBeRead) {
  EXPECT_EQ(complaint(folder_ / "none.obj"), "none.obj: no such file");
  EXPECT_EQ(complaint(folder_ / "none.dae"), "none.dae: no such file");
  std::filesystem::create_directory(folder_ / "folder.stl");
  EXPECT_EQ(complaint(folder_ / "folder.stl"), "folder.stl: is a folder; a file is needed");
  EXPECT_EQ(complaint("/dev/null"), "/dev/null: is a device; an ordinary file is needed");
  EXPECT_EQ(complaint("a.ply", ""), "a.ply: is empty; a mesh file is needed");
}

TEST_F(MeshFileComplaint, Options) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint("a.obj", objTetrahedron, {0.0, {}}),
            "a.obj: metres per unit must be a finite number above 0, not 0");
  EXPECT_EQ(complaint("a.obj", objTetrahedron, {-1.5, 'w'}),
            "a.obj: metres per unit must be a finite number above 0, not -1.5\n"
            "a.obj: the up-axis must be x, y or z, not \"w\"");
  EXPECT_EQ(complaint("a.obj", objTetrahedron, {nan, {}}),
            "a.obj: metres per unit must be a finite number above 0, not nan");
  EXPECT_EQ(complaint("a.obj", "v 1e300 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3", {1e10, {}}),
            "a.obj: its coordinates times 1e+10 m per unit are too large for a double");
}

TEST_F(MeshFileComplaint, NoFaces) {
  const std::string text =
      ": the mesh has no faces; triangles or polygons are needed, lines and points are not read";
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nl 1 1\n"), "a.obj" + text);
  EXPECT_EQ(complaint("a.stl", "solid\nendsolid\n"), "a.stl" + text);
  EXPECT_EQ(complaint("b.stl", std::string(84, '\0')), "b.stl" + text);
  EXPECT_EQ(
      complaint(
          "a.ply",
          "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty "
          "float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"),
      "a.ply" + text);
}

TEST_F(MeshFileComplaint, ObjVertices) {
  const std::string face = "\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";
  EXPECT_EQ(complaint("a.obj", "v 0 nan 0" + face), "a.obj:1: coordinate \"nan\" is not finite");
  EXPECT_EQ(complaint("a.obj", "v 0 0 -inf" + face), "a.obj:1: coordinate \"-inf\" is not finite");
  EXPECT_EQ(complaint("a.obj", "v 1e999 0 0" + face),
            "a.obj:1: coordinate \"1e999\" is too large for a double");
  // The exponents of these numbers are out of range for long double, too.
  for (const std::string word : {"1e5000", "-1e5000", "1e99999999999999999999"})
    EXPECT_EQ(complaint("a.obj", "v " + word + " 0 0" + face),
              "a.obj:1: coordinate \"" + word + "\" is too large for a double");
  EXPECT_EQ(complaint("a.obj", "v 1e-5000 -1e-99999999999999999999 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            "no complaint");
  EXPECT_EQ(complaint("a.obj", "v 0 0" + face), "a.obj:1: a vertex has 3 coordinates, found 2");
  const std::string right = " is not a number; write decimal numbers such as -1.25e-3";
  EXPECT_EQ(complaint("a.obj", "v 0 1,5 0" + face), "a.obj:1: coordinate \"1,5\"" + right);
  EXPECT_EQ(complaint("a.obj", "v 0 0x1 +-2" + face), "a.obj:1: coordinate \"0x1\"" + right);
  EXPECT_EQ(complaint("a.obj", "v 0 0 +-2" + face), "a.obj:1: coordinate \"+-2\"" + right);
  EXPECT_EQ(complaint("a.obj", "v 0 0 1 mm\nv 1 0 0 1 # a\nv 0 1 0 1 0 0\nf 1 2 3\n"),
            "a.obj:1: \"mm\" comes after the coordinates of a vertex; only numbers (a weight or a "
            "colour) may follow");
}

TEST_F(MeshFileComplaint, ObjFaces) {
  const std::string vertices = "v 0 0 0\nv 0 1 0\nv 0 0 1\n";
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2 0"),
            "a.obj:4: face corner 0 is out of range: vertices count from 1, or backwards from -1");
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2 4"),
            "a.obj:4: face corner 4 is out of range: the file has 3 vertices");
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2 5000000000"),
            "a.obj:4: face corner 5000000000 is out of range: the file has 3 vertices");
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2 -4\nv 1 1 1"),
            "a.obj:4: face corner -4 is out of range: 3 vertices come before it");
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2"),
            "a.obj:4: a face has at least 3 corners, found 2");
  EXPECT_EQ(complaint("a.obj", vertices + "f"), "a.obj:4: a face has at least 3 corners, found 0");
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2.5 3"),
            "a.obj:4: face corner \"2.5\" is not of the form 1, 1/2, 1/2/3 or 1//3");
  EXPECT_EQ(complaint("a.obj", vertices + "f 1 2/x 3"),
            "a.obj:4: face corner \"2/x\" is not of the form 1, 1/2, 1/2/3 or 1//3");
}

TEST_F(MeshFileComplaint, AllFaultsAtOnceAtMostTen) {
  EXPECT_EQ(
      complaint("a.obj", "v 0 nan 0\nv 0 0\nv 1 1 1\nf 1 2 9\n"),
      "a.obj:1: coordinate \"nan\" is not finite\na.obj:2: a vertex has 3 coordinates, found 2\n"
      "a.obj:4: face corner 9 is out of range: the file has 3 vertices");
  std::string many;
  for (int i = 0; i < 100; ++i) many += "v nan 0 0\n";
  const std::string text = complaint("a.obj", many);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_TRUE(text.ends_with("\na.obj: reading stopped at 10 faults; there may be more")) << text;
}

TEST_F(MeshFileComplaint, BinaryStl) {
  const std::string whole = binaryStlTetrahedron();
  EXPECT_EQ(complaint("a.stl", whole.substr(0, 200)),
            "a.stl: binary STL of 4 triangles: expected 284 bytes, found 200: it is cut short");
  EXPECT_EQ(complaint("a.stl", whole + "more"),
            "a.stl: binary STL of 4 triangles: expected 284 bytes, found 288: its header or its "
            "end is damaged");
  EXPECT_EQ(
      complaint("a.stl", binaryStlTetrahedron("x").substr(0, 80) + "\xff\xff\xff\xff" + "rest"),
      "a.stl: binary STL of 4294967295 triangles: expected 214748364834 bytes, found 88: it is cut "
      "short");
  EXPECT_EQ(complaint("a.stl", "hello"),
            "a.stl: is not an STL file: ASCII begins with \"solid\", binary has at least 84 "
            "bytes, found 5");
  std::string nan = whole;
  nan.replace(84 + 50 + 24, 4, bytesOf(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(complaint("a.stl", nan), "a.stl: facet 2 (byte 158): a coordinate is not finite");
}

TEST_F(MeshFileComplaint, AsciiStl) {
  const std::string whole = asciiStlTetrahedron();
  const auto cut = [&](const char* before) { return whole.substr(0, whole.rfind(before)); };
  EXPECT_EQ(
      complaint("a.stl", cut("endsolid")),
      "a.stl:30: the file ends where endsolid should come, after 4 whole facets: it is cut short");
  EXPECT_EQ(
      complaint("a.stl", cut("endfacet")),
      "a.stl:29: the file ends where endfacet should come, after 3 whole facets: it is cut short");
  EXPECT_EQ(complaint("a.stl", cut(" 1 0\n endloop")),
            "a.stl:27: the file ends where a coordinate should come, after 3 whole facets: it is "
            "cut short");
  EXPECT_EQ(complaint("a.stl", cut("outer")),
            "a.stl:24: the file ends where outer loop should come, after 3 whole facets: it is cut "
            "short");
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string text = whole;
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_EQ(complaint("a.stl", replaced("vertex 0 1 0", "vertex 0 inf 0")),
            "a.stl:5: coordinate \"inf\" is not finite");
  EXPECT_EQ(complaint("a.stl", replaced("vertex 0 1 0", "vertex 0 a 0")),
            "a.stl:5: coordinate \"a\" is not a number; write decimal numbers such as -1.25e-3");
  EXPECT_EQ(complaint("a.stl", replaced("  vertex 0 1 0\n", "")),
            "a.stl:6: expected vertex, found \"endloop\"");
  EXPECT_EQ(complaint("a.stl", replaced(" endloop", " vertex 1 1 1\n endloop")),
            "a.stl:7: a facet has exactly 3 vertices, found a fourth");
  EXPECT_EQ(complaint("a.stl", replaced("endfacet", "endfact")),
            "a.stl:8: expected endfacet, found \"endfact\"");
  const std::string facet =
      " facet normal 0 0 1 outer LOOP vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
  const std::string named =
      ": a facet is on the line of solid or endsolid, whose rest is a name; "
      "begin a new line before the facet";
  EXPECT_EQ(complaint("a.stl", "solid a" + facet + facet + "endsolid a\n"), "a.stl:1" + named);
  EXPECT_EQ(complaint("a.stl", "solid" + facet + facet + "endsolid a\n"), "a.stl:1" + named);
  EXPECT_EQ(complaint("a.stl", "solid a\n" + facet + "endsolid a solid b" + facet),
            "a.stl:3" + named);
  EXPECT_EQ(complaint("a.stl", "solid the facet of an outer loop vertex endfacet\n" + facet +
                                   "endsolid facet normal 0 0 1\n"),
            "no complaint");
  EXPECT_EQ(complaint("a.stl", whole + "junk"), "a.stl:31: expected solid, found \"junk\"");
}

TEST_F(MeshFileComplaint, PlyHeader) {
  const std::string format = "ply\nformat ascii 1.0\n";
  const std::string vertex =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_EQ(complaint("a.ply", "plx\n"), "a.ply:1: a PLY file must begin with the line \"ply\"");
  EXPECT_EQ(complaint("a.ply", "ply\nformat binary 1.0\n"),
            "a.ply:2: unknown format \"binary\"; expected ascii, binary_little_endian or "
            "binary_big_endian");
  EXPECT_EQ(complaint("a.ply", "ply\nformat ascii 2.0\n"),
            "a.ply:2: unknown version \"2.0\"; expected 1.0");
  EXPECT_EQ(complaint("a.ply", "ply\nend_header\n"), "a.ply:2: the header has no line \"format\"");
  EXPECT_EQ(complaint("a.ply", format + vertex),
            "a.ply:7: the file ends where end_header should come: it is cut short");
  EXPECT_EQ(complaint("a.ply", format + vertex + face + "end_header"),
            "a.ply:9: the file ends after its header: it is cut short");
  EXPECT_EQ(complaint("a.ply", format + vertex + "end_header\n"),
            "a.ply: the header has no element \"face\"");
  EXPECT_EQ(complaint("a.ply", format + face + "end_header\n"),
            "a.ply: the header has no element \"vertex\"");
  EXPECT_EQ(
      complaint("a.ply", format + "element vertex 3\nproperty float x\n" + face + "end_header\n"),
      "a.ply: element \"vertex\" needs one property \"y\"");
  EXPECT_EQ(complaint("a.ply",
                      format + vertex +
                          "element face 1\nproperty list uchar float vertex_indices\nend_header\n"),
            "a.ply: element \"face\" needs one list \"vertex_indices\" of an integer type");
  EXPECT_EQ(complaint("a.ply", format + "element vertex -3\n"),
            "a.ply:3: element \"vertex\": its count \"-3\" must be an integer of at least 0");
  EXPECT_EQ(complaint("a.ply", format + vertex + vertex),
            "a.ply:7: element \"vertex\" appears twice");
  EXPECT_EQ(complaint("a.ply", format + "property float x\n"),
            "a.ply:3: a property comes before the first element");
  EXPECT_EQ(complaint("a.ply", format + "element vertex 1\nproperty half x\n"),
            "a.ply:4: unknown type \"half\"; expected char, uchar, short, ushort, int, uint, "
            "float, double, or "
            "int8 to float64");
  EXPECT_EQ(complaint("a.ply", format + "element face 1\nproperty list float int vertex_indices\n"),
            "a.ply:4: the count of a list must have an integer type");
  EXPECT_EQ(complaint("a.ply", format + "elements\n"),
            "a.ply:3: unknown keyword \"elements\"; expected element, property or end_header");
}

TEST_F(MeshFileComplaint, PlyBody) {
  const auto ply = [](const std::string& body, const std::string& vertices = "3",
                      const std::string& faces = "1") {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n" + body;
  };
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(complaint("a.ply", ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")),
            "a.ply:11: vertex 2 of 3: coordinate \"nan\" is not finite");
  EXPECT_EQ(
      complaint("a.ply", ply(vertices + "3 0 1 3\n")),
      "a.ply:13: face 1 of 1: corner 3 is out of range: the file has 3 vertices, counted from 0");
  EXPECT_EQ(
      complaint("a.ply", ply(vertices + "3 0 1 -1\n")),
      "a.ply:13: face 1 of 1: corner -1 is out of range: the file has 3 vertices, counted from 0");
  EXPECT_EQ(complaint("a.ply", ply(vertices + "2 0 1\n")),
            "a.ply:13: face 1 of 1: a face has at least 3 corners, found 2");
  EXPECT_EQ(complaint("a.ply", ply(vertices + "3 0 x 2\n")),
            "a.ply:13: face 1 of 1: \"x\" is not an integer");
  EXPECT_EQ(complaint("a.ply", ply(vertices + "-3 0 1 2\n")),
            "a.ply:13: face 1 of 1: a list of -3 values; a count must be at least 0");
  EXPECT_EQ(complaint("a.ply", ply(vertices + "3 0 1")),
            "a.ply:13: face 1 of 1: the file ends here: it is cut short");
  EXPECT_EQ(complaint("a.ply", ply(vertices + "3 0 1 2\n7\n")),
            "a.ply:14: \"7\" comes after the last element: the header's counts are wrong");
  EXPECT_EQ(complaint("a.ply", ply(vertices, "90000000")),
            "a.ply: the header promises 90000000 of element \"vertex\", at least 6 "
            "bytes each, but 19 "
            "bytes are left: the file is cut short");
  EXPECT_EQ(complaint("a.ply", ply(vertices + "999999999 0 1 2\n")),
            "a.ply:14: face 1 of 1: the file ends here: it is cut short");

  const std::string whole = binaryPlyTetrahedron(true);
  EXPECT_EQ(complaint("b.ply", whole.substr(0, whole.size() - 3)),
            "b.ply: face 4 of 4 (byte 385): the file ends here: it is cut short");
}

}  // namespace
}  // namespace corridor::test
