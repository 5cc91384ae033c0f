// Pairs of links that were proved never in contact are left out of the tests only where the proof
// covers them: margin, padding, tube and joint values, through every public way of asking.
#include "planner/model/pair_proofs.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/checker/never_in_contact.h"
#include "planner/model/model_builder.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/problem.h"
#include "planner/robot/joint_types.h"
#include "planner/solve/verify_solution.h"
#include "planner/verify/proved_range.h"
#include "planner/verify/verify_path.h"

namespace corridor {
namespace {

constexpr double kMargin = 0.1, kBeyond = 0.05, kLimit = 1;

/// Returns the description of an arm that turns about z, within ±kLimit, beside a block that is
/// fixed to its base. The arm's corner edge passes the corner (0.1, 0.5) of the block at the
/// distance `gapAt`. No other pair has two shapes.
RobotDescription turner(const std::string& type = "revolute") {
  RobotParts parts;
  parts.links = {{"base", {}},
                 {"block", {shapeOf("block", Box{{0.2, 0.2, 0.2}}, {{0, 0.6, 0}})}},
                 {"arm", {shapeOf("arm", Box{{0.4, 0.05, 0.05}}, {{0.5, 0, 0}})}}};
  RobotParts::Joint mount, turn;
  mount.name = "mount", mount.parent = "base", mount.child = "block";
  turn.name = "turn", turn.parent = "base", turn.child = "arm", turn.axis = Vec3::UnitZ();
  turn.type = type == "revolute" ? JointType::revolute : JointType::continuous;
  if (type == "revolute") turn.lower = -kLimit, turn.upper = kLimit;
  parts.joints = {mount, turn};
  std::vector<Fault> faults;
  RobotDescription model = makeRobot(std::move(parts), faults).value();
  model.allowed.push_back({"arm", "block", std::string(kNeverInContact), {{kMargin, kBeyond}}});
  return model;
}

/// Returns `turner` with a second joint, so that something is planned for if the first is held.
RobotDescription turnerWithSlide() {
  RobotDescription description = turner();
  JointModel slide;
  slide.name = "slide", slide.type = JointType::prismatic, slide.parent = 0, slide.child = 3;
  slide.lower = 0, slide.upper = 1;
  description.links.push_back({"cart", {}});
  description.joints.push_back(slide);
  return description;
}

/// The distance of arm and block, for angles from 0.9 to 1.37 rad: that of the block's corner from
/// the line along the arm's side.
double gapAt(double angle) {
  return 0.5 * std::cos(angle) - 0.1 * std::sin(angle) - 0.025;
}

Model modelOf(RobotDescription description, const std::string& held = "", double value = 0) {
  ModelRobot robot;
  robot.description = std::move(description);
  if (const auto j = findJoint(robot.description, held)) robot.held[*j] = value;
  chooseJoints(robot, allMoving(robot));
  ModelBuilder builder;
  builder.addRobot(std::move(robot));
  return builder.build();
}

Configuration at(double angle) {
  return Configuration::Constant(1, angle);
}

Task taskOf(const Model& model, double margin = 0, Padding padding = {}, double tube = 0) {
  Task task;
  task.margin = margin;
  task.padding = std::move(padding);
  task.tube =
      tubeOf(model.space, TubeSpec{.joints = tube, .slides = {}, .position = {}, .rotation = {}});
  return task;
}

std::size_t pairsOf(const Checker& checker) {
  return checker.scene().pairs().size();
}

MotionVerdict verdictOf(const Model& model, const CheckerOptions& options, double angle) {
  return Checker(model, options).certifyState(at(angle)).verdict;
}
PathVerdict verdictOf(const Model& model, const Task& task, double angle) {
  return verifyPath(plainProblem(model, task), {at(angle)}).verdict;
}

/// The proof that the other tests give to the model is true.
TEST(PairProofs, TheProofHolds) {
  const Model model = modelOf(turner());
  const Scene scene = makeScene(model, Required::beyondProofs());
  QueryContext context;
  EXPECT_EQ(NeverInContact(model, scene)
                .prove(0, 1, {.margin = kMargin, .beyondLimits = kBeyond}, context)
                .verdict,
            NeverInContactResult::Verdict::proved);
  EXPECT_GT(gapAt(kLimit + kBeyond), kMargin);
  EXPECT_LT(gapAt(kLimit), kMargin + 0.07);
}

TEST(PairProofs, OptionsThatTheProofCoversLeaveThePairOut) {
  const Model model = modelOf(turner());
  for (const CheckerOptions& options : std::vector<CheckerOptions>{
           {},
           {.margin = kMargin},
           {.margin = 0.05, .padding = {{{0, 9}, {1, 9}}, {{{0, 1}, 0.0499}}}},
           {.tube = at(kBeyond)}}) {
    const Checker checker(model, options);
    EXPECT_EQ(pairsOf(checker), 0u);
    EXPECT_EQ(checker.certifyState(at(kLimit)).verdict, MotionVerdict::free);
  }
}

/// With each of these requirements, the state at the limit is not free. If the pair were left out,
/// it would be.
TEST(PairProofs, RequirementsAboveTheProofAreTested) {
  const Model model = modelOf(turner());
  const double wide = gapAt(kLimit) + 0.001;
  const Padding pair{{}, {{{0, 1}, wide - 0.05}}};
  EXPECT_NE(verdictOf(model, CheckerOptions{.margin = wide}, kLimit), MotionVerdict::free);
  EXPECT_NE(verdictOf(model, CheckerOptions{.margin = 0.5}, kLimit), MotionVerdict::free);
  EXPECT_NE(verdictOf(model, CheckerOptions{.margin = 0.05, .padding = pair}, kLimit),
            MotionVerdict::free);
  EXPECT_NE(verdictOf(model, CheckerOptions{.tube = at(0.4)}, kLimit), MotionVerdict::free);
  EXPECT_EQ(verdictOf(model, taskOf(model, wide), kLimit), PathVerdict::refuted);
  EXPECT_EQ(verdictOf(model, taskOf(model, 0.05, pair), kLimit), PathVerdict::refuted);
  EXPECT_NE(verdictOf(model, taskOf(model, 0, {}, 0.4), kLimit), PathVerdict::proved);
  // Slightly above the proof, the pair is tested, and the answer is right either way.
  for (const CheckerOptions& options : std::vector<CheckerOptions>{
           {.margin = std::nextafter(kMargin, 1)},
           {.margin = 0.05, .padding = {{}, {{{0, 1}, std::nextafter(0.05, 1)}}}},
           {.tube = at(std::nextafter(kBeyond, 1))}}) {
    const Checker checker(model, options);
    EXPECT_EQ(pairsOf(checker), 1u);
    EXPECT_EQ(checker.certifyState(at(0)).verdict, MotionVerdict::free);
    EXPECT_EQ(checker.certifyState(at(1.5)).verdict, MotionVerdict::contact) << "tested";
  }
}

/// Values that are no lengths never leave a pair out.
TEST(PairProofs, BadRequirementsAreRefused) {
  const Model model = modelOf(turner());
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, -0.01}) {
    for (const Padding& padding : {Padding{{}, {{{0, 1}, bad}}}, Padding{{{1, bad}}, {}}}) {
      EXPECT_THROW(Checker(model, {.padding = padding}), std::invalid_argument) << bad;
      if (!padding.pairs.empty()) {
        EXPECT_THROW(verdictOf(model, taskOf(model, 0, padding), 0), std::invalid_argument) << bad;
      }
    }
    EXPECT_THROW(Checker(model, {.margin = bad}), std::invalid_argument) << bad;
    if (bad != HUGE_VAL) {
      EXPECT_THROW(Checker(model, {.tube = at(bad)}), std::invalid_argument);
    }
    EXPECT_THROW(verdictOf(model, taskOf(model, bad), 0), std::invalid_argument) << bad;
    Required need = requiredBy(taskOf(model));
    need.tube = at(bad);
    EXPECT_EQ(model.filter.whyNotTested(0, 1, need), "") << bad;
  }
  Required need = requiredBy(taskOf(model));
  need.tube = {};
  EXPECT_EQ(model.filter.whyNotTested(0, 1, need), "") << "no tube, no proof";
}

