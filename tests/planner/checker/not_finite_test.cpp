// NaN and ±infinity in every number that a checker takes, one at a time: no verdict is ever `free`.
#include "tests/support/not_finite.h"

#include <ranges>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/robot/edge_motion.h"
#include "tests/planner/checker/hall.h"

namespace corridor {
namespace {

using test::forEachNotFinite;
using test::kNotFinite;

/// Returns a robot with a joint of every kind, and a ball at each end of its two branches. The only
/// obstacle is far away, so every configuration is free.
Model armOfAllJoints() {
  Model model;
  model.robots.resize(1);
  const auto variable = [&](Coordinate::Kind kind, const char* name) {
    Coordinate c;
    c.kind = kind;
    c.name = name;
    c.lower = -3;
    c.upper = 3;
    return model.space.coordinates()[model.space.add(c)].first;
  };
  const auto frame = [&](std::size_t parent, Frame::Joint joint, std::size_t first) {
    Frame f;
    f.name = "frame " + std::to_string(model.tree.frames.size());
    f.parent = parent;
    f.fixed = {Vec3(0.1, 0.2, 0.3), Eigen::Quaterniond(1, 0.1, 0.2, 0.3)};
    f.joint = joint;
    f.axis = Vec3(1, 2, 3);
    f.variable = first;
    f.count = 3;
    return model.tree.add(f);
  };
  using enum Coordinate::Kind;
  const std::size_t x = variable(line, "x");
  variable(line, "y"), variable(line, "z");
  const std::size_t q = variable(rotation, "rotation"), pan = variable(line, "pan"),
                    lift = variable(circle, "lift"), slide = variable(line, "slide");
  std::size_t at = frame(0, Frame::Joint::translation, x);
  at = frame(at, Frame::Joint::rotation, q);
  const std::size_t fork = at = frame(at, Frame::Joint::revolute, pan);
  at = frame(at, Frame::Joint::revolute, lift);
  const std::size_t tip = frame(at, Frame::Joint::prismatic, slide);
  const std::size_t side = frame(fork, Frame::Joint::revolute, pan);
  model.tree.frames[side].multiplier = -0.7;  // mimics `pan`
  const auto ball = [](const char* name) { return test::partShape(name, Sphere{0.05}); };
  model.bodies = {{"tip", tip, 0, {ball("tip")}},
                  {"side", side, 0, {ball("side")}},
                  {"far", 0, {}, {test::partShape("far", Box{Vec3(1, 1, 1)}, Vec3(90, 80, 70))}}};
  return model;
}

Configuration armAt(double offset) {
  Configuration q(10);
  q << 0.1, -0.2, 0.3, 0.1, 0.2, 0.3, 0.9, 0.4, -0.5, 0.2;
  return q.array() + offset;
}

/// The models, each with two ends of a free edge. The arm moves only the tested links; SE2 and SE3
/// have a mesh.
struct NotFiniteCase {
  const char* name;
  Model model;
  Configuration from, to;
};
std::vector<NotFiniteCase> cases() {
  std::vector<NotFiniteCase> all;
  all.push_back({"arm", armOfAllJoints(), armAt(0), armAt(0.1)});
  for (const test::Rigid kind : {test::Rigid::SE2, test::Rigid::SE3})
    all.push_back({kind == test::Rigid::SE2 ? "SE2" : "SE3", test::hallProblem(kind).model,
                   test::poseOf(kind, -3, -2, 0.1), test::poseOf(kind, -3, -2.5, 0.2)});
  return all;
}

void expectAmbiguous(const MotionResult& result, const std::string& what) {
  EXPECT_EQ(result.verdict, MotionVerdict::undecided) << what;
  EXPECT_EQ(result.reason, UndecidedReason::ambiguous) << what;
  EXPECT_EQ(result.certifiedUntil, 0) << what;
}

TEST(NotFiniteStates, AreNeverFree) {
  for (const NotFiniteCase& c : cases())
    for (const EdgeMethod method :
         {EdgeMethod::certified, EdgeMethod::adaptive, EdgeMethod::advancement}) {
      const Checker checker(c.model, {.method = method});
      ASSERT_EQ(checker.certifyEdge(c.from, c.to).verdict, MotionVerdict::free) << c.name;
      const std::size_t pairs = checker.pairsNotFree(c.from).size();
      ASSERT_EQ(pairs, 0u);
      const PairMargins more(std::vector<double>(checker.scene().pairs().size(), 0.001));
      const auto check = [&](const Configuration& q, const std::string& number) {
        const std::string what = std::string(c.name) + ": " + number;
        expectAmbiguous(checker.certifyState(q), what);
        for (const auto& [from, to] : {std::pair(q, c.to), std::pair(c.from, q), std::pair(q, q)})
          for (const bool earliest : {false, true}) {
            expectAmbiguous(checker.certifyEdge(from, to, {.earliest = earliest}), what);
            MotionCertificate certificate;
            expectAmbiguous(
                checker.certifyEdge(from, to, {.earliest = earliest, .certificate = &certificate}),
                what);
            EXPECT_TRUE(certificate.free.empty()) << what;
            expectAmbiguous(checker.certifyEdge(from, to, {.earliest = earliest, .margins = &more}),
                            what);
            EXPECT_FALSE(checker.isProvedFree(from, to)) << what;
          }
        EXPECT_FALSE(checker.inBounds(q)) << what;
        EXPECT_FALSE(checker.isProvedFree(q)) << what;
        EXPECT_FALSE(checker.pairsNotFree(q).empty()) << what;
        EXPECT_THROW(checker.interference(q), std::invalid_argument) << what;
        EXPECT_THROW(checker.clearance(q), std::invalid_argument) << what;
        EXPECT_THROW(checker.pairsWithin(q, more), std::invalid_argument) << what;
        MotionCertificate certificate;
        ASSERT_EQ(checker.certifyEdge(c.from, c.to, {.certificate = &certificate}).verdict,
                  MotionVerdict::free);
        EXPECT_TRUE(checker.faultOf(certificate, c.from, q, 1)) << what;
        EXPECT_TRUE(checker.faultOf(certificate, q, c.to, 1)) << what;
        EXPECT_TRUE(checker.faultOf(certificate, c.from, c.to, kNotFinite[0])) << what;
      };
      forEachNotFinite(c.from, check);
      for (const Coordinate& coordinate : c.model.space.coordinates()) {
        if (coordinate.kind != Coordinate::Kind::rotation) continue;
        Configuration zero = c.from;
        zero.segment<4>(static_cast<Eigen::Index>(coordinate.first)).setZero();
        check(zero, "zero quaternion");
      }
    }
}

TEST(NotFiniteStates, PiecesOfCurvesAreNeverFree) {
  for (const NotFiniteCase& c : cases()) {
    const Checker checker(c.model);
    for (const int degree : {1, 2, 5}) {
      CurvePiece good{Eigen::MatrixXd(c.from.size(), degree + 1),
                      Configuration::Zero(c.from.size())};
      for (int i = 0; i <= degree; ++i)
        good.coefficients.col(i) = c.from + (c.to - c.from) * i / degree;
      ASSERT_EQ(checker.certifyCurve(good).verdict, MotionVerdict::free) << c.name;
      // The quaternions between the first and the last column are not used; the rest of these
      // columns is.
      const auto numbersOf = [](CurvePiece& piece) {
        std::vector<double*> numbers;
        test::addNumbers(piece.coefficients, numbers);
        return numbers;
      };
      forEachNotFinite(good, numbersOf, [&](const CurvePiece& bad, const std::string& what) {
        for (const bool earliest : {false, true})
          expectAmbiguous(checker.certifyCurve(bad, earliest), std::string(c.name) + ": " + what);
      });
      for (const Coordinate& coordinate : c.model.space.coordinates())
        for (const int column : {0, degree}) {
          if (coordinate.kind != Coordinate::Kind::rotation) continue;
          CurvePiece zero = good;
          zero.coefficients.col(column)
              .segment<4>(static_cast<Eigen::Index>(coordinate.first))
              .setZero();
          expectAmbiguous(checker.certifyCurve(zero), std::string(c.name) + ": zero quaternion");
        }
      const auto errorsOf = [](CurvePiece& piece) {
        std::vector<double*> numbers;
        test::addNumbers(piece.error, numbers);
        return numbers;
      };
      forEachNotFinite(good, errorsOf, [&](const CurvePiece& bad, const std::string& what) {
        EXPECT_THROW(checker.certifyCurve(bad), std::invalid_argument) << c.name << ": " << what;
        EdgeMotion motion(c.model.tree, c.model.space, checker.scene().framePairs(),
                          checker.tube());
        motion.set(bad);
        EXPECT_TRUE(motion.ambiguous()) << c.name << ": " << what;
      });
    }
  }
}

TEST(NotFiniteStates, OptionsOfCheckersAreRefused) {
  const NotFiniteCase c = cases().front();
  const auto numbersOf = [](CheckerOptions& options) {
    std::vector<double*> numbers{&options.margin, &*options.tolerance};
    for (double& metres : options.padding.bodies | std::views::values) numbers.push_back(&metres);
    return numbers;
  };
  const CheckerOptions good{.margin = 0.01, .padding = {{{0, 0.01}}, {}}, .tolerance = 1e-6};
  ASSERT_EQ(Checker(c.model, good).certifyEdge(c.from, c.to).verdict, MotionVerdict::free);
  forEachNotFinite(good, numbersOf, [&](const CheckerOptions& bad, const std::string& what) {
    EXPECT_THROW(Checker(c.model, bad), std::invalid_argument) << what;
  });
  // An infinite half width is legal: nothing that depends on the coordinate is free. (The half
  // width of a rotation is the first of its four numbers; the others are not used.)
  const Configuration tube = test::roundingTube(c.model.space);
  forEachNotFinite(tube, [&](const Configuration& bad, const std::string& what) {
    if ((bad.array() >= 0).all()) {
      if (bad.segment<3>(4).allFinite()) {
        EXPECT_NE(Checker(c.model, {.tube = bad}).certifyEdge(c.from, c.to).verdict,
                  MotionVerdict::free)
            << what;
      }
      return;
    }
    EXPECT_THROW(Checker(c.model, {.tube = bad}), std::invalid_argument) << what;
    EXPECT_THROW(EdgeMotion(c.model.tree, c.model.space, {}, bad), std::invalid_argument) << what;
  });
}

TEST(NotFiniteStates, NumbersOfModelsAreNeverFree) {
  const NotFiniteCase c = cases().front();
  const auto numbersOf = [](Model& model) {
    std::vector<double*> numbers;
    for (Frame& frame : std::span(model.tree.frames).subspan(1)) {
      test::addNumbers(frame.fixed, numbers);
      if (frame.joint != Frame::Joint::revolute && frame.joint != Frame::Joint::prismatic) continue;
      test::addNumbers(frame.axis, numbers);
      numbers.push_back(&frame.multiplier);
      numbers.push_back(&frame.offset);
    }
    return numbers;
  };
  forEachNotFinite(c.model, numbersOf, [&](const Model& bad, const std::string& what) {
    EXPECT_FALSE(test::claims([&] {
      return Checker(bad, {.tolerance = 1e-6}).certifyEdge(c.from, c.to).verdict ==
             MotionVerdict::free;
    })) << what;
  });
}

}  // namespace
}  // namespace corridor
