// Tests that compare the relative motions of frames with independent kinematics in long double.
#include "planner/robot/edge_motion.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "collision/motion/rigid_motion.h"
#include "planner/robot/moving_joint.h"
#include "tests/planner/robot/random_trees.h"
#include "tests/planner/robot/reference_kinematics.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::LongReal;
using test::MovingPose;
using test::RandomTrees;
using test::ReferenceKinematics;

using std::numbers::pi;

/// Returns the middle and the half width of a random time interval; like those of `certifyMotion`,
/// they are exact doubles.
std::pair<double, double> interval(RandomTrees& random) {
  const double h = std::ldexp(0.5, -static_cast<int>(random.randomIndex(12)));
  return {h + 2 * h * std::floor(random.real(0, 0.5 / h)), h};
}

/// Returns the rounding error of the reference: some 100 roundings of 2^-64.
double noise(const MovingPose& real, double reach) {
  return 1e-17 * (1 + reach + static_cast<double>(real.t.norm()));
}

/// The rotation error of the constant poses before a prismatic joint displaces everything after the
/// joint, in proportion to the joint's translation.
TEST(EdgeMotion, APrismaticJointInheritsTheErrorOfTheConstantPosesBeforeIt) {
  LongPose fixed;
  Frame frame;
  frame.fixed.q = Eigen::AngleAxisd(0.1, Vec3::UnitX());
  for (int i = 0; i < 3000; ++i) fixed = fixed.then(frame);
  frame.joint = Frame::Joint::prismatic;
  frame.variable = 0;
  const Configuration none = Configuration::Zero(1);
  MovingJoint joint(frame, fixed, Coordinate::Kind::line, none);
  const Configuration from = Configuration::Constant(1, 3);
  const Configuration to = Configuration::Constant(1, -8);
  joint.set(from, to);
  EXPECT_GE(joint.shiftError(), 8 * fixed.error);
}

