#include "collision/geometry/convex_part.h"

#include <limits>

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Primitive, Complaints) {
  const double inf = std::numeric_limits<double>::infinity(), nan = inf - inf;
  EXPECT_EQ(checkPrimitive(Box{Vec3(1, 2, 3)}), std::nullopt);
  EXPECT_EQ(checkPrimitive(Box{Vec3(1, 0, 3)}),
            "a box's three edge lengths must be positive and finite, not 1 0 3");
  EXPECT_EQ(checkPrimitive(Sphere{-0.5}),
            "a sphere's radius must be positive and finite, not -0.5");
  EXPECT_EQ(checkPrimitive(Capsule{inf, 1}),
            "a capsule's radius and length must be positive and finite, not inf 1");
  EXPECT_EQ(checkPrimitive(Cylinder{1, 0}),
            "a cylinder's radius and length must be positive and finite, not 1 0");
  EXPECT_EQ(checkPrimitive(Convex{}), "a convex shape needs at least one point");
  EXPECT_EQ(checkPrimitive(Convex{{Vec3::Zero(), Vec3(0, nan, 0)}}),
            "point 1 (counted from 0) of a convex shape is not finite");
  EXPECT_EQ(checkPrimitive(Convex{{Vec3::Zero()}}), std::nullopt);
}

TEST(Primitive, NamesAndParts) {
  EXPECT_EQ(nameOf(Cylinder{1, 1}), "cylinder");
  const Transform X{Mat3::Identity(), Vec3(1, 2, 3)};
  const ConvexPart can = placed(Cylinder{0.5, 2}, X);
  ASSERT_EQ(can.points.size(), 2U);
  EXPECT_EQ(can.points[0], Vec3(1, 2, 2));
  EXPECT_EQ(can.points[1], Vec3(1, 2, 4));
  EXPECT_TRUE(can.flatEnds);
  EXPECT_EQ(can.radius, 0.5);
  const ConvexPart box = placed(Box{Vec3(2, 4, 6)}, X);
  ASSERT_EQ(box.points.size(), 8U);
  EXPECT_EQ(box.points[0], Vec3(0, 0, 0));
  EXPECT_EQ(box.points[7], Vec3(2, 4, 6));
}

}  // namespace
}  // namespace corridor
