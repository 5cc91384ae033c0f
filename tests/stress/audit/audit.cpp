#include "tests/stress/audit/audit.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <span>

#include <gtest/gtest.h>

#include "tests/stress/audit/pieces.h"
#include "tests/support/support.h"

namespace corridor::audit {
namespace {

/// Each case gets one of these kinds of trees at random. The default kind occurs five times in the
/// list, so that it is chosen more often.
constexpr TreeKind kTrees[] = {TreeKind::obb4,
                               TreeKind::obb4,
                               TreeKind::obb4,
                               TreeKind::obb4,
                               TreeKind::obb4,
#define CORRIDOR_KIND(kind, Volume, Overlap, volumeName, overlapName) TreeKind::kind,
                               CORRIDOR_EACH_OVERLAP(CORRIDOR_KIND)
#undef CORRIDOR_KIND
};
constexpr EdgeMethod kMethods[] = {EdgeMethod::certified, EdgeMethod::certified,
                                   EdgeMethod::certified, EdgeMethod::adaptive,
                                   EdgeMethod::advancement};
constexpr int kGaps = 6;

/// Chooses the method, the trees, the tolerance and the work limit of a case, and stores them in
/// `question`. Returns the gap of the case in metres, with the given sign. If bodies pass along
/// each other, the work grows as 1/√tolerance. For the methods that use distances the work grows
/// faster, so these methods get larger tolerances. In some cases the gap and the tolerance are so
/// small that only rounding decides between free and contact.
/// @param fine the gap and the tolerance must be that small. @param curve the bodies move along a
/// piece of a curve, which only the method `directional` certifies.
double chooseProof(Dice& dice, const Graze& graze, double sign, bool fine, bool curve,
                   Question& question) {
  MotionOptions& o = question.options;
  const double size = graze.size();
  if (question.ofModel) {  // a `Checker` has default trees and work limit, and proves a slack
    o.tolerance = o.clearanceSlack = std::max(4 * graze.rounding(), size * dice.power(-8, -5));
    return sign * size * dice.power(-13, -2);
  }
  o.trees = dice.of(std::span<const TreeKind>(kTrees));
  question.method =
      fine || curve ? EdgeMethod::certified : dice.of(std::span<const EdgeMethod>(kMethods));
  const bool certified = question.method == EdgeMethod::certified;
  o.tolerance =
      std::max(4 * graze.rounding(), size * (certified ? dice.power(-7, -5) : dice.power(-4, -3)));
  o.workLimit = 100'000;
  if (fine || (certified && dice.oneIn(graze.passesAlong() ? 8 : 2))) {
    o.workLimit = fine ? 10'000 : 50'000;
    o.tolerance = size * dice.power(-14, -8);
    if (fine || dice.oneIn(2)) {
      const double gap = graze.ulp() * dice.power(-1.5, 1.5);
      o.tolerance = gap * dice.power(-2, 0);
      return sign * gap;
    }
  }
  return sign * size * dice.power(-13, -2);
}

bool hasSingleJoints(const Edge& edge) {
  return std::ranges::all_of(edge.tree.frames, [](const Frame& frame) {
    return frame.joint == Frame::Joint::none || frame.joint == Frame::Joint::revolute ||
           frame.joint == Frame::Joint::prismatic;
  });
}

}  // namespace

Dice diceOf(std::uint64_t seed, long number) {
  return Dice(seed + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(number + 1));
}

long countOf(long normally, long stress) {
  if (const char* other = std::getenv("CORRIDOR_AUDIT_COUNT")) return std::stol(other);
  return test::isStressRun() ? stress : normally;
}

Audit::Audit(std::uint64_t seed, const Options& options)
    : seed_(test::testSeed(seed)), options_(options) {
  if (const char* only = std::getenv("CORRIDOR_AUDIT_CASE")) only_ = std::stol(only);
}

void Audit::run(long count) {
  for (long number = only_.value_or(0); checker_.sum(Table::cases) < count; ++number) {
    make(number);
    if (only_) break;
  }
}

void Audit::report(const std::string& title) const {
  checker_.print(title + ", checker");
  verifier_.print(title + ", verifier");
  std::cout << constructions_ << " constructions, of which " << usable_ << " are usable\n\n";
  EXPECT_EQ(checker_.sum(Table::wrong), 0);
  EXPECT_EQ(verifier_.sum(Table::wrong), 0);
}

void Audit::expectDecided() const {
  if (only_) return;
  for (const Table* table : {&checker_, &verifier_}) {
    const long all = table->sum(Table::cases);
    EXPECT_GT(all, 0);
    EXPECT_GT(table->sum(Table::truthFree), all / 16);
    EXPECT_GT(table->sum(Table::truthContact), all / 4);
    EXPECT_GT(table->sum(Table::free), all / 10);
    EXPECT_GT(table->sum(Table::contact), all / 10);
    EXPECT_LT(table->sum(Table::atLimit), all / 10);
  }
}

void Audit::make(long number) {
  Dice dice = diceOf(seed_, number);
  const Family family =
      options_.family.value_or(kFamilies[static_cast<std::size_t>(number) % std::size(kFamilies)]);
  double size = 1;
  Edge edge = randomEdge(dice, family, options_.states, size);
  size *= dice.power(-1, 0.3);
  if (options_.ofModels && !hasSingleJoints(edge)) return;
  if (options_.curves) bendEdge(dice, edge, size);
  Question question;
  question.mode = options_.mode;
  question.inTube = dice.oneIn(6);
  question.ofModel = options_.ofModels;
  question.rigidMotion = !edge.piece && !options_.ofModels && isRigidBody(edge) && dice.oneIn(2);
  MotionOptions& o = question.options;
  if (dice.oneIn(4)) o.margin = size * dice.power(-4, -0.5);
  if (!options_.ofModels && dice.oneIn(8)) o.clearanceSlack = size * dice.power(-8, -1);
  o.earliest = dice.oneIn(3);
  if (question.inTube) setTube(dice, edge, size, question.rigidMotion);
  const double keep = o.margin + o.clearanceSlack;
  ++constructions_;
  const Graze graze(dice, edge, {size, keep, question.inTube});
  if (!graze.usable()) return;
  ++usable_;
  const std::string row = question.inTube ? "tube: worst corner" : nameOf(family);
  for (int k = 0; k < kGaps; ++k) {
    const double gap = chooseProof(dice, graze, question.inTube || k % 2 ? -1 : 1, options_.fine,
                                   options_.curves, question);
    Truth truth;
    const Shape rest = graze.rest(gap, truth);
    const std::string name = nameOf(family) + ", CORRIDOR_SEED=" + std::to_string(seed_) +
                             " CORRIDOR_AUDIT_CASE=" + std::to_string(number) + ", gap " +
                             std::to_string(k + 1) + " of 6";
    EXPECT_FALSE(truth.violates && truth.apart > keep) << "the audit contradicts itself: " << name;
    const Case c{edge, graze, rest, truth, question, name};
    ask(c, row);
    // The verifier has no `clearanceSlack`. With a slack, the true verdict of the case would not be
    // the one that the verifier must report.
    if (keep == o.margin && dice.oneIn(options_.verify)) verify(c, row);
  }
}

/// Sets the tube's half width of each coordinate. All lengths get one half width, and all angles
/// get another. Unless `rigid` is true (a single rigid body moves), some half widths are then set
/// to 0: in half of the cases all except one, otherwise a third of them. On a piece of a curve, two
/// thirds of the coordinates get an error; half of these lose their tube.
void Audit::setTube(Dice& dice, Edge& edge, double size, bool rigid) const {
  const double position = size * dice.power(-9, -1), rotation = dice.power(-9, -1.5);
  const auto& coordinates = edge.space.coordinates();
  const bool one = !rigid && !coordinates.empty() && dice.oneIn(2);
  const std::size_t only = one ? dice.index(coordinates.size()) : 0;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Coordinate& c = coordinates[i];
    double& tube = edge.tube[static_cast<Eigen::Index>(c.first)];
    tube = isAngle(edge, c) ? rotation : position;
    if (one ? i != only : !rigid && dice.oneIn(3)) tube = 0;
    if (!edge.piece || dice.oneIn(3)) continue;
    edge.piece->error[static_cast<Eigen::Index>(c.first)] = tube * (dice.oneIn(2) ? 1 : 0.1);
    if (dice.oneIn(2)) tube = 0;
  }
}

