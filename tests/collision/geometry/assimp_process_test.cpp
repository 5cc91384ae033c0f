// Tests that the caller gets a mesh or an InputError, no matter how the process that runs assimp
// ends.
#include "collision/geometry/assimp_process.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <sstream>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Returns a Collada file with a grid of 2·n·n triangles.
std::string grid(int n) {
  std::ostringstream points, triangles;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) points << i << " " << j << " " << 0.1 * i << " ";
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int at = i * (n + 1) + j, above = at + n + 1;
      triangles << at << " " << above << " " << at + 1 << " " << above << " " << above + 1 << " "
                << at + 1 << " ";
    }
  const int count = (n + 1) * (n + 1);
  std::ostringstream text;
  text << "<?xml version=\"1.0\"?>\n<COLLADA "
          "xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
          "<asset><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh>\n"
          "<source id=\"p\"><float_array id=\"a\" count=\""
       << 3 * count << "\">" << points.str()
       << "</float_array><technique_common><accessor source=\"#a\" count=\"" << count
       << "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
          "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n"
          "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n"
          "<triangles count=\""
       << 2 * n * n << "\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>"
       << triangles.str()
       << "</p></triangles></mesh></geometry></library_geometries>\n<library_visual_scenes>"
          "<visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node>"
          "</visual_scene></library_visual_scenes>\n"
          "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";
  return text.str();
}

class AssimpProcess : public MeshFileTest {
 protected:
  /// Returns the message of the error that `readWithAssimp` throws if a shell script replaces the
  /// helper program.
  std::string complaintWith(const std::string& script, double seconds = 600) const {
    const auto program = write("helper", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return complaint({seconds, 1 << 30, program});
  }
  std::string complaint(const AssimpLimits& limits) const {
    try {
      readWithAssimp(file_, limits);
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.starts_with(file_ + ": ") ? text.substr(file_.size() + 2) : text;
    }
    return "no complaint";
  }

  const std::string file_ = write("a.dae", grid(2)).string();
};

const std::string reads = "assimp, which OMPL.app uses, ";
const std::string instead = "; save the mesh as OBJ, STL, PLY or OFF";

TEST_F(AssimpProcess, EndsWithoutAnAnswer) {
  EXPECT_EQ(complaintWith("kill -SEGV $$"),
            reads + "ended without an answer (killed by signal 11, Segmentation fault)" + instead);
  EXPECT_EQ(complaintWith("kill -ABRT $$"),
            reads + "ended without an answer (killed by signal 6, Aborted)" + instead);
  EXPECT_EQ(complaintWith("exit 9"),
            reads + "needs more than 1024 MiB of memory for this file" + instead);
  EXPECT_EQ(complaintWith("exit 3"), reads + "ended without an answer (exit status 3)" + instead);
  EXPECT_EQ(complaintWith("echo and this is no answer, long as it may be, of the program at all"),
            reads + "ended without an answer (exit status 0)" + instead);
}

TEST_F(AssimpProcess, TakesTooLong) {
  EXPECT_EQ(complaintWith("echo $$ >\"$1.id\"; exec sleep 1000", 2),
            reads + "took more than 2 s and was stopped" + instead);
  int id = 0;
  std::ifstream(file_ + ".id") >> id;
  ASSERT_GT(id, 0);
  EXPECT_EQ(::kill(id, 0), -1) << "the process still runs";
  // The time limit also ends a process that writes without end.
  EXPECT_EQ(complaintWith("while :; do echo y; done", 0.2),
            reads + "took more than 0.2 s and was stopped" + instead);
}

TEST_F(AssimpProcess, CannotBeStarted) {
  EXPECT_EQ(complaint({60, 1 << 30, ""}),
            "assimp is needed for OMPL.app's files, and its program corridor_assimp is not found; "
            "install it with the library, or save the mesh as OBJ, STL, PLY or OFF");
  EXPECT_EQ(complaint({60, 1 << 30, folder_ / "none"}),
            "assimp is needed for OMPL.app's files, and its program " +
                (folder_ / "none").string() + " cannot be run");
}

TEST_F(AssimpProcess, MemoryEnds) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer ends the process where memory ends";
#endif
  write("a.dae", grid(400));
  EXPECT_EQ(complaint({600, std::uint64_t{2} << 20, AssimpLimits::assimpProgram()}),
            reads + "needs more than 2 MiB of memory for this file" + instead);
  EXPECT_EQ(complaint({600, std::uint64_t{1} << 30, AssimpLimits::assimpProgram()}),
            "no complaint");
}

/// The time limit of the calling process must also end the real helper program. (The helper's own
/// limit of processor time is larger.)
TEST_F(AssimpProcess, TimeEnds) {
  write("a.dae", grid(400));
  EXPECT_EQ(complaint({1e-6, 1 << 30, AssimpLimits::assimpProgram()}),
            reads + "took more than 1e-06 s and was stopped" + instead);
}

/// If the calling program ignores SIGCHLD, waiting for the helper program fails. Reading must
/// succeed nevertheless.
TEST_F(AssimpProcess, WorksIfSigchldIsIgnored) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const AssimpImport import = readWithAssimp(file_);
  std::signal(SIGCHLD, before);
  EXPECT_EQ(import.mesh.triangles.size(), 8u);
}

TEST_F(AssimpProcess, SeveralThreadsAtATime) {
  const AssimpImport first = readWithAssimp(file_);
  ASSERT_EQ(first.mesh.triangles.size(), 8u);
  std::atomic<int> same = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      const AssimpImport import = readWithAssimp(file_);
      same += import.mesh.vertices == first.mesh.vertices &&
              import.mesh.triangles == first.mesh.triangles;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(same, 4);
}

TEST_F(AssimpProcess, NamesWithShellCharacters) {
  std::filesystem::create_directories(folder_ / "$(exit 3) 'a b");
  const auto file = write("$(exit 3) 'a b/-c \"d\".dae", grid(1));
  EXPECT_EQ(readMeshFile(file).mesh.triangles.size(), 2u);
}

/// Returns a glTF of one triangle whose buffer is the file `uri`.
std::string gltf(const std::string& uri) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0, "translation": [10, 0, 0]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"buffers": [{"uri": ")" +
         uri + R"(", "byteLength": 44}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 0]},
{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]})";
}

TEST_F(AssimpProcess, FilesThatAMeshFileRefersTo) {
  std::string numbers;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) numbers += bytesOf(x);
  for (std::uint16_t corner = 0; corner < 3; ++corner) numbers += bytesOf(corner);
  write("a.bin", numbers + std::string(2, '\0'));
  const MeshFile file = read("a.gltf", gltf("a.bin"));
  EXPECT_EQ(file.format, "glTF 2.0");
  ASSERT_EQ(file.mesh.vertices.size(), 3u);
  EXPECT_EQ(file.mesh.vertices[2], Vec3(10, 2, 0));
  // Reading a device would never end, and opening a pipe would block: the reader must open neither
  // of the two.
  ASSERT_EQ(::mkfifo((folder_ / "pipe.bin").c_str(), 0600), 0);
  for (const char* const uri : {"/dev/zero", "pipe.bin", "missing.bin"})
    EXPECT_THAT(MeshFileTest::complaint("b.gltf", gltf(uri)),
                StartsWith("b.gltf: the file \"" + std::string(uri) + "\" of buffer 0: "))
        << uri;
}

}  // namespace
}  // namespace corridor::test
