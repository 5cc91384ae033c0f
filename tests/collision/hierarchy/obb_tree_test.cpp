#include "collision/hierarchy/obb_tree.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/core/query_context.h"
#include "collision/queries/interference.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::add;

class Fits : public testing::TestWithParam<ObbFit> {};

TEST_P(Fits, ContainsItsTrianglesInRationals) {
  std::mt19937_64 random(test::testSeed(1));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  for (const double offset : {0.0, 1e6, 1e12}) {
    TriangleMesh mesh;
    for (int i = 0; i < 300; ++i) {
      const Vec3 c(offset + real(), real(), -offset + real());
      const double s = std::exp(3 * real() - 3);
      add(mesh, c, c + s * Vec3(real(), real(), real()),
          c + s * Vec3(real(), real(), real() * (i % 3)));
    }
    EXPECT_EQ(test::treeFault(ObbTree(mesh, {GetParam()})), std::nullopt) << offset;
  }
}

TEST_P(Fits, SharedMeshes) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const char* name :
       {"pqp_bunny", "slivers_A", "soup_far_A", "soup_tiny_B", "touching_boxes_B", "panda_hand"}) {
    const ObbTree tree(
        test::plainObj(*data / "collision" / "meshes" / (std::string(name) + ".obj")),
        {GetParam()});
    EXPECT_EQ(test::treeFault(tree), std::nullopt) << name;
  }
}

