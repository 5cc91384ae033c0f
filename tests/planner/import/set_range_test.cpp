#include "planner/import/set_range.h"

#include <gmock/gmock.h>

#include "collision/core/error.h"

namespace corridor {
namespace {

using testing::ElementsAre;

TEST(ProblemsOf, Ranges) {
  EXPECT_THAT(problemsOf("set.json#3-5"), ElementsAre("set.json#3", "set.json#4", "set.json#5"));
  EXPECT_THAT(problemsOf("a-b/set.json#3-3"), ElementsAre("a-b/set.json#3"));
  for (const char* text : {"set.json#3", "set.json", "problems/piano", "a#b-c", "#", "set#1-"})
    EXPECT_THAT(problemsOf(text), ElementsAre(text));
  EXPECT_THROW(problemsOf("set.json#5-3"), InputError);
  EXPECT_THROW(problemsOf("set.json#1-1001"), InputError);
  EXPECT_EQ(problemsOf("set.json#1-1000").size(), 1000u);
}

}  // namespace
}  // namespace corridor
