#include "collision/core/decimal_number.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(DecimalNumber, TheNearestDouble) {
  EXPECT_EQ(decimalNumber("-1.25e-3"), -0.00125);
  EXPECT_EQ(decimalNumber("+.5"), 0.5);
  EXPECT_EQ(decimalNumber("0.1000000000000000055511151231257827021181583404541015625"), 0.1);
  EXPECT_EQ(decimalNumber("4e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(decimalNumber("-1e-400"), 0);
  EXPECT_EQ(decimalNumber("1e400"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(decimalNumber("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(decimalNumber("-inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(decimalNumber("nan").value()));
}

TEST(DecimalNumber, OtherWords) {
  for (const char* word :
       {"", "+", "-", "+-1", "++1", "1,5", "1 ", " 1", "0x10", "1e", "1.5m", "one"})
    EXPECT_EQ(decimalNumber(word), std::nullopt) << word;
}

}  // namespace
}  // namespace corridor