TEST(PairProofs, AProblemThatIsChangedKeepsItsProofs) {
  Problem problem;
  problem.model = modelOf(turner());
  problem.task = taskOf(problem.model);
  const auto tested = [&] { return pairsOf(Checker(problem)); };
  EXPECT_EQ(tested(), 0u);
  setMargin(problem, 0.2);
  EXPECT_EQ(tested(), 1u);
  setMargin(problem, 0.3);
  ASSERT_EQ(problem.source.notes.size(), 1u) << "one note, not one for each call";
  EXPECT_EQ(problem.source.notes[0].text,
            "1 pair of never_in_contact is tested: the proof covers a margin of up to 0.1 m and a "
            "tube of up to 0.05 rad or m");
  setMargin(problem, 0.05);
  EXPECT_EQ(tested(), 0u);
  EXPECT_EQ(problem.source.notes.size(), 0u);
  setTube(problem, at(0.06));
  EXPECT_EQ(tested(), 1u);
  EXPECT_EQ(problem.source.notes.size(), 1u);
  setTube(problem, at(0.04));
  problem.task.margin = 0.2;  // not by setMargin
  EXPECT_EQ(tested(), 1u);
  EXPECT_EQ(plainProblem(problem).pairs.size(), 1u);
}

/// Beyond the joint values that the proof covers, the arm meets the block. No motion query may
/// return `free` there, although the pair is not tested.
TEST(PairProofs, NothingIsFreeBeyondTheProvedValues) {
  const Model model = modelOf(turner());
  const Checker checker(model);
  ASSERT_EQ(pairsOf(checker), 0u);
  const double inside = kLimit + 0.9 * kBeyond, outside = kLimit + 1.1 * kBeyond;
  const auto expectCovered = [](const MotionResult& result, bool covered, const char* what) {
    EXPECT_EQ(result.verdict, covered ? MotionVerdict::free : MotionVerdict::undecided) << what;
    EXPECT_EQ(result.reason, covered ? UndecidedReason::none : UndecidedReason::beyondProofs)
        << what;
  };
  for (const double sign : {1.0, -1.0})
    for (const bool covered : {true, false}) {
      const Configuration here = at(0), there = at(sign * (covered ? inside : outside));
      expectCovered(checker.certifyState(there), covered, "state");
      expectCovered(checker.certifyEdge(here, there), covered, "edge");
      expectCovered(checker.certifyEdge(there, here, {.earliest = true}), covered,
                    "edge, backwards");
      const PairMargins none(std::vector<double>{});
      expectCovered(checker.certifyEdge(here, there, {.margins = &none}), covered,
                    "edge with margins");
      MotionCertificate certificate;
      expectCovered(checker.certifyEdge(here, there, {.certificate = &certificate}), covered,
                    "certificate");
      EXPECT_EQ(checker.faultOf({}, here, there, 1).has_value(), !covered);
      CurvePiece piece{Eigen::MatrixXd(1, 2), at(0)};
      piece.coefficients << 0, there[0];
      expectCovered(checker.certifyCurve(piece), covered, "piece");
      const PathProblem plain = plainProblem(model, taskOf(model));
      for (const PathReport& report :
           {verifyPath(plain, {here, there}), verifyPath(plain, {there, here}),
            verifyPath(plain, {there}), verifyCurve(plain, {&piece, 1})}) {
        EXPECT_EQ(report.verdict, covered ? PathVerdict::proved : PathVerdict::undecided);
        ASSERT_EQ(report.findings.size(), covered ? 0u : 1u);
        if (covered) continue;
        EXPECT_EQ(report.findings[0].reason, verify::kBeyondProofs);
        EXPECT_EQ(report.findings[0].configuration, there);
      }
    }
  // The arm is in the block there.
  EXPECT_EQ(verdictOf(model, CheckerOptions{}, 1.5), MotionVerdict::undecided);
  EXPECT_EQ(verdictOf(model, taskOf(model), 1.5), PathVerdict::undecided);
  EXPECT_EQ(verdictOf(model, CheckerOptions{.margin = 0.2}, 1.5), MotionVerdict::contact);
}

