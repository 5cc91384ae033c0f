// Compares the verdicts on certified edges with those of the independent verifier, and the box
// overlap test with a test in rationals.
#include <array>
#include <iostream>
#include <random>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "collision/volumes/overlap_obb_obb.h"
#include "collision/world/scene.h"
#include "planner/robot/edge_motion.h"
#include "planner/verify/verify_path.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Random = std::mt19937_64;
using test::addBox;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
Vec3 vector(Random& random, double size) {
  const double x = uniform(random, -size, size), y = uniform(random, -size, size),
               z = uniform(random, -size, size);
  return {x, y, z};
}
Eigen::Quaterniond rotation(Random& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return {w, x, y, z};
}

// ---- edges ----

TriangleMesh soup(Random& random, int triangles, double size, double edge) {
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 centre = vector(random, size);
    const Vec3 p = centre + vector(random, edge), q = centre + vector(random, edge),
               r = centre + vector(random, edge);
    test::add(mesh, p, q, r);
  }
  return mesh;
}

struct Case {
  const char* name;
  TriangleMesh moving, fixed;
  double size, step;  // size: bound of |coordinates| of a state (m, or rad for angles of the arm);
                      // step: their largest change along an edge
  enum Mount { floating, planar, arm } mount;
};

std::vector<Case> cases(Random& random) {
  std::vector<Case> all(5);
  all[0] = {"soup in a soup", soup(random, 12, 0.3, 0.3), soup(random, 60, 3, 0.5), 3, 1,
            Case::floating};
  all[1] = {"bar in a room of boxes", {}, {}, 4, 1.5, Case::floating};
  addBox(all[1].moving, Vec3(-1, -0.1, -0.1), Vec3(1, 0.1, 0.1));
  addBox(all[1].fixed, Vec3(-50, -50, -5), Vec3(50, 50, -4));  // large triangles, small robot
  for (int i = 0; i < 12; ++i) {
    const Vec3 c = vector(random, 4);
    addBox(all[1].fixed, c - Vec3(0.5, 0.3, 0.8), c + Vec3(0.5, 0.3, 0.8),
           rotation(random).normalized().toRotationMatrix());
  }
  all[2] = {"slats", {}, {}, 1.5, 1, Case::floating};
  addBox(all[2].moving, Vec3(-0.6, -0.02, -0.2), Vec3(0.6, 0.02, 0.2));
  for (int i = -4; i <= 4; ++i)
    addBox(all[2].fixed, Vec3(-2, 0.3 * i, -2), Vec3(2, 0.3 * i + 0.01, 0.2));
  all[3] = {"hook in the plane", {}, {}, 4, 1.5, Case::planar};
  addBox(all[3].moving, Vec3(-0.8, -0.1, -0.1), Vec3(0.8, 0.1, 0.1));
  addBox(all[3].moving, Vec3(0.6, -0.1, -0.1), Vec3(0.8, 0.7, 0.1));
  for (int i = 0; i < 20; ++i) {
    const Vec3 c = Vec3(1, 1, 0).cwiseProduct(vector(random, 4));
    addBox(all[3].fixed, c - Vec3(0.3, 0.3, 0.5), c + Vec3(0.3, 0.3, 0.5));
  }
  all[4] = {"arm in a soup", {}, soup(random, 60, 3, 0.5), 3, 0.7, Case::arm};
  addBox(all[4].moving, Vec3(-0.1, -0.1, -0.1), Vec3(0.8, 0.1, 0.1));
  return all;
}

/// The robot of a case. The robot's last frame carries the moving mesh. On an arm, each of the two
/// frames before the last one carries a copy of this mesh, too.
struct Robot {
  KinematicTree tree;
  ConfigurationSpace space;
  std::vector<std::size_t> frames;

  explicit Robot(const Case& c) {
    using Kind = Coordinate::Kind;
    Frame shift, turn;
    shift.joint = Frame::Joint::translation;
    shift.variable = 0;
    const auto line = [&](Kind kind) {
      Coordinate coordinate;
      coordinate.kind = kind;
      coordinate.lower = -100, coordinate.upper = 100;
      space.add(coordinate);
    };
    if (c.mount == Case::arm) {
      for (std::size_t j = 0; j < 4; ++j) {
        Frame joint;
        joint.parent = tree.frames.size() - 1;
        joint.joint = j == 2 ? Frame::Joint::prismatic : Frame::Joint::revolute;
        joint.axis = j == 2 ? Vec3::UnitX() : j % 2 ? Vec3(0, 1, 0.2) : Vec3(0.1, 0, 1);
        joint.fixed.p = Vec3(j > 0 ? 0.8 : 0, 0, 0);
        joint.variable = j;
        line(Kind::line);
        const std::size_t added = tree.add(joint);
        if (j > 0) frames.push_back(added);
      }
      return;
    }
    const bool planar = c.mount == Case::planar;
    shift.count = planar ? 2 : 3;
    for (std::size_t i = 0; i < shift.count; ++i) line(Kind::line);
    turn.parent = tree.add(shift);
    turn.joint = planar ? Frame::Joint::revolute : Frame::Joint::rotation;
    turn.variable = shift.count;
    line(planar ? Kind::circle : Kind::rotation);
    frames.push_back(tree.add(turn));
  }

