// The audit: bodies that graze by construction, whose verdict is known in 128 bits, asked of the
// checker, the verifier and the check of evidence. README.md beside the folder says what is in it.
#include <algorithm>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/stress/audit/judge.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using namespace audit;

constexpr TreeKind kTrees[] = {TreeKind::wideObb,     TreeKind::wideObb, TreeKind::wideObb,
                               TreeKind::obb,         TreeKind::obbGjk,  TreeKind::obbLinearProgram,
                               TreeKind::obbEdgeFace, TreeKind::aabb,    TreeKind::sphere,
                               TreeKind::rss,         TreeKind::kdop14,  TreeKind::kdop18,
                               TreeKind::kdop26};

/// Makes cases, asks them, and counts the answers.
class Audit {
 public:
  explicit Audit(std::uint64_t seed, Mode mode = Mode::usual)
      : seed_(test::testSeed(seed)), mode_(mode) {
    if (const char* only = std::getenv("CORRIDOR_AUDIT_CASE")) only_ = std::stol(only);
  }

  /// `count` questions to the checker, families by turns; every `verify`th also to the verifier.
  void run(long count, bool states, std::size_t verify) {
    for (long number = only_.value_or(0); checker_.sum(Table::cases) < count; ++number) {
      make(number, states, verify);
      if (only_) break;
    }
  }
  void report(const std::string& title) const {
    checker_.print(title + ", checker");
    verifier_.print(title + ", verifier");
    std::cout << constructions_ << " constructions, of which " << usable_ << " are usable\n\n";
    EXPECT_EQ(checker_.sum(Table::wrong), 0);
    EXPECT_EQ(verifier_.sum(Table::wrong), 0);
  }
  /// Enough of all answers that silence is no agreement.
  void expectDecided() const {
    if (only_) return;
    for (const Table* table : {&checker_, &verifier_}) {
      const long all = table->sum(Table::cases);
      EXPECT_GT(table->sum(Table::truthFree), all / 8);
      EXPECT_GT(table->sum(Table::truthContact), all / 4);
      EXPECT_GT(table->sum(Table::free), all / 10);
      EXPECT_GT(table->sum(Table::contact), all / 10);
      EXPECT_LT(table->sum(Table::atLimit), all / 50);
    }
  }

 private:
  void make(long number, bool states, std::size_t verify) {
    // Every case has dice of its own: any can be repeated alone.
    Dice dice(seed_ + 0x9e3779b97f4a7c15u * (2 * static_cast<std::uint64_t>(number) + states));
    const Family family = kFamilies[static_cast<std::size_t>(number) % std::size(kFamilies)];
    double size = 1;
    Edge edge = randomEdge(dice, family, states, size);
    size *= dice.power(-1, 0.3);
    Question question;
    question.mode = mode_;
    question.inTube = dice.oneIn(6);
    question.rigidMotion = isRigidBody(edge) && dice.oneIn(2);
    MotionOptions& o = question.options;
    if (dice.oneIn(4)) o.margin = size * dice.power(-4, -0.5);
    if (dice.oneIn(8)) o.reserve = size * dice.power(-8, -1);
    o.earliest = dice.oneIn(3);
    if (question.inTube) setTube(dice, edge, size, question.rigidMotion);
    ++constructions_;
    const Graze graze(dice, edge, {size, o.margin + o.reserve, question.inTube});
    if (!graze.usable()) return;
    ++usable_;
    for (int k = 0; k < 6; ++k) {
      const double gap = dice.power(-13, -2) * size * (question.inTube || k % 2 ? -1 : 1);
      o.trees = dice.of(std::span<const TreeKind>(kTrees));
      const EdgeMethod methods[] = {EdgeMethod::certified, EdgeMethod::certified,
                                    EdgeMethod::certified, EdgeMethod::adaptive,
                                    EdgeMethod::advancement};
      question.method = methods[dice.index(5)];
      // Large enough that a method on distances comes to an end, or so small that only rounding is
      // between free and contact.
      const bool certified = question.method == EdgeMethod::certified;
      o.tolerance = std::max(4 * graze.rounding(), 1e-7 * size);
      if (certified && dice.oneIn(2)) o.tolerance = size * dice.power(-14, -8);
      o.workLimit = certified ? 2'000'000 : 200'000;
      Truth truth;
      const Shape rest = graze.rest(gap, truth);
      const Case c{edge,
                   graze,
                   rest,
                   truth,
                   question,
                   nameOf(family) + ", seed " + std::to_string(seed_) +
                       ", CORRIDOR_AUDIT_CASE=" + std::to_string(number) + ", gap " +
                       std::to_string(k) + " of 6: " + std::to_string(gap / size) + " of the size"};
      ask(c, nameOf(family));
      if (o.reserve == 0 && dice.oneIn(verify)) verifyToo(c, nameOf(family));
    }
  }

