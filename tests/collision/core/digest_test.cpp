// Tests of digests.
#include "collision/core/digest.h"

#include <initializer_list>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace corridor::test
