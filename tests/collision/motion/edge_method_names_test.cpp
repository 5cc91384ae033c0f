#include <gtest/gtest.h>

#include "collision/motion/edge_method.h"

namespace corridor {
namespace {

TEST(EdgeMethodNames, AreThoseOfTheEnumeration) {
  EXPECT_EQ(edgeMethodNames().size(), 3u);
  EXPECT_EQ(edgeMethodNamed("certified"), EdgeMethod::directional);
  EXPECT_EQ(edgeMethodNamed("adaptive"), EdgeMethod::adaptive);
  EXPECT_EQ(edgeMethodNamed("advancement"), EdgeMethod::advancement);
  EXPECT_FALSE(edgeMethodNamed("discrete"));
}

}  // namespace
}  // namespace corridor
