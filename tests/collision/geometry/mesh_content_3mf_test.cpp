// What 3MF files hold beyond the triangles that are read.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const MeshFileOptions inMetre{1, {}};

/// Returns a ZIP archive of files, which are not packed. @param files pairs of name and content
std::string archive(const std::vector<std::pair<std::string, std::string>>& files) {
  const auto half = [](std::size_t n) { return bytesOf(static_cast<std::uint16_t>(n)); };
  const auto word = [](std::size_t n) { return bytesOf(static_cast<std::uint32_t>(n)); };
  std::string bytes, directory;
  for (const auto& [name, content] : files) {
    std::uint32_t crc = ~0u;
    for (const char c : content) {
      crc ^= static_cast<unsigned char>(c);
      for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    const std::string entry = half(20) + word(0) + word(0) + word(~crc) + word(content.size()) +
                              word(content.size()) + half(name.size()) + half(0);
    directory += "PK\x01\x02" + half(20) + entry + half(0) + half(0) + half(0) + word(0) +
                 word(bytes.size()) + name;
    bytes += "PK\x03\x04" + entry + name + content;
  }
  return bytes + directory + "PK\x05\x06" + word(0) + half(files.size()) + half(files.size()) +
         word(directory.size()) + word(bytes.size()) + half(0);
}

const std::string relations =
    R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";

/// Returns a 3MF file of one triangle. The places: the attributes of its model, the resources after
/// the triangle, and the build, which are lines 4 and 5.
std::string threeMf(const std::string& attributes, const std::string& resources = "",
                    const std::string& build = R"(<item objectid="1"/>)",
                    std::vector<std::pair<std::string, std::string>> files = {}) {
  files.push_back({"_rels/.rels", relations});
  files.push_back(
      {"3D/3dmodel.model",
       R"(<?xml version="1.0"?><model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" )" +
           attributes + R"(>
<resources><object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="2" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
)" + resources +
           "</resources>\n<build>" + build + "</build></model>"});
  return archive(files);
}
const std::string model = "a.3mf";

TEST_F(MeshContent, ThreeMfArchives) {
  const MeshFile file = read("a.3mf", threeMf("unit=\"meter\""), inMetre);
  EXPECT_THAT(file.mesh.vertices, ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0)));
  EXPECT_THAT(file.notes, IsEmpty());
  EXPECT_EQ(file.fileUp, std::nullopt);
  EXPECT_EQ(read("a.3mf", threeMf("unit=\"millimeter\"")).mesh.vertices.at(2), Vec3(0, 0.002, 0));
  const auto fault = [&](const std::vector<std::pair<std::string, std::string>>& files) {
    return complaint("a.3mf", archive(files), inMetre);
  };
  // The model is the one that the relations name.
  EXPECT_THAT(read("a.3mf", threeMf("unit=\"meter\"", "", R"(<item objectid="1"/>)",
                                    {{"3D/Objects/o.MODEL", "<model/>"},
                                     {"__MACOSX/3D/._3dmodel.model", "resources"}}))
                  .notes,
              ElementsAre("the model \"3D/Objects/o.MODEL\" of the archive is not read"));
  EXPECT_EQ(fault({{"_rels/.rels", relations}, {"3D/other.model", "<model/>"}}),
            "a.3mf: the archive has no file \"3D/3dmodel.model\"" + instead);
  EXPECT_EQ(fault({{"3D/3dmodel.model", "<model/>"}}),
            "a.3mf: the archive has no file \"_rels/.rels\"" + instead);
  EXPECT_EQ(fault({{"_rels/.rels", relations},
                   {"3D/3dmodel.model", "<model/>"},
                   {"3D/3DModel.model", "<model/>"}}),
            "a.3mf: has \"3D/3dmodel.model\" twice" + instead);
  const auto faultOf = [&](const std::string& old, const std::string& by) {
    std::string relation = relations;
    relation.replace(relation.find(old), old.size(), by);
    return fault({{"_rels/.rels", relation}, {"3D/3dmodel.model", "<model/>"}});
  };
  EXPECT_EQ(faultOf("2013/01/3dmodel", "2013/01/other"),
            "a.3mf: _rels/.rels must name the model of the archive" + instead);
  EXPECT_THAT(faultOf("<Relationship ", "<r:Relationship "), HasSubstr("has a namespace prefix"));
  EXPECT_EQ(faultOf("</Relationships>",
                    R"(<Relationship Target="/b.model" Type=)"
                    R"("http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>)"
                    "</Relationships>"),
            "a.3mf:2: _rels/.rels names a second model, which is not supported" + instead);
  EXPECT_EQ(faultOf("<Relationship ", "<Relationship TargetMode=\"External\" "),
            "a.3mf:2: _rels/.rels names a model outside the archive" + instead);
  EXPECT_EQ(fault({{"_rels/.rels", relations}, {"3D/3dmodel.model", "<other/>"}}),
            model + ":1: the root element must be <model>, not <other>");
  EXPECT_EQ(fault({{"_rels/.rels", relations}, {"3D/3dmodel.model", "<model></model>\n<x/>"}}),
            model + ":2: something comes before or after the root element");
  EXPECT_EQ(complaint("a.3mf", "hello", inMetre), "a.3mf: the file is no ZIP archive" + instead);
  std::string damaged = threeMf("");
  damaged.replace(damaged.find("<vertices>"), 1, "[");
  EXPECT_EQ(complaint("a.3mf", damaged, inMetre),
            "a.3mf: a file in it is damaged or encrypted" + instead);
}

