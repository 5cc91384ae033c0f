#include "tests/support/support.h"

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <system_error>

namespace corridor::test {
namespace {

std::optional<std::filesystem::path> folderFrom(const char* variable) {
  const char* value = std::getenv(variable);
  if (value && std::filesystem::is_directory(value)) return value;
  return std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> dataFolder() {
  if (auto folder = folderFrom("CORRIDOR_DATA")) return folder;
  const std::filesystem::path beside =
      std::filesystem::path(CORRIDOR_SOURCE_DIR) / ".." / "shared" / "data";
  if (std::filesystem::is_directory(beside)) return beside;
  return std::nullopt;
}

std::optional<std::filesystem::path> omplAppFolder() {
  return folderFrom("CORRIDOR_OMPLAPP");
}

bool isStressRun() {
  return std::getenv("CORRIDOR_STRESS") != nullptr;
}

int casesOf(int normally, int stress) {
  return isStressRun() ? stress : normally;
}

std::filesystem::path newFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "corridor_test_XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::system_error(errno, std::generic_category(), name);
  return name;
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::uint64_t testSeed(std::uint64_t fallback) {
  const char* value = std::getenv("CORRIDOR_SEED");
  const std::uint64_t seed = value ? std::stoull(value) : fallback;
  std::cout << "seed " << seed << " (CORRIDOR_SEED selects another)\n";
  return seed;
}

}  // namespace corridor::test
