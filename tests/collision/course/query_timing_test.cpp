#include "collision/course/query_timing.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

/// Makes `count` additions, each of which needs the result of the previous addition.
double work(int count) {
  volatile double x = 0;
  for (int i = 0; i < count; ++i) x = x + 1;
  return x;
}

TEST(QueryTiming, QuickCallsAreRepeatedAndSlowOnesAreNot) {
  int first = 0, again = 0;
  const double quick = nanosecondsOf([&] { ++first; }, [&] { again += work(10) > 0; });
  EXPECT_EQ(first, 1);
  EXPECT_GT(again, 10);
  EXPECT_LT(quick, kRepeatBelow);
  first = again = 0;
  const double slow = nanosecondsOf([&] { first += work(10'000'000) > 0; }, [&] { ++again; });
  EXPECT_EQ(first, 1);
  EXPECT_EQ(again, 0);
  EXPECT_GT(slow, 1e6);  // no processor makes 10 dependent additions per nanosecond
}

}  // namespace
}  // namespace corridor
