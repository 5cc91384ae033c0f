#include "collision/predicates/small_int.h"

#include <cstdint>
#include <random>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::exact {
namespace {

using Reference = boost::multiprecision::cpp_int;

/// Returns a random integer of at most `most` bits. All numbers of bits are equally likely.
std::int64_t any(std::mt19937_64& random, unsigned most) {
  const auto length = static_cast<unsigned>(random() % (most + 1));
  const auto value = static_cast<std::int64_t>(random() & ((1ULL << length) - 1));
  return random() % 2 ? value : -value;
}

/// Compares orientations dot(a, cross(b, c)) with Boost's integers. The entries have up to 62 bits,
/// like differences of coordinates below 2^61. So every product and sum reaches its largest width.
TEST(SmallInt, OrientationsAgreeWithBoost) {
  std::mt19937_64 random(test::testSeed(61));
  int zeros = 0;
  for (int n = 0; n < 200'000 / test::kSlowdown; ++n) {
    std::int64_t x[3][3];
    for (auto& row : x)
      for (auto& value : row) value = any(random, 62);
    if (n % 2)  // nearly or exactly linearly dependent vectors
      for (int k = 0; k < 3; ++k) {
        for (auto& row : x) row[k] >>= 1;
        x[2][k] = x[0][k] + x[1][k];
      }
    if (n % 4 == 1) x[2][n % 3] += 1;
    Reference determinant = 0;
    Int192 sum;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const Int128 minor = Int64(x[1][j]) * Int64(x[2][k]) - Int64(x[1][k]) * Int64(x[2][j]);
      const Reference reference = Reference(x[1][j]) * x[2][k] - Reference(x[1][k]) * x[2][j];
      ASSERT_EQ(minor.sign(), reference.sign());
      ASSERT_EQ(minor.is_zero(), reference == 0);
      ASSERT_EQ((minor * Int64(x[0][i])).sign(), Reference(reference * x[0][i]).sign());
      sum = sum + (i % 2 ? minor * Int64(x[0][i]) : Int64(x[0][i]) * minor);
      determinant += reference * x[0][i];
    }
    ASSERT_EQ(sum.sign(), determinant.sign()) << determinant;
    ASSERT_EQ(sum.is_zero(), determinant == 0);
    zeros += determinant == 0;
    // `sum` is equal to the last bit: adding −determinant = high·2^64 + low gives 0.
    const Reference two64 = Reference(1) << 64;
    Reference low = -determinant % two64;
    if (low < 0) low += two64;
    const Reference high = (-determinant - low) / two64;
    const auto half = [&](const Reference& y) { return static_cast<std::int64_t>(y); };
    const SignedWide top = static_cast<SignedWide>(half(high / (Reference(1) << 62))) << 62;
    const Int192 negative(top + half(high % (Reference(1) << 62)), static_cast<std::uint64_t>(low));
    ASSERT_TRUE((sum + negative).is_zero()) << determinant;
  }
  EXPECT_GT(zeros, 1000 / test::kSlowdown);
}

TEST(SmallInt, SixtyFourBitsCompare) {
  std::mt19937_64 random(test::testSeed(62));
  for (int n = 0; n < 10'000; ++n) {
    const std::int64_t x = any(random, 62), y = n % 5 ? any(random, 62) : x;
    EXPECT_EQ(Int64(x) < Int64(y), x < y);
    EXPECT_EQ(Int64(x) >= Int64(y), x >= y);
    EXPECT_EQ((Int64(x) - Int64(y)).value(), x - y);
    EXPECT_EQ((Int64(x) - Int64(y)).is_zero(), x == y);
  }
}

}  // namespace
}  // namespace corridor::exact
