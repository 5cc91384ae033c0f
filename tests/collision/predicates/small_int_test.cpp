#include "collision/predicates/small_int.h"

#include <random>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::exact {
namespace {

using Reference = boost::multiprecision::cpp_int;

template <class Int>
class SmallInt : public testing::Test {};
using Types = testing::Types<Int128, Int256>;
TYPED_TEST_SUITE(SmallInt, Types);

/// Sums, differences, products, shifts and comparisons of numbers of all lengths that don't wrap,
/// against Boost's: both are built from the same 64-bit numbers.
TYPED_TEST(SmallInt, AgreesWithBoost) {
  const unsigned bits = std::is_same_v<TypeParam, Int128> ? 127 : 255;
  std::mt19937_64 random(test::testSeed(61));
  const auto any = [&](unsigned most) {
    const auto length = static_cast<unsigned>(random() % (most + 1));
    TypeParam value(0);
    Reference reference = 0;
    for (unsigned left = length; left > 0;) {  // |value| < 2^length
      const unsigned part = std::min(left, 62U);
      const auto digit = static_cast<std::int64_t>(random() & ((1ULL << part) - 1));
      value <<= part;
      value += TypeParam(digit);
      reference = (reference << part) + digit;
      left -= part;
    }
    if (random() % 2) {
      value = TypeParam(0) - value;
      reference = -reference;
    }
    return std::pair(value, reference);
  };
  const auto same = [](const TypeParam& value, const Reference& reference) {
    // What is left after taking the reference away, digit by digit.
    TypeParam rebuilt(0);
    const Reference size = abs(reference);
    for (int i = 4; i >= 0; --i) {
      rebuilt <<= 60;
      rebuilt +=
          TypeParam(static_cast<std::int64_t>((size >> (60 * i)) & ((Reference(1) << 60) - 1)));
    }
    if (reference < 0) rebuilt = TypeParam(0) - rebuilt;
    return rebuilt == value && value.sign() == reference.sign() &&
           value.is_zero() == (reference == 0);
  };
  for (int n = 0; n < 100'000 / test::kSlowdown; ++n) {
    const auto [a, x] = any(bits - 1);
    const auto [b, y] = any(bits - 1);
    ASSERT_TRUE(same(a, x) && same(b, y));
    ASSERT_TRUE(same(a + b, x + y));
    ASSERT_TRUE(same(a - b, x - y));
    ASSERT_EQ(a < b, x < y);
    ASSERT_EQ(a >= b, x >= y);
    ASSERT_EQ(a == b, x == y);
    const auto [c, z] = any(bits / 2);
    const auto [d, w] = any(bits / 2);
    ASSERT_TRUE(same(c * d, z * w));
    const auto shift = static_cast<unsigned>(random() % (bits / 2));
    TypeParam shifted = c;
    shifted <<= shift;
    ASSERT_TRUE(same(shifted, z << shift));
  }
}

}  // namespace
}  // namespace corridor::exact
