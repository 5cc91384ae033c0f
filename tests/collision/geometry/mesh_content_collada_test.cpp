// What Collada files hold beyond the triangles that are read.
#include <gmock/gmock.h>

#include "tests/collision/geometry/collada_fixture.h"
#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class ColladaContent : public MeshContent {
 protected:
  /// Returns the complaint on the file with another text in one of its places.
  std::string with(std::string ColladaParts::*place, const std::string& text) {
    ColladaParts parts;
    parts.*place = text;
    return complaint("a.dae", colladaOf(parts));
  }
  std::vector<std::string> notesWith(std::string ColladaParts::*place, const std::string& text) {
    ColladaParts parts;
    parts.*place = text;
    return notesOf("a.dae", colladaOf(parts));
  }
};

const std::string vertexInput = R"(<input semantic="VERTEX" source="#v" offset="0"/>)";
const std::string threeFaces = ColladaParts().faces;

TEST_F(ColladaContent, UnknownElements) {
  EXPECT_EQ(with(&ColladaParts::node, ""), "no complaint");
  for (const std::string name :
       {"instance_controller", "skew", "lookat", "Node", "translation", "Translate", "Extra"}) {
    const std::string element = "<" + name + ">5 0 0</" + name + ">";
    EXPECT_EQ(with(&ColladaParts::node, element), "a.dae:4: " + notIn("node", name));
    EXPECT_EQ(with(&ColladaParts::faces, threeFaces + element), "a.dae:3: " + notIn("mesh", name));
    std::string faces = threeFaces;
    faces.insert(faces.find("<p>"), element);
    EXPECT_EQ(with(&ColladaParts::faces, faces), "a.dae:3: " + notIn("triangles", name));
  }
  EXPECT_EQ(with(&ColladaParts::faces,
                 "<polygons count=\"1\">" + vertexInput + "<ph><p>0 1 2</p></ph></polygons>"),
            "a.dae:3: " + notIn("polygons", "ph"));
  for (const std::string name : {"convex_mesh", "brep"})
    EXPECT_EQ(with(&ColladaParts::inGeometry, "<" + name + "/>"),
              "a.dae:2: " + notIn("geometry", name));
  EXPECT_EQ(with(&ColladaParts::node, "<!-- <skew> -->"), "no complaint");
  EXPECT_EQ(with(&ColladaParts::node,
                 "<extra><technique profile='x'><Node ID='a'><translation>1 2 3</translation>"
                 "</Node></technique></extra>"),
            "no complaint");
  EXPECT_EQ(with(&ColladaParts::node, "5 0 0"),
            "a.dae:4: <node> has the text \"5 0 0\"; remove it");
}

TEST_F(ColladaContent, NamesWithAPrefix) {
  for (const std::string name : {"c:translate", "c:node"})
    EXPECT_EQ(with(&ColladaParts::node, "<" + name + ">5 0 0</" + name + ">"),
              "a.dae:4: <" + name +
                  "> has a namespace prefix, with which it is not read; remove the prefix");
  for (const std::string name : {"c:asset", "c:scene"})
    EXPECT_EQ(with(&ColladaParts::libraries, "<" + name + "/>"),
              "a.dae:1: <" + name + "> is not known in <COLLADA>; correct its name, or remove it");
}

TEST_F(ColladaContent, AssetsWithAPrefix) {
  EXPECT_EQ(with(&ColladaParts::asset, "<c:unit meter=\"0.001\"/>"),
            "a.dae:1: <c:unit> is not read; write <unit>");
  EXPECT_EQ(with(&ColladaParts::asset, "<c:Up_Axis>Z_UP</c:Up_Axis>"),
            "a.dae:1: <c:Up_Axis> is not read; write <up_axis>");
}

TEST_F(ColladaContent, OtherNamespaces) {
  EXPECT_EQ(with(&ColladaParts::node, "<translate xmlns=\"urn:other\">1 2 3</translate>"),
            "a.dae:4: <translate> is of another namespace than the file, \"urn:other\", which is "
            "not read; remove it");
  EXPECT_EQ(with(&ColladaParts::node,
                 "<translate xmlns=\"http://www.collada.org/2005/11/COLLADASchema\">1 2 3"
                 "</translate>"),
            "no complaint");
  EXPECT_THAT(notesWith(&ColladaParts::asset, "<units meter=\"0.001\"/>"),
              ElementsAre("<units> of <asset> is not read"));
}