/// With a tube of zero, the errors of the positions and of the first-order displacements of all
/// points y are at most fixedError + reachError·|y|, as the header promises.
TEST(EdgeMotion, PosesAndTwistsAreWithinTheirStatedError) {
  RandomTrees random(test::testSeed(1));
  double worst = 0, worstTwist = 0;  // the largest error divided by its bound
  std::vector<double> shares;
  const int count = test::casesOf(50'000, 1'000'000);
  for (int n = 0; n < count; ++n) {
    if (n % 5 == 0) random.makeTree(1 + random.randomIndex(12), n % 7 ? 1 : 1000);
    random.makeEdge(n % 3 ? 2 : 20, n % 11 ? 3 : 100);
    const Scene::FramePair pair[] = {random.pair()};
    EdgeMotion motion(random.tree, random.space, pair, random.noTube());
    motion.set(random.from, random.to);
    const ReferenceKinematics reference(random.tree, random.space, random.from, random.to);
    const auto [t, h] = interval(random);
    const MovingPose real = reference.relative(pair[0].a, pair[0].b, t);
    for (const double half : {0.0, h}) {
      const RelativeMotion w = motion.relativeMotion(0, t, half);
      const Vec3 p = random.vector(n % 2 ? 3 : 0.01);
      const Vec3 y = w.X_AB.m * p;
      const double bound = w.fixedError + w.reachError * y.norm() + noise(real, p.norm());
      const auto off = static_cast<double>((test::exactly(w.X_AB, p) - real.at(p)).norm());
      ASSERT_LE(off, bound) << "case " << n << ", t = " << t;
      if (half == 0) {
        worst = std::max(worst, off / bound);
        shares.push_back(off / bound);
      }
      const test::Vec3L step =
          w.linear.cast<LongReal>() +
          w.angular.cast<LongReal>().cross(w.X_AB.m.cast<LongReal>() * p.cast<LongReal>());
      const auto offTwist = static_cast<double>((step - half * real.velocity(p)).norm());
      ASSERT_LE(offTwist, bound) << "case " << n << ", t = " << t << ", h = " << half;
      worstTwist = std::max(worstTwist, offTwist / bound);
      ASSERT_GE(w.speed, w.linear.norm());
      ASSERT_GE(w.angle, w.angular.norm());
    }
  }
  std::nth_element(shares.begin(), shares.begin() + shares.size() / 2, shares.end());
  std::cout << "error as a share of its bound: worst " << worst << ", median "
            << shares[shares.size() / 2] << "; twist, worst " << worstTwist << '\n';
  EXPECT_GT(worst, 1e-2) << "a bound that no case comes near is not measured by this test";
}

/// A long chain: a hundred slides, each rotated by the same angle about z, so that the rounding
/// errors of the rotations add up. They are followed by a joint, and a hand far from this joint.
struct LongChain {
  KinematicTree tree;
  ConfigurationSpace space;
  Scene::FramePair pair[1] = {{0, 0}};
  Configuration from, to;

  LongChain(RandomTrees& random, double turn, Frame::Joint last, double reach) {
    const std::size_t slides = 100;
    from = to = Configuration::Zero(static_cast<Eigen::Index>(slides + 1));
    for (std::size_t k = 0; k <= slides; ++k) {
      Coordinate c;
      c.name = std::to_string(k);
      space.add(c);
      Frame frame;
      frame.parent = tree.frames.size() - 1;
      frame.fixed.p = random.vector(0.01);
      frame.fixed.q = Eigen::AngleAxisd(turn, Vec3::UnitZ());
      frame.joint = k < slides ? Frame::Joint::prismatic : last;
      frame.axis = k < slides ? random.direction() : Vec3::UnitX();
      frame.variable = k;
      tree.add(frame);
      const auto i = static_cast<Eigen::Index>(k);
      from[i] = random.real(-0.01, 0.01), to[i] = random.real(-0.01, 0.01);
    }
    Frame hand;
    hand.parent = tree.frames.size() - 1;
    hand.fixed.p = reach * random.direction();
    pair[0].b = tree.add(hand);
  }
};

/// In a long chain, a rotation's error displaces all following frames and tilts the axes of all
/// following joints.
TEST(EdgeMotion, LongChainsAreWithinTheirStatedError) {
  RandomTrees random(test::testSeed(5));
  double worst = 0, worstTwist = 0;
  for (int n = 0; n < 300; ++n) {
    const bool turns = n % 2;
    LongChain chain(random, random.real(-3, 3),
                    turns ? Frame::Joint::revolute : Frame::Joint::prismatic, turns ? 0.01 : 1e3);
    if (turns) chain.from.tail<1>()[0] = -1000, chain.to.tail<1>()[0] = 1000;
    EdgeMotion motion(chain.tree, chain.space, chain.pair, Configuration::Zero(101));
    motion.set(chain.from, chain.to);
    const ReferenceKinematics reference(chain.tree, chain.space, chain.from, chain.to);
    const MovingPose real = reference.relative(0, chain.pair[0].b, 0.5L);
    for (const double h : {0.0, 0.5}) {
      const RelativeMotion w = motion.relativeMotion(0, 0.5, h);
      const Vec3 p = random.vector(turns ? 1e3 : 0);
      const double bound =
          w.fixedError + w.reachError * (w.X_AB.m * p).norm() + 10 * noise(real, p.norm());
      const auto off = static_cast<double>((test::exactly(w.X_AB, p) - real.at(p)).norm());
      ASSERT_LE(off, bound) << n;
      const test::Vec3L step =
          w.linear.cast<LongReal>() +
          w.angular.cast<LongReal>().cross(w.X_AB.m.cast<LongReal>() * p.cast<LongReal>());
      const auto offTwist = static_cast<double>((step - h * real.velocity(p)).norm());
      // The last joint rotates by 1,000 rad in half of the interval, which enlarges the reference's
      // own rounding.
      ASSERT_LE(offTwist, bound + 1000 * noise(real, p.norm())) << n << ", h = " << h;
      worst = std::max(worst, off / bound), worstTwist = std::max(worstTwist, offTwist / bound);
    }
  }
  std::cout << "error as a share of its bound: " << worst << "; twist: " << worstTwist << '\n';
}

TEST(EdgeMotion, ErrorsBetweenLinksAreSmallFarFromTheOrigin) {
  KinematicTree tree;
  ConfigurationSpace space;
  for (const char* name : {"x", "y", "z", "shoulder", "elbow"}) {
    Coordinate c;
    c.name = name;
    space.add(c);
  }
  Frame base, shoulder, elbow;
  base.joint = Frame::Joint::translation;
  base.count = 3;
  base.variable = 0;
  shoulder.parent = tree.add(base);
  shoulder.joint = elbow.joint = Frame::Joint::revolute;
  shoulder.variable = 3;
  elbow.parent = tree.add(shoulder);
  elbow.fixed.p = {1, 0, 0};
  elbow.variable = 4;
  const std::size_t hand = tree.add(elbow);
  const Scene::FramePair pairs[] = {{1, hand}, {0, hand}};
  EdgeMotion motion(tree, space, pairs, Configuration::Zero(5));
  motion.set((Configuration(5) << 1e6, 0, 0, 1, 2).finished(),
             (Configuration(5) << 1.1e6, 3, 4, 1.5, 1).finished());
  const RelativeMotion w = motion.relativeMotion(0, 0.5, 0.5);
  EXPECT_LT(w.fixedError, 1e-13);
  EXPECT_EQ(w.screws.size(), 2u);
  EXPECT_GT(motion.relativeMotion(1, 0.5, 0.5).fixedError, 1e-10);
}

/// Each of the `screws` is applied by its amount, about its axis at the middle. Their product is
/// the motion from the middle to the end of the interval.
TEST(EdgeMotion, ScrewsAreTheMotion) {
  RandomTrees random(test::testSeed(2));
  for (int n = 0; n < 20'000; ++n) {
    random.makeTree(1 + random.randomIndex(6));
    random.makeEdge(2);
    const Scene::FramePair pair[] = {random.pair()};
    EdgeMotion motion(random.tree, random.space, pair, random.noTube());
    motion.set(random.from, random.to);
    const auto [t, h] = interval(random);
    const RelativeMotion w = motion.relativeMotion(0, t, h);
    const ReferenceKinematics reference(random.tree, random.space, random.from, random.to);
    // Screws have no sign. One of the 2^k combinations of signs has the interval's twist. This
    // combination must lead to the end of the interval.
    const std::size_t k = w.screws.size();
    bool found = false;
    for (std::size_t signs = 0; signs < (std::size_t{1} << k) && !found; ++signs) {
      Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      for (std::size_t j = 0; j < k; ++j) {
        const ScrewMotion& screw = w.screws[j];
        const double amount = (signs >> j & 1) ? -screw.amount : screw.amount;
        if (screw.kind == ScrewMotion::Kind::prismatic) {
          linear += amount * screw.axis;
          X = X * Eigen::Translation3d(amount * screw.axis);
        } else {
          angular += amount * screw.axis;
          linear += amount * screw.axis.cross(w.X_AB.t - screw.point);
          X = X * Eigen::Translation3d(screw.point) *
              Eigen::AngleAxisd(amount, screw.axis.normalized()) *
              Eigen::Translation3d(-screw.point);
        }
      }
      if ((linear - w.linear).norm() + (angular - w.angular).norm() > 1e-12) continue;
      const MovingPose end = reference.relative(pair[0].a, pair[0].b, t + h);
      const Vec3 p = random.vector();
      found = ((X * (w.X_AB * p)).cast<LongReal>() - end.at(p)).norm() < 1e-11;
    }
    ASSERT_TRUE(found) << "case " << n;
  }
}

TEST(EdgeMotion, ManyPairsShareOneMotion) {
  RandomTrees random(test::testSeed(3));
  const int count = test::casesOf(170, 500);
  for (int n = 0; n < count; ++n) {
    random.makeTree(8);
    std::vector<Scene::FramePair> pairs;
    for (std::size_t a = 0; a < random.tree.frames.size(); ++a)
      for (std::size_t b = a; b < random.tree.frames.size(); ++b) pairs.push_back({a, b});
    EdgeMotion all(random.tree, random.space, pairs, random.noTube());
    for (int edge = 0; edge < 3; ++edge) {
      random.makeEdge(2);
      all.set(random.from, random.to);
      const ReferenceKinematics reference(random.tree, random.space, random.from, random.to);
      for (int k = 0; k < 3; ++k) {
        const auto [t, h] = interval(random);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          const RelativeMotion w = all.relativeMotion(i, t, h);
          const MovingPose real = reference.relative(pairs[i].a, pairs[i].b, t);
          ASSERT_LE((w.X_AB.t.cast<LongReal>() - real.t).norm(), w.fixedError + noise(real, 0))
              << n << ' ' << i;
          ASSERT_LE((w.X_AB.m.cast<LongReal>() - real.m).norm(), 2 * w.reachError + noise(real, 0))
              << n << ' ' << i;
        }
      }
    }
  }
}

