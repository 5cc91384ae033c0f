#include <gtest/gtest.h>

#include "collision/motion/edge_method.h"

namespace corridor {
namespace {

TEST(EdgeMethodNames, AreThoseOfTheEnumeration) {
  EXPECT_EQ(edgeMethodNames().size(), 4u);
  EXPECT_EQ(edgeMethodNamed("certified"), EdgeMethod::certified);
  EXPECT_EQ(edgeMethodNamed("adaptive"), EdgeMethod::adaptive);
  EXPECT_EQ(edgeMethodNamed("advancement"), EdgeMethod::advancement);
  EXPECT_EQ(edgeMethodNamed("discrete"), EdgeMethod::discrete);
  EXPECT_FALSE(edgeMethodNamed("sampled"));
  for (const std::string& name : provingMethodNames()) EXPECT_TRUE(proves(*edgeMethodNamed(name)));
  EXPECT_EQ(provingMethodNames().size(), 3u);
  EXPECT_FALSE(proves(EdgeMethod::discrete));
}

}  // namespace
}  // namespace corridor
