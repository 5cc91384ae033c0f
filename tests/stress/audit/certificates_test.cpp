// Tests of certificates that must be refused, and of edges that must not be proved: forged
// certificates, half turns, a body inside a solid, and joints that mimic a continuous joint across
// ±π. ../README.md describes the audit.
#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "planner/robot/edge_motion.h"
#include "tests/stress/audit/audit.h"
#include "tests/stress/audit/pieces.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor::audit {
namespace {

using std::numbers::pi;

constexpr EdgeMethod kEdgeMethods[] = {EdgeMethod::certified, EdgeMethod::adaptive,
                                       EdgeMethod::advancement};

/// If the bodies come closer than the margin, a certificate must be refused, whatever clearance it
/// claims. A claim that is a little too large may be accepted: `checkCertificate` proves only the
/// distance margin + (clearance − margin)/2. At least nine in ten of the certificates that the
/// query returns for free edges must be accepted.
TEST(Certificates, AcceptedImpliesTheMarginIsKept) {
  const std::uint64_t seed = test::testSeed(5);
  const long count = countOf(320, 50'000);
  long honest = 0, accepted = 0, forged = 0;
  int wrong = 0, claimed = 0;
  for (long number = 0; forged < count; ++number) {
    Dice dice = diceOf(seed, number);
    const Family family = kFamilies[static_cast<std::size_t>(number) % std::size(kFamilies)];
    double size = 1;
    Edge edge = randomEdge(dice, family, false, size);
    if (number % 3 == 2) bendEdge(dice, edge, size);
    Question question;
    MotionOptions& o = question.options;
    if (!dice.oneIn(3)) o.margin = size * dice.power(-3, -0.5);
    const double keep = o.margin;
    question.inTube = dice.oneIn(4);
    if (question.inTube) edge.tube.setConstant(std::min(size, 1.0) * dice.power(-6, -2));
    const Graze graze(dice, edge, {size, keep, question.inTube});
    if (!graze.usable()) continue;
    o.tolerance = std::max(1e-7 * size, 4 * graze.rounding());
    o.workLimit = 100'000;
    for (const double sign : {-1.0, 1.0}) {
      // With sign −1 the distance is too small by up to 0.9 of the margin, or the bodies penetrate.
      const double gap = sign * std::max(size * dice.power(-4, -1), dice.real(0, 0.9) * keep);
      Truth truth;
      const Shape rest = graze.rest(gap, truth);
      const Case c{edge,  graze,    rest,
                   truth, question, nameOf(family) + ", number " + std::to_string(number)};
      const Certificate answer = certifiedAnswer(c);
      if (answer.result.verdict == MotionVerdict::free) {
        ++honest;
        accepted += answer.accepted;
        claimed += truth.violates;
        if (truth.violates && claimed <= 2) std::cout << "FALSE FREE\n" << describe(c);
      }
      if (!truth.violates) continue;
      ++forged;
      const double claim = std::max(keep, size * dice.power(-4, -2)) * (1 + dice.power(-9, -0.5));
      const int intervals = 1 << dice.index(7);
      if (!acceptsForged(c, claim, intervals)) continue;
      if (++wrong <= 3)
        std::cout << "accepted: " << intervals << " intervals that claim " << claim << " m\n"
                  << describe(c) << std::endl;
    }
  }
  std::cout << forged << " certificates forged, " << wrong << " accepted; " << honest << " honest, "
            << accepted << " accepted\n";
  EXPECT_EQ(wrong, 0) << "forged certificates accepted";
  EXPECT_EQ(claimed, 0) << "false certificates of the query itself";
  EXPECT_GT(honest, count / 10);
  EXPECT_GE(static_cast<double>(accepted), 0.9 * static_cast<double>(honest));
}

/// A rotation within 1e-9 rad of a half turn has no defined direction. Even if all bodies are far
/// apart, the checker must report the edge as ambiguous, the verifier must not prove the edge, and
/// no certificate may be accepted.
TEST(Certificates, HalfTurnsAreNotProved) {
  const std::uint64_t seed = test::testSeed(6);
  const long count = countOf(1'000, 50'000);
  int free = 0, proved = 0, accepted = 0;
  for (long number = 0; number < count; ++number) {
    Dice dice = diceOf(seed, number);
    Edge edge;
    Frame shift, turn;
    const bool planar = dice.oneIn(2);
    shift.joint = Frame::Joint::translation;
    shift.variable = 0;
    shift.count = planar ? 2 : 3;
    for (std::size_t k = 0; k < shift.count; ++k) edge.space.add({});
    turn.parent = edge.tree.add(shift);
    turn.joint = planar ? Frame::Joint::revolute : Frame::Joint::rotation;
    turn.variable = shift.count;
    Coordinate last;
    last.kind = planar ? Coordinate::Kind::circle : Coordinate::Kind::rotation;
    edge.space.add(last);
    edge.second = edge.tree.add(turn);
    const auto numbers = static_cast<Eigen::Index>(edge.space.size());
    edge.from = edge.to = edge.tube = Configuration::Zero(numbers);
    const double off = dice.oneIn(3) ? 0 : dice.sign() * dice.power(-16, -9.3);
    if (planar) {
      edge.from[2] = dice.real(-pi, pi);
      edge.to[2] = std::remainder(edge.from[2] + pi + off, 2 * pi);
    } else {
      const Eigen::Quaterniond a(
          Eigen::Vector4d(dice.real(), dice.real(), dice.real(), dice.real()));
      const Eigen::AngleAxisd half(pi + off, dice.vector().normalized());
      edge.from.tail<4>() = a.coeffs();
      edge.to.tail<4>() = (Eigen::Quaterniond(half) * a).coeffs() * dice.sign();
    }
    if (!(leftToHalfTurn(edge) < 0.9e-9)) continue;
    Question question;
    question.options.tolerance = 1e-7;
    question.rigidMotion = dice.oneIn(2);
    question.method = kEdgeMethods[dice.index(3)];
    const Graze graze(dice, edge, {1, 0, false});
    if (!graze.usable()) continue;
    Truth truth;
    const Shape rest = graze.rest(dice.real(5, 20), truth);
    const Case c{edge, graze, rest, truth, question, "number " + std::to_string(number)};
    const MotionResult r = *askChecker(c);
    free += r.verdict != MotionVerdict::undecided || r.reason != UndecidedReason::ambiguous;
    proved += askVerifier(c)->verdict == PathVerdict::proved;
    accepted += acceptsForged(c, 1e-3, 1 << dice.index(4));
  }
  EXPECT_EQ(free, 0) << "half turns that the checker decides";
  EXPECT_EQ(proved, 0) << "half turns that the verifier proves";
  EXPECT_EQ(accepted, 0) << "half turns for which a certificate is accepted";
}

/// A small body stays inside a solid box along the edge. The surfaces stay apart, but the edge is
/// not free.
TEST(Certificates, NothingIsFreeInsideASolid) {
  Dice dice = diceOf(test::testSeed(7), 0);
  int free = 0, accepted = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Scene::Placed> bodies;
    bodies.push_back({Body("solid", test::box(Vec3(-5, -5, -5), Vec3(5, 5, 5)), true), 0});
    const Vec3 low = -Vec3(0.2, 0.2, 0.2);
    const bool part = dice.oneIn(2);
    bodies.push_back({part ? Body("inside", ConvexPart{{low}, 0.1, false})
                           : Body("inside", test::box(low, -low)),
                      2});
    const Scene scene(std::move(bodies), {{0, 1}});
    KinematicTree tree;
    ConfigurationSpace space;
    Frame shift;
    shift.joint = Frame::Joint::translation;
    shift.variable = 0;
    shift.count = 3;
    for (int k = 0; k < 4; ++k) space.add({});
    Frame turn;
    turn.parent = tree.add(shift);
    turn.joint = Frame::Joint::revolute;
    turn.variable = 3;
    tree.add(turn);
    EdgeMotion motion(tree, space, scene.framePairs(), Configuration::Zero(4));
    const auto state = [&] {
      return Configuration(
          Eigen::Vector4d(dice.real(-3, 3), dice.real(-3, 3), dice.real(-3, 3), dice.real(-3, 3)));
    };
    motion.set(state(), state());
    MotionOptions options;
    options.tolerance = 1e-7;
    QueryContext context;
    for (const EdgeMethod method : kEdgeMethods)
      free += scene.certify(motion, options, context, method).verdict == MotionVerdict::free;
    MotionCertificate forged;
    forged.free.push_back({0, 0, 1, 0.1});
    accepted +=
        !checkCertificate(motion, scene.motionPairs(), options, 1, forged, context).has_value();
  }
  EXPECT_EQ(free, 0) << "free inside a solid";
  EXPECT_EQ(accepted, 0) << "certificate accepted inside a solid";
}

/// A joint mimics a continuous joint with a multiplier that is not an integer. When the continuous
/// joint passes ±π (the seam), the value of the mimicking joint jumps. So no continuous motion
/// reaches the edge's second state, in which the bodies touch, and the edge must not be free. An
/// edge that does not pass the seam is decided as usual.
TEST(Certificates, MimicsOverTheSeamOfACircle) {
  const std::uint64_t seed = test::testSeed(8);
  const long count = countOf(150, 50'000);
  int free = 0, proved = 0, wrong = 0;
  long over = 0, decided = 0;
  for (long number = 0; number < count; ++number) {
    Dice dice = diceOf(seed, number);
    Edge edge;
    Coordinate circle;
    circle.kind = Coordinate::Kind::circle;
    edge.space.add(circle);
    Frame leader, follower;
    leader.joint = Frame::Joint::revolute;
    leader.axis = dice.vector();
    leader.variable = 0;
    const bool both = dice.oneIn(2);
    if (both) follower.parent = edge.tree.add(leader);
    follower.fixed.p = dice.vector();
    follower.joint = dice.oneIn(3) ? Frame::Joint::prismatic : Frame::Joint::revolute;
    follower.axis = dice.vector();
    follower.variable = 0;
    follower.multiplier = dice.oneIn(2) ? 0.5 : dice.real(-2.5, 2.5);
    follower.offset = dice.real();
    edge.second = edge.tree.add(follower);
    const bool seam = dice.oneIn(2);
    const double a = dice.sign() * dice.real(1.8, 3.1);
    edge.from = Configuration::Constant(1, a);
    edge.to = Configuration::Constant(
        1, seam ? -std::copysign(dice.real(1.8, 3.1), a) : std::copysign(dice.real(0.1, 3.1), a));
    edge.tube = Configuration::Zero(1);
    Edge last = edge;
    if (seam) last.from = edge.to;
    const Graze graze(dice, last, {1, 0, false});
    if (!graze.usable()) continue;
    Question question;
    question.options.tolerance = 1e-5;
    question.options.workLimit = 200'000;
    question.method = kEdgeMethods[dice.index(3)];
    Truth truth;
    const Shape rest = graze.rest(dice.power(-6, -2) * (seam ? -1 : dice.sign()), truth);
    if (seam && !truth.violates) continue;
    const Case c{edge, graze, rest, truth, question, "number " + std::to_string(number)};
    const MotionResult r = *askChecker(c);
    const PathReport report = *askVerifier(c);
    if (seam) {
      ++over;
      free += r.verdict == MotionVerdict::free;
      proved += report.verdict == PathVerdict::proved;
      continue;
    }
    ++decided;
    for (const std::string& fault : {faultOf(c, r), faultOf(c, report)})
      if (!fault.empty() && ++wrong <= 3) std::cout << fault << "\n" << describe(c) << std::endl;
  }
  std::cout << over << " edges over the seam, " << decided << " others\n";
  EXPECT_EQ(free, 0) << "edges over the seam that the checker calls free";
  EXPECT_EQ(proved, 0) << "edges over the seam that the verifier proves";
  EXPECT_EQ(wrong, 0) << "wrong answers short of the seam";
  EXPECT_GT(over, count / 4);
}

}  // namespace
}  // namespace corridor::audit
