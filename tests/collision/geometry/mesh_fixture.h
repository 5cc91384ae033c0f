#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "collision/geometry/mesh_file.h"
#include "tests/support/support.h"

namespace corridor::test {

/// The fixture of tests that write small mesh files. Each test has a folder of its own.
class MeshFileTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  MeshFile read(const std::string& name, const std::string& bytes,
                const MeshFileOptions& options = {}) const {
    return readMeshFile(write(name, bytes), options);
  }

  /// Returns the message of the InputError that `read` throws, without the folder's path.
  template <class Read>
  std::string complaintOf(const Read& read) const {
    try {
      read();
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.string() + '/';
      for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return "no complaint";
  }

  std::string complaint(const std::filesystem::path& file,
                        const MeshFileOptions& options = {}) const {
    return complaintOf([&] { readMeshFile(file, options); });
  }

  std::string complaint(const std::string& name, const std::string& bytes,
                        const MeshFileOptions& options = {}) const {
    return complaint(write(name, bytes), options);
  }

  std::filesystem::path folder_ = newFolder();
};

/// Returns the bytes of a number: the most significant byte first if `bigEndian`, otherwise the
/// least significant.
template <class T>
std::string bytesOf(T value, bool bigEndian = false) {
  std::string bytes;
  if constexpr (std::is_same_v<T, float>) {
    return bytesOf(std::bit_cast<std::uint32_t>(value), bigEndian);
  } else if constexpr (std::is_same_v<T, double>) {
    return bytesOf(std::bit_cast<std::uint64_t>(value), bigEndian);
  } else {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const std::size_t shift = 8 * (bigEndian ? sizeof(T) - 1 - i : i);
      bytes += static_cast<char>(static_cast<std::make_unsigned_t<T>>(value) >> shift);
    }
    return bytes;
  }
}

/// The same tetrahedron as a file of each format.
inline const char* const objTetrahedron =
    "# a comment\nmtllib missing.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\nvn 0 0 "
    "1\n"
    "v 0 0 1\nf 1 3 2\nf 1/1 2/2 4/3\nf 2//1 3//1 4//1\nf -4/1/1 -1/1/1 -2/1/1\n";

inline std::string asciiStlTetrahedron() {
  return "solid a tetrahedron\n"
         "facet normal 0 0 -1\n outer loop\n  vertex 0 0 0\n  vertex 0 1 0\n  vertex 1 0 0\n "
         "endloop\nendfacet\n"
         "facet normal 0 -1 0\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 0 1\n "
         "endloop\nendfacet\n"
         "facet normal nan nan nan\n outer loop\n  vertex 1 0 0\n  vertex 0 1 0\n  vertex 0 0 1\n "
         "endloop\nendfacet\n"
         "facet normal -1 0 0\n outer loop\n  vertex 0 0 0\n  vertex 0 0 1\n  vertex -0 1 0\n "
         "endloop\nendfacet\n"
         "endsolid a tetrahedron\n";
}

inline std::string binaryStlTetrahedron(std::string header = "solid, but binary") {
  header.resize(80, '\0');
  std::string bytes = header + bytesOf<std::uint32_t>(4);
  const float corners[4][3][3] = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                  {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                  {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                  {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
  for (const auto& facet : corners) {
    bytes += std::string(12, '\xff');  // a normal of NaNs, which must not matter
    for (const auto& corner : facet) {
      for (const float x : corner) bytes += bytesOf(x);
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline const char* const asciiPlyTetrahedron =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty "
    "float y\n"
    "property float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\n"
    "element edge 1\nproperty int vertex1\nproperty list uchar float weights\nend_header\n"
    "0 0 0 255\n1 0 0 255\n0 1 0 255\n0 0 1 255\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n0 2 0.5 nan\n";

inline std::string binaryPlyTetrahedron(bool bigEndian) {
  std::string bytes =
      std::string("ply\nformat ") + (bigEndian ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\nobj_info by hand\nelement material 1\nproperty list ushort short numbers\n"
      "element vertex 4\nproperty double x\nproperty int16 unused\nproperty float y\n"
      "property int z\nelement face 4\nproperty uchar flag\n"
      "property list uint8 ushort vertex_index\nend_header\n";
  bytes += bytesOf<std::uint16_t>(2, bigEndian) + bytesOf<std::int16_t>(-1, bigEndian) +
           bytesOf<std::int16_t>(7, bigEndian);
  const int vertices[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& v : vertices) {
    bytes += bytesOf(static_cast<double>(v[0]), bigEndian) + bytesOf<std::int16_t>(-9, bigEndian) +
             bytesOf(static_cast<float>(v[1]), bigEndian) + bytesOf<std::int32_t>(v[2], bigEndian);
  }
  const std::uint16_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  for (const auto& face : faces) {
    bytes += bytesOf<std::uint8_t>(1) + bytesOf<std::uint8_t>(3);
    for (const std::uint16_t corner : face) bytes += bytesOf(corner, bigEndian);
  }
  return bytes;
}

}  // namespace corridor::test