void Audit::ask(const Case& c, const std::string& row) {
  const std::optional<MotionResult> r = askChecker(c);
  const std::string fault = r ? faultOf(c, *r) : "";
  Table::Column answer = Table::undecided;
  if (r && r->verdict == MotionVerdict::free) answer = Table::free;
  if (r && r->verdict == MotionVerdict::contact) answer = Table::contact;
  if (r && r->reason == UndecidedReason::workLimit) answer = Table::atLimit;
  const double keep = c.question.options.margin + c.question.options.clearanceSlack;
  checker_.count(row, c.truth, keep, answer, !fault.empty());
  if (!fault.empty()) complain("checker", fault, c);
}

void Audit::verify(const Case& c, const std::string& row) {
  const std::optional<PathReport> r = askVerifier(c);
  const std::string fault = r ? faultOf(c, *r) : "";
  Table::Column answer = Table::undecided;
  if (r && r->verdict == PathVerdict::proved) answer = Table::free;
  if (r && r->verdict == PathVerdict::refuted) answer = Table::contact;
  if (r && !r->findings.empty() && r->findings.front().reason == "work limit reached")
    answer = Table::atLimit;
  verifier_.count(row, c.truth, c.question.options.margin, answer, !fault.empty());
  if (!fault.empty()) complain("verifier", fault, c);
}

void Audit::complain(const char* who, const std::string& fault, const Case& c) {
  if (++complaints_ <= 5) std::cout << who << ": " << fault << "\n" << describe(c) << std::endl;
}

}  // namespace corridor::audit
