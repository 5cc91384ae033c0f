#include "collision/geometry/point_cloud.h"

#include <cmath>
#include <random>

#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

class PointCloudTest : public MeshFileTest {
 protected:
  PointCloud read(const std::string& name, const std::string& bytes,
                  const MeshFileOptions& options = {}) const {
    return readPointCloud(write(name, bytes), options);
  }
  std::string complaint(const std::string& name, const std::string& bytes,
                        const MeshFileOptions& options = {}) const {
    return complaintOf([&] { readPointCloud(write(name, bytes), options); });
  }
};

using Points = std::vector<Vec3>;
const Points kThree{{1, 2, 3}, {-0.5, 0, 4e-3}, {7, 8, 9}};

std::string pcdHeader(const std::string& points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS rgb x y z n\n"
         "SIZE 1 4 8 4 2\nTYPE U F F F I\nCOUNT 1 1 1 1 2\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

/// Returns the point's bytes in the order of the header above.
std::string pcdPoint(const Vec3& p) {
  return std::string("\x05", 1) + bytesOf(static_cast<float>(p[0])) + bytesOf(p[1]) +
         bytesOf(static_cast<float>(p[2])) + bytesOf(std::int16_t{1}) + bytesOf(std::int16_t{2});
}

TEST_F(PointCloudTest, Ply) {
  const std::string properties =
      "element vertex 3\nproperty float nx\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n";
  const PointCloud text =
      read("a.ply", "ply\nformat ascii 1.0\n" + properties + "0 1 2 3\n0 -0.5 0 4e-3\n0 7 8 9\n");
  EXPECT_EQ(text.points, kThree);
  EXPECT_EQ(text.format, "PLY (ASCII)");
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\n" + properties;
    for (const Vec3& p : kThree)
      bytes += bytesOf(0.0F, big) + bytesOf(p[0], big) + bytesOf(p[1], big) + bytesOf(p[2], big);
    EXPECT_EQ(read("b.ply", bytes).points, kThree);
  }
  // The faces of a mesh are skipped.
  EXPECT_EQ(read("c.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                 "end_header\n1 2 3\n4 5 6\n7 8 9\n3 0 1 2\n")
                .points.size(),
            3u);
}

TEST_F(PointCloudTest, Pcd) {
  std::string text;
  for (const Vec3& p : kThree)
    text += "5 " + std::to_string(p[0]) + ' ' + std::to_string(p[1]) + ' ' + std::to_string(p[2]) +
            " 1 2\n";
  const PointCloud ascii = read("a.pcd", pcdHeader("3", "ascii") + text);
  EXPECT_EQ(ascii.format, "PCD (ASCII)");
  EXPECT_EQ(ascii.points, kThree);
  std::string bytes;
  for (const Vec3& p : kThree) bytes += pcdPoint(p);
  const PointCloud binary = read("b.pcd", pcdHeader("3", "binary") + bytes);
  ASSERT_EQ(binary.points.size(), 3u);
  EXPECT_EQ(binary.points[1], Vec3(-0.5, 0, 4e-3F)) << "x and z are floats, y is a double";
  // The header has no COUNT, and no POINTS: the number of points follows from WIDTH and HEIGHT.
  EXPECT_EQ(read("c.pcd",
                 "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\nDATA ascii\n"
                 "1 2 3\n4 5 6\n7 8 9\nnan nan nan\n1 1 1\n-inf 0 0")
                .points.size(),
            4u);
}

/// Compresses bytes to the format of liblzf: literals, and copies of up to 264 bytes that begin at
/// most 8 KiB before.
std::string packed(const std::string& bytes) {
  std::string out, literal;
  const auto flush = [&] {
    if (literal.empty()) return;
    out += static_cast<char>(literal.size() - 1);
    out += literal;
    literal.clear();
  };
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t best = 0, from = 0;
    for (std::size_t start = at > 600 ? at - 600 : 0; start < at; ++start) {
      std::size_t length = 0;  // the copy may overlap its own output
      while (at + length < bytes.size() && length < 264 &&
             bytes[start + length] == bytes[at + length])
        ++length;
      if (length > best) best = length, from = start;
    }
    if (best < 3) {
      literal += bytes[at++];
      if (literal.size() == 32) flush();
      continue;
    }
    flush();
    const std::size_t back = at - from - 1, length = best - 2;
    out += static_cast<char>(std::min<std::size_t>(length, 7) << 5 | back >> 8);
    if (length >= 7) out += static_cast<char>(length - 7);
    out += static_cast<char>(back & 255);
    at += best;
  }
  flush();
  return out;
}

