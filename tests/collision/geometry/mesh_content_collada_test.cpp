// What Collada files hold beyond the triangles that are read.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

/// Returns a Collada file of the triangle (0, 0, 0), (1, 0, 0), (0, 2, 0). The places: the content
/// of the node, the primitives, and further libraries, which begin in line 3.
std::string collada(const std::string& node = "", const std::string& primitives = "",
                    const std::string& libraries = "") {
  return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
)" + libraries +
         R"(
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)" +
         primitives +
         R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/>)" +
         node + R"(</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshContent, ColladaElements) {
  EXPECT_EQ(complaint("a.dae", collada()), "no complaint");
  EXPECT_EQ(complaint("a.dae", collada("<instance_controller url=\"#c\"/>")),
            "a.dae:8: " + notRight("instance_controller"));
  EXPECT_EQ(complaint("a.dae", collada("<node><skew>45 0 1 0 1 0 0</skew></node>")),
            "a.dae:8: " + notRight("skew"));
  EXPECT_EQ(complaint("a.dae", collada("<!-- <skew> -->")), "no complaint");
  EXPECT_EQ(
      complaint("a.dae", collada("", "<polygons count=\"1\"><ph><p>0 1 2</p></ph></polygons>")),
      "a.dae:6: " + notRight("ph"));
  EXPECT_THAT(complaint("a.dae", "<!DOCTYPE COLLADA [<!ENTITY a \"<!--\">]>" + collada()),
              StartsWith("a.dae:1: a DOCTYPE with declarations is not read; save the file without "
                         "it"));
  EXPECT_THAT(complaint("a.dae",
                        "<!DOCTYPE COLLADA SYSTEM \"a>b\" [<!ATTLIST unit meter CDATA "
                        "\"0.01\">]>" +
                            collada()),
              StartsWith("a.dae:1: a DOCTYPE with declarations is not read; save the file without "
                         "it"));
  for (const std::string declaration :
       {"PUBLIC \"it's\" 'x><COLLADA>decoy</COLLADA><!--'", "<?x >", "SYSTEM 'x' <!-- > -->"})
    EXPECT_THAT(complaint("a.dae", "<!DOCTYPE COLLADA " + declaration + ">" + collada()),
                StartsWith("a.dae:1: a DOCTYPE with declarations is not read"))
        << declaration;
  EXPECT_EQ(complaint("a.dae", "<!DOCTYPE COLLADA SYSTEM \"it's a.dtd\">" + collada()),
            "no complaint");
  for (const std::string name : {"convex_mesh", "brep"})
    EXPECT_EQ(complaint("a.dae", collada("", "",
                                         "<library_geometries><geometry id=\"h\"><" + name +
                                             "/></geometry></library_geometries>")),
              "a.dae:2: " + notRight(name));
}

TEST_F(MeshContent, ColladaReferences) {
  EXPECT_EQ(complaint("a.dae", collada("<instance_node url=\"other.dae#x\"/>")),
            "a.dae: assimp leaves out geometry: Unresolved reference format of node");
  EXPECT_EQ(complaint("a.dae", collada("<instance_node url=\"#x\"/>")),
            "a.dae: assimp leaves out geometry: Unable to resolve reference to instanced node x");
  EXPECT_EQ(complaint("a.dae", collada("<instance_node url=\"#" + std::string(2000, 'x') + "\"/>")),
            "a.dae: assimp leaves out geometry: long message discarded>");
  EXPECT_THAT(
      complaint("a.dae", collada("<instance_geometry url=\"#x\"/>")),
      StartsWith("a.dae: assimp leaves out geometry: Unable to find geometry for ID \"x\""));
  EXPECT_THAT(complaint("a.dae", collada("<instance_geometry url=\"other.dae#g\"/>")),
              StartsWith("a.dae: cannot be read by assimp: "));
  EXPECT_EQ(complaint("a.dae", collada("", "",
                                       "<library_geometries><geometry id=\"g\"/>"
                                       "</library_geometries>")),
            "a.dae:3: two elements <geometry> have the id \"g\", so assimp drops one; give each an "
            "id of its own");
}

