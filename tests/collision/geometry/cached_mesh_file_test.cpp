// Tests that a mesh file is read the same with and without a cache.
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "collision/core/file_cache.h"
#include "collision/geometry/mesh_file.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

class CachedMeshFile : public testing::Test {
 protected:
  ~CachedMeshFile() override { std::filesystem::remove_all(folder_); }

  /// Writes the mesh as OBJ, with a comment that states a unit and an element that is not read.
  std::string writeObj(const std::string& name, const TriangleMesh& mesh) const {
    std::ofstream out(folder_ / name);
    out.precision(17);
    out << "# units: mm\np 1\n";
    for (const Vec3& v : mesh.vertices) out << "v " << v.transpose() << '\n';
    for (const auto& t : mesh.triangles)
      out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    return folder_ / name;
  }
  FileCache cache() const { return FileCache(folder_ / "cache", "code"); }

  static void expectEqual(const MeshFile& a, const MeshFile& b) {
    EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
    EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
    EXPECT_EQ(a.format, b.format);
    EXPECT_EQ(a.unitRule, b.unitRule);
    EXPECT_EQ(a.upRule, b.upRule);
    EXPECT_EQ(a.fileUp, b.fileUp);
    EXPECT_EQ(a.isCollada, b.isCollada);
    EXPECT_EQ(a.facesOnly, b.facesOnly);
    EXPECT_EQ(a.notes, b.notes);
    EXPECT_EQ(a.otherFiles, b.otherFiles);
    ASSERT_EQ(a.statedUnits.size(), b.statedUnits.size());
    for (std::size_t i = 0; i < a.statedUnits.size(); ++i) {
      EXPECT_EQ(a.statedUnits[i].line, b.statedUnits[i].line);
      EXPECT_EQ(a.statedUnits[i].words, b.statedUnits[i].words);
      EXPECT_EQ(a.statedUnits[i].metresPerUnit, b.statedUnits[i].metresPerUnit);
    }
  }
  /// Reads the file without a cache, with an empty one, and with a filled one.
  void expectEqualWithCache(const std::string& file, const MeshFileOptions& options = {}) const {
    const MeshFile plain = readMeshFile(file, options);
    FileCache first = cache();
    expectEqual(plain, readMeshFile(file, options, &first));
    EXPECT_EQ(first.counts().missed, 1u) << file;
    first.save();
    FileCache second = cache();
    expectEqual(plain, readMeshFile(file, options, &second));
    EXPECT_EQ(second.counts().found, 1u) << file;
  }

  std::filesystem::path folder_ = newFolder();
};

TEST_F(CachedMeshFile, IsReadAsWithoutACache) {
  const std::string file = writeObj("cube.obj", tessellatedCube(12));
  expectEqualWithCache(file);
  expectEqualWithCache(file, {.metresPerUnit = 0.001});
  expectEqualWithCache(file, {.up = 'y'});
  expectEqualWithCache(file, {.metresPerUnit = 0.0254, .up = 'x'});
  const MeshFile read = readMeshFile(file);
  EXPECT_FALSE(read.notes.empty() || read.statedUnits.empty());
}

/// Values that only Collada and PLY files set: they decide how a robot's reader turns and scales.
TEST_F(CachedMeshFile, OfOtherFormatsIsReadAsWithoutACache) {
  const TriangleMesh mesh = tessellatedCube(20);
  std::ofstream dae(folder_ / "cube.dae");
  dae << "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>\n"
         "<asset><unit name='inch' meter='0.0254'/><up_axis>Y_UP</up_axis></asset>\n"
         "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='f' count='"
      << 3 * mesh.vertices.size() << "'>";
  for (const Vec3& v : mesh.vertices) dae << v.transpose() << '\n';
  dae << "</float_array><technique_common><accessor source='#f' count='" << mesh.vertices.size()
      << "' stride='3'><param name='X' type='float'/><param name='Y' type='float'/><param "
         "name='Z' type='float'/></accessor></technique_common></source><vertices id='v'><input "
         "semantic='POSITION' source='#p'/></vertices><triangles count='"
      << mesh.triangles.size() << "'><input semantic='VERTEX' source='#v' offset='0'/><p>";
  for (const auto& t : mesh.triangles) dae << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  dae << "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id='s'><node><instance_geometry url='#g'/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>\n";
  dae.close();
  expectEqualWithCache(folder_ / "cube.dae");
  expectEqualWithCache(folder_ / "cube.dae", {.metresPerUnit = 0.001, .up = 'x'});
  const MeshFile collada = readMeshFile(folder_ / "cube.dae");
  EXPECT_TRUE(collada.isCollada);
  EXPECT_TRUE(collada.facesOnly);
  EXPECT_EQ(collada.fileUp, 'y');

  std::ofstream ply(folder_ / "cube.ply");
  ply << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) ply << v.transpose() << '\n';
  for (const auto& t : mesh.triangles) ply << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  ply.close();
  expectEqualWithCache(folder_ / "cube.ply");
  EXPECT_FALSE(readMeshFile(folder_ / "cube.ply").isCollada);
}

TEST_F(CachedMeshFile, AnotherContentIsReadAnew) {
  const std::string file = writeObj("cube.obj", tessellatedCube(12));
  expectEqualWithCache(file);
  TriangleMesh moved = tessellatedCube(12);
  moved.vertices.back().x() = std::nextafter(moved.vertices.back().x(), 2);
  writeObj("cube.obj", moved);
  FileCache kept = cache();
  EXPECT_EQ(readMeshFile(file, {}, &kept).mesh.vertices, moved.vertices);
  EXPECT_EQ(kept.counts().found, 0u);
}

TEST_F(CachedMeshFile, AnotherExtensionIsReadAnew) {
  // These bytes are legal as OFF only.
  std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  text.resize(20'000, '\n');
  std::ofstream(folder_ / "a.off") << text;
  std::ofstream(folder_ / "a.obj") << text;
  expectEqualWithCache(folder_ / "a.off");
  FileCache kept = cache();
  EXPECT_THROW(readMeshFile(folder_ / "a.obj", {}, &kept), InputError);
}

TEST_F(CachedMeshFile, SmallAndFaultyFilesAreNotKept) {
  const std::string small = writeObj("small.obj", tessellatedCube(2));
  std::ofstream(folder_ / "faulty.obj") << std::string(20'000, '\n') + "v 0 0\n";
  FileCache kept = cache();
  expectEqual(readMeshFile(small), readMeshFile(small, {}, &kept));
  EXPECT_THROW(readMeshFile(folder_ / "faulty.obj", {}, &kept), InputError);
  kept.save();
  EXPECT_EQ(kept.counts().written, 0u);
}

}  // namespace
}  // namespace corridor::test