TEST_F(PointCloudTest, CompressedPcd) {
  std::mt19937_64 random(testSeed(310));
  Points points;
  for (int i = 0; i < 700; ++i)
    points.emplace_back(static_cast<float>(i % 30), static_cast<double>(random() % 5),
                        i < 300 ? 1 : static_cast<float>(random() % 1000));
  std::string columns(points.size(), '\x05');
  for (const Vec3& p : points) columns += bytesOf(static_cast<float>(p[0]));
  for (const Vec3& p : points) columns += bytesOf(p[1]);
  for (const Vec3& p : points) columns += bytesOf(static_cast<float>(p[2]));
  for (std::size_t i = 0; i < points.size(); ++i)
    columns += bytesOf(std::int16_t{1}) + bytesOf(std::int16_t{2});
  const std::string data = packed(columns);
  ASSERT_LT(data.size(), columns.size() / 2);
  const auto file = [&](const std::string& packedData, std::size_t size) {
    return pcdHeader("700", "binary_compressed") +
           bytesOf(static_cast<std::uint32_t>(packedData.size())) +
           bytesOf(static_cast<std::uint32_t>(size)) + packedData;
  };
  const PointCloud cloud = read("a.pcd", file(data, columns.size()));
  EXPECT_EQ(cloud.points, points);
  EXPECT_EQ(cloud.format, "PCD (compressed)");
  // Damaged data are refused, or read as other points; nothing is read out of bounds.
  int refused = 0;
  for (int n = 0; n < 300; ++n) {
    std::string damaged = data;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    if (n % 2) damaged.resize(random() % damaged.size());
    refused += complaint("d.pcd", file(damaged, columns.size())) != "no complaint";
  }
  EXPECT_GT(refused, 100);
  EXPECT_EQ(complaint("e.pcd", file(data, columns.size()).substr(0, 400)),
            "e.pcd: the data's sizes do not fit the file: it is cut short");
  EXPECT_EQ(complaint("f.pcd", file(data + '\x00', columns.size())),
            "f.pcd: the compressed data are damaged");
}

TEST_F(PointCloudTest, Text) {
  for (const char* name : {"a.xyz", "a.txt", "a.asc", "a.pts", "a.csv"})
    EXPECT_EQ(read(name, "# x y z\n// comment\n1 2 3 255 0 0\n\n-0.5,0,4e-3\r\n7;8; 9").points,
              kThree)
        << name;
  EXPECT_EQ(read("b.pts", "3\n1 2 3\n-0.5 0 4e-3\n7 8 9\n").points, kThree);
  EXPECT_EQ(complaint("b.pts", "4\n1 2 3\n-0.5 0 4e-3\n7 8 9\n"),
            "b.pts: its first line promises 4 points, but it has 3");
  EXPECT_EQ(read("c.txt", "X Y Z intensity\n1 2 3 7\n-0.5 0 4e-3 7\n7 8 9 7\n").points, kThree);
}

