// Numbers of Collada and 3DS files that assimp would read as other numbers.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// --- Collada

const std::string xyz = R"(<param name="X" type="float"/><param name="Y" type="float"/>)"
                        R"(<param name="Z" type="float"/>)";
const std::string threeFaces =
    R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>)";

struct ColladaParts {
  std::string accessor = R"(count="3" stride="3")";
  std::string params = xyz;
  std::string inputs = R"(<input semantic="POSITION" source="#p"/>)";
  std::string faces = threeFaces;
  std::string node;
  std::string array = R"(count="9">0 0 0 1 0 0 0 2 0)";
};

/// Returns a Collada file: the accessor is in line 2, the inputs and faces in line 3, the node
/// in 4.
std::string colladaOf(const ColladaParts& parts) {
  return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" )" +
         parts.array + R"(</float_array><technique_common><accessor source="#pa" )" +
         parts.accessor + ">" + parts.params + R"(</accessor></technique_common></source>
<vertices id="v">)" +
         parts.inputs + "</vertices>" + parts.faces + R"(</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)" +
         parts.node + R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshContent, ColladaAccessors) {
  const auto fault = [&](const std::string& attributes, const std::string& params = xyz) {
    ColladaParts parts;
    parts.accessor = attributes;
    parts.params = params;
    return complaint("a.dae", colladaOf(parts));
  };
  const std::string three = R"(count="3" stride="3")";
  EXPECT_EQ(fault(three), "no complaint");
  const auto named = [](const std::string& names) {
    std::string params;
    for (const char name : names)
      params += "<param " +
                (name == ' ' ? std::string() : "name=\"" + std::string(1, name) + "\" ") +
                "type=\"float\"/>";
    return params;
  };
  for (const std::string names : {"", "xyz", "XY", "ZYX", "XYZZ", "   ", "STP"})
    EXPECT_EQ(fault(three, named(names)),
              "a.dae:2: the <accessor> of positions needs <param>s of the names X, Y and Z in this "
              "order, because assimp reads no others")
        << names;
  for (const std::string stride : {"", "stride=\"2\"", "stride=\"\"", "stride=\"3x\""})
    EXPECT_EQ(fault("count=\"3\" " + stride),
              "a.dae:2: the <accessor> of positions needs a stride of at least 3, its number of "
              "<param>s")
        << stride;
  for (const std::string attributes :
       {R"(count="4" stride="3")", R"(count="3" stride="4")", R"(count="3" stride="3" offset="1")",
        R"(count="3" stride="3" offset="10")", R"(count="-1" stride="3")",
        R"(count="3" stride="3" offset="-1")", R"(count="2147483647" stride="2147483647")"})
    EXPECT_EQ(fault(attributes),
              "a.dae:2: the <accessor> of positions reads beyond the end of its <float_array>; "
              "correct its count, stride or offset")
        << attributes;
  ColladaParts wide;
  wide.array = R"(count="13">9 0 0 0 7 1 0 0 7 0 2 0 7)";
  wide.accessor = R"(count="3" stride="4" offset="0")";
  wide.params = named(" XYZ");
  EXPECT_EQ(read("a.dae", colladaOf(wide)).mesh.vertices.at(2), Vec3(0, 2, 0));
}

