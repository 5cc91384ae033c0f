#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// Two triangles, and whether they touch in real arithmetic.
struct KnownPair {
  Triangle a, b;
  bool touch = false;
};

/// The pairs of triangles in one file of the shared data.
struct KnownPairs {
  std::string name;
  std::vector<KnownPair> pairs;
};
/// Reads all files of the folder `tripairs` in the shared collision data. Returns them sorted by
/// name.
std::vector<KnownPairs> sharedPairs(const std::filesystem::path& collisionFolder);

}  // namespace corridor::test