TEST_F(ColladaContent, VersionsAndBases) {
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = colladaOf({});
    return complaint("a.dae", text.replace(text.find(from), from.size(), to));
  };
  for (const std::string version : {"1.4.0", "1.5.0", "1.4"})
    EXPECT_EQ(changed("1.4.1", version), "no complaint");
  for (const std::string version : {"1.3.1", "2.0", ""})
    EXPECT_EQ(
        changed("1.4.1", version),
        "a.dae:1: Collada " + version + " is not supported; save the mesh as Collada 1.4 or 1.5");
  EXPECT_EQ(changed("version", "xml:base=\"b.dae\" version"),
            "a.dae:1: xml:base is not read; remove it");
  EXPECT_EQ(changed("<node", "<node xml:base=\"b.dae\""),
            "a.dae:4: xml:base is not read; remove it");
}

/// It may move nodes.
TEST_F(ColladaContent, KinematicsScenesThatBindJoints) {
  std::string text = colladaOf({});
  text.insert(text.find("</scene>"),
              "<instance_kinematics_scene><bind_joint_axis target=\"n/a\"/>"
              "</instance_kinematics_scene>");
  EXPECT_EQ(complaint("a.dae", text),
            "a.dae:5: the kinematics scene sets joints, which may move nodes and is not "
            "supported; save the mesh in its pose");
}

/// TinyXML2 cuts a text at some of them.
TEST_F(ColladaContent, ReferencesToNoCharacter) {
  for (const std::string text : {"&#;", "&#x;", "&#0;", "&#x0;", "&#x110000;", "&#x100000000;",
                                 "&#4294967344;", "&#x7fffffff;", "&#4 ;", "&#48"})
    EXPECT_THAT(with(&ColladaParts::node, "<translate>1 2 3" + text + "</translate>"),
                testing::HasSubstr("to no character; correct it"))
        << text;
  EXPECT_EQ(with(&ColladaParts::node, "<translate>1 2 &#51;&#x35;</translate>"), "no complaint");
}

TEST_F(ColladaContent, OtherScenes) {
  const auto notes = [&](const std::string& inside) {
    return notesWith(&ColladaParts::libraries, "<library_visual_scenes><visual_scene id=\"t\">" +
                                                   inside +
                                                   "</visual_scene></library_visual_scenes>");
  };
  EXPECT_THAT(notes(""), IsEmpty());
  const std::string rest = " is not the one that <scene> names and not read";
  EXPECT_THAT(notes("<node id=\"m\"><instance_geometry url=\"#g\"/></node>"),
              ElementsAre("the visual scene \"t\"" + rest));
  EXPECT_THAT(notesWith(&ColladaParts::libraries,
                        "<library_visual_scenes><visual_scene><node/></visual_scene>"
                        "</library_visual_scenes>"),
              ElementsAre("the visual scene" + rest));
}

/// A mesh of one point is legal; a transform that makes it one is not.
TEST_F(ColladaContent, MeshesOfOnePoint) {
  EXPECT_EQ(with(&ColladaParts::array, "count=\"9\">1 1 1 1 1 1 1 1 1"), "no complaint");
  EXPECT_EQ(
      with(&ColladaParts::node, "<scale>0 0 0</scale>"),
      "a.dae: the transforms of its nodes shrink a mesh to nothing, or stretch it beyond 1e250");
}

TEST_F(ColladaContent, Declarations) {
  const std::string file = colladaOf({});
  for (const std::string declaration :
       {"[<!ENTITY a \"<!--\">]", "SYSTEM \"a>b\" [<!ATTLIST unit meter CDATA \"0.01\">]", "<?x >",
        "SYSTEM 'x' <!-- > -->"})
    EXPECT_THAT(complaint("a.dae", "<!DOCTYPE COLLADA " + declaration + ">" + file),
                StartsWith("a.dae:1: a DOCTYPE with declarations is not read; save the file "
                           "without it"))
        << declaration;
  EXPECT_THAT(
      complaint("a.dae",
                "<!DOCTYPE COLLADA PUBLIC \"it's\" 'x><COLLADA>decoy</COLLADA><!--'>" + file),
      StartsWith("a.dae:1: is no complete XML"));
  EXPECT_EQ(complaint("a.dae", "<!DOCTYPE COLLADA SYSTEM \"it's a.dtd\">" + file), "no complaint");
}

