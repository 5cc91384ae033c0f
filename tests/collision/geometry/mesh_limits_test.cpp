// Tests that mesh files are refused if they claim too many items or need too much memory. Readers
// must not allocate more memory than the size of the file justifies.
#include <gmock/gmock.h>

#include "planner/jobs/child_process.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

class MeshLimits : public MeshFileTest {
 protected:
  /// Returns the message of the error that is thrown when a file is read in a process that may
  /// allocate at most 64 MB.
  std::string complaintInLittleMemory(const std::string& name, const std::string& bytes) const {
#ifdef __SANITIZE_ADDRESS__
    const std::size_t memory = 0;  // no limit: the sanitizer would end the process
#else
    const std::size_t memory = 64 << 20;
#endif
    const auto file = write(name, bytes);
    const ChildEnd end =
        inChild([&](const std::function<void(const std::string&)>& send) { send(complaint(file)); },
                {{600}, memory});
    return end.messages.empty() ? end.failure : end.messages.front();
  }
  void expect(const std::string& name, const std::string& bytes,
              const std::string& complaintText) const {
    EXPECT_EQ(complaintInLittleMemory(name, bytes), name + complaintText);
  }
};

constexpr const char* coarser =
    " or more; at most 100000000 are read: use a coarser mesh, or split it";

