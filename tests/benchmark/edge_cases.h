#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "planner/benchmark/fcl_scene.h"
#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/robot/edge_motion.h"
#include "planner/solve/verify_solution.h"
#include "tests/benchmark/random_edges.h"
#include "tests/collision/motion/grazing.h"

/// Edges whose true verdict is known by construction, in closed form, or from the independent
/// verifier. No verdict is taken from samples.
namespace corridor::bench {

struct EdgeCase {
  const Scene* scene = nullptr;
  double size = 1;  ///< metres; tolerances are relative to this size
  bool contact = false;
  double firstContact = -1;  ///< time t in [0, 1] of the first contact; −1 if it is not known, or
                             ///< if there is no contact
  /// Constructs and returns the motion. The time for this counts as part of the edge's cost.
  std::function<MotionSource&()> motion;
  /// Computes the poses of the scene's frames at t.
  std::function<void(double t, std::vector<Transform>& X_WF)> poses;
#ifdef CORRIDOR_WITH_FCL
  /// Makes FCL's models. If this function is empty, the models are made from `scene`, whose bodies
  /// are then all meshes.
  std::function<std::shared_ptr<FclScene>()> fcl;
#endif
};

/// A named set of cases, with the objects that they refer to.
struct EdgeSet {
  std::string name;
  std::vector<EdgeCase> cases;
  std::vector<std::shared_ptr<const void>> kept;
  int dropped = 0;  ///< edges that the verifier left undecided
};

/// Adds a case of one rigid mesh, which moves from pose `from` to pose `to`, and one fixed mesh.
inline void addRigid(EdgeSet& set, TriangleMesh fixed, TriangleMesh moving, const RigidPose& from,
                     const RigidPose& to, double size, bool contact, double firstContact = -1) {
  std::vector<Scene::Placed> bodies;
  bodies.push_back({Body("fixed", std::move(fixed)), 0});
  bodies.push_back({Body("moving", std::move(moving)), 1});
  const auto scene =
      std::make_shared<const Scene>(std::move(bodies), std::vector<Scene::Pair>{{0, 1}});
  const auto edge = std::make_shared<std::optional<RigidEdge>>();
  const RigidMotion motion = RigidMotion::spatial(from, to, {});
  EdgeCase made;
  made.scene = scene.get();
  made.size = size;
  made.contact = contact;
  made.firstContact = firstContact;
  made.motion = [edge, from, to]() -> MotionSource& {
    return edge->emplace(RigidMotion::spatial(from, to, {}));
  };
  made.poses = [motion](double t, std::vector<Transform>& X_WF) {
    X_WF.assign({Transform(), motion.at(t)});
  };
  set.cases.push_back(std::move(made));
  set.kept.push_back(scene);
}

/// Returns edges that graze by construction. At the end of the motion or all along it, two meshes
/// penetrate each other, or are apart, by 10^-2 to 10^-13 of their size.
inline EdgeSet grazingEdges(int count, std::mt19937_64& random) {
  EdgeSet set{"grazing", {}, {}, 0};
  for (int n = 0; static_cast<int>(set.cases.size()) < count; ++n) {
    const double size = std::pow(10.0, n % 5 - 2), amount = std::pow(10.0, -2 - n % 12);
    const double gap = n / 12 % 2 ? amount : -amount;
    test::Grazing g(random, static_cast<test::Grazing::Feature>(n % 7 % 3), n % 3 == 0, gap, size);
    if (g.known) addRigid(set, g.fixed, g.moving, g.from, g.to, size, gap < 0);
  }
  return set;
}

/// Returns edges whose time of first contact has a closed form: a rod that rotates about its end
/// down onto a plate, a box that slides into a wall, and a blade that rotates past a needle. Half
/// of the edges are free.
inline EdgeSet closedForms(int count, std::mt19937_64& random) {
  EdgeSet set{"closed forms", {}, {}, 0};
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto still = Eigen::Quaterniond::Identity();
  const auto turnedBy = [](double angle, const Vec3& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
  };
  for (int n = 0; n < count; ++n) {
    const double amount = std::pow(10.0, -1 - n / 6 % 8);
    const bool contact = n / 3 % 2;
    if (n % 3 == 0) {
      // A rod from the origin along x rotates down by `angle` about y. The plate is at z = −sin(a),
      // or at z = −1 if a > π/2, so the rod's far end meets the plate at the angle a, if at all.
      const double angle = real(0.3, 1.5), a = contact ? angle * real(0.01, 0.99) : angle + amount;
      const double depth = std::sin(std::min(a, std::numbers::pi / 2));
      addRigid(
          set, test::box(Vec3(-3, -3, -depth - 0.001), Vec3(3, 3, -depth)),
          [] {
            TriangleMesh rod;
            test::add(rod, Vec3::Zero(), Vec3::UnitX(), Vec3(0.5, 0, 0));
            return rod;
          }(),
          {Vec3::Zero(), still}, {Vec3::Zero(), turnedBy(angle, Vec3::UnitY())}, 1, contact,
          contact ? a / angle : -1);
    } else if (n % 3 == 1) {
      // A box moves 2 m towards a thin wall. It meets the wall at t, or stops at the distance
      // `amount` from the wall.
      const double t = contact ? real(0.01, 0.99) : 1 + amount / 2;
      const double wall = 2 * t + 0.5;
      addRigid(set, test::box(Vec3(wall, -1, -1), Vec3(wall + 0.001, 1, 1)),
               test::box(-0.5 * Vec3::Ones(), 0.5 * Vec3::Ones()), {Vec3::Zero(), still},
               {Vec3(2, 0, 0), still}, 1, contact, contact ? t : -1);
    } else {
      // A blade of length 1 rotates about z past a needle, which stands at the angle a. The
      // distance of the needle from the axis is a little below or above 1.
      const double angle = real(0.5, 2.5), a = angle * real(0.3, 0.9);
      const double reach = contact ? 1 - amount : 1 + amount;
      const Vec3 tip = reach * Vec3(std::cos(a), std::sin(a), 0);
      TriangleMesh needle, blade;
      test::add(needle, tip + Vec3(0, 0, -1), tip + Vec3(0, 0, 1), tip + Vec3(0, 0, 0.5));
      test::add(blade, Vec3::Zero(), Vec3::UnitX(), Vec3(0.3, -0.1, 0));
      // The leading edge, from the origin to (1, 0, 0), sweeps over the needle at angle a.
      addRigid(set, needle, blade, {Vec3::Zero(), still},
               {Vec3::Zero(), turnedBy(angle, Vec3::UnitZ())}, 1, contact,
               contact ? a / angle : -1);
    }
  }
  return set;
}

/// Returns random edges of a problem between states in its bounds. The first state of each edge is
/// free. Half of the edges are free, if enough free edges are found. The true verdict is the
/// verifier's.
inline EdgeSet sceneEdges(const std::string& file, int count, std::uint64_t seed) {
  const auto problem = std::make_shared<const Problem>(readProblem(file));
  const auto checker = std::make_shared<const Checker>(*problem);
  const auto motion = std::make_shared<EdgeMotion>(
      problem->model.tree, problem->model.space, checker->scene().framePairs(), problem->task.tube);
  EdgeSet set{problem->source.name, {}, {problem, checker, motion}, 0};
  const PathProblem plain = plainProblem(*problem);
  RandomEdges random(*problem, seed);
  int free = 0, touching = 0;
  for (int n = 0; free + touching < count && n < 200 * count; ++n) {
    const RandomEdges::Edge e =
        random.next(random.rigid() ? std::vector{0.02, 0.05, 0.1, 0.2}[n % 4]
                                   : std::vector{0.1, 0.3, 1.0, 3.0}[n % 4]);
    if (!checker->inBounds(e.to) || checker->interference(e.from)) continue;
    // The checker's verdict is used only to choose about as many free edges as others. It is not
    // the true verdict.
    const bool maybeFree = checker->certifyEdge(e.from, e.to).verdict == MotionVerdict::free;
    if ((maybeFree ? free : touching) >= count / 2) continue;
    const PathVerdict truth = verifyPath(plain, {e.from, e.to}).verdict;
    if (truth == PathVerdict::undecided) {
      ++set.dropped;
      continue;
    }
    EdgeCase made;
    made.scene = &checker->scene();
    made.size = checker->scene().defaultTolerance() * 1e7;
    made.contact = truth == PathVerdict::refuted;
    made.motion = [motion, e]() -> MotionSource& {
      motion->set(e.from, e.to);
      return *motion;
    };
    made.poses = [problem, e](double t, std::vector<Transform>& X_WF) {
      X_WF = framePoses(problem->model.tree, problem->model.space.interpolate(e.from, e.to, t));
    };
#ifdef CORRIDOR_WITH_FCL
    made.fcl = [checker] { return std::make_shared<FclScene>(*checker); };
#endif
    (made.contact ? touching : free)++;
    set.cases.push_back(std::move(made));
  }
  return set;
}

}  // namespace corridor::bench
