#include "planner/checker/never_in_contact.h"

#include <atomic>
#include <cmath>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "collision/world/body_queries.h"
#include "planner/checker/checker.h"
#include "planner/checker/pair_survey.h"
#include "planner/model/model_builder.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Verdict = NeverInContactResult::Verdict;

/// Returns a URDF's link with a sphere at x = `at`.
std::string ball(const std::string& name, double radius, double at = 0) {
  return "<link name='" + name + "'><collision><origin xyz='" + std::to_string(at) +
         " 0 0'/><geometry><sphere radius='" + std::to_string(radius) +
         "'/></geometry></collision></link>";
}

std::string limits(double lower, double upper) {
  return "<limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) +
         "' effort='1' velocity='1'/>";
}

/// @param more elements of the joint: its limit, its axis, its mimic.
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& at, const std::string& more) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + at + "'/>" + more + "</joint>";
}

constexpr const char* kAboutZ = "<axis xyz='0 0 1'/>";

Model modelOf(const std::string& elements) {
  const std::filesystem::path folder = test::newFolder();
  std::ofstream(folder / "arm.urdf") << "<robot name='arm'>" << elements << "</robot>";
  Model model = ModelBuilder().addRobot(folder / "arm.urdf").build();
  std::filesystem::remove_all(folder);
  return model;
}

std::size_t bodyNamed(const Model& model, const std::string& name) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].name == name) return b;
  throw std::out_of_range(name);
}

NeverInContactResult prove(const Model& model, const std::string& a, const std::string& b,
                           const NeverInContactOptions& options = {}) {
  const Scene scene = makeScene(model, Required::beyondProofs());
  QueryContext context;
  return NeverInContact(model, scene)
      .prove(bodyNamed(model, a), bodyNamed(model, b), options, context);
}

/// Two links of length 1 that move in the plane, with a ball on the base and one on the hand. If
/// the elbow is at φ, the centres of the balls are 2·cos(φ/2) apart. So the balls are nearest where
/// the elbow is at a limit.
Model planarArm(double elbowLimit, double radius, const std::string& shoulderType = "revolute") {
  return modelOf(ball("base", radius) + "<link name='upper'/>" + ball("hand", radius, 1) +
                 joint("shoulder", shoulderType, "base", "upper", "0 0 0",
                       kAboutZ + (shoulderType == "revolute" ? limits(-0.5, 0.5) : std::string())) +
                 joint("elbow", "revolute", "upper", "hand", "1 0 0",
                       kAboutZ + limits(-elbowLimit, elbowLimit)));
}

constexpr double kElbow = 2.5, kGap = 0.02;
/// With this radius, the balls touch where the elbow is at a limit.
const double kTouching = std::cos(kElbow / 2);

TEST(NeverInContact, ProvesAnArmThatJustMissesItself) {
  const NeverInContactResult result =
      prove(planarArm(kElbow, kTouching - kGap / 2), "base", "hand", {.boxes = 20000});
  EXPECT_EQ(result.verdict, Verdict::proved) << result.boxes;
  EXPECT_GT(result.boxes, 10u);
  const Model model = planarArm(kElbow, kTouching - kGap / 2);
  EXPECT_EQ(prove(model, "hand", "base", {.boxes = 20000}).verdict, Verdict::proved)
      << "in the other order";
}

TEST(NeverInContact, NeverProvesAnArmThatJustTouchesItself) {
  // The balls overlap by 0.1 mm, in a tiny region of joint values at each limit of the elbow. The
  // middles of boxes of joint values, tested breadth first, may or may not meet this region before
  // the work limit.
  const NeverInContactResult result =
      prove(planarArm(kElbow, kTouching + 0.5e-4), "base", "hand", {.boxes = 20000});
  EXPECT_NE(result.verdict, Verdict::proved);
  EXPECT_EQ(prove(planarArm(kElbow, 1.5 * kTouching), "base", "hand").verdict, Verdict::tooClose);
}

TEST(NeverInContact, KeepsTheMargin) {
  const Model model = planarArm(kElbow, kTouching - 0.05);  // a gap of 0.1 m
  EXPECT_EQ(prove(model, "base", "hand", {.margin = 0.08, .boxes = 20000}).verdict,
            Verdict::proved);
  EXPECT_NE(prove(model, "base", "hand", {.margin = 0.101, .boxes = 20000}).verdict,
            Verdict::proved);
}

TEST(NeverInContact, CoversValuesBeyondTheLimits) {
  // The gap at the limit is 0.04 m. Since d/dφ 2·cos(φ/2) = −sin(φ/2), the centres are nearer by at
  // least 0.047 m if the elbow is 0.05 rad beyond the limit.
  const Model model = planarArm(kElbow, kTouching - 0.02);
  EXPECT_EQ(prove(model, "base", "hand", {.boxes = 20000}).verdict, Verdict::proved);
  EXPECT_NE(prove(model, "base", "hand", {.beyondLimits = 0.05, .boxes = 20000}).verdict,
            Verdict::proved);
}

