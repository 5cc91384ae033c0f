// What FBX files in text have twice, or in words that assimp reads as other numbers.
#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class FbxText : public MeshContent {
 protected:
  std::string fault(const std::string& text) { return complaint("a.fbx", text); }
  /// Returns a file in which one text is replaced by another.
  static std::string changed(const std::string& from, const std::string& to) {
    std::string text = fbx("");
    return text.replace(text.find(from), from.size(), to);
  }
};

std::string settings(const std::string& properties) {
  return "GlobalSettings: {\n Version: 1000\n Properties70: {\n" + properties + " }\n}\n";
}

std::string property(const std::string& name, const std::string& value) {
  return "  P: \"" + name + "\", \"double\", \"Number\", \"\"," + value + "\n";
}

TEST_F(FbxText, NumbersThatAssimpMisreads) {
  const auto with = [&](const std::string& word) {
    return fault(changed("0,2,0\n", "0," + word + ",0\n"));
  };
  const std::string start = "a.fbx:11: Vertices has \"",
                    digits =
                        "\", which assimp misreads; write decimal numbers with at most 15 digits",
                    none = "\", which is no decimal number; write decimal numbers such as -1.25e-3";
  for (const std::string word :
       {"2.0000000000000000000000000000000", "20000000000000000000e-19", "0.00000000000000002e17"})
    EXPECT_EQ(with(word), start + word + digits);
  for (const std::string word : {"1.#INF", "-1.#IND", "0.2d1", "nan", "2x"})
    EXPECT_EQ(with(word), start + word + none);
  for (const std::string word :
       {"2", "-2.5", "1.2246467991473532e-16", "2.00000000000000000000000000000", "1e+01"})
    EXPECT_EQ(with(word), "no complaint") << word;
  const std::string long0 = "2.0000000000000000000000000000000";
  EXPECT_EQ(fault(fbx(settings(property("UnitScaleFactor", long0)))),
            "a.fbx:8: UnitScaleFactor has \"" + long0 + digits);
  EXPECT_EQ(fault(fbx(settings(property("TimeSpanStop", long0)))), "no complaint");
}

TEST_F(FbxText, PartsThatAreThereTwice) {
  const auto twice = [](int line, const std::string& name) {
    return "a.fbx:" + std::to_string(line) + ": a second \"" + name +
           "\" is in one part of the file, and assimp drops one" + instead;
  };
  const std::string unit = property("UnitScaleFactor", "100");
  EXPECT_EQ(fault(fbx(settings(unit))), "no complaint");
  EXPECT_EQ(fault(fbx(settings(unit + unit))), twice(9, "UnitScaleFactor"));
  EXPECT_EQ(fault(fbx(settings(unit) + settings(unit))), twice(11, "GlobalSettings"));
  EXPECT_EQ(fault(fbx("") + "Connections: {\n}\n"), twice(25, "Connections"));
  EXPECT_EQ(fault(fbx("") + "; a comment {\nObjects: {\n}\n"), twice(26, "Objects"));
  EXPECT_EQ(fault(changed("  PolygonVertexIndex",
                          "  Vertices: *3 {\n   a: 1,2,3\n  }\n"
                          "  PolygonVertexIndex")),
            twice(13, "Vertices"));
}

TEST_F(FbxText, CornersOfPolygons) {
  const auto with = [&](const std::string& corners) { return fault(changed("0,1,-3", corners)); };
  for (const std::string corners : {"0,1,-3,0,1,2", "0,1,-3,2,1,-0"})
    EXPECT_EQ(fault(changed("*3 {\n   a: 0,1,-3", "*6 {\n   a: " + corners)),
              "a.fbx:14: the last polygon does not end, and assimp drops it; make its last corner "
              "negative");
  for (const std::string corners : {"0,1.0,-3", "0,4294967297,-3", "0,x,-3"})
    EXPECT_EQ(with(corners),
              "a.fbx:14: PolygonVertexIndex may have whole numbers only, with at most 31 bits");
}

TEST_F(FbxText, ListsOfAnotherLength) {
  const std::string cut = "; the file may be cut off, save it again";
  EXPECT_EQ(fault(changed("Vertices: *9", "Vertices: *12")),
            "a.fbx:11: Vertices has 9 values and says 12" + cut);
  EXPECT_EQ(fault(changed("PolygonVertexIndex: *3", "PolygonVertexIndex: *6")),
            "a.fbx:14: PolygonVertexIndex has 3 values and says 6" + cut);
  EXPECT_EQ(fault(changed("PolygonVertexIndex: *3", "PolygonVertexIndex: *x")),
            "a.fbx:14: PolygonVertexIndex has 3 values and says x" + cut);
}