TEST_F(MeshContent, ThreeMfUnits) {
  const auto notes = [&](const std::string& unit, double given) {
    return read("a.3mf", threeMf(unit), {given, {}}).notes;
  };
  for (const auto& [unit, metre] :
       std::vector<std::pair<std::string, double>>{{"", 0.001},
                                                   {"unit=\"millimeter\"", 0.001},
                                                   {"unit=\"micron\"", 1e-6},
                                                   {"unit=\"centimeter\"", 0.01},
                                                   {"unit=\"inch\"", 0.0254},
                                                   {"unit=\"foot\"", 0.3048},
                                                   {"unit=\"meter\"", 1}}) {
    EXPECT_THAT(notes(unit, metre), IsEmpty()) << unit;
    EXPECT_THAT(notes(unit, 2), ElementsAre(HasSubstr("which is used"))) << unit;
  }
  EXPECT_THAT(notes("", 1),
              ElementsAre("the file's own unit, 0.001 m, is not the stated one, 1 m, which is "
                          "used"));
  EXPECT_EQ(complaint("a.3mf", threeMf("unit=\"Inch\""), inMetre),
            model +
                ":1: the unit \"Inch\" is not one of 3MF; write micron, millimeter, centimeter, "
                "inch, foot or meter");
}

TEST_F(MeshContent, ThreeMfReferences) {
  const auto fault = [&](const std::string& build, const std::string& resources = "") {
    return complaint("a.3mf", threeMf("unit=\"meter\"", resources, build), inMetre);
  };
  const std::string missing = " names an object that is not in the model; correct its objectid";
  EXPECT_EQ(fault("<item objectid=\"1\"/><item objectid=\"7\"/>"), model + ":5: <item>" + missing);
  EXPECT_EQ(fault("<item/>"), model + ":5: <item> has no objectid; add it, or remove the element");
  const std::string of7 =
      "<object id=\"2\"><components><component objectid=\"7\"/></components></object>";
  EXPECT_EQ(fault("<item objectid=\"2\"/>", of7), model + ":4: <component>" + missing);
  EXPECT_EQ(fault("<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 6\"/>"),
            model + ":5: the transform of <item> needs 12 decimal numbers");
  EXPECT_EQ(fault("<item objectid=\"1\" p:path=\"/3D/o.model\"/>"),
            model + ":5: <item> is in another model, which is not supported" + instead);
  EXPECT_EQ(fault("<item objectid=\"1\"/>", "<object id=\"1\"/>"),
            model + ":4: the id 1 is used twice; give each resource a number of its own");
  EXPECT_EQ(fault("<item objectid=\"2\"/>",
                  "<object id=\"2\"><components><component objectid=\"2\"/></components></object>"),
            "a.3mf: nodes nest deeper than 500, or a node contains itself");
  EXPECT_EQ(fault("<item objectid=\"1\" Transform=\"1 0 0 0 1 0 0 0 1 5 6 7\"/>"),
            model + ":5: the attribute \"Transform\" of <item> is not read; write \"transform\"");
  const std::string unused = "<object id=\"2\"><mesh><vertices/><triangles/></mesh></object>";
  EXPECT_THAT(read("a.3mf", threeMf("unit=\"meter\"", unused), inMetre).notes,
              ElementsAre("objects that are in no item of the build are not read"));
}

/// A row vector times the matrix: the last three numbers are the translation.
TEST_F(MeshContent, ThreeMfTransforms) {
  const auto placed = [&](const std::string& resources, const std::string& build) {
    return read("a.3mf", threeMf("unit=\"meter\"", resources, build), inMetre).mesh.vertices;
  };
  const std::string turned = "transform=\"0 1 0 -1 0 0 0 0 1 5 6 7\"";
  EXPECT_THAT(placed("", "<item objectid=\"1\" " + turned + "/>"),
              ElementsAre(Vec3(5, 6, 7), Vec3(5, 7, 7), Vec3(3, 6, 7)));
  // The component first, then its item.
  EXPECT_THAT(
      placed("<object id=\"2\"><components><component objectid=\"1\" transform=\"2 0 0 0 2 0 0 "
             "0 2 1 0 0\"/></components></object>",
             "<item objectid=\"2\" " + turned + "/>"),
      ElementsAre(Vec3(5, 7, 7), Vec3(5, 9, 7), Vec3(1, 7, 7)));
  EXPECT_EQ(placed("", "<item objectid=\"1\"/><item objectid=\"1\" " + turned + "/>").size(), 6u);
  // Products of small numbers that floats would lose.
  const std::string large = "transform=\"1e22 0 0 0 1e22 0 0 0 1e22 0 0 0\"",
                    small = "transform=\"1e-44 0 0 0 1e-44 0 0 0 1e-44 0 0 0\"";
  EXPECT_NEAR(placed("<object id=\"2\"><components><component objectid=\"1\" " + small +
                         "/></components></object><object id=\"3\"><components><component "
                         "objectid=\"2\" " +
                         large + "/></components></object>",
                     "<item objectid=\"3\" " + large + "/>")
                  .at(2)
                  .y(),
              2, 1e-14);
}

