#include "collision/geometry/occupancy_map.h"

#include <climits>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <sstream>

#ifdef CORRIDOR_WITH_OCTOMAP
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#endif

#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

/// Returns the header of a .bt file with `nodes` nodes.
std::string header(int nodes) {
  return "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first "
         "line as it is!)\n#\nid OcTree\nsize " +
         std::to_string(nodes) + "\nres 0.1\ndata\n";
}

/// Returns the data of a .bt file: `levels` inner nodes, each of which is the only child of the
/// node above it, at index `child`; then `last`, the 16 bits of the last node.
std::string chain(int child, std::uint16_t last, int levels = 15) {
  std::string data;
  for (int i = 0; i < levels; ++i) data += bytesOf(static_cast<std::uint16_t>(3 << 2 * child));
  return data + bytesOf(last);
}

std::string complaintOf(const std::string& bytes, const OccupancyRules& rules = {}) {
  try {
    parseOccupancyMap(bytes, rules, "map.bt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(OccupancyMap, SmallCells) {
  // Child 7 of the root has positive coordinates. Below it, child 0 is chosen at every level: it is
  // next to the origin.
  std::string data = bytesOf(std::uint16_t(3 << 14)) + chain(0, 2 << 0 | 1 << 2 | 2 << 4, 14);
  const OccupancyMap map = parseOccupancyMap(header(19) + data, {}, "map.bt");
  EXPECT_EQ(map.format, "OctoMap (.bt)");
  EXPECT_EQ(map.resolution, 0.1);
  ASSERT_EQ(map.cubes.size(), 2u);
  EXPECT_EQ(map.free, 1u);
  EXPECT_EQ(map.cubes[0].size, 1);
  EXPECT_EQ(map.centerOf(map.cubes[0]), Vec3(0.05, 0.05, 0.05));
  EXPECT_LT((map.centerOf(map.cubes[1]) - Vec3(0.05, 0.15, 0.05)).norm(), 1e-15) << "bit 1 is y";
  EXPECT_EQ(map.sizeOf(map.cubes[0]), 0.1);

  // The bounding box of the three cells contains one unknown cell.
  const OccupancyMap all =
      parseOccupancyMap(header(19) + data, {.unknownIsOccupied = true}, "map.bt");
  ASSERT_EQ(all.cubes.size(), 3u);
  EXPECT_LT((all.centerOf(all.cubes[2]) - Vec3(0.15, 0.15, 0.05)).norm(), 1e-15);

  // Eight occupied cells are one cube.
  data = bytesOf(std::uint16_t(3 << 14)) + chain(0, 0xaaaa, 14);
  const OccupancyMap joined = parseOccupancyMap(header(24) + data, {}, "map.bt");
  ASSERT_EQ(joined.cubes.size(), 1u);
  EXPECT_EQ(joined.cubes[0].size, 2);
  EXPECT_EQ(joined.centerOf(joined.cubes[0]), Vec3(0.1, 0.1, 0.1));
}

/// A message of OctoMap has the nodes of a file, without the file's header.
TEST(OccupancyMap, Messages) {
  const std::string data = chain(0, 2);
  const OccupancyMap file = parseOccupancyMap(header(17) + data, {}, "map.bt");
  const OccupancyMap map = parseOccupancyMessage({true, "OcTree", 0.1, data}, {}, "message");
  EXPECT_EQ(map.format, "octomap_msgs/Octomap");
  EXPECT_FALSE(map.hasProbabilities);
  ASSERT_EQ(map.cubes.size(), 1u);
  EXPECT_EQ(map.centerOf(map.cubes[0]), file.centerOf(file.cubes.at(0)));
  EXPECT_EQ(parseOccupancyMessage({true, "OcTree", 0.1, ""}, {}, "message").cubes.size(), 0u);
  const auto complaint = [](const OccupancyMessage& message) {
    try {
      parseOccupancyMessage(message, {}, "message");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no complaint");
  };
  EXPECT_EQ(complaint({true, "OcTree", 0.1, data + "x"}),
            "message: 1 byte comes after the last node: the message is damaged");
  EXPECT_EQ(complaint({true, "OcTree", 0.1, data.substr(1)}).substr(0, 9), "message: ");
  EXPECT_EQ(complaint({true, "ColorOcTree", 0.1, data}),
            "message: trees of type \"ColorOcTree\" can't be read; save an OcTree");
  EXPECT_EQ(complaint({true, "OcTree", 0, data}),
            "message: resolution: the edge length of a cell, in metres, must be above 0 and below "
            "1e100");
}

TEST(OccupancyMap, Faults) {
  const std::string good = header(17) + chain(0, 2);
  EXPECT_EQ(complaintOf(good), "no complaint");
  EXPECT_EQ(complaintOf("PCD\n"),
            "map.bt:1: a map of OctoMap begins with \"# Octomap OcTree binary file\" or \"# "
            "Octomap OcTree file\"");
  EXPECT_EQ(complaintOf(good.substr(0, good.size() - 1)),
            "map.bt: the file ends within its nodes: it is cut short");
  EXPECT_EQ(complaintOf(good + "x"),
            "map.bt: 1 byte comes after the last node: the file is damaged");
  EXPECT_EQ(complaintOf(header(18) + chain(0, 3 << 4) + chain(0, 2)),
            "map.bt: the tree is deeper than 16 levels: the file is damaged");
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string bytes = good;
    return complaintOf(bytes.replace(bytes.find(old), old.size(), text));
  };
  EXPECT_EQ(with("id OcTree", "id OcTreeStamped"),
            "map.bt: trees of type \"OcTreeStamped\" can't be read; save an OcTree");
  EXPECT_EQ(with("size 17", "size -2"), "map.bt:5: size: a number of nodes is needed, not \"-2\"");
  EXPECT_EQ(with("size 17\n", ""), "map.bt: the header has no line \"size\"");
  EXPECT_EQ(with("size 17", "size 18"),
            "map.bt: the header promises 18 nodes, but the data have 17: the file is damaged");
  EXPECT_EQ(with("res 0.1", "res 0"),
            "map.bt: res: the edge length of a cell, in metres, must be above 0 and below 1e100");
  EXPECT_EQ(with("res 0.1", "res small"),
            "map.bt:6: res: coordinate \"small\" is not a number; write decimal numbers such as "
            "-1.25e-3");
  EXPECT_EQ(complaintOf(header(1) + std::string(2, '\0')),
            "map.bt: the tree has a root only, whose state this form of a map does not store; save "
            "the full form");
  EXPECT_EQ(with("res 0.1", "res 10 cm"),
            "map.bt:6: \"cm\" comes after the value of \"res\"; one value is needed");
  EXPECT_EQ(with("res 0.1", "res 0.1\nres 0.2"), "map.bt:7: the header has a second line \"res\"");
  EXPECT_EQ(with("res 0.1", "colour red"), "map.bt:6: \"colour\" is no line of OctoMap's header");
  EXPECT_EQ(complaintOf(header(17).substr(0, header(17).size() - 5)),
            "map.bt:7: the header has no line \"data\"");
  EXPECT_EQ(complaintOf(good, {.threshold = 1}),
            "map.bt: threshold: a probability above 0 and below 1 is needed, not 1");
}

/// A cell whose probability p is the threshold is occupied, although float(ln(p/(1 − p))) may be
/// below ln(p/(1 − p)).
TEST(OccupancyMap, TheThresholdItselfIsOccupied) {
  for (const double p : {0.1, 0.5, 0.51, 0.55, 0.6, 0.7, 0.85, 0.97}) {
    const auto logOdds = static_cast<float>(std::log(p / (1 - p)));
    const auto cubes = [&](float value) {
      return parseOccupancyMap("# Octomap OcTree file\nid OcTree\nsize 2\nres 0.1\ndata\n" +
                                   bytesOf(1.0F) + '\x01' + bytesOf(value) + '\0',
                               {.threshold = p}, "map.ot")
          .cubes.size();
    };
    EXPECT_EQ(cubes(logOdds), 1u) << p;
    EXPECT_EQ(cubes(std::nextafter(logOdds, -HUGE_VALF)), 0u) << p;
  }
}

#ifdef CORRIDOR_WITH_OCTOMAP

using Cell = std::array<int, 3>;

/// Returns the cells of the smallest size that all cubes of the map contain.
std::set<Cell> cellsOf(const OccupancyMap& map) {
  std::set<Cell> cells;
  for (const OccupancyMap::Cube& cube : map.cubes)
    for (int i = 0; i < cube.size; ++i)
      for (int j = 0; j < cube.size; ++j)
        for (int k = 0; k < cube.size; ++k)
          cells.insert({cube.corner[0] + i, cube.corner[1] + j, cube.corner[2] + k});
  return cells;
}

template <class Tree>
std::set<Cell> cellsOf(const Tree& tree, const std::function<bool(double)>& isOccupied) {
  std::set<Cell> cells;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!isOccupied(leaf->getOccupancy())) continue;
    const int size = 1 << (16 - leaf.getDepth());
    const octomap::OcTreeKey low = leaf.getIndexKey();
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j)
        for (int k = 0; k < size; ++k)
          cells.insert({low[0] + i - 32768, low[1] + j - 32768, low[2] + k - 32768});
  }
  return cells;
}

