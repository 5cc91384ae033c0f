// What OBJ, PLY and OFF files hold beyond the triangles that are read.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(MeshContent, ObjKeywords) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  for (const std::string line :
       {"fo 1 2 3", "F 1 2 3", "V 1 2 3", "surf 0 1 0 1 1 2 3", "curv 0 1 1 2", "call other.obj",
        "bzp 1 2 3 4", "csh -x", "hello"}) {
    const std::string keyword = line.substr(0, line.find(' '));
    EXPECT_EQ(complaint("a.obj", triangle + line + "\n"),
              "a.obj:5: the keyword \"" + keyword +
                  "\" is not supported, and may be or move geometry; write faces with v and f");
  }
  EXPECT_THAT(notesOf("a.obj", triangle + "vn 0 0 1\nvt 0 0\nvp 0\ng a\no b\ns 1\nmg 0\nusemtl m\n"
                                          "mtllib none.mtl\nlod 1\ntrace_obj x\n # f 9\n\n"),
              IsEmpty());
  EXPECT_THAT(notesOf("a.obj", triangle + "l 1 2\nl 2 3\n"), ElementsAre(linesNote));
  EXPECT_THAT(notesOf("a.obj", triangle + "p 1\n"), ElementsAre(linesNote));
}

TEST_F(MeshContent, ObjLinesThatGoOn) {
  const std::string text =
      "# c \\\nv 0 0 0 \\\n1.0\nv 1 0 0\nv 0 2 0\nvn 0 0 \\\n1\ng a \\\n b\nl 1 \\\n2\nf 1 2 "
      "\\\n3\n";
  EXPECT_EQ(read("a.obj", text).mesh.triangles.size(), 1u);
}

/// A backslash continues a line only at its end (Wavefront's format, "Line continuation").
TEST_F(MeshContent, ObjBackslashesWithinALine) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n";
  const auto fault = [&](const std::string& text) { return complaint("a.obj", head + text); };
  const std::string why = "a backslash continues a line only at its end; something follows it";
  for (const std::string text : {"f 1 2 3 \\ 4\n\n", "f 1 2 3 \\ 4\n# c\n", "f 1 2 3\\ 4\n",
                                 "f 1 2 \\ 3\n3\n", "f 1 2 3 \\ \\\n\n"})
    EXPECT_THAT(fault(text), testing::StartsWith("a.obj:5: " + why)) << text;
  EXPECT_THAT(fault("v 0 0 \\ 7\n9\nf 1 2 3\n"), HasSubstr(why));
  EXPECT_EQ(fault("f 1 2 \\ \n3\n"), "no complaint") << "blanks may follow";
  // A name that ends in a backslash takes the next line with it.
  EXPECT_THAT(notesOf("a.obj", head + "f 1 2 3\nusemtl C:\\dir\\\nf 1 3 4\n"),
              ElementsAre("line 7, which begins with f, continues the line above, which ends in a "
                          "backslash"));
}

std::string ply(const std::string& element, const std::string& property, const std::string& list) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\n" +
         list + (element.empty() ? "" : "element " + element + " 1\nproperty " + property + "\n") +
         "end_header\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n" + (list.empty() ? "" : "1 7\n") +
         (element.empty() ? "" : "1 7\n");
}

TEST_F(MeshContent, PlyElementsThatMayHoldTriangles) {
  const std::string list = "list uchar int numbers";
  for (const auto& [element, property] : {std::pair<std::string, std::string>{"polygon", list},
                                          {"Triangles", list},
                                          {"faces", list},
                                          {"tristrips", list},
                                          {"patch", list},
                                          {"edge", "list uchar int vertex_index"}})
    EXPECT_EQ(complaint("a.ply", ply(element, property, "")),
              "a.ply: element \"" + element +
                  "\" is not read, and may hold triangles; save the mesh with polygons only");
  for (const auto& [element, property] : {std::pair<std::string, std::string>{"edge", list},
                                          {"material", list},
                                          {"camera", list},
                                          {"pose", "int a\nproperty int b"}})
    EXPECT_EQ(complaint("a.ply", ply(element, property, "")), "no complaint") << element;
  EXPECT_THAT(notesOf("a.ply", ply("pose", "int a\nproperty int b", "")),
              ElementsAre("the element \"pose\" is not read"));
  EXPECT_THAT(complaint("a.ply", ply("quads", "int a\nproperty int b", "")),
              HasSubstr("may hold triangles"));
}

TEST_F(MeshContent, PlyListsOfFaces) {
  EXPECT_THAT(notesOf("a.ply", ply("", "", "property list uchar int holes\n")),
              ElementsAre("the list \"holes\" of faces is not read"));
  for (const std::string name : {"texcoord", "flags", "red"})
    EXPECT_THAT(notesOf("a.ply", ply("", "", "property list uchar int " + name + "\n")), IsEmpty());
}

TEST_F(MeshContent, OffFacesOfTwoCorners) {
  const std::string points = "0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n";
  EXPECT_THAT(notesOf("a.off", "OFF 3 1 0\n" + points), IsEmpty());
  EXPECT_THAT(notesOf("a.off", "OFF 3 2 0\n" + points + "2 0 1\n"), ElementsAre(linesNote));
  EXPECT_THAT(notesOf("a.off", "OFF 3 2 0\n" + points + "1 0\n"), ElementsAre(linesNote));
}

TEST_F(MeshContent, PlyStrips) {
  const auto ply = [](const std::string& count) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
           "element tristrips " +
           count +
           "\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n" +
           (count == "0" ? "" : "3 0 1 2\n");
  };
  EXPECT_EQ(complaint("a.ply", ply("1")),
            "a.ply: element \"tristrips\" is not read, and may hold triangles; save the mesh with "
            "polygons only");
  EXPECT_EQ(complaint("a.ply", ply("0")), "no complaint");
}

}  // namespace
}  // namespace corridor::test::mesh_content
