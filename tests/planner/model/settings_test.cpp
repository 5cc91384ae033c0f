#include "planner/model/settings.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

/// If a method had a name but no value in `EdgeCheck`, it would be taken for `discrete`.
TEST(Settings, EdgesAreCheckedByEveryMethodOrBySamples) {
  EXPECT_EQ(wordOf(EdgeCheck::discrete), "discrete");
  EXPECT_EQ(wordsFor<EdgeCheck>().size(), edgeMethodNames().size() + 1);
  for (const std::string& name : edgeMethodNames()) {
    ASSERT_TRUE(choiceNamed<EdgeCheck>(name)) << name;
    EXPECT_EQ(methodOf(*choiceNamed<EdgeCheck>(name)), edgeMethodNamed(name)) << name;
  }
  EXPECT_EQ(choiceNamed<EdgeCheck>("discrete"), EdgeCheck::discrete);
  EXPECT_EQ(choiceNamed<EdgeCheck>("sampled"), std::nullopt);
}

}  // namespace
}  // namespace corridor