  static void setTube(Dice& dice, Edge& edge, double size, bool rigid) {
    const double position = size * dice.power(-9, -1), rotation = dice.power(-9, -1.5);
    for (const Coordinate& c : edge.space.coordinates()) {
      double& tube = edge.tube[static_cast<Eigen::Index>(c.first)];
      const bool turns =
          std::any_of(edge.tree.frames.begin(), edge.tree.frames.end(), [&](const Frame& frame) {
            return frame.joint == Frame::Joint::turn && frame.variable == c.first;
          });
      tube = turns || c.kind != Coordinate::Kind::line ? rotation : position;
      if (!rigid && dice.oneIn(3)) tube = 0;
    }
  }

  void ask(const Case& c, const std::string& family) {
    const std::optional<MotionResult> r = askChecker(c);
    const std::string fault = r ? faultOf(c, *r) : "";
    const double keep = c.question.options.margin + c.question.options.reserve;
    Table::Column answer = Table::undecided;
    if (r && r->verdict == MotionVerdict::free) answer = Table::free;
    if (r && r->verdict == MotionVerdict::contact) answer = Table::contact;
    if (r && r->reason == UndecidedReason::workLimit) answer = Table::atLimit;
    checker_.count(c.question.inTube ? "tube: worst corner" : family, c.truth, keep, answer,
                   !fault.empty());
    if (!fault.empty()) tell("checker", fault, c);
  }
  void verifyToo(const Case& c, const std::string& family) {
    const std::optional<PathReport> r = askVerifier(c);
    const std::string fault = r ? faultOf(c, *r) : "";
    Table::Column answer = Table::undecided;
    if (r && r->verdict == PathVerdict::proved) answer = Table::free;
    if (r && r->verdict == PathVerdict::refuted) answer = Table::contact;
    if (r && !r->findings.empty() && r->findings.front().reason == "work limit reached")
      answer = Table::atLimit;
    verifier_.count(c.question.inTube ? "tube: worst corner" : family, c.truth,
                    c.question.options.margin, answer, !fault.empty());
    if (!fault.empty()) tell("verifier", fault, c);
  }
  void tell(const char* who, const std::string& fault, const Case& c) {
    if (++told_ <= 5) std::cout << who << ": " << fault << "\n" << describe(c) << std::endl;
  }

  std::uint64_t seed_;
  Mode mode_;
  std::optional<long> only_;
  Table checker_, verifier_;
  long constructions_ = 0, usable_ = 0;
  int told_ = 0;
};

long countOf(long normally, long stress) {
  return (test::stressAsked() ? stress : normally) / test::kSlowdown;
}

TEST(Audit, Edges) {
  Audit audit(1);
  audit.run(countOf(20'000, 1'000'000), false, 4);
  audit.report("edges");
  audit.expectDecided();
}

TEST(Audit, States) {
  Audit audit(2);
  audit.run(countOf(20'000, 1'000'000), true, 4);
  audit.report("states");
  audit.expectDecided();
}

}  // namespace
}  // namespace corridor