/// One frame that rotates about z by a coordinate of the given kind.
struct OneTurn {
  KinematicTree tree;
  ConfigurationSpace space;
  const Scene::FramePair pair[1] = {{0, 1}};

  OneTurn(Coordinate::Kind kind, double multiplier = 1) {
    Coordinate c;
    c.kind = kind;
    space.add(c);
    Frame frame;
    frame.joint = Frame::Joint::revolute;
    frame.variable = 0;
    frame.multiplier = multiplier;
    tree.add(frame);
  }
  std::unique_ptr<EdgeMotion> motion(double from, double to, double tube = 0) const {
    auto m = std::make_unique<EdgeMotion>(tree, space, pair, Configuration::Constant(1, tube));
    m->set(Configuration::Constant(1, from), Configuration::Constant(1, to));
    return m;
  }
};

double yaw(const RelativeMotion& w) {
  return std::atan2(w.X_AB.m(1, 0), w.X_AB.m(0, 0));
}

TEST(EdgeMotion, CirclesTakeTheShorterWay) {
  const OneTurn circle(Coordinate::Kind::circle), line(Coordinate::Kind::line);
  EXPECT_NEAR(std::abs(yaw(circle.motion(3, -3)->relativeMotion(0, 0.5, 0))), pi, 1e-15);
  EXPECT_NEAR(circle.motion(3, -3)->relativeMotion(0, 0.5, 0.5).angle, pi - 3, 1e-13);
  EXPECT_NEAR(yaw(circle.motion(7, 1)->relativeMotion(0, 1, 0)), 1, 1e-14);
  EXPECT_NEAR(yaw(line.motion(3, -3)->relativeMotion(0, 0.5, 0)), 0, 1e-15);
  EXPECT_NEAR(line.motion(3, -3)->relativeMotion(0, 0.5, 0.5).angle, 3, 1e-13);
}