  /// Returns a random edge. @param little if true, the rotation of a floating body along the edge
  /// is small.
  std::pair<Configuration, Configuration> edge(Random& random, const Case& c, bool little) const {
    Configuration from(space.size()), to(space.size());
    for (Eigen::Index k = 0; k < from.size(); ++k) {
      from[k] = uniform(random, -c.size, c.size);
      to[k] = from[k] + uniform(random, -c.step, c.step);
    }
    if (c.mount == Case::planar) from[2] = uniform(random, -3, 3), to[2] = uniform(random, -3, 3);
    if (c.mount == Case::floating) {
      from.tail<4>() = rotation(random).coeffs();
      to.tail<4>() = rotation(random).coeffs();
      if (little) to.tail<4>() = (from.tail<4>() + 0.2 * to.tail<4>()).eval();
    }
    return {from, to};
  }
};

TEST(Stress, CertifiedEdgesAgainstTheVerifier) {
  Random random(test::testSeed(20));
  const int edges = test::casesOf(40, 5'000);  // per scene
  int undecided = 0, all = 0;
  for (const Case& c : cases(random)) {
    const Robot robot(c);
    PathProblem problem;
    problem.tree = &robot.tree;
    problem.space = &robot.space;
    problem.bodies.push_back({"world", &c.fixed, {}, false, 0});
    std::vector<Scene::Placed> bodies;
    std::vector<Scene::Pair> pairs;
    bodies.push_back({Body("world", c.fixed), 0});
    for (const std::size_t frame : robot.frames) {
      pairs.push_back({0, bodies.size()});
      if (bodies.size() > 2) pairs.push_back({bodies.size() - 2, bodies.size()});
      problem.bodies.push_back({"robot", &c.moving, {}, false, frame});
      bodies.push_back({Body("robot", c.moving), frame});
    }
    for (const Scene::Pair& pair : pairs) problem.pairs.push_back({pair.a, pair.b});
    const Scene scene(std::move(bodies), std::move(pairs));
    MotionOptions options;
    problem.tolerance = options.tolerance = scene.defaultTolerance();
    problem.tube = Configuration::Zero(static_cast<Eigen::Index>(robot.space.size()));
    EdgeMotion motion(robot.tree, robot.space, scene.framePairs(), problem.tube);
    QueryContext context;
    int count[3] = {}, silent = 0;
    for (int i = 0; i < edges; ++i, ++all) {
      const auto [from, to] = robot.edge(random, c, i % 2);
      motion.set(from, to);
      const MotionResult r = scene.certify(motion, options, context);
      const PathReport report = verifyPath(problem, {from, to});
      ++count[static_cast<int>(r.verdict)];
      silent += report.verdict == PathVerdict::undecided;
      if (r.verdict == MotionVerdict::free) {
        EXPECT_NE(report.verdict, PathVerdict::refuted) << c.name << ", edge " << i;
      }
      if (r.verdict == MotionVerdict::contact) {
        EXPECT_NE(report.verdict, PathVerdict::proved) << c.name << ", edge " << i;
      }
    }
    std::cout << c.name << ": free " << count[0] << ", contact " << count[1] << ", undecided "
              << count[2] << "; verifier undecided " << silent << "\n";
    EXPECT_GT(count[0], edges / 50) << c.name << ": too few free edges for a meaningful test";
    EXPECT_GT(count[1], edges / 50) << c.name << ": too few contacts for a meaningful test";
    EXPECT_LE(silent, 1 + edges / 100) << c.name << ": the oracle says nothing";
    undecided += count[2];
  }
  EXPECT_LE(undecided, 1 + all / 1000) << "more than 0.1 % undecided";
}

// ---- boxes ----

using Rational = boost::multiprecision::cpp_rational;
using Row = std::array<Rational, 3>;

Rational dot(const Row& a, const Row& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Row cross(const Row& a, const Row& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A stored box under a map, exactly: centre and three half edges.
struct ExactBox {
  Row centre;
  std::array<Row, 3> edge;
  ExactBox(const Obb& box, const Transform& X) {
    for (int i = 0; i < 3; ++i) {
      centre[i] = Rational(X.t[i]);
      for (int k = 0; k < 3; ++k) {
        centre[i] += Rational(X.m(i, k)) * Rational(box.center[k]);
        for (int j = 0; j < 3; ++j)
          edge[j][i] += Rational(X.m(i, k)) * Rational(box.axes(k, j)) * Rational(box.half[j]);
      }
    }
  }
};

/// Returns whether two parallelepipeds share a point. If not, the normal of a face or a common
/// normal of two edges separates them.
bool boxesTouch(const ExactBox& a, const ExactBox& b) {
  std::vector<Row> axes;
  for (int i = 0; i < 3; ++i) {
    axes.push_back(cross(a.edge[i], a.edge[(i + 1) % 3]));
    axes.push_back(cross(b.edge[i], b.edge[(i + 1) % 3]));
    for (int j = 0; j < 3; ++j) axes.push_back(cross(a.edge[i], b.edge[j]));
  }
  const Row T = {b.centre[0] - a.centre[0], b.centre[1] - a.centre[1], b.centre[2] - a.centre[2]};
  for (const Row& L : axes) {
    Rational reach = 0;
    for (int i = 0; i < 3; ++i) reach += abs(dot(a.edge[i], L)) + abs(dot(b.edge[i], L));
    if (abs(dot(T, L)) > reach) return false;
  }
  return true;
}

TEST(Stress, BoxOverlapAgainstRationals) {
  Random random(test::testSeed(21));
  const int rounds = test::casesOf(300, 50'000);
  int touching = 0, apart = 0, proved = 0, clear = 0;
  for (int i = 0; i < rounds; ++i) {
    Obb a, b;
    for (Obb* box : {&a, &b}) {
      box->center = vector(random, std::pow(10, uniform(random, -3, 3)));
      box->axes = rotation(random).normalized().toRotationMatrix();
      if (i % 4 == 0)  // axes sheared by 1e-12
        box->axes +=
            1e-12 * (Mat3() << vector(random, 1), vector(random, 1), vector(random, 1)).finished();
      for (int k = 0; k < 3; ++k) box->half[k] = std::pow(10, uniform(random, -3, 1));
    }
    Transform X;
    X.m = rotation(random).normalized().toRotationMatrix();
    if (i % 8 < 2) X.m = a.axes * b.axes.transpose();  // parallel boxes
    // Places the boxes so that they just touch along one of the 15 axes, then moves one box by a
    // tiny step along this axis.
    const Mat3 ub = X.m * b.axes;
    const int which = i % 15;
    Vec3 n = which < 3   ? Vec3(a.axes.col(which))
             : which < 6 ? Vec3(ub.col(which - 3))
                         : Vec3(a.axes.col((which - 6) / 3).cross(ub.col((which - 6) % 3)));
    if (n.norm() < 0.01) n = a.axes.col(0);  // nearly parallel edges: an ill-conditioned axis
    n.normalize();
    double reach = 0;
    Vec3 slide = Vec3::Zero();  // brings the supporting features together
    for (int k = 0; k < 3; ++k) {
      const double alongA = n.dot(a.axes.col(k)), alongB = n.dot(ub.col(k));
      reach += a.half[k] * std::abs(alongA) + b.half[k] * std::abs(alongB);
      slide += a.half[k] *
                   (std::abs(alongA) < 1e-9 ? uniform(random, -1, 1)
                    : alongA > 0            ? 1
                                            : -1) *
                   a.axes.col(k) +
               b.half[k] *
                   (std::abs(alongB) < 1e-9 ? uniform(random, -1, 1)
                    : alongB > 0            ? 1
                                            : -1) *
                   ub.col(k);
    }
    const double scale = reach + a.center.norm() + b.center.norm();
    const double step = std::pow(10, uniform(random, -17, -9)) * (i & 1 ? 1 : -1);
    X.t = a.center + slide + n * step * scale - X.m * b.center;

    const double defect[] = {orthonormalityDefect(a.axes), orthonormalityDefect(b.axes)};
    const BoxPairMargins margins = boxPairMargins(defect[0], roundedUp(a.center.norm()), defect[1],
                                                  roundedUp(b.center.norm()), X);
    if (i % 4) {  // rounded rotations: `boxPairMargins` gives 3·4·(3·17) + 400 unit roundoffs
      ASSERT_LT(margins.relative, 2048 * kUnit);
    }
    const bool separated = obbsSeparated(a, b, X, margins, 0);
    if (boxesTouch(ExactBox(a, {}), ExactBox(b, X))) {
      ++touching;
      ASSERT_FALSE(separated) << "round " << i << ", axis " << which << ", step " << step;
    } else {
      ++apart;
      proved += separated;
      // The margin grows with the boxes' sizes and the distance of their centres, even if the boxes
      // are thin along n. The margin is divided by the length |L| ≥ 0.01 of the axis.
      const double total =
          std::sqrt(3.0) * (X * b.center - a.center).norm() + a.half.sum() + b.half.sum();
      if (i % 4 && step * scale > 2 * (margins.relative * total / 0.01 + margins.absolute)) {
        EXPECT_TRUE(separated) << "round " << i << ", step " << step;
        ++clear;
      }
    }
  }
  std::cout << touching << " touch, " << apart << " apart, of these proved " << proved << "\n";
  EXPECT_GT(clear, rounds / 50);
  EXPECT_GT(touching, rounds / 4);
  EXPECT_GT(proved, rounds / 8);
}

}  // namespace
}  // namespace corridor
