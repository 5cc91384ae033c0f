#include "collision/core/nearest.h"

#include <gtest/gtest.h>

namespace corridor::test {
namespace {

TEST(EditDistance, CountsChanges) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("checkr", "checker"), 1u);
  EXPECT_EQ(editDistance("rnage", "range"), 1u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(editDistance("ca", "abc"), 3u);  // optimal string alignment, not Damerau's 2
}

TEST(Nearest, SuggestsOnlyWhatMayBeMeant) {
  const std::vector<std::string> planners{"RRT", "RRTConnect", "PRM", "KPIECE1"};
  EXPECT_EQ(nearest("rrtconect", planners), "RRTConnect");
  EXPECT_EQ(nearest("KPIECE", planners), "KPIECE1");
  EXPECT_EQ(nearest("prm", planners), "PRM");
  EXPECT_EQ(nearest("RTT", planners), "RRT");
  EXPECT_EQ(nearest("w", {"x", "y"}), std::nullopt);
  EXPECT_EQ(nearest("AStar", planners), std::nullopt);
  EXPECT_EQ(nearest(std::string(100000, 'R'), planners), std::nullopt);
  EXPECT_EQ(didYouMean("rrt", planners), "; did you mean \"RRT\"?");
  EXPECT_EQ(didYouMean("dijkstra", planners), "");
}

TEST(Nearest, QuotesForMessages) {
  EXPECT_EQ(quotedWord("a\nb"), "\"a?b\"");
  EXPECT_EQ(quotedWord("Tür"), "\"Tür\"");
  EXPECT_EQ(quotedWord(std::string(59, 'x') + "ü"), "\"" + std::string(59, 'x') + "…\"");
}

}  // namespace
}  // namespace corridor::test