/// The amount of a screw is rounded up: it is never below the joint's real motion, whatever the
/// angles of a coordinate of the kind `circle`.
TEST(EdgeMotion, AmountsAreNeverBelowTheRealMotion) {
  RandomTrees random(test::testSeed(6));
  const OneTurn circle(Coordinate::Kind::circle);
  for (int n = 0; n < 20'000; ++n) {
    const double size = std::pow(10.0, n % 7), near = std::pow(10.0, -(n % 5));
    const double from = random.real(-size, size),
                 to = from + near * random.real() + 2 * pi * std::trunc(random.real(-10, 10));
    const LongReal way = std::remainder(static_cast<LongReal>(to) - static_cast<LongReal>(from),
                                        2 * std::numbers::pi_v<LongReal>);
    const auto motion = circle.motion(from, to);
    const RelativeMotion w = motion->relativeMotion(0, 0.5, 0.5);
    if (motion->ambiguous()) continue;
    ASSERT_EQ(w.screws.size(), from == to ? 0U : 1U);
    if (from == to) continue;
    // The reference is off by 2^-62 per turn, and there are at most 11.
    ASSERT_GE(w.screws[0].amount, 0.5L * std::abs(way) - 0x1p-58L) << from << " to " << to;
  }
}

TEST(EdgeMotion, HalfTurnsAreAmbiguous) {
  const OneTurn circle(Coordinate::Kind::circle), line(Coordinate::Kind::line);
  EXPECT_TRUE(circle.motion(0, pi)->ambiguous());
  EXPECT_TRUE(circle.motion(pi / 2, -pi / 2 + 1e-10)->ambiguous());
  EXPECT_FALSE(circle.motion(pi / 2, -pi / 2 + 1e-8)->ambiguous());
  EXPECT_FALSE(circle.motion(pi, -pi)->ambiguous());
  EXPECT_FALSE(line.motion(0, pi)->ambiguous());
  // A joint that mimics a coordinate of the kind `circle` with the multiplier ½ would jump where
  // the stored angles differ by more than half a turn.
  EXPECT_TRUE(OneTurn(Coordinate::Kind::circle, 0.5).motion(3, -3)->ambiguous());
  EXPECT_TRUE(OneTurn(Coordinate::Kind::circle, 0.5).motion(7, 0.5)->ambiguous());
  EXPECT_FALSE(OneTurn(Coordinate::Kind::circle, 0.5).motion(1, -1)->ambiguous());
  EXPECT_FALSE(OneTurn(Coordinate::Kind::circle, 0.5).motion(3, 4)->ambiguous());
  EXPECT_FALSE(OneTurn(Coordinate::Kind::circle, -2).motion(3, -3)->ambiguous());
}