/// A piece of a curve may have coefficients outside while its values are inside, and its error and
/// the tube count.
TEST(PairProofs, PiecesAreJudgedByTheirValues) {
  const Model model = modelOf(turner());
  const auto answers = [&](std::initializer_list<double> coefficients, double error, double tube) {
    const auto degree = static_cast<Eigen::Index>(coefficients.size()) - 1;
    CurvePiece piece{Eigen::MatrixXd(1, degree + 1), at(error)};
    std::copy(coefficients.begin(), coefficients.end(), piece.coefficients.data());
    const bool free =
        Checker(model, {.tube = at(tube)}).certifyCurve(piece).verdict == MotionVerdict::free;
    Task task;
    task.tube = at(tube);
    EXPECT_EQ(verifyCurve(plainProblem(model, task), {&piece, 1}).verdict == PathVerdict::proved,
              free);
    return free;
  };
  EXPECT_TRUE(answers({0, 2, 0}, 0, 0)) << "the peak of 1 is at the limit";
  EXPECT_TRUE(answers({0, 2.09, 0}, 0, 0)) << "the peak is 1.045";
  EXPECT_FALSE(answers({0, 2.11, 0}, 0, 0)) << "the peak is 1.055";
  EXPECT_FALSE(answers({0, -2.11, 0}, 0, 0));
  EXPECT_TRUE(answers({0, 1, 1}, 0.049, 0));
  EXPECT_FALSE(answers({0, 1, 1}, 0.051, 0));
  EXPECT_TRUE(answers({0, 1, 1}, 0.02, 0.029));
  EXPECT_FALSE(answers({0, 1, 1}, 0.02, 0.031));
  EXPECT_TRUE(answers({0, 1, 1}, 0, kBeyond)) << "the tube takes all; the limit is still covered";
  EXPECT_FALSE(answers({0, std::nextafter(1, 2), std::nextafter(1, 2)}, 0, kBeyond));
}