TEST_F(MeshContent, ColladaPositions) {
  const auto inputs = [&](const std::string& text) {
    ColladaParts parts;
    parts.inputs = text;
    return complaint("a.dae", colladaOf(parts));
  };
  const std::string one = R"(<input semantic="POSITION" source="#p"/>)";
  const std::string count =
      "a.dae:2: the <vertices> of a <mesh> need one <input> of semantic POSITION, and have ";
  EXPECT_EQ(inputs(one + one), count + "2");
  EXPECT_EQ(inputs(R"(<input semantic="position" source="#p"/>)"), count + "0");
  EXPECT_EQ(inputs(R"(<input semantic="POSITION" source="#q"/>)"),
            "a.dae:2: the source \"#q\" of positions is not in the <mesh>" + instead);
  const auto fault = [&](const std::string& faces) {
    ColladaParts parts;
    parts.faces = faces;
    return complaint("a.dae", colladaOf(parts));
  };
  const auto fans = [](const std::string& n, const std::string& p) {
    return "<trifans count=\"" + n + R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           p + "</p></trifans>";
  };
  EXPECT_EQ(fault(fans("1", "0 1 2")), "no complaint");
  for (const std::string p : {"0 1 2 <!-- c --> 0", "0 1 -2", "0 1 2.5", "0 1 2 x"})
    EXPECT_EQ(fault(fans("1", p)), "a.dae:3: <p> may have whole numbers only") << p;
  for (const std::string n : {"0", "", "-1", "one"})
    EXPECT_EQ(fault(threeFaces + fans(n, "0 1 2")),
              "a.dae:3: <trifans> needs the number of its primitives as its count")
        << n;
  EXPECT_THAT(fault(threeFaces + one + threeFaces),
              HasSubstr("a.dae:3: an <input> of semantic POSITION is not in <vertices>"));
  ColladaParts commas;
  commas.array = R"(count="9">0,0,0,1,0,0,0,2,0)";
  EXPECT_EQ(complaint("a.dae", colladaOf(commas)),
            "a.dae:2: <float_array> has commas; write decimal numbers such as -1.25e-3");
}

TEST_F(MeshContent, ColladaTransforms) {
  const auto at = [&](const std::string& node) {
    ColladaParts parts;
    parts.node = node;
    return colladaOf(parts);
  };
  const std::string length =
      "a.dae:4: the axis of <rotate> is not of length 1, and assimp would distort the mesh; write "
      "the axis with length 1, with six digits or more";
  for (const std::string axis : {"0 0 10 90", "0 0 0 90", "0 0 1.0001 5", "0.7071 0.7071 0 90"})
    EXPECT_EQ(complaint("a.dae", at("<rotate>" + axis + "</rotate>")), length) << axis;
  const auto corner = [&](const std::string& rotation) {
    return read("a.dae", at("<rotate>" + rotation + "</rotate>")).mesh.vertices.at(2);
  };
  EXPECT_EQ(corner("0 0 10 0"), Vec3(0, 2, 0)) << "an angle of 0 is the identity";
  EXPECT_LT((corner("0.57735 0.57735 0.57735 120") - Vec3(0, 0, 2)).norm(), 1e-5);
  EXPECT_EQ(complaint("a.dae", at("<lookat>5 6 7 5 6 0 0 1 0</lookat>")),
            "a.dae:4: " + notRight("lookat"));
  EXPECT_EQ(complaint("a.dae", at("<rotate>0 0 1 3600000180</rotate>")),
            "a.dae:4: the angle of <rotate> is rounded to a float; write one from -720 to 720");
  const std::string second =
      "a.dae:4: a <node> has a second <scale> or <matrix>; multiply them, or write two nodes";
  // Scales that cancel would shear the mesh, by their rounding.
  EXPECT_EQ(complaint("a.dae", at("<scale>1e6 1 1</scale><rotate>0 0 1 90</rotate>"
                                  "<scale>1 1e-6 1</scale>")),
            second);
  const std::string one = "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>";
  EXPECT_EQ(complaint("a.dae", at(one)), "no complaint");
  EXPECT_EQ(complaint("a.dae", at(one + one)), second);
  for (const auto& [name, size] : std::vector<std::pair<std::string, std::string>>{
           {"rotate", "4"}, {"translate", "3"}, {"scale", "3"}, {"matrix", "16"}})
    for (const std::string numbers : {"1", "1 2 x", "1,2,3", "1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8"})
      EXPECT_EQ(complaint("a.dae", at("<" + name + ">" + numbers + "</" + name + ">")),
                "a.dae:4: <" + name + "> needs " + size + " decimal numbers");
}

TEST_F(MeshContent, ColladaDecimals) {
  const auto with = [&](const std::string& word) {
    ColladaParts parts;
    parts.array = "count=\"9\">0 0 0 1 0 0 0 " + word + " 0";
    return complaint("a.dae", colladaOf(parts));
  };
  for (const std::string word : {"0.2d1", "2x", "0x2", "2.5.2", "INF", "&#50;", "2;4"})
    EXPECT_EQ(with(word), "a.dae:2: <float_array> has \"" + word +
                              "\", which is no decimal number; write decimal numbers such as "
                              "-1.25e-3");
  for (const std::string word : {"2", "+2.0", "2.", ".2E1", "\n20e-1\t"})
    EXPECT_EQ(with(word), "no complaint") << word;
}

/// Of such numbers, assimp's function fast_atof reads other values.
TEST_F(MeshContent, ColladaDigits) {
  const auto array = [&](const std::string& word) {
    ColladaParts parts;
    parts.array = "count=\"9\">0 0 0 1 0 0 0 " + word + " 0";
    return complaint("a.dae", colladaOf(parts));
  };
  const auto node = [&](const std::string& word) {
    ColladaParts parts;
    parts.node = "<translate>" + word + " 0 0</translate>";
    return complaint("a.dae", colladaOf(parts));
  };
  const std::string end = "\", which assimp misreads; write decimal numbers with at most 15 digits";
  for (const std::string word :
       {"340282346638528859811704183484516925440.000000", "200000000000000000000e-20",
        "20000000000000000000e-19", "0.00000000000000002e17", "0.0000000000000001234e20"}) {
    EXPECT_EQ(array(word), "a.dae:2: <float_array> has \"" + word + end);
    EXPECT_EQ(node(word), "a.dae:4: <translate> has \"" + word + end);
  }
  for (const std::string word :
       {"0.000000", "-123.456789", "1.2246467991473532e-16", "6.123233995736766e-17", "1e-45",
        "0.10000000000000000555", "123456789012345678", "3.4028234663852886e+38",
        "1.1754943508222875e-38", "4.371138828673793e-08", "0.70710678118654752440"})
    EXPECT_EQ(array(word), "no complaint") << word;
  EXPECT_EQ(node("6.1232339957367660e-17"), "no complaint");
}

/// Lengths that cancel in real arithmetic, but not in floats.
TEST_F(MeshContent, LengthsThatCancel) {
  const auto fault = [&](const std::string& node) {
    ColladaParts parts;
    parts.node = node;
    return complaint("a.dae", colladaOf(parts));
  };
  const std::string moves = "a.dae: assimp computes in floats, which may move a mesh by ";
  EXPECT_THAT(fault("<translate>5000000.3 0 0</translate><translate>-5000000 0 0</translate>"),
              testing::AllOf(StartsWith(moves), HasSubstr("more than a hundredth of its size; move "
                                                          "it to the origin of its file, or")));
  for (const std::string cancel :
       {"<translate>100000000 0 0</translate><translate>-99999998 0 0</translate>",
        "<scale>.001 1 1</scale><translate>1e9 0 0</translate><translate>-1e9 0 0</translate>",
        "<matrix>1 0 0 1e8 0 1 0 0 0 0 1 0 0 0 0 1</matrix><translate>-1e8 0 0</translate>",
        // Lost decimals, times a scale.
        "<scale>1e20 1e20 1e20</scale><node><translate>0.0000000000000009 0 0</translate><node>"
        "<scale>1e-20 1e-20 1e-20</scale><instance_geometry url=\"#g\"/></node></node>",
        "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><translate>1e7 0 0</translate>"
        "<translate>-1e7 0 0</translate>"})
    EXPECT_THAT(fault(cancel), StartsWith(moves)) << cancel;
  // A pivot, and the unit of a part.
  EXPECT_EQ(fault("<translate>1 2 3</translate><rotate>0 0 1 30</rotate>"
                  "<translate>-1 -2 -3</translate>"),
            "no complaint");
  EXPECT_EQ(fault("<scale>.001 .001 .001</scale><translate>1000 0 0</translate>"), "no complaint");
  // Positions far from the origin.
  ColladaParts far;
  far.array = "count=\"9\">5000000.3 0 0 5000001 0 0 5000000 2 0";
  EXPECT_THAT(complaint("a.dae", colladaOf(far)), StartsWith(moves));
  far.array = "count=\"9\">200.3 0 0 201 0 0 200 2 0";
  EXPECT_THAT(notesOf("a.dae", colladaOf(far)),
              testing::Contains(StartsWith("coordinates are computed in floats, which may move a "
                                           "mesh by ")));
}

TEST_F(MeshContent, IndicesBeyondTheRange) {
  ColladaParts parts;
  parts.faces.replace(parts.faces.find("<p>0"), 4, "<p>4294967296");
  EXPECT_EQ(complaint("a.dae", colladaOf(parts)), "a.dae:3: <p> may have numbers below 2^31 only");
}

/// assimp looks for names without a prefix.
TEST_F(MeshContent, ColladaNamesWithAPrefix) {
  const std::string text = colladaOf({});
  for (const std::string part :
       {"<asset/>", "<scene><instance_visual_scene url=\"#s\"/></scene>"}) {
    std::string changed = text;
    const std::string name = part.substr(1, 5);
    changed.replace(changed.find(part), part.size(), "<c:" + name + "/>" + part);
    EXPECT_THAT(complaint("a.dae", changed),
                HasSubstr(": <c:" + name +
                          "> has a namespace prefix, and assimp drops it; remove the prefix"));
  }
  std::string unit = text;
  unit.replace(unit.find("<asset/>"), 8, "<asset><c:unit meter='1000'/><c:formula/></asset>");
  EXPECT_EQ(complaint("a.dae", unit),
            "a.dae:1: <c:unit> has a namespace prefix, and assimp drops it; remove the prefix");
}

/// assimp reads as many polygons as the count says, and skips elements that it does not know.
TEST_F(MeshContent, ColladaElementsThatAreDropped) {
  const auto polygons = [&](const std::string& count, const std::string& corners) {
    ColladaParts parts;
    parts.faces = "<polylist count=\"" + count +
                  R"("><input semantic="VERTEX" source="#v" offset="0"/><vcount>)" + corners +
                  "</vcount><p>0 1 2 0 2 1</p></polylist>";
    return complaint("a.dae", colladaOf(parts));
  };
  EXPECT_EQ(polygons("2", "3 3"), "no complaint");
  for (const auto& [count, corners] :
       std::vector<std::pair<std::string, std::string>>{{"1", "3 3"}, {"3", "3 3"}, {"", "3"}})
    EXPECT_THAT(polygons(count, corners), StartsWith("a.dae:3: <vcount> has ")) << count;
  EXPECT_EQ(polygons("2", "3 3.5"), "a.dae:3: <vcount> may have whole numbers only");
  const auto unknown = [](int line, const std::string& name, const std::string& parent) {
    return "a.dae:" + std::to_string(line) + ": <" + name + "> is not known in <" + parent +
           ">, and assimp drops it; correct its name, or remove it";
  };
  for (const std::string name : {"Node", "translation", "Translate", "c:translate", "Extra",
                                 "Instance_geometry", "matrix4"}) {
    ColladaParts parts;
    parts.node = "<" + name + ">5 0 0</" + name + ">";
    EXPECT_EQ(complaint("a.dae", colladaOf(parts)), unknown(4, name, "node"));
    parts = {};
    parts.faces += "<" + name + "/>";
    EXPECT_EQ(complaint("a.dae", colladaOf(parts)), unknown(3, name, "mesh"));
    parts = {};
    parts.faces.insert(parts.faces.find("<p>"), "<" + name + "/>");
    EXPECT_EQ(complaint("a.dae", colladaOf(parts)), unknown(3, name, "triangles"));
  }
  ColladaParts parts;
  parts.faces += "<Triangles/>";
  EXPECT_EQ(complaint("a.dae", colladaOf(parts)), unknown(3, "Triangles", "mesh"));
  parts = {};
  parts.node =
      "<extra><technique profile='x'><Node ID='a'><translation>1 2 3</translation></Node>"
      "</technique></extra>";
  EXPECT_EQ(complaint("a.dae", colladaOf(parts)), "no complaint");
}

// --- 3DS

/// assimp lays the meshes of 3DS files on their side: OMPL.app's rules read them so, ROS's do not.
TEST_F(MeshContent, ThreeDsOnlyByTheRulesOfOmplApp) {
  const auto half = [](std::size_t n) { return bytesOf(static_cast<std::uint16_t>(n)); };
  const auto chunk = [&](std::size_t id, const std::string& content) {
    return half(id) + bytesOf(static_cast<std::uint32_t>(content.size() + 6)) + content;
  };
  std::string points = half(3);
  for (const float x : {0.f, 0.f, 5.f, 1.f, 0.f, 5.f, 0.f, 2.f, 5.f}) points += bytesOf(x);
  const std::string faces = half(1) + half(0) + half(1) + half(2) + half(7);
  const std::string mesh = chunk(0x4110, points) + chunk(0x4120, faces);
  const std::string bytes =
      chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, std::string("a\0", 2) + chunk(0x4100, mesh))));
  EXPECT_EQ(
      complaint("a.3ds", bytes),
      "a.3ds: the extension \".3ds\" is not supported; save the mesh as OBJ, STL, PLY, OFF or "
      "glTF");
  const OmplAppMesh read = readOmplAppMesh(folder_ / "a.3ds");
  EXPECT_THAT(read.mesh.vertices,
              testing::UnorderedElementsAre(Vec3(0, 5, 0), Vec3(1, 5, 0), Vec3(0, 5, -2)));
  // Each importer reads files of its extensions only, whatever their content.
  write("a.dae", bytes);
  EXPECT_THROW(readOmplAppMesh(folder_ / "a.dae"), InputError);
}

}  // namespace
}  // namespace corridor::test::mesh_content