TEST_F(MeshContent, ThreeMfElements) {
  const auto fault = [&](const std::string& resources, const std::string& attributes = "") {
    return complaint("a.3mf", threeMf("unit=\"meter\" " + attributes, resources), inMetre);
  };
  // An object beside the triangle, which is placed.
  const auto placed = [&](const std::string& content) {
    const std::string mesh =
        content.starts_with("<mesh>") ? "" : "<mesh><vertices/><triangles/></mesh>";
    return complaint("a.3mf",
                     threeMf("unit=\"meter\"", "<object id=\"2\">" + content + mesh + "</object>",
                             "<item objectid=\"1\"/><item objectid=\"2\"/>"),
                     inMetre);
  };
  for (const std::string name : {"b:beamlattice", "s:slicestack", "slicestack"}) {
    EXPECT_EQ(fault("<" + name + " id=\"2\"/>"), model + ":4: " + notIn("resources", name));
    EXPECT_EQ(placed("<" + name + "/>"), model + ":4: " + notIn("object", name));
    EXPECT_EQ(placed("<mesh><" + name + "/><vertices/><triangles/></mesh>"),
              model + ":4: " + notIn("mesh", name));
  }
  EXPECT_EQ(placed("<extra/>"), model + ":4: " + notIn("object", "extra"));
  EXPECT_THAT(complaint("a.3mf",
                        threeMf("unit=\"meter\"", "",
                                "<item objectid=\"1\"/><item xmlns=\"urn:v\" objectid=\"1\"/>"),
                        inMetre),
              testing::HasSubstr("<item> is of another namespace than the file, \"urn:v\""));
  EXPECT_EQ(fault("<m:colorgroup id=\"3\"><m:color color=\"#FF0000FF\"/></m:colorgroup>"
                  "<basematerials id=\"4\"><base name=\"a\" displaycolor=\"#FF0000FF\"/>"
                  "</basematerials>"),
            "no complaint");
  EXPECT_EQ(fault("", "requiredextensions=\"b\" xmlns:b=\"http://b/beamlattice/2017/02\""),
            model + ":1: the required extension \"b\" is not supported" + instead);
  EXPECT_EQ(fault("",
                  "requiredextensions=\"m p\" xmlns:m=\"http://m/material/2015/02\" "
                  "xmlns:p=\"http://p/production/2015/06\""),
            "no complaint");
  const auto object = [&](const std::string& vertex, const std::string& corner) {
    return placed("<mesh><vertices><vertex " + vertex +
                  "/></vertices><triangles><triangle v1=\"0\" v2=\"0\" v3=\"" + corner +
                  "\"/></triangles></mesh>");
  };
  EXPECT_THAT(object("x=\"0\" y=\"0\"", "0"),
              StartsWith(model + ":4: <vertex> has no z; add it, or remove the element"));
  for (const std::string z : {"0,5", "", "half", "1 2", "0x1"})
    EXPECT_THAT(object("x=\"0\" y=\"0\" z=\"" + z + "\"", "0"),
                EndsWith(model + ":4: <vertex> needs one decimal number z"))
        << z;
  EXPECT_EQ(object("x=\"0\" y=\"+.5\" z=\" 5e-1\n\"/><vertex x=\"1\" y=\"0\" z=\"0\"", "1"),
            "no complaint");
  for (const std::string corner : {"0.5", "-1", "zero", "2147483648", "4294967296"})
    EXPECT_THAT(object("x=\"0\" y=\"1\" z=\"0\"", corner),
                StartsWith(model + ":4: <triangle> v3: \"" + corner +
                           "\" is no whole number from 0 to 2^31 - 1"));
  EXPECT_EQ(object("x=\"0\" y=\"1\" z=\"0\"", "1"),
            model + ":4: v3 of <triangle> is vertex 1 (from 0), and there are 1");
  EXPECT_THAT(object("x=\"0\" y=\"0\" z=\"0\" x=\"0\"", "0"), StartsWith(model + ":4: "));
  EXPECT_EQ(placed("<components><component objectid=\"1\"/></components>"),
            model + ":4: an <object> needs a <mesh> or <components>");
}

}  // namespace
}  // namespace corridor::test::mesh_content
