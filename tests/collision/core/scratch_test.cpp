#include "collision/core/scratch.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace corridor {
namespace {

struct First {
  std::vector<int> numbers;
};
struct Second {
  std::vector<int> numbers;
};

TEST(Scratch, OneObjectOfEachType) {
  Scratch scratch;
  First& first = *scratch.use<First>();
  first.numbers = {1, 2, 3};
  EXPECT_TRUE(scratch.use<Second>()->numbers.empty());
  scratch.use<std::vector<double>>()->push_back(4);
  EXPECT_EQ(&*scratch.use<First>(), &first) << "an object keeps its address";
  EXPECT_EQ(first.numbers.size(), 3U);
}

TEST(Scratch, ACopyHasMemoryOfItsOwn) {
  Scratch scratch;
  scratch.use<First>()->numbers = {1};
  Scratch copy(scratch);
  EXPECT_TRUE(copy.use<First>()->numbers.empty());
  copy = scratch;
  EXPECT_NE(&*copy.use<First>(), &*scratch.use<First>());
  const First* const kept = &*scratch.use<First>();
  Scratch moved(std::move(scratch));
  EXPECT_EQ(&*moved.use<First>(), kept);
}

#ifndef NDEBUG
TEST(ScratchDeathTest, OneUserAtATime) {
  Scratch scratch;
  { const auto use = scratch.use<First>(); }
  const auto use = scratch.use<First>();
  const auto other = scratch.use<Second>();
  EXPECT_DEATH({ const auto again = scratch.use<First>(); }, "two users of one scratch object");
}
#endif

}  // namespace
}  // namespace corridor
