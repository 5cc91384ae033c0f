#include "collision/core/floating_point.h"

#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "collision/course/octree_interference.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/obb4_tree.h"
#include "tests/support/floating_point.h"
#include "tests/support/meshes.h"

namespace corridor {
namespace {

TEST(FloatingPointTest, EverySettingIsDetected) {
  for (const auto& setting : test::floatingPointSettings()) {
    FloatingPoint seen = FloatingPoint::standard, inThread = seen;
    {
      const test::WithFloatingPoint set(setting);
      seen = floatingPoint();
      std::thread([&] { inThread = floatingPoint(); }).join();
    }
    const FloatingPoint expected = setting.shortExtended ? FloatingPoint::precision
                                   : setting.standard()  ? FloatingPoint::standard
                                                         : FloatingPoint::rounding;
    EXPECT_EQ(seen, expected) << setting.name;
    EXPECT_EQ(inThread, expected) << setting.name << ": threads inherit it";
    EXPECT_EQ(floatingPoint(), FloatingPoint::standard) << "after " << setting.name;
  }
}

/// Bodies and trees store bounds that proofs use. Therefore, in a floating-point mode that does not
/// round to nearest, building a body or a tree must fail.
TEST(FloatingPointTest, NothingIsBuiltInOtherFloatingPointModes) {
  TriangleMesh mesh;
  test::add(mesh, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
  const ConvexPart part{{Vec3::Zero()}, 1, false};
  for (const auto& setting : test::floatingPointSettings()) {
    const auto builds = [&](const auto& build) {
      const test::WithFloatingPoint set(setting);
      try {
        build();
      } catch (const std::runtime_error&) {
        return false;
      }
      return true;
    };
    EXPECT_EQ(builds([&] { Body("", mesh); }), setting.standard()) << setting.name;
    EXPECT_EQ(builds([&] { Body("", part); }), setting.standard()) << setting.name;
    EXPECT_EQ(builds([&] { Obb4Tree{mesh}; }), setting.standard()) << setting.name;
    EXPECT_EQ(builds([&] { Obb4Tree{part}; }), setting.standard()) << setting.name;
    EXPECT_EQ(builds([&] { ObbTree{mesh}; }), setting.standard()) << setting.name;
    EXPECT_EQ(builds([&] { ObbTree{part}; }), setting.standard()) << setting.name;
    EXPECT_EQ(builds([&] { Octree(mesh, {}); }), setting.standard()) << setting.name;
  }
}

}  // namespace
}  // namespace corridor
