// Tests of the curves that rows define, of the bounds of these curves, and of the texts that are
// written.
#include "planner/trajectory/trajectory_curve.h"

#include <algorithm>
#include <random>

#include "collision/core/whole_file.h"
#include "planner/problem/text_words.h"
#include "planner/solve/outside_bounds.h"
#include "planner/solve/verify_solution.h"
#include "planner/trajectory/trajectory_text.h"
#include "tests/planner/trajectory/trajectory_fixture.h"

namespace corridor {
namespace {

using test::numbers;
using testing::ElementsAre;
using testing::HasSubstr;

class TrajectoryCurve : public test::TrajectoryTest {
 protected:
  std::string curveComplaint(const std::string& text,
                             std::optional<RowInterpolation> wanted = {}) const {
    try {
      TrajectoryRows read = rows(text);
      const RowInterpolation between = interpolationOf(read, wanted);
      curveOf(read, problem_.model.space, between);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

const char* const kQuintic =
    "time pan lift pan_vel lift_vel pan_acc lift_acc\n1 0 0 0 1 0 0\n1.5 1 1 0 1 0 0\n4 1 0 0 0 0 "
    "0\n";
const char* const kCubic = "time pan lift pan_vel lift_vel\n1 0 0 0 1\n1.5 1 1 0 1\n4 1 0 0 0\n";

TEST_F(TrajectoryCurve, TheFileDecidesWhatLiesBetweenRows) {
  for (const auto& [text, degree] : {std::pair{"0 0\n1 1\n1 0\n", 1}, {kCubic, 3}, {kQuintic, 5}}) {
    TrajectoryRows read = rows(text);
    const Curve curve = curveOf(read, problem_.model.space, interpolationOf(read, {}));
    ASSERT_EQ(curve.pieces.size(), 2u);
    EXPECT_EQ(curve.pieces[0].degree(), degree);
    EXPECT_EQ(curve.knots,
              read.timed ? std::vector({1.0, 1.5, 4.0}) : std::vector({0.0, 1.0, 2.0}));
    EXPECT_EQ(curve.pieces[1].coefficients(1, 0), 1);
    EXPECT_TRUE(read.notes.empty());
  }
}

TEST_F(TrajectoryCurve, TheCommandLineMayChooseLess) {
  TrajectoryRows read = rows(kQuintic);
  EXPECT_EQ(interpolationOf(read, RowInterpolation::cubic), RowInterpolation::cubic);
  EXPECT_EQ(interpolationOf(read, RowInterpolation::linear), RowInterpolation::linear);
  EXPECT_THAT(
      textsOf(read.notes),
      ElementsAre("t.csv: --between cubic: the file's accelerations are not used",
                  "t.csv: --between linear: the file's velocities and accelerations are not "
                  "used"));
  EXPECT_EQ(curveComplaint(kCubic, RowInterpolation::quintic),
            "t.csv: --between quintic needs accelerations, which the file does not have; by "
            "default, cubic is used");
  EXPECT_EQ(curveComplaint("time pan lift\n0 0 0\n1 1 1\n", RowInterpolation::cubic),
            "t.csv: --between cubic needs times and velocities, which the file does not have; by "
            "default, linear is used");
}

TEST_F(TrajectoryCurve, AnglesAreLiteral) {
  EXPECT_EQ(curveComplaint("3.1 0\n-3.1 0\n"),
            "t.csv:2: pan jumps from 3.1 to -3.1 rad, by more than half a turn: angles are used as "
            "they are written; add or subtract whole turns so that the angles continue, or add "
            "rows between");
  // The file has degrees instead of radians.
  EXPECT_EQ(
      curveComplaint("0 0\n90 0\n180 0\n270 0\n"),
      "t.csv:2: pan jumps from 0 to 90 rad, by more than half a turn: angles are used as they "
      "are written; add or subtract whole turns so that the angles continue, or add rows between "
      "(2 more rows have faults)");
  EXPECT_EQ(curveComplaint("3.1 0\n3.2 0\n6 0\n9 0\n"), "");
  EXPECT_EQ(
      curveComplaint("time pan lift pan_vel lift_vel\n0 0 0 0 0\n1 1 0 1e308 0\n1e9 1 0 1e308 "
                     "0\n"),
      "t.csv:4: the values of this row and the row before are too large to compute with");
}

TEST_F(TrajectoryCurve, BoundsHoldAlongTheWholeCurve) {
  // lift is within ±3.14159. It is at 0 in both rows, and the velocity v takes it to v·T·4/27 at a
  // third of the time (closed form of the cubic v·T·τ(1 − τ)²).
  const auto outside = [&](double v) {
    TrajectoryRows read = rows("time pan lift pan_vel lift_vel\n0 0 0 0 0\n1 0 0 0 " +
                               std::to_string(v) + "\n3 0 0 0 0\n");
    return outsideBounds(problem_.model.space,
                         curveOf(read, problem_.model.space, interpolationOf(read, {})).pieces);
  };
  const double limit = problem_.model.space.coordinates()[1].upper * 27 / 4 / 2;
  EXPECT_TRUE(outside(limit - 1e-5).empty());
  for (const double v : {limit + 1e-5, -limit - 1e-5, 1000.0}) {
    const auto places = outside(v);
    ASSERT_EQ(places.size(), 1u) << v;
    EXPECT_EQ(places[0].coordinate, 1u);
    EXPECT_EQ(places[0].piece, std::abs(v) > 500 ? 0u : 1u);
    EXPECT_GT(std::abs(places[0].value), 3.14159);
    if (places[0].piece == 1) {
      EXPECT_NEAR(places[0].t, 1.0 / 3, 0.01);
    }
  }
  // A curve that rests at its bound is within it.
  TrajectoryRows still = rows("time pan lift pan_vel lift_vel\n0 0 3.14159 0 0\n1 0 3.14159 0 0\n");
  EXPECT_TRUE(outsideBounds(problem_.model.space,
                            curveOf(still, problem_.model.space, RowInterpolation::cubic).pieces)
                  .empty());
}

TEST_F(TrajectoryCurve, WrittenTextsReadBackAsTheSameDoubles) {
  const std::uint64_t seed = test::testSeed(4);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-300, 3);
  TrajectoryRows wrote;
  double time = 0;
  for (int i = 0; i < 300; ++i) {
    const auto any = [&] {
      return numbers({unit(random) * std::pow(10, exponent(random)), unit(random)});
    };
    wrote.rows.push_back({0, time, any(), any(), any()});
    time = nearestNanosecond(time + 1e-9 + std::abs(unit(random)));
  }
  for (const bool timed : {true, false})
    for (const int has : {0, 1, 2}) {
      if (!timed && has > 0) continue;
      wrote.timed = timed;
      wrote.hasVelocities = has > 0;
      wrote.hasAccelerations = has > 1;
      std::vector<std::string> all{csvText(wrote, problem_.model)};
      if (timed) all.push_back(messageText(wrote, problem_.model.space));
      for (const std::string& text : all) {
        const TrajectoryRows read = rows(text);
        ASSERT_EQ(read.rows.size(), wrote.rows.size());
        EXPECT_EQ(read.timed, timed);
        EXPECT_EQ(read.hasVelocities, has > 0);
        EXPECT_EQ(read.hasAccelerations, has > 1);
        for (std::size_t k = 0; k < read.rows.size(); ++k) {
          if (timed) {
            ASSERT_EQ(read.rows[k].time, wrote.rows[k].time) << k;
          }
          ASSERT_EQ(read.rows[k].positions, wrote.rows[k].positions) << k;
          if (has > 0) {
            ASSERT_EQ(read.rows[k].velocities, wrote.rows[k].velocities) << k;
          }
          if (has > 1) {
            ASSERT_EQ(read.rows[k].accelerations, wrote.rows[k].accelerations) << k;
          }
        }
      }
    }
  wrote.timed = true;
  wrote.rows[1].time = 1.0 / 3;
  EXPECT_THROW(messageText(wrote, problem_.model.space), std::invalid_argument);
}

/// Joints with any names are written so that the reader finds them.
TEST_F(TrajectoryCurve, NamesOfAnyKindAreReadBack) {
  const std::vector<std::string> all{"Revolute 1",
                                     "a,b",
                                     "c # d",
                                     "e \"f\"",
                                     "time",
                                     "b",
                                     "a",
                                     "1",
                                     "-2.5",
                                     "vel/a",
                                     "a_velocity",
                                     "a.velocity",
                                     "(deg)",
                                     "x;y",
                                     "from",
                                     "velocity/a",
                                     "T\u00fcr",
                                     "acc_a",
                                     "a_acceleration",
                                     "time_from_start"};
  std::mt19937_64 random(test::testSeed(5));
  for (int n = 0; n < 200; ++n) {
    std::vector<std::string> names = all;
    std::shuffle(names.begin(), names.end(), random);
    names.resize(1 + random() % 6);
    std::string text = "<robot name='r'><link name='l0'/>";
    const auto quoted = [](std::string name) {
      for (auto at = name.find('"'); at != name.npos; at = name.find('"', at + 6))
        name.replace(at, 1, "&quot;");
      return name;
    };
    for (std::size_t i = 0; i < names.size(); ++i)
      text += "<link name='l" + std::to_string(i + 1) + "'/><joint name=\"" + quoted(names[i]) +
              "\" type='continuous'><parent link='l" + std::to_string(i) + "'/><child link='l" +
              std::to_string(i + 1) + "'/></joint>";
    write("names.urdf", text + "</robot>");
    std::string state;
    for (const std::string& name : names)
      state += (state.empty() ? "" : ", ") + yamlText(name) + ": 0.5";
    const Problem problem = readProblem(
        write("names.yaml", "format: corridor-problem-1\nrobot: names.urdf\nworld: {}\nstart: {" +
                                state + "}\ngoal: {" + state + "}\n"));
    EXPECT_EQ(problem.task.start, Configuration::Constant(Eigen::Index(names.size()), 0.5));
    TrajectoryRows wrote;
    const auto size = static_cast<Eigen::Index>(names.size());
    wrote.timed = random() % 4 != 0;
    wrote.hasVelocities = wrote.timed && random() % 2;
    wrote.hasAccelerations = wrote.hasVelocities && random() % 2;
    for (int k = 0; k < 3; ++k)
      wrote.rows.push_back({0, double(k), Configuration::Random(size), Configuration::Random(size),
                            Configuration::Random(size)});
    const std::string csv = csvText(wrote, problem.model);
    const TrajectoryRows read = readTrajectory("t.csv", csv, problem.model);
    ASSERT_EQ(read.rows.size(), 3u) << csv;
    EXPECT_EQ(read.timed, wrote.timed);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(read.rows[k].positions, wrote.rows[k].positions) << csv;
      if (wrote.hasVelocities) {
        EXPECT_EQ(read.rows[k].velocities, wrote.rows[k].velocities) << csv;
      }
      if (wrote.hasAccelerations) {
        EXPECT_EQ(read.rows[k].accelerations, wrote.rows[k].accelerations) << csv;
      }
    }
  }
}

TEST_F(TrajectoryCurve, FloatingBodiesAreWrittenWithQuaternions) {
  const Problem body = read(head + poses);
  TrajectoryRows wrote;
  wrote.timed = wrote.hasVelocities = true;
  const Configuration zero = Configuration::Zero(7);
  wrote.rows = {{0, 0, numbers({1, 2, 3, 0, 0, 0, 1}), numbers({4, 5, 6, 0, 0, 0, 0}), {}},
                {0, 1, numbers({1, 2, 3, 0.1, 0, 0, 1}), zero, {}}};
  const TrajectoryRows back = readTrajectory("t.csv", csvText(wrote, body.model), body.model);
  EXPECT_EQ(back.rows[0].velocities, wrote.rows[0].velocities);
  EXPECT_EQ(back.rows[1].positions, wrote.rows[1].positions);
  EXPECT_THROW(messageText(wrote, body.model.space), std::invalid_argument);
}

TEST_F(TrajectoryCurve, StartAndGoalAreNotedAndBoundsRefute) {
  // The first row is not the start; the last row is in the goal.
  const auto verified = [&](const std::string& text) {
    return verifyTrajectory(problem_, rows(text));
  };
  const VerifyReport later = verified("0.1 0\n1 0.5\n");
  EXPECT_EQ(later.verdict, PathVerdict::proved);
  EXPECT_THAT(textsOf(later.notes), ElementsAre("the trajectory does not begin at the problem's "
                                                "start: it differs by 0.1 rad in a joint"));
  const VerifyReport shorter = verified("0 0\n0.5 0.5\n");
  EXPECT_EQ(shorter.verdict, PathVerdict::proved);
  EXPECT_THAT(
      textsOf(shorter.notes),
      ElementsAre("the trajectory does not end in the problem's goal: it differs by 0.5 rad in a "
                  "joint"));
  const VerifyReport beyond = verified("time pan lift\n0 0 0\n2 0 -3.5\n3 0 0\n");
  EXPECT_EQ(beyond.verdict, PathVerdict::refuted);
  EXPECT_THAT(beyond.violations,
              ElementsAre(HasSubstr("lift = -3.5 is outside of its bounds, [-3.14159, 3.14159]: at "
                                    "2 s, in line 3")));
  const VerifyReport degrees = verified("time pan lift\n0 0 0\n2 0 35\n3 0 0\n");
  ASSERT_FALSE(degrees.violations.empty());
  EXPECT_THAT(degrees.violations[0], HasSubstr("; is it in degrees? These files have radians"));
}

}  // namespace
}  // namespace corridor
