// Tests of numbers in messages.
#include "collision/core/shortest.h"

#include <cmath>

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Shortest, TextsShowWhichNumberIsSmaller) {
  const auto texts = [](double smaller, double larger) {
    const OrderedTexts both = orderedTexts(smaller, larger);
    return both.smaller + " < " + both.larger;
  };
  EXPECT_EQ(texts(0.123456789, 0.2), "0.1235 < 0.2");
  EXPECT_EQ(texts(0.19999, 0.2), "0.19999 < 0.2");
  EXPECT_EQ(texts(0.123405, 0.12341), "0.123405 < 0.12341");
  EXPECT_EQ(texts(0.2 - 1e-9, 0.2), "0.199999999 < 0.2");
  EXPECT_EQ(texts(std::nextafter(0.2, 0), 0.2), "0.19999999999999998 < 0.20000000000000001");
  EXPECT_EQ(texts(-1e-300, 0), "-1e-300 < 0");
}

}  // namespace
}  // namespace corridor