/// Files of every format may have the extension .xyz or .txt. Some editors write a byte order mark.
TEST_F(PointCloudTest, TheContentDecidesWhatAFileIs) {
  EXPECT_EQ(read("a.csv", "\xEF\xBB\xBFx,y,z\n1,2,3\n-0.5,0,4e-3\n7,8,9\n").points, kThree);
  EXPECT_EQ(read("a.xyz",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property double z\nend_header\n1 2 3\n-0.5 0 4e-3\n7 8 9\n")
                .points,
            kThree);
  EXPECT_EQ(read("a.txt",
                 "# .PCD v0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 3\nHEIGHT 1\nPOINTS 3\n"
                 "DATA ascii\n1 2 3\n-0.5 0 4e-3\n7 8 9\n")
                .points,
            kThree);
}

/// Commas are decimal marks in many countries. If a comma may be a decimal mark, the reader refuses
/// the line instead of guessing.
TEST_F(PointCloudTest, DecimalCommas) {
  EXPECT_EQ(read("a.xyz", "1, 2, 3\n-0.5,0,4e-3\n7,8 , 9 \n").points, kThree);
  EXPECT_EQ(read("a.xyz", "1; 2; 3\n-0.5;0;4e-3\n7 ;8;9\n").points, kThree);
  for (const char* line : {"1,5 2,5 3,5\n", "1,5\t2,5\t3,5\n", "  1,5 2 3\n", "1,5, 2,5, 3,5\n"})
    EXPECT_EQ(complaint("b.xyz", line),
              "b.xyz:1: has commas and blanks between numbers; use one of them, and write decimals "
              "with a point");
  EXPECT_EQ(complaint("c.xyz", "1,5;2;3\n"),
            "c.xyz:1: coordinate \"1,5\" is not a number; write decimal numbers such as -1.25e-3");
}

TEST_F(PointCloudTest, GroupsAndUnnamedColumns) {
  for (const char* line : {"1 2 3; 4 5 6\n", "1 2 3;4 5 6;\n", "1;2;3 4;5\n", "1,5 2 3; 4 5 6\n"})
    EXPECT_EQ(complaint("a.xyz", line),
              "a.xyz:1: semicolons separate groups of numbers; write a line for each point");
  EXPECT_EQ(complaint("a.xyz", "1;2;3;4 # 5 6\n"), "no complaint");
  EXPECT_EQ(read("a.xyz", "1 2 3 255 0 0\n").unnamedColumns, 3);
  EXPECT_EQ(read("a.xyz", "1 2 3 # 7\n").unnamedColumns, 0);
  EXPECT_EQ(read("a.xyz", "x y z i\n1 2 3 7\n").unnamedColumns, 0);
}

/// An empty field among the coordinates would shift the later ones.
TEST_F(PointCloudTest, EmptyFields) {
  const auto empty = [](const std::string& where) {
    return "a.csv:" + where.substr(0, 1) + ": the field before " + where.substr(2) + " is empty";
  };
  EXPECT_EQ(complaint("a.csv", "x,y,z,i\n0.6,,0,5\n"), empty("2 comma 2"));
  EXPECT_EQ(complaint("a.csv", "0.6, ,0,5\n"), empty("1 comma 2"));
  EXPECT_EQ(complaint("a.csv", "1;2; ;5\n"), empty("1 semicolon 3"));
  EXPECT_EQ(complaint("a.csv", "1,2,3\n,1,2,3\n"), empty("2 comma 1"));
  EXPECT_EQ(complaint("a.csv", "1,2,3\n1,2,,\n"), empty("2 comma 3"));
  EXPECT_EQ(complaint("a.csv", "1 2,,3\n"), empty("1 comma 2"));
  const std::string index = " (pandas writes its index so; use index=False)";
  EXPECT_EQ(complaint("a.csv", ",x,y,z\n0,1,2,3\n"), empty("1 comma 1") + index);
  EXPECT_EQ(complaint("a.csv", "1,2,\n"), "a.csv:1: a point has 3 coordinates, found 2");
  EXPECT_EQ(read("a.csv", "1,2,3,,5\n-0.5,0,4e-3,\n,,,\n7;8;9;;;\n").points, kThree)
      << "later columns are not read";
}

/// Two tabs in a row may be an empty field, or only fill up the columns.
TEST_F(PointCloudTest, Tabs) {
  EXPECT_EQ(read("a.xyz", "1\t\t2\t3\n-0.5\t0\t4e-3\n7\t8\t\t9\n").points, kThree);
  EXPECT_EQ(complaint("a.xyz", "1\t2\t3\t4\n5\t\t6\t7\n"),
            "a.xyz:2: has 3 columns, but line 1 has 4, and two tabs in a row may be an empty "
            "field; fill it, or write one tab between numbers");
  EXPECT_EQ(complaint("a.xyz", "5\t\t6\t7\n1\t2\t3\t4\n"),
            "a.xyz:2: has 4 columns, but line 1 has 3, and two tabs in a row may be an empty "
            "field; fill it, or write one tab between numbers");
}

/// Colours and labels may follow the coordinates, but no other unit.
TEST_F(PointCloudTest, WordsAfterThePoints) {
  for (const std::string rest : {"", " 255 0 0", " tree", " label in", " m", " # m", " # a tree"})
    EXPECT_EQ(complaint("a.xyz", "1 1 1" + rest + "\n"), "no complaint") << rest;
  const auto other = [&](const std::string& rest, const std::string& word,
                         const std::string& state) {
    EXPECT_EQ(complaint("a.xyz", "1 1 1 " + rest + "\n"),
              "a.xyz:1: \"" + word +
                  "\" follows the coordinates, which are read with a unit of 1 m; state the unit" +
                  state + ", or remove the word if it is no unit");
  };
  other("mm", "mm", " (unit: mm)");
  other("255 0 0 [CM]", "[CM]", " (unit: cm)");
  other("in", "in", " (unit: in)");
  other("feet", "feet", "");
  other("# mm", "# mm", " (unit: mm)");
  EXPECT_EQ(complaint("a.xyz", "1 1 1 mm\n", {0.001, {}}), "no complaint");
  const std::string says =
      "says that a unit is 0.001 m, but coordinates are read with a unit of 1 m; state the unit "
      "(unit: mm), or remove the line if it is wrong";
  EXPECT_EQ(complaint("a.xyz", "1 1 1 # unit: mm\n"), "a.xyz:1: " + says);
  EXPECT_EQ(complaint("a.xyz", "1 1 1 # x y z in cm\n# unit: mm\n"), "a.xyz:2: " + says);
}

TEST_F(PointCloudTest, UnitUpAndPointsThatAreNotFinite) {
  const PointCloud cloud = read("a.xyz", "1 2 3\nnan nan nan\n1 inf 2\n", {0.5, 'y'});
  EXPECT_EQ(cloud.points, Points({{0.5, -1.5, 1}}));
  EXPECT_EQ(cloud.notFinite, 2u);
  EXPECT_EQ(complaint("b.xyz", "nan nan nan\n"), "b.xyz: none of its 1 points is finite");
  EXPECT_EQ(complaint("c.xyz", "1e308 0 0\n", {1000, {}}),
            "c.xyz: its coordinates in metres are too large for a double");
}

TEST_F(PointCloudTest, Faults) {
  EXPECT_EQ(complaint("a.xyz", "1 2\n1 2 x\n"),
            "a.xyz:1: a point has 3 coordinates, found 2\na.xyz:2: coordinate \"x\" is not a "
            "number; write decimal numbers such as -1.25e-3");
  EXPECT_EQ(complaint("b.xyz", "# nothing\n"), "b.xyz: it has no points");
  EXPECT_EQ(complaint("c.obj", "v 1 2 3\n"),
            "c.obj: points are read from .ply, .pcd, .xyz, .txt, .asc, .pts and .csv, not from "
            "\".obj\"");
  EXPECT_EQ(complaint("d.pcd", "VERSION 0.7\nFIELDS x y\nDATA ascii\n1 2\n"),
            "d.pcd: FIELDS needs one field \"z\" of COUNT 1");
  EXPECT_EQ(complaint("d.pcd", "FIELDS x x y z\nDATA ascii\n1 2 3 4\n"),
            "d.pcd: FIELDS needs one field \"x\" of COUNT 1");
  EXPECT_EQ(complaint("d.pcd", "FIELDS x y z\nCOLUMNS y x z\nDATA ascii\n1 2 3\n"),
            "d.pcd:2: the header has a second line \"COLUMNS\"; delete one of them");
  EXPECT_EQ(complaint("e.pcd", "FIELDS x y z\nSIZE 4 4\n"),
            "e.pcd:2: SIZE has 2 values for 3 FIELDS");
  EXPECT_EQ(complaint("f.pcd", "FIELDS x y z\nTYPE F F Q\n"),
            "f.pcd:2: TYPE \"Q\" is not F, I or U");
  EXPECT_EQ(complaint("g.pcd", "FIELDS x y z\nSIZE 4 4 3\n"),
            "g.pcd:2: SIZE \"3\" is not 1, 2, 4 or 8");
  EXPECT_EQ(complaint("h.pcd", "FIELDS x y z\nPOINTS -1\n"),
            "h.pcd:2: \"-1\" is not an integer from 0 to 1000000000");
  EXPECT_EQ(complaint("i.pcd", "FIELDS x y z\nPOINTS 1\n"),
            "i.pcd:3: the header has no line DATA; a PCD file needs one");
  EXPECT_EQ(complaint("j.pcd", "FIELDS x y z\nPOINTS 1\nDATA zip\n1 2 3\n"),
            "j.pcd:3: DATA \"zip\" is not ascii, binary or binary_compressed");
  EXPECT_EQ(complaint("k.pcd", pcdHeader("2", "binary") + pcdPoint({1, 2, 3})),
            "k.pcd: the header promises 2 points of 21 bytes, but 21 bytes are left: the file is "
            "cut short");
  const std::string two = "FIELDS x y z\nPOINTS 2\nDATA ascii\n1.5 2.5 3.5\n";
  EXPECT_EQ(complaint("l.pcd", two + "1.5 2.5"),
            "l.pcd:5: a line has 2 numbers; by FIELDS and COUNT a point has 3");
  EXPECT_EQ(complaint("l.pcd", two + "1.5 2.5 3.5 255"),
            "l.pcd:5: a line has 4 numbers; by FIELDS and COUNT a point has 3");
  EXPECT_EQ(complaint("l.pcd", two + "# no point"),
            "l.pcd:5: coordinate \"#\" is not a number; write decimal numbers such as -1.25e-3\n"
            "l.pcd:5: coordinate \"no\" is not a number; write decimal numbers such as -1.25e-3\n"
            "l.pcd:5: coordinate \"point\" is not a number; write decimal numbers such as "
            "-1.25e-3");
  EXPECT_EQ(complaint("l.pcd", two + "1 2 3\n\n4 5 6\n"),
            "l.pcd:7: more points than the 2 that the header promises");
  EXPECT_EQ(complaint("l.pcd", two + "\n\n\n\n"),
            "l.pcd: the header promises 2 points, but the file has 1: it is cut short");
  EXPECT_EQ(complaint("m.pcd", "FIELDS x y z\nPOINTS 9000000\nDATA ascii\n1 2 3\n"),
            "m.pcd: the header promises 9000000 points of 3 numbers; the file is cut short");
  EXPECT_EQ(
      complaint("m.pcd", "FIELDS x y z\nPOINTS 90000000\nDATA ascii\n1 2 3\n"),
      "m.pcd: has 90000000 points or more; a file may have at most 10000000: thin the cloud out");
  EXPECT_EQ(
      complaint("m.ply",
                "ply\nformat ascii 1.0\nelement vertex 90000000\nproperty float x\nproperty "
                "float y\nproperty float z\nend_header\n1 2 3\n"),
      "m.ply: has 90000000 points or more; a file may have at most 10000000: thin the cloud out");
  EXPECT_EQ(complaint("p.pcd", "FIELDS x y z\nWIDTH 3\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n"),
            "p.pcd: POINTS is 1, but WIDTH times HEIGHT is 3");
  EXPECT_EQ(
      complaint("q.pcd", pcdHeader("1", "binary") + pcdPoint({1, 2, 3}) + pcdPoint({1, 2, 3})),
      "q.pcd: 21 bytes come after the last point: the header's counts are wrong");
  EXPECT_EQ(read("r.pcd", pcdHeader("1", "binary") + pcdPoint({1, 2, 3}) + std::string(9, '\0'))
                .points.size(),
            1u)
      << "filled up with zeros";
  EXPECT_EQ(complaint("n.pcd", "hello\n"), "n.pcd:1: \"hello\" is no line of a PCD header");
  EXPECT_EQ(complaint("o.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n"),
            "o.ply: the header has no element \"vertex\"");
}

}  // namespace
}  // namespace corridor::test
