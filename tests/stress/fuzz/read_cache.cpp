// Fuzz target: files of the cache (collision/core/cache_file.h), with the key that their header
// states.
#include <cstring>
#include <string>
#include <vector>

#include "collision/core/cache_file.h"
#include "tests/stress/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  constexpr std::size_t kKeyAt = 16;  // behind the file's first words
  Digest key;
  if (size >= kKeyAt + sizeof(key)) std::memcpy(&key, data + kKeyAt, sizeof(key));
  const std::string bytes(fuzz::textOf(data, size));
  const auto file = folder.write("a.cache", bytes);
  std::vector<Vec3> points;
  std::vector<std::uint32_t> numbers;
  double value = 0;
  std::string text;
  CacheFileReader reader(file, key);
  reader.take(points);
  reader.take(numbers);
  reader.take(value);
  reader.take(text);
  if (!reader.isWhole()) return 0;
  CacheFileWriter writer;
  writer.put(points);
  writer.put(numbers);
  writer.put(value);
  writer.put(text);
  if (writer.bytes(key) != bytes) fuzz::fail("other bytes than those that were written");
  return 0;
}