template <class Tree>
void fill(Tree& tree, std::mt19937_64& random) {
  for (int n = 0; n < 300; ++n) {
    std::normal_distribution<double> normal(0, n % 2 ? 0.2 : 1);
    const double x = normal(random), y = normal(random), z = normal(random);
    tree.updateNode(
        octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)),
        n % 3 != 0);
  }
  for (double x = 0.1; x < 0.6; x += 0.05)  // a block, whose cells are joined
    for (double y = 0.1; y < 0.6; y += 0.05)
      for (double z = 0.1; z < 0.6; z += 0.05)
        tree.updateNode(
            octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)),
            true);
}

/// OctoMap's own library writes the files and lists their leaves.
TEST(OccupancyMap, FilesOfOctomap) {
  std::mt19937_64 random(testSeed(320));
  for (int n = 0; n < 20; ++n) {
    octomap::OcTree tree(0.05 + 0.01 * n);
    fill(tree, random);
    if (n % 2) tree.prune();
    std::ostringstream full;
    ASSERT_TRUE(tree.write(full));
    const OccupancyMap ot = parseOccupancyMap(full.str(), {}, "map.ot");
    EXPECT_EQ(ot.format, "OctoMap (.ot)");
    EXPECT_NEAR(ot.resolution, tree.getResolution(), 1e-15);  // the file has six digits
    const auto half = [](double p) { return p >= 0.5; };
    EXPECT_EQ(cellsOf(ot), cellsOf(tree, half));
    const OccupancyMap sure = parseOccupancyMap(full.str(), {.threshold = 0.8}, "map.ot");
    EXPECT_EQ(cellsOf(sure), cellsOf(tree, [](double p) { return p >= 0.8; }));
    EXPECT_LT(cellsOf(sure).size(), cellsOf(ot).size());

    std::ostringstream binary;
    // This also replaces probabilities by the most likely state.
    ASSERT_TRUE(tree.writeBinary(binary));
    const OccupancyMap bt = parseOccupancyMap(binary.str(), {}, "map.bt");
    EXPECT_EQ(cellsOf(bt), cellsOf(tree, half));
    EXPECT_GT(bt.free, 0u);
    for (const OccupancyMap::Cube& cube : bt.cubes) {
      const Vec3 center = bt.centerOf(cube);
      const auto* node = tree.search(center.x(), center.y(), center.z());
      ASSERT_NE(node, nullptr);
      EXPECT_TRUE(tree.isNodeOccupied(node)) << "our coordinates are OctoMap's";
    }

    // Unknown cells are those that OctoMap's search does not find.
    octomap::OcTree small(0.1);
    for (int i = 0; i < 30; ++i)
      small.updateNode(octomap::point3d(static_cast<float>(random() % 8) * 0.1F + 0.05F,
                                        static_cast<float>(random() % 8) * 0.1F + 0.05F,
                                        static_cast<float>(random() % 8) * 0.1F + 0.05F),
                       i % 2 == 0);
    std::ostringstream text;
    ASSERT_TRUE(small.writeBinary(text));
    Cell low{INT_MAX, INT_MAX, INT_MAX}, high{INT_MIN, INT_MIN, INT_MIN};
    for (const Cell& cell : cellsOf(small, [](double) { return true; }))
      for (std::size_t k = 0; k < 3; ++k)
        low[k] = std::min(low[k], cell[k]), high[k] = std::max(high[k], cell[k]);
    std::set<Cell> wanted;
    for (int i = low[0]; i <= high[0]; ++i)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int k = low[2]; k <= high[2]; ++k) {
          const auto* node = small.search(0.1 * (i + 0.5), 0.1 * (j + 0.5), 0.1 * (k + 0.5));
          if (!node || small.isNodeOccupied(node)) wanted.insert({i, j, k});
        }
    EXPECT_EQ(cellsOf(parseOccupancyMap(text.str(), {.unknownIsOccupied = true}, "map.bt")),
              wanted);
  }
}

TEST(OccupancyMap, ColorTrees) {
  std::mt19937_64 random(testSeed(321));
  octomap::ColorOcTree tree(0.05);
  fill(tree, random);
  std::ostringstream text;
  ASSERT_TRUE(tree.write(text));
  EXPECT_EQ(cellsOf(parseOccupancyMap(text.str(), {}, "map.ot")),
            cellsOf(tree, [](double p) { return p >= 0.5; }));
}

#endif

}  // namespace
}  // namespace corridor::test
