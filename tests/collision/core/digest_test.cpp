// Tests of digests, and of the build id that is part of every key of the cache.
#include "collision/core/digest.h"

#include <array>
#include <cstdio>
#include <string>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

Digest digestOf(std::initializer_list<std::string_view> texts) {
  Digester digester;
  for (const std::string_view text : texts) digester.add(bytesOf(text));
  return digester.result();
}

TEST(Digest, DependsOnEveryByteAndOnTheLengths) {
  const Digest one = digestOf({"ab", "c"});
  EXPECT_EQ(one, digestOf({"ab", "c"}));
  EXPECT_NE(one, digestOf({"a", "bc"}));
  EXPECT_NE(one, digestOf({"abc"}));
  EXPECT_NE(one, digestOf({"ab", "c", ""}));
  std::string text(1000, 'x');
  const Digest before = digestOf({text});
  for (char& c : text) {
    c ^= 1;
    EXPECT_NE(digestOf({text}), before);
    c ^= 1;
  }
}

TEST(Digest, IsXxh3) {
  const Digest empty = Digester().result();  // the value for no bytes in the tests of xxHash
  EXPECT_EQ(empty.high, 0x99aa06d3014798d8U);
  EXPECT_EQ(empty.low, 0x6001c324468d497fU);
}

TEST(Digest, KnowsTheBuildIdThatTheLinkerWrote) {
  std::string expected;
  for (const std::byte b : buildId()) {
    std::array<char, 3> hex{};
    std::snprintf(hex.data(), hex.size(), "%02x", static_cast<unsigned>(b));
    expected += hex.data();
  }
  ASSERT_GE(expected.size(), 16u);
  const auto folder = newFolder();
  const std::string out = folder / "notes.txt";
  const std::string command =
      "readelf -n /proc/" + std::to_string(::getpid()) + "/exe >'" + out + "' 2>/dev/null";
  const int status = std::system(command.c_str());
  const std::string notes = contents(out);
  std::filesystem::remove_all(folder);
  if (status != 0) GTEST_SKIP() << "readelf of binutils is not installed";
  EXPECT_THAT(notes, testing::HasSubstr("Build ID: " + expected));
}

}  // namespace
}  // namespace corridor::test
