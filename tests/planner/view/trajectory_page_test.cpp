// Tests that a page plays a trajectory at its true speed: poses, plots and findings at their times.
#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "planner/view/curve_plots.h"
#include "planner/view/view_page.h"
#include "tests/planner/trajectory/trajectory_fixture.h"
#include "tests/planner/view/page_reader.h"

namespace corridor {
namespace {

using test::PageReader;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A cubic polynomial of time, c0 + c1·s + c2·s² + c3·s³, and its derivatives; s is the time since
/// the beginning of the piece.
struct Cubic {
  double c[4];

  /// Returns the cubic with these positions and velocities after 0 and `duration` seconds, by
  /// solving for its coefficients.
  static Cubic through(double p0, double v0, double p1, double v1, double duration) {
    const double d = p1 - p0 - v0 * duration, e = v1 - v0;
    return {{p0, v0, (3 * d - e * duration) / (duration * duration),
             (e * duration - 2 * d) / (duration * duration * duration)}};
  }
  double position(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
  double velocity(double s) const { return c[1] + s * (2 * c[2] + s * 3 * c[3]); }
  double acceleration(double s) const { return 2 * c[2] + 6 * c[3] * s; }
};

class TrajectoryPage : public test::TrajectoryTest {
 protected:
  ViewedPath viewed(const std::string& text) const {
    ViewedPath path;
    const TrajectoryRows all = rows(text);
    path.report = verifyTrajectory(problem_, all);
    path.curve = curveOf(all, problem_.model.space, *path.report.between);
    for (const TrajectoryRow& row : all.rows) path.solution.path.push_back(row.positions);
    return path;
  }
  PageReader page(const ViewedPath& path) const { return PageReader(viewPage(problem_, path)); }

  /// Three rows whose times do not begin at 0. Pan turns beyond 180°.
  const std::string cubic_ =
      "time,pan,lift,pan_velocity,lift_velocity\n"
      "1,2.5,0.5,0.2,0\n1.5,3.4,0.75,1,0.5\n4,3.5,1,0,-0.25\n";
  const double knots_[3] = {1, 1.5, 4};
  const Cubic pan_[2] = {Cubic::through(2.5, 0.2, 3.4, 1, 0.5),
                         Cubic::through(3.4, 1, 3.5, 0, 2.5)};
  const Cubic lift_[2] = {Cubic::through(0.5, 0, 0.75, 0.5, 0.5),
                          Cubic::through(0.75, 0.5, 1, -0.25, 2.5)};
};

TEST_F(TrajectoryPage, PosesAreAtTheirTimes) {
  const PageReader reader = page(viewed(cubic_));
  const auto& json = reader.json["path"];
  EXPECT_EQ(json["times"], (nlohmann::json{1.0, 4.0}));
  EXPECT_EQ(reader.json["solution"]["between"], "cubic");
  EXPECT_TRUE(reader.json["solution"]["length_m"].is_null() &&
              reader.json["solution"]["rotation_rad"].is_null())
      << "the rows do not give the length of a curve";
  const auto at = reader.array<double>(json["at"]),
             framePoseNumbers = reader.array<double>(json["poses"]);
  const auto edge = reader.array<std::size_t>(json["edge"]);
  const std::vector<std::size_t> states = json["states"];
  ASSERT_EQ(states.size(), 3U);
  EXPECT_EQ(at[states[1]], static_cast<float>(0.5 / 3));
  EXPECT_EQ(at.back(), 1);
  ASSERT_GE(at.size(), 400U) << "no step is larger than a 400th of the path";
  std::vector<std::size_t> frames;
  for (const ModelBody& body : problem_.model.bodies)
    if (body.frame != 0 && (frames.empty() || frames.back() != body.frame))
      frames.push_back(body.frame);
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  ASSERT_EQ(framePoseNumbers.size(), 7 * frames.size() * at.size());
  const double origin[3] = {reader.json["origin"][0], reader.json["origin"][1],
                            reader.json["origin"][2]};
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double s = 1 + 3 * at[i] - knots_[edge[i]];
    Configuration q(2);
    q << pan_[edge[i]].position(s), lift_[edge[i]].position(s);
    const std::vector<Transform> real = framePoses(problem_.model.tree, q);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const double* p = framePoseNumbers.data() + 7 * (i * frames.size() + k);
      // `at` and poses are floats: the time is off by 3·2^-24 s, and speeds are below 5 m/s, 5
      // rad/s.
      const Vec3 position(p[0] + origin[0], p[1] + origin[1], p[2] + origin[2]);
      EXPECT_LT((position - real[frames[k]].t).norm(), 2e-6);
      const Eigen::Quaterniond shown(p[6], p[3], p[4], p[5]);
      EXPECT_LT((shown.normalized().toRotationMatrix() - real[frames[k]].m).norm(), 4e-6);
    }
  }
}

TEST_F(TrajectoryPage, PlotsHaveAllDerivativesAndTheLimits) {
  ViewedPath path = viewed(cubic_);
  path.velocityLimits = test::numbers({3, kInfinity});
  const PageReader reader = page(path);
  const auto& joints = reader.json["plots"]["joints"];
  ASSERT_EQ(joints.size(), 2U);
  EXPECT_EQ(joints[0]["name"], "pan");
  EXPECT_EQ(joints[0]["unit"], "rad");
  EXPECT_TRUE(joints[0]["bounds"].is_null()) << "pan turns without end";
  EXPECT_EQ(joints[0]["velocity"], 3.0);
  EXPECT_EQ(joints[1]["bounds"], (nlohmann::json{-3.14159, 3.14159}));
  EXPECT_TRUE(joints[1]["velocity"].is_null());
  EXPECT_TRUE(joints[0]["acceleration"].is_null());
  const auto at = reader.array<double>(reader.json["plots"]["at"]);
  ASSERT_GE(at.size(), 40U);
  std::size_t piece = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i > 0 && at[i] == at[i - 1]) ++piece;  // the knot: the values after it
    const double s = 1 + 3 * at[i] - knots_[piece];
    for (const int joint : {0, 1}) {
      const auto& cubic = (joint == 0 ? pan_ : lift_)[piece];
      const auto values = [&](int quantity) {
        return reader.array<double>(joints[joint]["values"][quantity]).at(i);
      };
      // Floats, and `at` is off by 2^-24 of 3 s; jerks are below 60 rad/s³.
      EXPECT_NEAR(values(0), cubic.position(s), 2e-5);
      EXPECT_NEAR(values(1), cubic.velocity(s), 2e-5);
      EXPECT_NEAR(values(2), cubic.acceleration(s), 2e-5);
    }
  }
  EXPECT_EQ(piece, 1U);
  EXPECT_EQ(at.back(), 1);
}