TEST_F(ColladaContent, References) {
  const std::string missing =
      ", which is not in this file; correct it, or save the mesh as one file";
  for (const std::string name : {"instance_node", "instance_geometry"}) {
    for (const std::string url : {"other.dae#g", "#x", "g"})
      EXPECT_EQ(with(&ColladaParts::node, "<" + name + " url=\"" + url + "\"/>"),
                "a.dae:4: <" + name + "> refers to \"" + url + "\"" + missing);
    EXPECT_EQ(with(&ColladaParts::node, "<" + name + "/>"),
              "a.dae:4: <" + name + "> has no url; add it, or remove the element");
  }
}

/// TinyXML2 drops the blank between two comments, and ends a text at the character 0.
TEST_F(ColladaContent, TextsThatTheParserWouldChange) {
  const auto polygon = [&](const std::string& indices) {
    return with(&ColladaParts::faces,
                "<polygons count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>" +
                    indices + "</p></polygons>");
  };
  for (const std::string indices : {"0 1<!-- a --> <!-- b -->2", "0 1 <![CDATA[2]]> <![CDATA[2]]>"})
    EXPECT_THAT(polygon(indices), testing::StartsWith("a.dae:3: comments or CDATA are within"));
  EXPECT_EQ(polygon("<!-- a --> <!-- b -->0 1<!-- c --> 2"), "no complaint");
  EXPECT_EQ(polygon("0 1 2&#x00; 2"),
            "a.dae: has a reference \"&#x00;\" to no character; correct it");
  EXPECT_EQ(polygon("0&#09;1 2"), "no complaint");
  EXPECT_EQ(with(&ColladaParts::node, "<rotate>0 0 1 36000000000000090</rotate>"),
            "a.dae:4: the angle of <rotate> is beyond 1e6 degrees; write it within 360");
}

TEST_F(ColladaContent, ElementsThatAreThereTwice) {
  EXPECT_EQ(
      with(&ColladaParts::inLibrary, "<geometry id=\"g\"/>"),
      "a.dae:4: two elements have the id \"g\", to which this element refers; give each an id "
      "of its own");
  EXPECT_EQ(with(&ColladaParts::node, "<node id=\"a\"/><node id=\"a\"/>"), "no complaint")
      << "nothing refers to them";
  EXPECT_EQ(
      with(&ColladaParts::node, "<node id=\"a\"/><node id=\"a\"/><instance_node url=\"#a\"/>"),
      "a.dae:4: two elements have the id \"a\", to which this element refers; give each an id "
      "of its own");
  EXPECT_EQ(with(&ColladaParts::inGeometry, "<mesh/>"),
            "a.dae:2: a second <mesh> is in one <geometry>");
  const std::string second = "<float_array id='pb' count='9'>9 0 0 1 0 0 0 2 0</float_array>";
  EXPECT_EQ(with(&ColladaParts::inSource, second), "no complaint") << "it has another id";
  EXPECT_EQ(with(&ColladaParts::inSource, "<float_array id='pa' count='0'/>"),
            "a.dae:2: two elements <float_array> of one <source> have the id \"pa\"; give each an "
            "id of its own");
  EXPECT_THAT(with(&ColladaParts::asset, "<unit meter='0.001' meter='1'/>"),
              StartsWith("a.dae:1: "));
}

TEST_F(ColladaContent, Roots) {
  const std::string file = colladaOf({}) + "\n";
  EXPECT_EQ(complaint("a.dae", "<?xml version='1.0'?>" + file + "<!-- c -->"), "no complaint");
  const std::string more = "something comes before or after the root element";
  EXPECT_EQ(complaint("a.dae", file + file), "a.dae:6: " + more);
  EXPECT_EQ(complaint("a.dae", file + "<x/>"), "a.dae:6: " + more);
  EXPECT_EQ(complaint("a.dae", "<x/>\n" + file), "a.dae:2: " + more);
  EXPECT_EQ(complaint("a.dae", "<x/>"), "a.dae:1: the root element must be <COLLADA>, not <x>");
}

/// Nodes of other scenes, and nodes around those that are instanced, count, too.
TEST_F(ColladaContent, AssetsAroundInstancedNodes) {
  const std::string mm = "<asset><unit meter=\"0.001\"/></asset>";
  const std::string inner = "<node id=\"i\"><instance_geometry url=\"#g\"/></node>";
  ColladaParts parts;
  parts.node = "<instance_node url=\"#i\"/>";
  for (const std::string& library :
       {"<library_nodes><node id=\"o\">" + mm + inner + "</node></library_nodes>",
        "<library_visual_scenes><visual_scene id=\"t\">" + mm + inner +
            "</visual_scene></library_visual_scenes>"}) {
    parts.libraries = library;
    EXPECT_THAT(complaint("a.dae", colladaOf(parts)),
                testing::HasSubstr("this <asset> has another unit or up-axis"));
  }
}