std::string ply(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

const std::string xyz = "property char x\nproperty char y\nproperty char z\n";
const std::string kCornersOfFace = "property list uchar uchar vertex_indices\n";

TEST_F(MeshLimits, PlyCounts) {
  for (const char* const format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    SCOPED_TRACE(format);
    const auto fault = [&](const std::string& elements, const std::string& complaintText) {
      expect("a.ply", ply(format, elements) + std::string(100, '1'), complaintText);
    };
    fault("element vertex 4000000000\n" + xyz + "element face 1\n" + kCornersOfFace,
          std::string(": has 4000000000 vertices") + coarser);
    fault("element vertex 1\n" + xyz + "element face 1000000000\n" + kCornersOfFace,
          std::string(": has 1000000000 faces") + coarser);
    fault("element vertex 90000000\n" + xyz + "element face 1\n" + kCornersOfFace,
          ": the header promises 90000000 of element \"vertex\", at least " +
              std::string(format[0] == 'a' ? "6" : "3") + " bytes each, but 10" +
              (format[0] == 'a' ? "1" : "0") + " bytes are left: the file is cut short");
    // An element without properties takes no bytes, so a large count of such elements is no fault.
    fault("element dust 9000000000000000000\nelement vertex 9\n" + xyz + "element face 99\n" +
              kCornersOfFace,
          format[0] == 'a' ? ":11: vertex 1 of 9: the file ends here: it is cut short"
                           : ": the header promises 99 of element \"face\", at least 1 bytes "
                             "each, but 73 bytes are left: the file is cut short");
  }
}

TEST_F(MeshLimits, PlyLists) {
  const std::string points = "element vertex 1\n" + xyz;
  const std::string list = "element face 1\nproperty list uint uchar vertex_indices\n";
  expect("a.ply",
         ply("binary_little_endian", points + list) + std::string(3, '\0') + "\xff\xff\xff\xff" +
             std::string(6, '\0'),
         ": face 1 of 1 (byte 180): the file ends here: it is cut short");
  expect("a.ply", ply("ascii", points + list) + "0 0 0\n1000000000000000000 0 0 0\n",
         ":12: face 1 of 1: the file ends here: it is cut short");
  const std::string unread = "element face 1\n" + kCornersOfFace + "property list uint int more\n";
  expect("a.ply", ply("ascii", points + unread) + "0 0 0\n3 0 0 0 1000000000000000000 5\n",
         ":13: face 1 of 1: the file ends here: it is cut short");
}

/// The size of PLY headers is limited, because every name in a header is compared with all others.
TEST_F(MeshLimits, PlyHeaders) {
  std::string elements, properties = "element vertex 1\n";
  for (int i = 0; i < 100'000; ++i) {
    elements += "element e" + std::to_string(i) + " 0\n";
    properties += "property char p" + std::to_string(i) + "\n";
  }
  expect("a.ply", ply("ascii", elements), ":1003: the header has more than 1000 elements");
  expect("a.ply", ply("ascii", properties),
         ":1004: element \"vertex\" has more than 1000 properties");
}

TEST_F(MeshLimits, StlOffAndObj) {
  expect("a.stl", std::string(80, ' ') + "\xff\xff\xff\xff" + std::string(500, '\0'),
         ": binary STL of 4294967295 triangles: expected 214748364834 bytes, found 584: it is cut "
         "short");
  expect("a.off", "OFF\n4000000000 1 0\n0 0 0\n",
         std::string(":2: has 4000000000 vertices") + coarser);
  expect("a.off", "OFF\n3 1000000000000000000 0\n0 0 0\n",
         std::string(":2: has 1000000000000000000 faces") + coarser);
  expect("a.off", "OFF\n-4 1 0\n0 0 0\n",
         ":2: the number of vertices is \"-4\"; a whole number is needed");
  expect("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n",
         ":6: a face of 4000000000 corners lists only 3");
  expect("a.obj", "v 0 0 0\nf 1 1 1000000000000000000\n",
         ":2: face corner 1000000000000000000 is out of range: the file has 1 vertices");
  expect("a.obj", "v 0 0 0\nf 1 1 -1000000000000000000\n",
         ":2: face corner -1000000000000000000 is out of range: 1 vertices come before it");
  expect("a.obj", "v 0 0 0\nf 1 1 99999999999999999999\n",
         ":2: face corner \"99999999999999999999\" is not of the form 1, 1/2, 1/2/3 or 1//3");
}

/// The number of triangles is limited even if the file really has that many: here one face has more
/// than 10^8 corners.
TEST_F(MeshLimits, PolygonsOfTooManyTriangles) {
  if (!isStressRun()) GTEST_SKIP() << "2 GB of memory: set CORRIDOR_STRESS";
  std::string face = "v 0 0 0\nf";
  for (int i = 0; i < 100'000'004; ++i) face += " 1";
  EXPECT_EQ(complaint("a.obj", face), std::string("a.obj:2: has 100000001 triangles") + coarser);
}

TEST_F(MeshLimits, NoOrdinaryFile) {
  for (const char* const name : {"zero.obj", "zero.dae", "zero.glb"}) {
    std::filesystem::create_symlink("/dev/zero", folder_ / name);
    EXPECT_EQ(complaint(folder_ / name),
              std::string(name) + ": is a device; an ordinary file is needed");
    EXPECT_THROW(readOmplAppMesh(folder_ / name), InputError);
  }
}

TEST_F(MeshLimits, SizesOfFiles) {
  const auto sparse = [&](const std::string& name, std::uint64_t size) {
    const auto file = write(name, "x");
    std::filesystem::resize_file(file, size);
    return complaint(file);
  };
  EXPECT_EQ(sparse("a.stl", (std::uint64_t{4} << 30) + 1),
            "a.stl: has 4294967297 bytes, more than 4294967296, the limit for a mesh file");
  for (const char* const name : {"a.dae", "a.glb"})
    EXPECT_EQ(sparse(name, (std::uint64_t{1} << 30) + 1),
              std::string(name) +
                  ": has 1073741825 bytes, more than 1073741824, the limit for a mesh file");
}

TEST_F(MeshLimits, OnlySupportedExtensions) {
  const std::string formats =
      " is not supported; save the mesh as OBJ, STL, PLY, OFF, "
      "Collada, glTF or 3MF";
  // The content is OFF. assimp would recognise it, whatever the extension.
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* const extension : {".blend", ".fbx", ".x3d", ".amf", ".unknown"}) {
    EXPECT_EQ(complaint("a" + std::string(extension), off),
              "a" + std::string(extension) + ": the extension \"" + extension + "\"" + formats);
    EXPECT_THROW(readOmplAppMesh(write("a" + std::string(extension), off)), InputError);
  }
  EXPECT_EQ(complaint("mesh", off), "mesh: a name without an extension" + formats +
                                        " (a robot in URDF begins with <robot>)");
}

}  // namespace
}  // namespace corridor::test
