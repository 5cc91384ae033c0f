// Tests that no motion exceeds the bounds that `motionBound` derives from EdgeMotion's screws, and
// that some motions attain them.
#include <functional>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "planner/robot/edge_motion.h"
#include "tests/planner/robot/random_trees.h"
#include "tests/planner/robot/reference_kinematics.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::LongReal;
using test::RandomTrees;
using test::ReferenceKinematics;
using test::Vec3L;

/// Moves both ends of an edge such that the whole moved edge stays within the tube around the
/// original edge.
void stray(RandomTrees& random, const Configuration& tube, Configuration& from, Configuration& to) {
  for (const Coordinate& c : random.space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    // Slightly less than the tube, to allow for the rounding of this function.
    const double by = 0.999 * tube[i] * (random.oneIn(2) ? 1 : random.real());
    if (c.kind == Coordinate::Kind::rotation) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(by, random.direction()));
      for (Configuration* q : {&from, &to})
        q->segment<4>(i) = (turn * Eigen::Quaterniond(q->data() + i)).coeffs();
    } else {
      from[i] += by;
      to[i] += by;
    }
  }
}

/// At every time of the interval, the motion of every point stays within the isotropic bound. Along
/// any direction it stays within the first-order motion plus the remainder. This also holds with
/// perturbations within the tube.
TEST(ChainBound, IsNeverExceeded) {
  RandomTrees random(test::testSeed(1));
  const int count = test::casesOf(32'000, 2'000'000);
  double tightest = 0, tightestAlong = 0, tightestStray = 0;
  for (int n = 0; n < count; ++n) {
    if (n % 5 == 0) random.makeTree(1 + random.randomIndex(8));
    random.makeEdge(n % 3 == 0 ? 8 : 1);
    const Scene::FramePair pair[] = {random.pair()};
    Configuration tube = random.noTube();
    const bool strays = n % 2 == 0;
    if (strays)
      for (double& number : tube)
        number = random.oneIn(3) ? 0 : std::pow(10.0, random.real(-6, -1));
    EdgeMotion motion(random.tree, random.space, pair, tube);
    motion.set(random.from, random.to);
    if (motion.ambiguous()) continue;
    const double h = std::ldexp(0.5, -static_cast<int>(random.randomIndex(8)));
    const double t = h + 2 * h * std::floor(random.real(0, 0.5 / h));
    const RelativeMotion w = motion.relativeMotion(0, t, h);
    const Vec3 p = random.vector(n % 7 ? 1 : 100), direction = random.direction();
    const Vec3 x = w.X_AB * p, y = w.X_AB.m * p;
    const MotionBound bound = motionBound(w, x, 0);
    // A point of a sphere about x stays within the bound of the sphere.
    const Vec3 other = p + random.real(0, 1) * random.direction();
    const double radius = (other - p).norm() * (1 + 1e-12);
    const MotionBound ball = motionBound(w, x, radius);
    Configuration from = random.from, to = random.to;
    stray(random, tube, from, to);
    const ReferenceKinematics reference(random.tree, random.space, from, to);
    const double noise = 1e-17 * (1 + p.norm() + x.norm());  // rounding of the reference
    for (const double s : {-1.0, 1.0, random.real(), 0.0}) {
      const auto real = reference.relative(pair[0].a, pair[0].b, t + static_cast<LongReal>(s) * h);
      const Vec3L moved = real.at(p) - test::exactly(w.X_AB, p);
      const Vec3L otherMoved = real.at(other) - test::exactly(w.X_AB, other);
      ASSERT_LE(moved.norm(), bound.isotropic + bound.pad + noise) << "case " << n;
      ASSERT_LE(otherMoved.norm(), ball.isotropic + ball.pad + noise) << "case " << n;
      const Vec3 step = s * (w.linear + w.angular.cross(y));
      const auto off = static_cast<double>(
          std::abs((moved - step.cast<LongReal>()).dot(direction.cast<LongReal>())));
      const double remainder = bound.secondOrderAcross * direction.cross(w.angular).norm() +
                               bound.secondOrder + bound.pad;
      ASSERT_LE(off, remainder + noise) << "case " << n;
      const auto way = static_cast<double>(moved.norm());
      if (!strays && way > 1e-3) tightest = std::max(tightest, way / (bound.isotropic + bound.pad));
      if (!strays && off > 1e-3) tightestAlong = std::max(tightestAlong, off / remainder);
      if (strays && s == 0 && way > 1e-6) tightestStray = std::max(tightestStray, way / bound.pad);
    }
  }
  std::cout << "share of the bounds: isotropic " << tightest << ", remainder " << tightestAlong
            << ", tube " << tightestStray << '\n';
  EXPECT_GT(tightest, 0.999);
  EXPECT_GT(tightestAlong, 0.9);
  EXPECT_GT(tightestStray, 0.9);
}

/// A chain of joints on which a random search looks for a motion that attains the bound.
struct Chain {
  const char* name;
  std::function<Scene::FramePair(KinematicTree&)> build;
  std::size_t variables;
  double share;  ///< the part of the bound that must be attained, from 0 to 1
};

std::size_t addJoint(KinematicTree& tree, std::size_t parent, Frame::Joint joint, const Vec3& axis,
                     std::size_t variable, const Vec3& offset = {1, 0, 0}, double multiplier = 1) {
  Frame frame;
  frame.parent = parent;
  frame.fixed.p = offset;
  frame.joint = joint;
  frame.axis = axis;
  frame.variable = variable;
  frame.multiplier = multiplier;
  return tree.add(frame);
}

TEST(ChainBound, IsAttained) {
  using Joint = Frame::Joint;
  const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();
  const Chain chains[] = {
      {"one turn",
       [=](KinematicTree& tree) {
         return Scene::FramePair{0, addJoint(tree, 0, Joint::revolute, Z, 0)};
       },
       1, 0.99},
      {"parallel axes",
       [=](KinematicTree& tree) {
         std::size_t f = addJoint(tree, 0, Joint::revolute, Z, 0);
         f = addJoint(tree, f, Joint::revolute, Z, 1);
         return Scene::FramePair{0, addJoint(tree, f, Joint::revolute, Z, 2)};
       },
       3, 0.99},
      {"intersecting axes",
       [=](KinematicTree& tree) {
         const std::size_t f = addJoint(tree, 0, Joint::revolute, Z, 0);
         return Scene::FramePair{0, addJoint(tree, f, Joint::revolute, Y, 1, Vec3::Zero())};
       },
       2, 0.99},
      {"slide after turn",
       [=](KinematicTree& tree) {
         const std::size_t f = addJoint(tree, 0, Joint::revolute, Z, 0);
         return Scene::FramePair{0, addJoint(tree, f, Joint::prismatic, Y, 1)};
       },
       2, 0.99},
      {"turn after slide",
       [=](KinematicTree& tree) {
         const std::size_t f = addJoint(tree, 0, Joint::prismatic, X, 0);
         return Scene::FramePair{0, addJoint(tree, f, Joint::revolute, Z, 1)};
       },
       2, 0.99},
      {"two branches",
       [=](KinematicTree& tree) {
         const std::size_t a = addJoint(tree, 0, Joint::revolute, Z, 0);
         const std::size_t b = addJoint(tree, 0, Joint::revolute, Z, 1, -X);
         return Scene::FramePair{a, b};
       },
       2, 0.99},
      {"mimic on another branch",
       [=](KinematicTree& tree) {
         const std::size_t a = addJoint(tree, 0, Joint::revolute, Z, 0);
         const std::size_t b = addJoint(tree, 0, Joint::revolute, Z, 0, -X, -0.8);
         return Scene::FramePair{a, b};
       },
       1, 0.99},
      {"arm of six",
       [=](KinematicTree& tree) {
         std::size_t f = addJoint(tree, 0, Joint::revolute, Z, 0);
         f = addJoint(tree, f, Joint::revolute, Y, 1, {0, 0, 1});
         f = addJoint(tree, f, Joint::revolute, Y, 2);
         f = addJoint(tree, f, Joint::revolute, Z, 3);
         f = addJoint(tree, f, Joint::revolute, Y, 4, Vec3::Zero());
         return Scene::FramePair{0, addJoint(tree, f, Joint::revolute, Z, 5, Vec3::Zero())};
       },
       6, 0.95},
  };
  RandomTrees random(test::testSeed(2));
  for (const Chain& chain : chains) {
    KinematicTree tree;
    const Scene::FramePair pair[] = {chain.build(tree)};
    ConfigurationSpace space;
    for (std::size_t i = 0; i < chain.variables; ++i) space.add({});
    const auto count = static_cast<Eigen::Index>(chain.variables);
    EdgeMotion motion(tree, space, pair, Configuration::Zero(count));
    // The entries of v are the configuration at the middle, then the half steps (up to more than
    // π), then the point.
    const auto share = [&](const Eigen::VectorXd& v) {
      const Configuration from = v.head(count) - v.segment(count, count),
                          to = v.head(count) + v.segment(count, count);
      motion.set(from, to);
      const RelativeMotion w = motion.relativeMotion(0, 0.5, 0.5);
      const Vec3 p = v.tail<3>();
      const MotionBound bound = motionBound(w, w.X_AB * p, 0);
      const Vec3L moved =
          ReferenceKinematics(tree, space, from, to).relative(pair[0].a, pair[0].b, 1).at(p) -
          test::exactly(w.X_AB, p);
      EXPECT_LE(moved.norm(), bound.isotropic + bound.pad) << chain.name;
      return static_cast<double>(moved.norm()) / bound.isotropic;
    };
    double attained = 0;
    for (int start = 0; start < 20 && attained < 0.999; ++start) {
      Eigen::VectorXd v(2 * count + 3);
      for (double& number : v) number = random.real(-3, 3);
      for (Eigen::Index i = 0; i < count; ++i) v[count + i] = random.real(0.3, 4);
      double best = share(v);
      for (int i = 0; i < 4000; ++i) {
        Eigen::VectorXd next = v;
        const double size = std::pow(10.0, random.real(-4, 0));
        for (double& number : next)
          if (random.oneIn(2)) number += size * random.real();
        // Excludes tiny steps: they attain the bound trivially, because its first-order term
        // dominates.
        for (Eigen::Index k = 0; k < count; ++k) next[count + k] = std::max(0.3, next[count + k]);
        if (const double s = share(next); s > best) {
          best = s;
          v = next;
        }
      }
      attained = std::max(attained, best);
    }
    std::cout << chain.name << ": " << attained << " of the bound\n";
    EXPECT_GT(attained, chain.share) << chain.name;
  }
}

}  // namespace
}  // namespace corridor