TEST_F(FbxText, WhereAssimpEnds) {
  EXPECT_THAT(fault(fbx("}\n" + settings(property("UnitScaleFactor", "100")))),
              HasSubstr("a } without a {, where assimp ends; remove it"));
  for (const std::string& byte : {std::string(1, '\0'), std::string("\f")})
    EXPECT_THAT(fault(fbx("; x" + byte + "\n")), HasSubstr("a character that text doesn't have"));
}

TEST_F(FbxText, UnitsThatAreNotPositive) {
  for (const std::string unit : {"0", "-100"})
    EXPECT_EQ(fault(fbx(settings(property("UnitScaleFactor", unit)))),
              "a.fbx:8: UnitScaleFactor is not above 0; write the length of a unit in centimetres");
}

TEST_F(FbxText, TransformsThatAssimpDoesNotApply) {
  // The square of the difference from the identity is compared with 2^-23: 3.4527e-4 squared.
  const auto of = [&](const std::string& name, const std::string& value) {
    return fault(fbx(settings(property(name, value))));
  };
  const auto small = HasSubstr("is so near the identity that assimp does not apply it");
  EXPECT_THAT(of("Lcl Translation", "3.452e-4,0,0"), small);
  EXPECT_THAT(of("PreRotation", "1e-4,0,-1e-4"), small);
  EXPECT_THAT(of("Lcl Scaling", "1.0003,1,1"), small);
  EXPECT_THAT(of("GeometricScaling", "1,0.9999,1"), small);
  for (const std::string value : {"0,0,0", "3.46e-4,0,0", "1,1,1", "1e-15,0,0"})
    EXPECT_EQ(of("Lcl Translation", value), "no complaint") << value;
  EXPECT_EQ(of("Lcl Scaling", "1,1,1"), "no complaint");
  for (const std::string more : {",1", ",0,0"})  // assimp reads the first three numbers
    EXPECT_THAT(of("Lcl Scaling", "1.0003,1,1" + more), small);

  // Roundings of floats have a note: 2^-23 of scales and turns (6.83e-6 degrees), and 2^-24 of the
  // geometry's largest coordinate, 2, times the scales below 1.
  const auto note =
      Contains("transforms of FBX that differ from the identity by roundings only are not applied");
  const auto notes = [&](const std::string& name, const std::string& value,
                         const std::string& scale = "1,1,1") {
    return notesOf("a.fbx", fbx(settings(property(name, value) + property("Other", "1") +
                                         property("GeometricScaling", scale))));
  };
  EXPECT_THAT(notes("Lcl Translation", "1e-15,0,0"), note);
  EXPECT_THAT(notes("Lcl Translation", "1.1e-7,0,0"), note);
  EXPECT_THAT(notes("Lcl Translation", "0,0,0"), Not(note));
  EXPECT_THAT(notes("Lcl Scaling", "0.999999940395355,1,1"), note);
  EXPECT_THAT(notes("Lcl Rotation", "5.00895567e-06,0,0"), note);
  EXPECT_THAT(of("Lcl Translation", "1.3e-7,0,0"), small);
  EXPECT_THAT(of("RotationPivot", "1.3e-7,0,0"), small);
  EXPECT_THAT(of("Lcl Scaling", "0.9999998,1,1"), small);
  EXPECT_THAT(of("Lcl Rotation", "6.9e-6,0,0"), small);
  EXPECT_THAT(fault(fbx(settings(property("Lcl Translation", "1.1e-7,0,0") +
                                 property("GeometricScaling", "0.5,1,1")))),
              small);
}

TEST_F(FbxText, ObjectsOfOneId) {
  EXPECT_THAT(fault(fbx("", " Geometry: 1, \"Geometry::b\", \"Mesh\" {\n }\n")),
              HasSubstr("duplicate object id"));
}

TEST_F(FbxText, AxesThatAreNoRightHandedFrame) {
  const auto axes = [&](int up, int upSign, int front, int frontSign, int coordSign) {
    const auto whole = [](const std::string& name, int value) {
      return "  P: \"" + name + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n";
    };
    return notesOf("a.fbx",
                   fbx(settings(whole("UpAxis", up) + whole("UpAxisSign", upSign) +
                                whole("FrontAxis", front) + whole("FrontAxisSign", frontSign) +
                                whole("CoordAxis", 0) + whole("CoordAxisSign", coordSign))));
  };
  const auto note = Contains(StartsWith("the file's axes are left-handed, or its up-axis points"));
  EXPECT_THAT(axes(1, 1, 2, 1, 1), Not(note));
  EXPECT_THAT(axes(2, 1, 1, -1, 1), Not(note));
  EXPECT_THAT(axes(1, 1, 2, 1, -1), note);
  EXPECT_THAT(axes(1, -1, 2, -1, 1), note);
}

}  // namespace
}  // namespace corridor::test::mesh_content