TEST(EdgeMotion, TubesFollowTheMultiplierAndStayWhereNothingMoves) {
  const OneTurn follower(Coordinate::Kind::line, -2);
  const auto motion = follower.motion(0, 1, 0.01);  // owns the screws of the intervals
  const RelativeMotion moving = motion->relativeMotion(0, 0.5, 0.5);
  ASSERT_EQ(moving.screws.size(), 1u);
  EXPECT_NEAR(moving.screws[0].amount, 1, 1e-14);
  EXPECT_GE(moving.screws[0].amount, 1);
  EXPECT_NEAR(moving.screws[0].tube, 0.02, 1e-16);
  const auto still = follower.motion(1, 1, 0.01);
  ASSERT_EQ(still->relativeMotion(0, 0.5, 0.5).screws.size(), 1u);
  EXPECT_EQ(still->relativeMotion(0, 0.5, 0.5).screws[0].amount, 0);
  const auto nothing = follower.motion(1, 1, 0);
  EXPECT_TRUE(nothing->relativeMotion(0, 0.5, 0.5).screws.empty());
}

/// A floating joint: the position moves on a straight line, and the orientation rotates about one
/// axis.
struct Floating {
  KinematicTree tree;
  ConfigurationSpace space;
  const Scene::FramePair pair[1] = {{0, 2}};

  Floating() {
    for (const char* name : {"x", "y", "z"}) {
      Coordinate c;
      c.name = name;
      space.add(c);
    }
    Coordinate rotation;
    rotation.kind = Coordinate::Kind::rotation;
    space.add(rotation);
    Frame shift, rotate;
    shift.joint = Frame::Joint::translation;
    shift.count = 3;
    shift.variable = 0;
    rotate.parent = tree.add(shift);
    rotate.joint = Frame::Joint::rotation;
    rotate.variable = 3;
    tree.add(rotate);
  }
};

TEST(EdgeMotion, ARigidBodyMovesAsRigidMotionSays) {
  RandomTrees random(test::testSeed(4));
  const Floating body;
  for (int n = 0; n < 20'000; ++n) {
    Configuration from(7), to(7);
    for (auto* q : {&from, &to})
      for (Eigen::Index i = 0; i < 7; ++i) (*q)[i] = (i < 3 ? 10 : 1) * random.real();
    if (n % 3 == 0)
      to.tail<4>() = from.tail<4>() + std::pow(10, random.real(-18, 0)) * to.tail<4>();
    if (n % 5 == 0) to.tail<4>() = -2 * from.tail<4>();
    EdgeMotion motion(body.tree, body.space, body.pair, Configuration::Zero(7));
    motion.set(from, to);
    const RigidMotion rigid =
        RigidMotion::spatial({from.head<3>(), Eigen::Quaterniond(from.tail<4>())},
                             {to.head<3>(), Eigen::Quaterniond(to.tail<4>())}, {});
    EXPECT_EQ(motion.ambiguous(), rigid.ambiguous());
    const auto [t, h] = interval(random);
    std::array<ScrewMotion, 2> screws;
    const RelativeMotion a = motion.relativeMotion(0, t, h), b = rigid.relativeMotion(t, h, screws);
    const double fixed = a.fixedError + b.fixedError, reach = a.reachError + b.reachError;
    EXPECT_LE((a.X_AB.t - b.X_AB.t).norm(), fixed);
    EXPECT_LE((a.X_AB.m - b.X_AB.m).norm(), 2 * reach);
    EXPECT_LE((a.linear - b.linear).norm(), fixed);
    EXPECT_LE((a.angular - b.angular).norm(), reach);
    EXPECT_LT(fixed, 1e-11);
    EXPECT_LT(reach, 1e-11);
  }
}

}  // namespace
}  // namespace corridor