/// The proof is for all values of the joint within its limits, so a held joint keeps it.
TEST(PairProofs, HoldForHeldJointsWithinTheLimits) {
  for (const auto& [held, left] : std::vector<std::pair<double, bool>>{{0.3, true},
                                                                       {kLimit, true},
                                                                       {-kLimit - 0.04, true},
                                                                       {kLimit + 0.06, false},
                                                                       {-1.5, false}}) {
    RobotDescription description = turnerWithSlide();
    const Model model = modelOf(description, "turn", held);
    EXPECT_EQ(model.filter.proofs().size(), left ? 1u : 0u) << held;
    EXPECT_EQ(model.filter.whyNotTested(0, 1, requiredBy(taskOf(model))),
              left ? kNeverInContact : kTestedAtRest);
    EXPECT_EQ(pairsOf(Checker(model)), 0u) << "they never move against each other";
    for (const auto& [pair, proof] : model.filter.proofs()) EXPECT_TRUE(proof.ranges.empty());
  }
}

/// A joint with equal limits is not planned for when the proof is made, so the proof is for its
/// only value. For another value, or if the joint is planned for, the pair is tested.
TEST(PairProofs, JointsWithEqualLimitsHaveOneProvedValue) {
  RobotDescription description = turnerWithSlide();
  description.joints[1].lower = description.joints[1].upper = 0.5;
  EXPECT_EQ(modelOf(description, "turn", 0.5).filter.proofs().size(), 1u);
  EXPECT_EQ(modelOf(description, "turn", 0.509).filter.proofs().size(), 0u);
  ModelRobot robot;
  robot.description = description;
  chooseJoints(robot, {1});
  ModelBuilder builder;
  builder.addRobot(std::move(robot));
  EXPECT_EQ(builder.build().filter.proofs().size(), 0u);
}