TEST(NeverInContact, CoversTheWholeCircle) {
  const Model model = planarArm(kElbow, kTouching - 0.05, "continuous");
  EXPECT_EQ(prove(model, "base", "hand", {.boxes = 200000}).verdict, Verdict::proved);
  // After half a turn the hand meets the post, a ball beside the axis. No limit excludes this
  // angle.
  const Model met =
      modelOf("<link name='root'/>" + ball("post", 0.1, -1) + "<link name='turn'/>" +
              ball("hand", 0.1, 1) + joint("fix", "fixed", "root", "post", "0 0 0", "") +
              joint("pan", "continuous", "root", "turn", "0 0 0", kAboutZ) +
              joint("slide", "prismatic", "turn", "hand", "0 0 0", limits(-0.01, 0.01)));
  EXPECT_NE(prove(met, "post", "hand").verdict, Verdict::proved);
}

TEST(NeverInContact, StopsAtTheWorkLimit) {
  const Model model = planarArm(kElbow, kTouching - kGap / 2);
  const NeverInContactResult result = prove(model, "base", "hand", {.boxes = 10});
  EXPECT_EQ(result.verdict, Verdict::workLimit);
  EXPECT_EQ(result.boxes, 10u);
  EXPECT_EQ(prove(model, "base", "hand", {.boxes = 0}).verdict, Verdict::workLimit);
  const NeverInContactResult tests = prove(model, "base", "hand", {.tests = 0});
  EXPECT_EQ(tests.verdict, Verdict::workLimit);
  EXPECT_EQ(tests.boxes, 0u);
  const std::atomic<bool> interrupted = true;
  const NeverInContactResult none = prove(model, "base", "hand", {.interrupted = &interrupted});
  EXPECT_EQ(none.verdict, Verdict::workLimit);
  EXPECT_EQ(none.boxes, 0u);
}

TEST(NeverInContact, ReportsTheShareThatIsProved) {
  const Model model = planarArm(kElbow, kTouching - kGap / 2);
  double last = 0;
  for (const std::uint64_t boxes : {0u, 5u, 10u, 20000u}) {
    const NeverInContactResult result = prove(model, "base", "hand", {.boxes = boxes});
    EXPECT_GE(result.provedShare, last);
    EXPECT_EQ(result.verdict == Verdict::proved, boxes == 20000);
    EXPECT_FALSE(result.exhausted);
    // Shares are powers of two, and their sums are exact.
    EXPECT_EQ(result.provedShare == 1, result.verdict == Verdict::proved);
    last = result.provedShare;
  }
  // The centres are 1.6 m apart if the elbow is at 1.287 rad: 48 % of all states are in contact.
  const NeverInContactResult half = prove(planarArm(kElbow, 0.8), "base", "hand", {.boxes = 1000});
  EXPECT_LE(half.provedShare, 0.52);
}

/// Two balls touch only at one joint value, the limit of the slide, which no sample meets.
TEST(NeverInContact, DoesNotProveATouchInOnePoint) {
  const auto slider = [](double upper) {
    return modelOf(ball("base", 0.25) + "<link name='cart'/>" + ball("hand", 0.25) +
                   joint("slide", "prismatic", "base", "cart", "2 0 0",
                         "<axis xyz='-1 0 0'/>" + limits(0, upper)) +
                   joint("turn", "continuous", "cart", "hand", "0 0 0", kAboutZ));
  };
  EXPECT_NE(prove(slider(1.5), "base", "hand", {.boxes = 20000}).verdict, Verdict::proved);
  EXPECT_EQ(prove(slider(1.49), "base", "hand", {.boxes = 20000}).verdict, Verdict::proved);
}

TEST(NeverInContact, TriesNothingWithoutBounds) {
  const auto mimic = [](const std::string& multiplier) {
    return modelOf(ball("base", 0.1) + "<link name='turn'/>" + ball("hand", 0.1, 1) +
                   joint("pan", "continuous", "base", "turn", "0 0 0", kAboutZ) +
                   joint("follow", "continuous", "turn", "hand", "1 0 1",
                         kAboutZ + ("<mimic joint='pan' multiplier='" + multiplier + "'/>")));
  };
  EXPECT_EQ(prove(mimic("-2"), "base", "hand").verdict, Verdict::proved);
  // After a full turn of `pan`, a joint that mimics it with the multiplier 1/2 is elsewhere. The
  // reader refuses such a joint, but a model may have one.
  Model half = mimic("-2");
  half.tree.frames.back().multiplier = 0.5;
  EXPECT_EQ(prove(half, "base", "hand").verdict, Verdict::notTried);
  // In this model, no joint is between the two links.
  const Model fixed = modelOf(ball("base", 0.1) + ball("lamp", 0.1, 1) + ball("hand", 0.1) +
                              joint("fix", "fixed", "base", "lamp", "0 0 0", "") +
                              joint("pan", "continuous", "base", "hand", "2 0 0", kAboutZ));
  EXPECT_EQ(prove(fixed, "base", "lamp").verdict, Verdict::notTried);
}

