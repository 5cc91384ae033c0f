#include "planner/problem/digest.h"

#include "collision/core/read_file.h"
#include "planner/problem/sha256.h"

namespace corridor {

std::string digestOf(const Problem& problem) {
  std::string digests;
  for (const std::filesystem::path& file : problem.source.files)
    for (const std::uint8_t byte : sha256(readFile(file, "an input")))
      digests += static_cast<char>(byte);
  return sha256Hex(digests);
}

}  // namespace corridor