/// Triangles of size 2^-i around a point make a tree whose depth is about the number of triangles.
TEST_P(Fits, DeepTreesNeedNoCallStack) {
  TriangleMesh mesh;
  // Each node computes the hull of its triangles, so a deep tree takes quadratic time with hulls.
  const int count = GetParam() == ObbFit::hull ? test::casesOf(300, 1'000) : 1'000;
  for (int i = 0; i < count; ++i) {
    const double s = std::ldexp(1.0, -i);
    add(mesh, Vec3(s, 0, 0), Vec3(s, s / 4, 0), Vec3(s, 0, s / 4));
  }
  const ObbTree tree(mesh, {GetParam()});
  EXPECT_GT(tree.depth(), 100U);
  QueryContext context;
  EXPECT_TRUE(interference(Posed(tree), Posed(tree), context));
  EXPECT_FALSE(interference(Posed(tree), Posed(tree, {Mat3::Identity(), Vec3(0, 0, 2)}), context));
}

TEST_P(Fits, IdenticalTrianglesAreOneLeaf) {
  TriangleMesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.triangles.assign(10'000, {0, 1, 2});
  const ObbTree tree(mesh, {GetParam()});
  EXPECT_EQ(tree.nodes().size(), 1U);
  EXPECT_TRUE(tree.node(0).isLeaf());
}

TEST_P(Fits, SinglePointAndSegment) {
  TriangleMesh point;
  add(point, Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3));
  const ObbTree tree(point, {GetParam()});
  EXPECT_EQ(test::treeFault(tree), std::nullopt);
  EXPECT_LT(tree.node(0).radius, 1e-14);
  TriangleMesh segment;
  add(segment, Vec3(0, 0, 0), Vec3(3, 4, 0), Vec3(3, 4, 0));
  EXPECT_EQ(test::treeFault(ObbTree(segment, {GetParam()})), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(All, Fits,
                         testing::Values(ObbFit::vertices, ObbFit::triangles, ObbFit::hull),
                         [](const auto& p) {
                           return p.param == ObbFit::vertices    ? "vertices"
                                  : p.param == ObbFit::triangles ? "triangles"
                                                                 : "hull";
                         });

/// The tree of a primitive is one leaf. Its box contains the primitive, and is tight.
TEST(ObbTree, OfAConvexPart) {
  std::mt19937_64 random(test::testSeed(6));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (int n = 0; n < 400; ++n) {
    const double thin = n % 7 == 0 ? 1e-6 : 1, offset = n % 3 == 0 ? 1e6 : 1;
    const double r = thin * real(0.1, 1), l = (n % 2 ? thin : 1) * real(0.1, 1);
    Primitive p;
    double wanted = 0;  // expected sum of half extents
    switch (n % 5) {
      case 0:
        p = Box{Vec3(l, r, 0.5)}, wanted = (l + r + 0.5) / 2;
        break;
      case 1:
        p = Sphere{r}, wanted = 3 * r;
        break;
      case 2:
        p = Capsule{r, l}, wanted = 3 * r + l / 2;
        break;
      case 3:
        p = Cylinder{r, l}, wanted = 2 * r + l / 2;
        break;
      default: {
        Convex hull;
        for (int i = 0; i < 1 + n % 30; ++i) hull.points.emplace_back(real(), real() * l, real());
        p = hull;
        wanted = 6;
      }
    }
    const Transform X{
        Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix(),
        offset * Vec3(real(), real(), real())};
    const ConvexPart part = placed(p, X);
    const ObbTree tree(part);
    EXPECT_EQ(test::treeFault(tree), std::nullopt) << nameOf(p) << " " << n;
    ASSERT_EQ(tree.nodes().size(), 1U);
    EXPECT_TRUE(tree.node(0).isLeaf());
    ASSERT_TRUE(tree.hasParts());
    EXPECT_TRUE(tree.triangles().empty());
    for (const Vec3& q : part.points) EXPECT_GE(tree.reach(), q.norm() + part.radius);
    EXPECT_LE(tree.node(0).box.half.sum(), wanted * (1 + 1e-9) + 1e-14 * offset) << nameOf(p);
  }
}

/// The fits of a box by triangles and by the hull depend on the shape, not on its tessellation. If
/// one face of a cube is refined a thousandfold, the moments of the surface and of the hull must
/// not change.
TEST(ObbFrame, MomentsIgnoreTessellation) {
  const Vec3 size(4, 2, 1);
  const auto cube = [&](int n) {  // the face x = 4 has n × n cells, each other face has one cell
    std::vector<Triangle> all;
    const auto quad = [&](Vec3 p, Vec3 u, Vec3 v) {
      all.push_back({p, p + u, p + u + v});
      all.push_back({p, p + u + v, p + v});
    };
    const Vec3 x(size[0], 0, 0), y(0, size[1], 0), z(0, 0, size[2]), o(0, 0, 0);
    quad(o, x, y), quad(z, x, y), quad(o, x, z), quad(y, x, z), quad(o, y, z);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) quad(x + y * i / n + z * k / n, y / n, z / n);
    return all;
  };
  for (const ObbFit fit : {ObbFit::triangles, ObbFit::hull}) {
    const ObbFrame coarse = fitFrame(cube(1), fit), fine = fitFrame(cube(32), fit);
    EXPECT_LT((coarse.mean - fine.mean).norm(), 1e-13);
    for (int k = 0; k < 3; ++k)
      EXPECT_GT(std::abs(coarse.axes.col(k).dot(fine.axes.col(k))), 1 - 1e-13);
    EXPECT_GT(std::abs(fine.axes(0, 0)), 1 - 1e-13) << "longest axis first";
  }
  // The fit by vertices does depend on the tessellation: the fine face dominates.
  EXPECT_GT(
      (fitFrame(cube(1), ObbFit::vertices).mean - fitFrame(cube(32), ObbFit::vertices).mean).norm(),
      1.0);
}

/// Triangles inside the hull change the moments of the triangles, but not those of the hull.
TEST(ObbFrame, HullIgnoresInnerGeometry) {
  std::mt19937_64 random(test::testSeed(2));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  std::vector<Triangle> shell;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < i; ++k)
      shell.push_back({Vec3(i & 1 ? 3 : -3, i & 2 ? 2 : -2, i & 4 ? 1 : -1),
                       Vec3(k & 1 ? 3 : -3, k & 2 ? 2 : -2, k & 4 ? 1 : -1), Vec3(0, 0, 0)});
  std::vector<Triangle> filled = shell;
  for (int i = 0; i < 500; ++i)  // a dense needle along z inside
    filled.push_back({Vec3(0.1 * real(), 0.1 * real(), real()),
                      Vec3(0.1 * real(), 0.1 * real(), real()), Vec3(0, 0, real())});
  const ObbFrame a = fitFrame(shell, ObbFit::hull), b = fitFrame(filled, ObbFit::hull);
  for (int k = 0; k < 3; ++k) EXPECT_GT(std::abs(a.axes.col(k).dot(b.axes.col(k))), 1 - 1e-9);
  EXPECT_GT(std::abs(b.axes(0, 0)), 1 - 1e-9);
}

TEST(ObbFrame, FlatInputFallsBack) {
  std::vector<Triangle> flat;
  for (int i = 0; i < 10; ++i) flat.push_back({Vec3(i, 0, 5), Vec3(i + 1, 0, 5), Vec3(i, 1, 5)});
  const ObbFrame frame = fitFrame(flat, ObbFit::hull);
  EXPECT_GT(std::abs(frame.axes(0, 0)), 0.99);
  EXPECT_LT(enclosingObb(flat, frame.axes).half[2], 1e-12);
}

}  // namespace
}  // namespace corridor