/// A held joint is stored with a rounding, which a proof with margin 0 does not cover.
TEST(PairProofs, HeldJointsNeedAMarginOfTheProof) {
  RobotDescription description = turnerWithSlide();
  description.allowed.back().proof->margin = 0;
  EXPECT_EQ(modelOf(description, "turn", 0.3).filter.proofs().size(), 0u);
  EXPECT_EQ(modelOf(description).filter.proofs().size(), 1u);
}

TEST(PairProofs, ContinuousJointsHaveNoProvedRange) {
  const Model model = modelOf(turner("continuous"));
  const auto box = provedBox(model, requiredBy(taskOf(model)));
  ASSERT_TRUE(box);
  EXPECT_TRUE(box->contains(at(1e300)));
  EXPECT_EQ(provedBox(model, Required::beyondProofs()), std::nullopt);
}

/// A proof never says anything about planar and floating joints, or about a joint that mimics a
/// continuous one without returning after a turn.
TEST(PairProofs, SomeJointsHaveNoProofs) {
  RobotDescription description = turner();
  for (const JointType type : {JointType::planar, JointType::floating}) {
    description.joints[1].type = type;
    ModelRobot robot;
    robot.description = description;
    chooseJoints(robot, allMoving(robot));
    ModelBuilder builder;
    builder.addRobot(robot).bound("turn", {Vec3::Constant(-1), Vec3::Constant(1)});
    EXPECT_TRUE(builder.build().filter.proofs().empty());
  }
  for (const double multiplier : {1.0, 0.5, 0.0}) {
    RobotDescription mimicking = turner("continuous");
    JointModel follow = mimicking.joints[1];
    follow.name = "follow", follow.child = 3, follow.mimic = Mimic{1, multiplier, 0};
    mimicking.links.push_back({"hand", {shapeOf("hand", Sphere{0.1}, {{0, 0, 5}})}});
    mimicking.joints.push_back(follow);
    mimicking.allowed = {{"hand", "block", std::string(kNeverInContact), {{kMargin, kBeyond}}}};
    EXPECT_EQ(modelOf(mimicking).filter.proofs().size(), multiplier == 0.5 ? 0u : 1u) << multiplier;
  }
}

/// A body without `robot` on a frame that moves would be taken to be at rest.
TEST(MakeScene, RefusesObstaclesThatMove) {
  Model model = modelOf(turner());
  const auto complaint = [&](const auto& make) {
    try {
      make();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto everyWay = [&] {
    const std::string first = complaint([&] { makeScene(model, Required::beyondProofs()); });
    EXPECT_EQ(complaint([&] { const Checker checker(model); }), first);
    EXPECT_EQ(complaint([&] { plainProblem(model, taskOf(model)); }), first);
    return first;
  };
  EXPECT_EQ(everyWay(), "none");
  const std::size_t moving = model.bodies[1].frame;
  model.bodies.push_back({"cup", moving, {}, {shapeOf("cup", Sphere{0.1})}});
  EXPECT_EQ(everyWay(),
            "Model: the frame of the body \"cup\" moves, but the body has no robot; set "
            "ModelBody::robot, or choose a frame that is fixed to the world");
  model.bodies.back().robot = 0;
  EXPECT_EQ(everyWay(), "none");
  model.bodies.back().frame = 99;
  EXPECT_EQ(everyWay(), "Model: the frame of the body \"cup\" does not exist");
}

}  // namespace
}  // namespace corridor