TEST_F(ColladaContent, AssetsWithin) {
  const auto fault = [&](const std::string& outer, const std::string& inner,
                         std::string ColladaParts::*place) {
    ColladaParts parts;
    parts.asset = outer;
    parts.*place = "<asset>" + inner + "</asset>";
    const std::string text = complaint("a.dae", colladaOf(parts));
    const auto colon = text.find(": ");
    return colon == text.npos ? text : text.substr(colon + 2);
  };
  const std::string other =
      "this <asset> has another unit or up-axis than the document's, which is not supported; save "
      "the mesh with one unit and one up-axis";
  const std::string mm = R"(<unit name="mm" meter="0.001"/>)", z = "<up_axis>Z_UP</up_axis>";
  for (const auto place : {&ColladaParts::inLibrary, &ColladaParts::inGeometry,
                           &ColladaParts::inScene, &ColladaParts::node, &ColladaParts::inSource}) {
    EXPECT_EQ(fault("", mm, place), other);
    EXPECT_EQ(fault(mm, "<unit/>", place), other) << "1 m by the specification";
    EXPECT_EQ(fault("", z, place), other);
    EXPECT_EQ(fault(mm + z, "<unit meter=\"1e-3\"></unit><up_axis> Z_UP </up_axis>", place),
              "no complaint");
    EXPECT_EQ(fault(mm + z, "<created>2020</created>", place), "no complaint");
  }
}

TEST_F(ColladaContent, UnitsOfOtherNames) {
  const auto notes = [&](const std::string& attributes) {
    return notesWith(&ColladaParts::asset, "<unit " + attributes + "/>");
  };
  EXPECT_THAT(notes(R"(name="centimeter" meter="0.01")"), IsEmpty());
  EXPECT_THAT(notes(R"(name="mesh unit" meter="0.5")"), IsEmpty());
  EXPECT_THAT(notes(R"(name="mm")"),
              ElementsAre("<unit name=\"mm\"> has no meter, so a unit of 1 m is used"));
  EXPECT_THAT(
      notes(R"(name="centimeter" meter="1")"),
      ElementsAre("<unit name=\"centimeter\"> has the meter of another unit, which is used"));
}

TEST_F(ColladaContent, Notes) {
  EXPECT_THAT(notesWith(&ColladaParts::node, ""), IsEmpty());
  EXPECT_THAT(notesWith(&ColladaParts::faces,
                        threeFaces + "<lines count=\"1\">" + vertexInput + "<p>0 1</p></lines>"),
              ElementsAre(linesNote));
  const std::string unplaced = " is in no node of the scene and not read";
  EXPECT_THAT(notesWith(&ColladaParts::inLibrary, "<geometry id=\"h\"><mesh/></geometry>"),
              ElementsAre("the geometry \"h\"" + unplaced));
  EXPECT_THAT(notesWith(&ColladaParts::inLibrary, "<geometry><mesh/></geometry>"),
              ElementsAre("the geometry" + unplaced));
  EXPECT_THAT(
      notesWith(
          &ColladaParts::libraries,
          "<library_nodes><node id=\"n\"><instance_geometry url=\"#g\"/></node></library_nodes>"),
      ElementsAre("the node \"n\" of <library_nodes>" + unplaced));
  EXPECT_THAT(notesWith(&ColladaParts::node, "<node my:scale=\"2\" xml:lang=\"en\"/>"),
              ElementsAre("the attribute \"my:scale\" of <node> is not read"));
  const std::string physics =
      "<library_physics_models><physics_model id='p'><rigid_body sid='r'><technique_common><shape>"
      "<box><half_extents>1 1 1</half_extents></box></shape></technique_common></rigid_body>"
      "</physics_model></library_physics_models>";
  EXPECT_THAT(notesWith(&ColladaParts::libraries, physics),
              ElementsAre("the shapes of physics models are not read"));
  EXPECT_THAT(notesWith(&ColladaParts::node, "<node colour=\"red\"/>"),
              ElementsAre("the attribute \"colour\" of <node> is not read"));
  EXPECT_EQ(with(&ColladaParts::node, "<node Id=\"a\"/>"),
            "a.dae:4: the attribute \"Id\" of <node> is not read; write \"id\"");
}

