/// What a certified edge costs against sampling it: `edge_cost_benchmark PROBLEM… [--edges N]`.
///
/// For each problem (YAML or OMPL.app's .cfg), random edges of 2, 5, 10 and 20 % of the scene's
/// size, starting at valid states. Per edge: the certified query; Corridor's own interference test
/// and FCL's (BVHModel<OBBRSS>, Debian's build) at n samples, that is n + 1 evenly spaced poses, up
/// to the first contact. Same edges, same run, one thread; times are sums over the edges that the
/// certified query calls free, and those it does not, apart; the medians of three repeats. CSV on
/// stdout.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#ifdef CORRIDOR_WITH_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#endif

#include "collision/world/scene.h"
#include "planner/problem/problem.h"

namespace corridor {
namespace {

struct Edge {
  RigidPose from, to;
  Vec3 fromPlanar, toPlanar;
};

Transform poseAt(const Problem& problem, const Edge& e, double t) {
  return problem.space == RigidSpace::SE2 ? RigidMotion::planar(e.fromPlanar, e.toPlanar, {}).at(t)
                                          : RigidMotion::spatial(e.from, e.to, {}).at(t);
}

#ifdef CORRIDOR_WITH_FCL
using FclModel = fcl::BVHModel<fcl::OBBRSS<double>>;
std::shared_ptr<FclModel> fclModel(const TriangleMesh& mesh) {
  auto model = std::make_shared<FclModel>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}
#endif

double seconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times[1];
}

void run(const std::string& file, int count) {
  const Problem problem = readProblem(file);
  std::vector<Body> moving, fixed;
  for (const ProblemMesh& m : problem.robot) moving.emplace_back(m.name, m.source.mesh);
  for (const ProblemMesh& m : problem.world) fixed.emplace_back(m.name, m.source.mesh);
  const Scene scene(std::move(moving), std::move(fixed));
  const bool planar = problem.space == RigidSpace::SE2;
  QueryContext context;
  MotionOptions options;
  options.tolerance = scene.defaultTolerance();
  const double size = (problem.upper - problem.lower).norm();
  options.tube = {0x1p-40 * size, 0x1p-40 * 2 * 3.2};
  const auto certify = [&](const Edge& e) {
    return planar ? scene.certifyEdgePlanar(e.fromPlanar, e.toPlanar, options, context)
                  : scene.certifyEdge(e.from, e.to, options, context);
  };
#ifdef CORRIDOR_WITH_FCL
  std::vector<std::shared_ptr<FclModel>> fclMoving, fclFixed;
  for (const Body& b : scene.moving()) fclMoving.push_back(fclModel(b.mesh()));
  for (const Body& b : scene.fixed()) fclFixed.push_back(fclModel(b.mesh()));
  const auto fclTouches = [&](const Transform& X) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.linear() = X.m;
    pose.translation() = X.t;
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    for (const auto& m : fclMoving)
      for (const auto& f : fclFixed) {
        result.clear();
        if (fcl::collide(f.get(), fcl::Transform3d::Identity(), m.get(), pose, request, result) > 0)
          return true;
      }
    return false;
  };
#endif
  std::mt19937_64 random(20261121);
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (const double share : {0.02, 0.05, 0.1, 0.2}) {
    std::vector<Edge> free, other;
    int undecided = 0;
    while (static_cast<int>(free.size() + other.size()) < count) {
      Edge e;
      Vec3 p, q;
      const Vec3 direction = Vec3(real(), real(), planar ? 0 : real()).normalized();
      for (int k = 0; k < 3; ++k) p[k] = real(problem.lower[k], problem.upper[k]);
      if (planar) p[2] = 0;
      q = p + share * size * direction;
      const double turn = share * 3.14159 * real();
      e.from.p = p;
      e.from.q = Eigen::Quaterniond(real(), real(), real(), real()).normalized();
      e.to.p = q;
      e.to.q =
          Eigen::Quaterniond(Eigen::AngleAxisd(turn, Vec3(real(), real(), real()).normalized())) *
          e.from.q;
      const double yaw = real(-3.14159, 3.14159);
      e.fromPlanar = Vec3(p[0], p[1], yaw);
      e.toPlanar = Vec3(q[0], q[1], yaw + turn);
      if (((q.array() < problem.lower.array()) || (q.array() > problem.upper.array()))
              .head(planar ? 2 : 3)
              .any())
        continue;
      if (scene.interference(poseAt(problem, e, 0), context)) continue;
      const MotionVerdict verdict = certify(e).verdict;
      undecided += verdict == MotionVerdict::undecided;
      (verdict == MotionVerdict::free ? free : other).push_back(e);
    }
    for (const auto* edges : {&free, &other}) {
      if (edges->empty()) continue;
      context.counters = {};
      int wrong = 0;
      const double n = static_cast<double>(edges->size());
      const double certified = seconds([&] {
                                 for (const Edge& e : *edges) certify(e);
                               }) /
                               n * 1e6;
      const Counters per = context.counters;
      std::cout << problem.name << ',' << share << ',' << (edges == &free ? "free" : "contact")
                << ',' << edges->size() << ',' << undecided << ',' << certified << ','
                << static_cast<double>(per.boxTests) / 3 / n << ','
                << static_cast<double>(per.triangleTests) / 3 / n << ','
                << static_cast<double>(per.poses) / 3 / n;
      for (const int samples : {10, 100}) {
        const auto discrete = [&](const auto& touches) {
          return seconds([&] {
                   for (const Edge& e : *edges)
                     for (int i = 0; i <= samples; ++i)
                       if (touches(poseAt(problem, e, static_cast<double>(i) / samples))) {
                         wrong += edges == &free;
                         break;
                       }
                 }) /
                 n * 1e6;
        };
        std::cout << ',' << discrete([&](const Transform& X) {
          return scene.interference(X, context).has_value();
        });
#ifdef CORRIDOR_WITH_FCL
        const double fcl = discrete(fclTouches);
        std::cout << ',' << fcl << ',' << fcl / certified;
#else
        std::cout << ",,";
#endif
      }
      std::cout << ',' << wrong << '\n' << std::flush;
    }
  }
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  int count = 500;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--edges" && i + 1 < argc) {
      count = std::atoi(argv[++i]);
    } else {
      files.emplace_back(argv[i]);
    }
  }
  if (files.empty() || count < 1) {
    std::cerr << "usage: edge_cost_benchmark PROBLEM… [--edges N]\n";
    return 2;
  }
  std::cout << "problem,length,verdict,edges,undecided,certified_us,box_tests,triangle_tests,poses,"
               "own10_us,fcl10_us,fcl10_ratio,own100_us,"
               "fcl100_us,fcl100_ratio,samples_in_contact_on_free\n";
  try {
    for (const std::string& file : files) corridor::run(file, count);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