TEST_F(MeshContent, ColladaCountsAndUrls) {
  EXPECT_EQ(complaint("a.dae", collada("<instance_node/>")),
            "a.dae:8: <instance_node> has no url; add it, or remove the element");
  std::string longer = collada();
  longer.replace(longer.find("0 2 0<"), 6, "0 2 0 7<");
  EXPECT_EQ(complaint("a.dae", longer),
            "a.dae:3: <float_array> has 10 numbers, and the count is \"9\"; correct one of them");
}

/// Programs write such numbers for 0. An exponent makes lost decimals large.
TEST_F(MeshContent, ColladaDecimalsAfterThe15th) {
  const auto moved = [](const std::string& transform) {
    return collada("<node>" + transform + "<instance_geometry url=\"#g\"/></node>");
  };
  EXPECT_EQ(complaint("a.dae", moved("<translate>0.000000000000000055 0 -2.2e-16</translate>")),
            "no complaint");
  EXPECT_EQ(complaint("a.dae", moved("<translate>0.0000000000000001e17 0 0</translate>")),
            "a.dae:8: <translate> has \"0.0000000000000001e17\", which assimp misreads; write "
            "decimal numbers with at most 15 digits");
  // The numbers of a scale multiply others, so they may lose nothing.
  EXPECT_THAT(complaint("a.dae", moved("<scale>0.0000000000000011 1 1</scale>")),
              StartsWith("a.dae:8: <scale> has \"0.0000000000000011\", which assimp misreads"));
}

TEST_F(MeshContent, ColladaUnitsOfOtherNames) {
  const auto unit = [](const std::string& name, const std::string& metres) {
    std::string file = collada();
    return file.replace(file.find("<asset/>"), 8,
                        "<asset><unit name=\"" + name + "\" meter=\"" + metres + "\"/></asset>");
  };
  EXPECT_THAT(notesOf("a.dae", unit("centimeter", "0.01")), IsEmpty());
  EXPECT_THAT(notesOf("a.dae", unit("mesh unit", "0.5")), IsEmpty());
  std::string none = unit("mm", "1");
  none.erase(none.find(" meter="), 10);
  EXPECT_THAT(notesOf("a.dae", none),
              ElementsAre("<unit name=\"mm\"> has no meter, so a unit of 1 m is used"));
  EXPECT_THAT(
      notesOf("a.dae", unit("centimeter", "1")),
      ElementsAre("<unit name=\"centimeter\"> has the meter of another unit, which is used"));
}

/// assimp takes the last of two nodes with one id, and a node's name before another one's id.
TEST_F(MeshContent, ColladaIdsAndNamesOfNodes) {
  EXPECT_EQ(
      complaint("a.dae", collada("<node id=\"a\"/><node id=\"a\"/>")),
      "a.dae:8: two elements <node> have the id \"a\", so assimp drops one; give each an id of "
      "its own");
  const std::string instance = "<instance_node url=\"#a\"/>";
  EXPECT_EQ(complaint("a.dae", collada("<node id=\"a\" name=\"a\"/><node>" + instance + "</node>")),
            "no complaint");
  EXPECT_EQ(complaint("a.dae", collada("<node id=\"b\" name=\"a\"/><node id=\"a\"/><node>" +
                                       instance + "</node>")),
            "a.dae:8: the name of this <node> is the id that an <instance_node> asks for; give the "
            "node another name");
}

TEST_F(MeshContent, LinesAreNoted) {
  EXPECT_THAT(notesOf("a.dae", collada()), IsEmpty());
  EXPECT_THAT(notesOf("a.dae", collada("",
                                       "<lines count=\"1\"><input semantic=\"VERTEX\" "
                                       "source=\"#v\" offset=\"0\"/><p>0 1</p></lines>")),
              ElementsAre(linesNote));
}

}  // namespace
}  // namespace corridor::test::mesh_content