TEST_F(TrajectoryPage, LimitsOverTimeAreInTheVerdict) {
  const char* rows = "time,pan,lift\n10,0,1.57\n12,1.6,1.57\n";
  const std::string problem =
      "format: corridor-problem-1\nrobot: arm.yaml\nstart: {pan: 0, lift: 1.57}\ngoal: {pan: 1.6, "
      "lift: 1.57}\n";
  problem_ = read(problem + "limits: {default: {velocity: 0.5, acceleration: 1}}\n");
  ViewedPath path = viewed(rows);
  path.limitsText = "exceeded; velocity";
  const auto exceeded = page(path).json["verdict"];
  EXPECT_EQ(exceeded["verdict"], "proved");
  EXPECT_EQ(exceeded["limits"]["verdict"], "exceeded");
  EXPECT_EQ(exceeded["limits"]["text"], path.limitsText);
  problem_ = read(problem + "limits: {default: {velocity: 1, acceleration: 1}}\n");
  EXPECT_EQ(page(viewed(rows)).json["verdict"]["limits"]["verdict"], "not tested");
  EXPECT_FALSE(page(viewed("pan,lift\n0,1.57\n1.6,1.57\n")).json["verdict"].contains("limits"));
}

TEST_F(TrajectoryPage, RowsWithoutTimesPlayAsAPath) {
  const PageReader reader = page(viewed("pan,lift\n0,0.5\n0.5,0.75\n1,0.3\n"));
  EXPECT_FALSE(reader.json["path"].contains("times"));
  EXPECT_FALSE(reader.json.contains("plots"));
  ViewedPath solution;
  for (const auto& q :
       {test::numbers({0, 0.5}), test::numbers({0.5, 0.75}), test::numbers({1, 0.3})})
    solution.solution.path.push_back(q);
  solution.report = verifySolution(problem_, solution.solution);
  const PageReader path = page(solution);
  for (const char* key : {"at", "t", "edge", "poses"})
    EXPECT_THAT(
        reader.array<double>(reader.json["path"][key]),
        testing::Pointwise(testing::DoubleNear(1e-6), path.array<double>(path.json["path"][key])))
        << key;
  EXPECT_EQ(reader.json["solution"]["rotation_rad"], path.json["solution"]["rotation_rad"]);
}

/// The lower arm is horizontal, 0.7 m above the ground, and reaches 0.4 m. It swings through a
/// post.
TEST_F(TrajectoryPage, FindingsAreAtTheirTimes) {
  problem_ = read(
      "format: corridor-problem-1\nrobot: arm.yaml\nworld:\n  post: {box: [0.1, 0.1, 1], at: "
      "[0.3, 0.3, 0.5]}\nstart: {pan: 0, lift: 0}\ngoal: {pan: 1, lift: 0.5}\n");
  const ViewedPath path = viewed("time,pan,lift\n10,0,1.57\n12,1.6,1.57\n");
  ASSERT_EQ(path.report.verdict, PathVerdict::refuted);
  const PageReader reader = page(path);
  const auto& finding = reader.json["verdict"]["findings"].at(0);
  const double t = path.report.pathReport.findings.at(0).t;
  ASSERT_GT(t, 0);
  EXPECT_DOUBLE_EQ(finding["time_s"].get<double>(), 10 + 2 * t);
  const auto at = reader.array<double>(reader.json["path"]["at"]);
  EXPECT_EQ(at.at(reader.json["path"]["findings"][0].get<std::size_t>()), static_cast<float>(t));
}

/// The limit for a rigid body's position applies to the length of the vector. The limit is stored
/// in the entry of x, and the entry of y is infinite. `limitOf` returns the entry of x for both.
TEST(LimitOf, NumbersOfAPositionShareTheirLimit) {
  const Problem problem = readProblem(CORRIDOR_SOURCE_DIR "/problems/hook_maze");
  const ConfigurationSpace& space = problem.model.space;
  ASSERT_EQ(space.numberNames(), (std::vector<std::string>{"x", "y", "yaw"}));
  const Configuration limits = test::numbers({0.5, kInfinity, 2});
  EXPECT_EQ(view::limitOf(space, 0, limits), 0.5);
  EXPECT_EQ(view::limitOf(space, 1, limits), 0.5);
  EXPECT_EQ(view::limitOf(space, 2, limits), 2);
  EXPECT_EQ(view::limitOf(space, 0, {}), kInfinity);
}

}  // namespace
}  // namespace corridor