TEST_F(ColladaContent, ManyNotes) {
  std::string attributes;
  for (int i = 0; i < 90; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  const std::string first = "<node" + attributes + "/>";
  EXPECT_EQ(notesWith(&ColladaParts::node, first).size(), 90u);
  for (char& c : attributes) c = c == 'a' ? 'b' : c;
  const auto notes = notesWith(&ColladaParts::node, first + "<node" + attributes + "/>");
  ASSERT_EQ(notes.size(), 101u);
  EXPECT_EQ(notes[99], "the attribute \"b9\" of <node> is not read");
  EXPECT_EQ(notes[100], "more is not read than these notes say");
}

/// What other elements than meshes have is not checked.
TEST_F(ColladaContent, ArraysOutsideOfMeshes) {
  const std::string source = "<source id=\"i\"><float_array count=\"1\">x</float_array></source>";
  EXPECT_EQ(with(&ColladaParts::libraries, "<library_animations><animation id=\"n\">" + source +
                                               source + "</animation></library_animations>"),
            "no complaint");
}

TEST_F(ColladaContent, Accessors) {
  const auto named = [](const std::string& names) {
    std::string params;
    for (const char name : names)
      params += "<param " +
                (name == ' ' ? std::string() : "name=\"" + std::string(1, name) + "\" ") +
                "type=\"float\"/>";
    return params;
  };
  EXPECT_EQ(with(&ColladaParts::params, named("XYZ")), "no complaint");
  for (const std::string names : {"", "xyz", "XY", "ZYX", "XYZZ", " XYZ", "STP"})
    EXPECT_EQ(with(&ColladaParts::params, named(names)),
              "a.dae:2: the <accessor> of positions needs <param>s of the names X, Y and Z in this "
              "order, and no others")
        << names;
  const auto fault = [&](const std::string& text) { return with(&ColladaParts::accessor, text); };
  for (const std::string stride : {"", "stride=\"2\"", "stride=\"0\""})
    EXPECT_EQ(fault("count=\"3\" " + stride),
              "a.dae:2: the <accessor> of positions needs a stride of 3 or more")
        << stride;
  for (const std::string text :
       {R"(count="4" stride="3")", R"(count="3" stride="4")", R"(count="3" stride="3" offset="1")",
        R"(count="3" stride="3" offset="10")", R"(count="2147483647" stride="2147483647")"})
    EXPECT_EQ(fault(text),
              "a.dae:2: the <accessor> of positions reads beyond the end of its <float_array>; "
              "correct its count, stride or offset")
        << text;
  for (const std::string text :
       {R"(count="3" stride="")", R"(count="3" stride="3x")", R"(count="-1" stride="3")",
        "stride=\"3\"", R"(count="3" stride="3" offset="-1")", R"(count="3 3" stride="3")"})
    EXPECT_THAT(fault(text), HasSubstr("a.dae:2: <accessor> ")) << text;
  EXPECT_EQ(with(&ColladaParts::array, "count=\"9\">0 0 0 1 0 0 0 2 0 7"),
            "a.dae:2: <float_array> has 10 numbers, and the count is \"9\"; correct one of them");
}

TEST_F(ColladaContent, Positions) {
  const auto inputs = [&](const std::string& text) { return with(&ColladaParts::inputs, text); };
  const std::string one = R"(<input semantic="POSITION" source="#p"/>)";
  EXPECT_EQ(inputs(one + one), "a.dae:3: <vertices> have a second <input> of semantic POSITION");
  EXPECT_EQ(inputs(R"(<input semantic="position" source="#p"/>)"),
            "a.dae:3: <vertices> have no <input> of semantic POSITION");
  EXPECT_EQ(inputs(R"(<input semantic="POSITION" source="#q"/>)"),
            "a.dae:3: the source \"#q\" is no <source> of its <mesh>");
  std::string faces = threeFaces;
  EXPECT_EQ(with(&ColladaParts::faces,
                 faces.insert(faces.find("<p>"),
                              R"(<input semantic="POSITION" source="#p" offset="1"/>)")),
            "a.dae:3: an <input> of semantic POSITION is not in <vertices>");
  for (const std::string word :
       {"0.2d1", "2x", "0x2", "2.5.2", "2;4", "2,4", "2&amp;", "2-", "1e999"})
    EXPECT_EQ(with(&ColladaParts::array, "count=\"9\">0 0 0 1 0 0 0 " + word + " 0"),
              "a.dae:2: <float_array>: coordinate \"" +
                  (word == "2&amp;" ? std::string("2&") : word) +
                  (word == "1e999" ? "\" is too large for a double"
                                   : "\" is not a number; write decimal numbers such as -1.25e-3"));
  EXPECT_EQ(with(&ColladaParts::array, "count=\"9\">0 0 0 1 0 0 0 INF 0"),
            "a.dae:2: <float_array>: coordinate \"INF\" is not finite");
}

TEST_F(ColladaContent, Corners) {
  const auto fans = [&](const std::string& n, const std::string& p) {
    return with(&ColladaParts::faces, threeFaces + "<trifans count=\"" + n + "\">" + vertexInput +
                                          "<p>" + p + "</p></trifans>");
  };
  EXPECT_EQ(fans("1", "0 1 <!-- c --> 2"), "no complaint");
  for (const std::string word : {"-2", "2.5", "x", "2147483648", "4294967296"})
    EXPECT_EQ(fans("1", "0 1 " + word),
              "a.dae:3: <p>: \"" + word + "\" is no whole number from 0 to 2^31 - 1");
  EXPECT_EQ(fans("1", "0 1 3"), "a.dae:3: <p> names vertex 3 (from 0), and there are 3");
  for (const std::string n : {"0", "2"})
    EXPECT_EQ(fans(n, "0 1 2"),
              "a.dae:3: <trifans> has 1 <p>, and needs " + n + "; correct its count");
  for (const std::string n : {"", "-1", "one"})
    EXPECT_THAT(fans(n, "0 1 2"), EndsWith("<trifans> needs one whole number as its count")) << n;
  const auto polygons = [&](const std::string& count, const std::string& sizes,
                            const std::string& p = "0 1 2 0 2 1") {
    return with(&ColladaParts::faces, "<polylist count=\"" + count + "\">" + vertexInput +
                                          "<vcount>" + sizes + "</vcount><p>" + p +
                                          "</p></polylist>");
  };
  EXPECT_EQ(polygons("2", "3 3"), "no complaint");
  for (const std::string count : {"1", "3"})
    EXPECT_EQ(polygons(count, "3 3"), "a.dae:3: <vcount> has 2 numbers, and the count is " + count +
                                          "; correct one of them");
  EXPECT_EQ(polygons("2", "3 4"), "a.dae:3: <p> has 6 corners, and needs 7; correct the count");
  EXPECT_EQ(polygons("1", "3"), "a.dae:3: <p> has 6 corners, and needs 3; correct the count");
  EXPECT_THAT(polygons("2", "3 3.5"),
              StartsWith("a.dae:3: <vcount>: \"3.5\" is no whole number from 0 to 2^31 - 1"));
  std::string faces = threeFaces;
  faces.insert(faces.find("<p>"), R"(<input semantic="UV" source="#u" offset="1"/>)");
  EXPECT_EQ(with(&ColladaParts::faces, faces),
            "a.dae:3: <p> has 3 numbers, which is no multiple of its 2 offsets");
}

TEST_F(ColladaContent, Transforms) {
  const auto node = [&](const std::string& text) { return with(&ColladaParts::node, text); };
  EXPECT_EQ(node("<rotate>0 0 0 90</rotate>"), "a.dae:4: the axis of <rotate> is 0");
  EXPECT_EQ(node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2</matrix>"),
            "a.dae:4: the last row of a <matrix> is not 0 0 0 1, which is not supported");
  for (const auto& [name, size] : std::vector<std::pair<std::string, std::string>>{
           {"rotate", "4"}, {"translate", "3"}, {"scale", "3"}, {"matrix", "16"}})
    for (const std::string numbers : {"1", "1 2 x", "1,2,3", "1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8"})
      EXPECT_THAT(node("<" + name + ">" + numbers + "</" + name + ">"),
                  EndsWith("a.dae:4: <" + name + "> needs " + size + " decimal numbers"));
  for (const std::string number : {"1e251", "-1e-251"})
    EXPECT_THAT(node("<translate>" + number + " 0 0</translate>"),
                HasSubstr("is not 0 or from 1e-250 to 1e250"));
}

}  // namespace
}  // namespace corridor::test::mesh_content
