// Curves whose polynomials are free, but which touch within the tube and the error of the piece.
// The checker and the verifier must never prove them. As a control, the same questions are asked
// without the tube, without the error, and without both: then many cases must be proved. So an
// answer that ignores the tube or the error would be found.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <span>

#include <gtest/gtest.h>

#include "tests/stress/audit/audit.h"
#include "tests/stress/audit/pieces.h"
#include "tests/support/support.h"

namespace corridor::audit {
namespace {

constexpr Family kMoved[] = {Family::planarBody, Family::spatialBody, Family::chain,
                             Family::branches,   Family::movingBase,  Family::mimics,
                             Family::mimics,     Family::scales,      Family::reachingArm};

/// What may stray from the polynomials of a piece.
enum class Stray { tube, error, both };

/// Gives each coordinate a tube, an error, or both, of 10^-6 to 10^-1.5 of the bodies' size, or of
/// 10^-6 to 10^-2 rad. A third of the coordinates do not stray. In half of the cases with joints
/// that mimic another, only coordinates that such joints follow stray.
void setStray(Dice& dice, Edge& edge, double size, Stray stray) {
  const auto isFollowed = [&](const Coordinate& c) {
    return std::any_of(edge.tree.frames.begin(), edge.tree.frames.end(),
                       [&](const Frame& f) { return f.variable == c.first && f.multiplier != 1; });
  };
  const auto& all = edge.space.coordinates();
  const bool onlyFollowed = std::any_of(all.begin(), all.end(), isFollowed) && dice.oneIn(2);
  for (const Coordinate& c : all) {
    const auto i = static_cast<Eigen::Index>(c.first);
    const auto halfWidth = [&] {
      return isAngle(edge, c) ? dice.power(-6, -2) : size * dice.power(-6, -1.5);
    };
    if (onlyFollowed ? !isFollowed(c) : dice.oneIn(3)) continue;
    if (stray != Stray::error) edge.tube[i] = halfWidth();
    if (stray != Stray::tube) edge.piece->error[i] = halfWidth();
  }
}

/// Gives half of the joints on a circle any multiplier. On a curve, angles are literal, so no joint
/// jumps.
void setMultipliers(Dice& dice, Edge& edge) {
  for (const Coordinate& c : edge.space.coordinates())
    for (Frame& frame : edge.tree.frames)
      if (c.kind == Coordinate::Kind::circle && frame.joint == Frame::Joint::revolute &&
          frame.variable == c.first && dice.oneIn(2))
        frame.multiplier = dice.real(-5, 5);
}

Edge without(const Edge& edge, bool tube, bool error) {
  Edge bare = edge;
  if (tube) bare.tube.setZero();
  if (error) bare.piece->error.setZero();
  return bare;
}

/// The answers to one question, and counts of the answers that claim a proof.
struct ProofAnswers {
  MotionResult scene, model;
  PathReport verifier;

  explicit ProofAnswers(const Case& c)
      : scene(*askChecker(c)), model(answerOfModel(c)), verifier(*askVerifier(c)) {}
};
struct ProofCounts {
  long cases = 0, scene = 0, model = 0, verifier = 0;

  void add(const ProofAnswers& answers) {
    ++cases;
    scene += answers.scene.verdict == MotionVerdict::free;
    model += answers.model.verdict == MotionVerdict::free;
    verifier += answers.verifier.verdict == PathVerdict::proved;
  }
  long least() const { return std::min({scene, model, verifier}); }
  void print(const std::string& title) const {
    std::cout << std::left << std::setw(34) << title << std::right;
    for (const long n : {cases, scene, model, verifier}) std::cout << std::setw(14) << n;
    std::cout << "\n";
  }
};

TEST(Audit, CurvesThatTouchInTheirTube) {
  const std::uint64_t seed = test::testSeed(15);
  const char* only = std::getenv("CORRIDOR_AUDIT_CASE");
  const long count = only ? 1 : countOf(130, 100'000);
  ProofCounts touching, bare, noTube, noError;
  long wrong = 0;
  std::array<long, CurvePiece::kLargestDegree + 1> degrees{};
  for (long number = only ? std::stol(only) : 0; touching.cases < count; ++number) {
    Dice dice = diceOf(seed, number);
    double size = 1;
    Edge edge = randomEdge(dice, dice.of(std::span<const Family>(kMoved)), false, size);
    size *= dice.power(-1, 0.3);
    setMultipliers(dice, edge);
    bendEdge(dice, edge, size);
    const Stray stray = std::array{Stray::tube, Stray::error, Stray::both}[dice.index(3)];
    setStray(dice, edge, size, stray);
    Question question;
    question.inTube = true;
    question.options.earliest = dice.oneIn(3);
    if (dice.oneIn(4)) question.options.margin = size * dice.power(-4, -0.5);
    const Graze graze(dice, edge, {size, question.options.margin, true});
    if (only && !graze.usable()) break;
    if (!graze.usable()) continue;
    question.options.tolerance = std::max(4 * graze.rounding(), 1e-8 * size);
    question.options.workLimit = 50'000;
    Truth truth;
    const Shape rest = graze.rest(-size * dice.power(-12, -7), truth);
    if (only && !truth.violates) break;
    if (!truth.violates) continue;
    const Case c{
        edge,
        graze,
        rest,
        truth,
        question,
        "CORRIDOR_SEED=" + std::to_string(seed) + " CORRIDOR_AUDIT_CASE=" + std::to_string(number)};
    const ProofAnswers answers(c);
    for (const std::string& fault :
         {faultOf(c, answers.scene), faultOf(c, answers.model), faultOf(c, answers.verifier)})
      if (!fault.empty() && ++wrong <= 3) std::cout << fault << "\n" << describe(c) << std::endl;
    touching.add(answers);
    ++degrees[static_cast<std::size_t>(edge.piece->degree())];
    const auto control = [&](bool tube, bool error, ProofCounts& counts) {
      const Edge changed = without(edge, tube, error);
      counts.add(ProofAnswers({changed, graze, rest, truth, question, c.name}));
    };
    control(true, true, bare);
    if (stray == Stray::both) {
      control(true, false, noTube);
      control(false, true, noError);
    }
    if (only) break;
  }
  std::cout << "cases, and how many are proved by Scene::certify, certifyCurve and verifyCurve:\n";
  touching.print("touches in the tube or the error");
  bare.print("control: without tube and error");
  noTube.print("control: without the tube");
  noError.print("control: without the error");
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(touching.scene + touching.model + touching.verifier, 0);
  if (only || test::kSlowdown > 1) return;
  // The test can fail: answers that ignore the tube, the error or both are often proofs.
  EXPECT_GT(bare.least(), bare.cases / 3);
  EXPECT_GT(noTube.least(), noTube.cases / 8);
  EXPECT_GT(noError.least(), noError.cases / 8);
  EXPECT_GT(noTube.cases, count / 8);
  EXPECT_EQ(std::count(degrees.begin() + 1, degrees.end(), 0), 0) << "a degree does not occur";
}

}  // namespace
}  // namespace corridor::audit