TEST(NeverInContact, RefusesBadOptions) {
  const Model model = planarArm(1, 0.1);
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(prove(model, "base", "hand", {.margin = bad}), std::invalid_argument);
    EXPECT_THROW(prove(model, "base", "hand", {.beyondLimits = bad}), std::invalid_argument);
  }
}

/// A random tree of links, with revolute, continuous and prismatic joints, and mimics. Links have
/// one or two shapes.
std::string randomRobot(std::mt19937_64& random) {
  const auto uniform = [&](double lower, double upper) {
    return std::uniform_real_distribution(lower, upper)(random);
  };
  const auto triple = [&](double size) {
    return std::to_string(uniform(-size, size)) + " " + std::to_string(uniform(-size, size)) + " " +
           std::to_string(uniform(-size, size));
  };
  const auto shape = [&] {
    const std::string sizes[] = {"<sphere radius='" + std::to_string(uniform(0.05, 0.15)) + "'/>",
                                 "<box size='" + std::to_string(uniform(0.05, 0.5)) + " 0.1 0.2'/>",
                                 "<cylinder radius='0.06' length='0.3'/>"};
    return "<collision><origin xyz='" + triple(0.3) + "' rpy='" + triple(3) + "'/><geometry>" +
           sizes[random() % 3] + "</geometry></collision>";
  };
  std::string text, typeOfFirst;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "l" + std::to_string(i);
    text += "<link name='" + name + "'>" + shape() + (random() % 2 ? shape() : "") + "</link>";
    if (i == 0) continue;
    const std::string parent =
        "l" + std::to_string(i - 1 - static_cast<int>(random() % 2) * (i > 1));
    const std::string types[] = {"revolute", "revolute", "continuous", "prismatic"};
    const std::string type = types[random() % 4];
    const double low = uniform(-1.5, 0), high = uniform(0, 1.5),
                 shrink = type == "prismatic" ? 0.2 : 1;
    std::string more = "<axis xyz='" + triple(1) + "'/>" + limits(shrink * low, shrink * high);
    if (i == 1) typeOfFirst = type;
    // No prismatic joint may mimic a continuous one.
    const bool mayFollow = typeOfFirst != "continuous" || type != "prismatic";
    if (i == 4 && mayFollow && random() % 2)
      more += "<mimic joint='j1' multiplier='-2' offset='0.1'/>";
    text += joint("j" + std::to_string(i), type, parent, name, triple(0.8), more);
  }
  return text;
}

/// At random and extreme joint values, no pair that was proved may be closer than the margin. The
/// distances come from static queries, which do not use boxes of joint values.
TEST(NeverInContact, NoStateRefutesAProof) {
  std::mt19937_64 random(test::testSeed(20261));
  const NeverInContactOptions options{.margin = 0.02, .beyondLimits = 0.1, .boxes = 400};
  std::size_t proved = 0, met = 0, others = 0;
  const auto robots = static_cast<std::size_t>(test::casesOf(20, 40));
  for (std::size_t robot = 0; robot < robots; ++robot) {
    const Model model = modelOf(randomRobot(random));
    const Scene scene = makeScene(model, Required::beyondProofs());
    const NeverInContact prover(model, scene);
    QueryContext context;
    std::vector<std::size_t> firstShape{0};
    for (const ModelBody& body : model.bodies)
      firstShape.push_back(firstShape.back() + body.shapes.size());
    for (std::size_t a = 0; a < model.bodies.size(); ++a)
      for (std::size_t b = a + 1; b < model.bodies.size(); ++b) {
        const bool isProved = prover.prove(a, b, options, context).verdict == Verdict::proved;
        ++(isProved ? proved : others);
        double least = HUGE_VAL;
        for (int i = 0; i < 300; ++i) {
          Configuration q = randomConfiguration(model.space, [&] { return random(); });
          for (const Coordinate& c : model.space.coordinates()) {
            double& value = q[static_cast<Eigen::Index>(c.first)];
            const bool line = c.kind == Coordinate::Kind::line;
            if (!line) continue;
            const double kind = std::uniform_real_distribution(0.0, 1.0)(random);
            if (kind < 0.2) value = c.lower - options.beyondLimits;
            if (kind > 0.8) value = c.upper + options.beyondLimits;
          }
          const std::vector<Transform> X_WF = framePoses(model.tree, q);
          for (std::size_t s = firstShape[a]; s < firstShape[a + 1]; ++s)
            for (std::size_t t = firstShape[b]; t < firstShape[b + 1]; ++t)
              least = std::min(
                  least,
                  distance(Posed(scene.bodies()[s].body, X_WF[model.bodies[a].frame]),
                           Posed(scene.bodies()[t].body, X_WF[model.bodies[b].frame]), {}, context)
                      .distance);
        }
        met += least == 0;
        if (isProved) {
          EXPECT_GT(least, options.margin)
              << "robot " << robot << ": " << model.bodies[a].name << ", " << model.bodies[b].name;
        }
      }
  }
  // This test shows something only if proved pairs, other pairs, and contacts are common.
  EXPECT_GT(proved, robots);
  EXPECT_GT(others, robots);
  EXPECT_GT(met, robots / 2);
}

}  // namespace
}  // namespace corridor
