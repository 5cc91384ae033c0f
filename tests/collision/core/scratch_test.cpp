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
  First& first = scratch.of<First>();
  first.numbers = {1, 2, 3};
  EXPECT_TRUE(scratch.of<Second>().numbers.empty());
  scratch.of<std::vector<double>>().push_back(4);
  EXPECT_EQ(&scratch.of<First>(), &first) << "an object keeps its address";
  EXPECT_EQ(first.numbers.size(), 3U);
}

TEST(Scratch, ACopyHasMemoryOfItsOwn) {
  Scratch scratch;
  scratch.of<First>().numbers = {1};
  Scratch copy(scratch);
  EXPECT_TRUE(copy.of<First>().numbers.empty());
  copy = scratch;
  EXPECT_NE(&copy.of<First>(), &scratch.of<First>());
  const First* const kept = &scratch.of<First>();
  Scratch moved(std::move(scratch));
  EXPECT_EQ(&moved.of<First>(), kept);
}

}  // namespace
}  // namespace corridor
