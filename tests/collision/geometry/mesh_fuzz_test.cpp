// Damaged files must never crash or hang a reader. A reader must return a mesh without faults, or
// throw an InputError whose text has no control characters.
#include <random>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/mesh_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : random() % n;
}

std::string damaged(std::string bytes, Random& random) {
  static const std::vector<std::string> pieces = {"-",
                                                  "+",
                                                  ".",
                                                  "e",
                                                  "/",
                                                  "\\\n",
                                                  "#",
                                                  "\n",
                                                  " ",
                                                  "0",
                                                  "99999999999999999999",
                                                  "-1",
                                                  "4294967296",
                                                  "nan",
                                                  "1e999",
                                                  "1e-999",
                                                  std::string(1, '\0'),
                                                  "\xff\xff\xff\xff",
                                                  std::string("\0\0\x80\x7f", 4),
                                                  "endsolid",
                                                  "solid",
                                                  "f ",
                                                  "v "};
  for (std::size_t times = 1 + below(random, 4); times > 0; --times) {
    const std::size_t at = below(random, bytes.size());
    switch (below(random, 6)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.erase(at, 1 + below(random, 8));
        break;
      case 2:
        bytes.insert(at, pieces[below(random, pieces.size())]);
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(random, bytes.size()), below(random, 64)));
        break;
      default:
        if (!bytes.empty()) bytes[at] = static_cast<char>(random());
    }
  }
  return bytes;
}

class MeshFuzz : public MeshFileTest {
 protected:
  void attack(const std::string& name, const std::string& whole) {
    const int mutations = isStressRun() ? 100000 : 2000;
    Random random(testSeed(7));
    int sound = 0, refused = 0;
    for (int i = 0; i < mutations; ++i) {
      const std::string bytes = damaged(whole, random);
      SCOPED_TRACE("mutation " + std::to_string(i));
      try {
        const MeshFile file = read(name, bytes);
        EXPECT_EQ(checkMesh(file.mesh), std::nullopt);
        EXPECT_FALSE(file.mesh.triangles.empty());
        ++sound;
      } catch (const InputError& error) {
        for (const Fault& fault : error.faults()) {
          for (const char c : fault.text) ASSERT_TRUE(c >= ' ' || c < 0) << fault.text;
        }
        ++refused;
      }
    }
    EXPECT_GT(sound, mutations / 100);  // or nearly all mutations were refused at once
    EXPECT_GT(refused, mutations / 10);
  }
};

TEST_F(MeshFuzz, Obj) {
  attack("a.obj", objTetrahedron);
}
TEST_F(MeshFuzz, AsciiStl) {
  attack("a.stl", asciiStlTetrahedron());
}
TEST_F(MeshFuzz, BinaryStl) {
  attack("a.stl", binaryStlTetrahedron());
}
TEST_F(MeshFuzz, AsciiPly) {
  attack("a.ply", asciiPlyTetrahedron);
}
TEST_F(MeshFuzz, LittleEndianPly) {
  attack("a.ply", binaryPlyTetrahedron(false));
}
TEST_F(MeshFuzz, BigEndianPly) {
  attack("a.ply", binaryPlyTetrahedron(true));
}

TEST_F(MeshFuzz, Off) {
  attack("a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
}

TEST_F(MeshFuzz, EveryTruncationIsNoticed) {
  // A file that is cut before the end of its last face must be refused. OBJ is left out: the format
  // has no end mark, so missing lines cannot be detected.
  const auto noticed = [&](const std::string& name, const std::string& whole, std::size_t tail) {
    for (std::size_t size = 0; size + tail < whole.size(); ++size) {
      EXPECT_THROW(read(name, whole.substr(0, size)), InputError)
          << name << " cut to " << size << " bytes";
    }
  };
  noticed("a.stl", binaryStlTetrahedron(), 0);
  noticed("a.ply", binaryPlyTetrahedron(false), 0);
  noticed("a.ply", binaryPlyTetrahedron(true), 0);
  noticed("a.stl", asciiStlTetrahedron(), std::string(" a tetrahedron\n").size());
  noticed("a.ply", asciiPlyTetrahedron,
          std::string("an\n").size());  // readers do not use the last word, "nan": it may be cut
}

}  // namespace
}  // namespace corridor::test
