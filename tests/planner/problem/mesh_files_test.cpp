// Files that mesh files name, and notes on mesh files, in problems.
#include "planner/problem/digest.h"
#include "planner/robot/note.h"
#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

const std::string lines = "lines and points have no volume, and are not read: ";

class MeshFiles : public ProblemTest {
 protected:
  /// Writes a glTF file of a triangle, and its buffer `NAME.bin`, with the first corner at (x, 0,
  /// 0).
  void writeGltf(const std::string& name, float x) const {
    const float numbers[9] = {x, 0, 0, 1, 0, 0, 0, 2, 0};
    write(name + ".bin", {reinterpret_cast<const char*>(numbers), sizeof numbers});
    write(name + ".gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"buffers": [{"uri": ")" + name +
                              R"(.bin", "byteLength": 36}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
  }
  static std::string problem(const std::string& mesh) {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld: {rock: {mesh: " + mesh +
           ", at: [50, 0, 0]}}\n" + poses;
  }
  /// Writes a URDF with this mesh. Returns a problem with this robot.
  std::string problemOfUrdf(const std::string& mesh) const {
    write("r.urdf",
          "<robot name=\"r\"><link name=\"base\"/><link name=\"l\"><collision><geometry><mesh "
          "filename=\"" +
              mesh +
              "\"/></geometry></collision></link><joint name=\"j\" "
              "type=\"prismatic\"><parent link=\"base\"/><child link=\"l\"/><axis xyz=\"1 0 0\"/>"
              "<limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"1\"/></joint></robot>");
    return "format: corridor-problem-1\nrobot: r.urdf\nworld: {rock: {box: [1, 1, 1], at: [50, 0, "
           "0]}}\nstart: {j: 0}\ngoal: {j: 1}\n";
  }
  Problem readCfg(const std::string& mesh) const {
    write("problem.cfg",
          "[problem]\nname=p\nrobot=" + mesh + "\nworld=" + mesh +
              "\nstart.x=0\nstart.y=0\nstart.z=9\n"
              "start.theta=0\nstart.axis.x=1\nstart.axis.y=0\nstart.axis.z=0\ngoal.x=1\n"
              "goal.y=0\ngoal.z=9\ngoal.theta=0\ngoal.axis.x=1\ngoal.axis.y=0\ngoal.axis.z=0\n"
              "volume.min.x=-20\nvolume.min.y=-20\nvolume.min.z=-20\nvolume.max.x=20\n"
              "volume.max.y=20\nvolume.max.z=20\n");
    return readProblem(folder_ / "problem.cfg");
  }
  /// Expects that the digest of the problem covers the buffer of `name`.gltf.
  void expectCovered(const std::string& name) const {
    const Problem p = readProblem(folder_ / "problem.yaml");
    EXPECT_THAT(p.source.files, testing::Contains(folder_ / (name + ".bin")));
    const std::string digest = digestOf(p);
    writeGltf(name, 0.25);
    EXPECT_NE(digestOf(readProblem(folder_ / "problem.yaml")), digest);
  }
};

TEST_F(MeshFiles, TheDigestCoversBuffersOfTheWorld) {
  writeGltf("m", 0);
  write("problem.yaml", problem("m.gltf"));
  expectCovered("m");
}

TEST_F(MeshFiles, TheDigestCoversBuffersOfURDFs) {
  writeGltf("m", 0);
  write("problem.yaml", problemOfUrdf("m.gltf"));
  expectCovered("m");
}

TEST_F(MeshFiles, TheDigestCoversBuffersOfOmplApp) {
  writeGltf("m", 0);
  EXPECT_THAT(readCfg("m.gltf").source.files, testing::Contains(folder_ / "m.bin"));
}

TEST_F(MeshFiles, TheDigestCoversNoMaterials) {
  write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nusemtl red\nf 1 2 3\n");
  write("m.mtl", "newmtl red\n");
  EXPECT_THAT(readCfg("m.obj").source.files,
              testing::ElementsAre(folder_ / "problem.cfg", folder_ / "m.obj"));
}

TEST_F(MeshFiles, LinesAreNotedInProblemsOfOmplApp) {
  write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\nl 1 2\n");
  EXPECT_THAT(textsOf(readCfg("m.obj").source.notes),
              testing::Contains(lines + (folder_ / "m.obj").string()));
}

TEST_F(MeshFiles, LinesAreNotedOnceForAllFiles) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\nl 1 2\n";
  write("a.obj", triangle);
  write("b.obj", triangle);
  const Problem p = read(
      "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n"
      "  one: {mesh: a.obj, at: [50, 0, 0]}\n"
      "  two: {mesh: b.obj, at: [60, 0, 0]}\n"
      "  more: {mesh: a.obj, at: [70, 0, 0]}\n"
      "" +
      poses);
  EXPECT_THAT(textsOf(p.source.notes), testing::Contains(lines + (folder_ / "a.obj").string() +
                                                         ", " + (folder_ / "b.obj").string()));
}

/// A format's up-axis that is not z is not applied; a note says so, unless `up` decides.
TEST_F(MeshFiles, UpAxesOfTheWorld) {
  writeGltf("m", 0);
  const auto notesOf = [&](const std::string& keys) {
    return textsOf(read("format: corridor-problem-1\nrobot: robot.yaml\nworld: {rock: {" + keys +
                        ", at: [50, 0, 0]}}\n" + poses)
                       .source.notes);
  };
  const std::string note =
      "the up-axis of the file is not z; it is not applied (ROS's rule), and up: y applies it: " +
      (folder_ / "m.gltf").string();
  EXPECT_THAT(notesOf("mesh: m.gltf"), testing::Contains(note));
  EXPECT_THAT(notesOf("convex: m.gltf"), testing::Contains(note));
  const auto hull = testing::Contains(testing::StartsWith("the hull is that of the corners of"));
  EXPECT_THAT(notesOf("convex: m.gltf"), hull);
  EXPECT_THAT(notesOf("mesh: m.gltf"), testing::Not(hull));
  EXPECT_THAT(notesOf("convex: wedge.obj"), testing::Not(hull));
  write("b.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
        R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAIBAAEDAQIDAAMC"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
{"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}]})");
  EXPECT_THAT(notesOf("mesh: b.gltf, convex: true, deviation: 9"),
              testing::Contains(testing::HasSubstr("up: y applies it: ")));
  for (const std::string up : {"y", "z"})
    EXPECT_THAT(notesOf("mesh: m.gltf, up: " + up),
                testing::Not(testing::Contains(testing::HasSubstr("up-axis"))));
}

TEST_F(MeshFiles, UpAxesOfURDFs) {
  writeGltf("m", 0);
  const Problem p = read(problemOfUrdf("m.gltf"));
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains((folder_ / "r.urdf").string() +
                                ": the up-axis of m.gltf is not z; it is not applied (ROS's rule), "
                                "and a rotation in <origin> applies it"));
}

}  // namespace
}  // namespace corridor::test
