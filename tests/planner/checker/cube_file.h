#pragma once

#include <filesystem>
#include <fstream>

namespace corridor::test {

/// Writes `cube.obj`, a closed cube of size 2.
inline void writeCube(const std::filesystem::path& folder) {
  std::ofstream out(folder / "cube.obj");
  for (int i = 0; i < 8; ++i)
    out << "v " << (i & 1 ? 1 : -1) << ' ' << (i & 2 ? 1 : -1) << ' ' << (i & 4 ? 1 : -1) << '\n';
  out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

}  // namespace corridor::test
