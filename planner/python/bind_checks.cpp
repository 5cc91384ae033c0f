#include <algorithm>
#include <cmath>
#include <optional>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <vector>

#include "collision/geometry/isolated_points.h"
#include "collision/world/body_queries.h"
#include "planner/model/bounds.h"
#include "planner/python/arrays.h"
#include "planner/python/bindings.h"
#include "planner/python/native_problem.h"
#include "planner/python/parallel.h"

namespace corridor::python {
namespace {

/// Results of many queries, as arrays with one element or row for each query.
struct Results {
  explicit Results(std::size_t n)
      : verdict(static_cast<py::ssize_t>(n)),
        time(static_cast<py::ssize_t>(n)),
        gap(static_cast<py::ssize_t>(n)),
        pairs({n, std::size_t{2}}) {}
  py::array_t<std::int8_t> verdict;
  py::array_t<double> time, gap;
  py::array_t<std::int64_t> pairs;
};

/// Pointers into the arrays, which threads without Python's lock may use.
struct Rows {
  explicit Rows(Results& r)
      : verdict(r.verdict.mutable_data()),
        time(r.time.mutable_data()),
        gap(r.gap.mutable_data()),
        pairs(r.pairs.mutable_data()) {}
  void set(std::size_t i, const Checker& checker, bool inBounds, const MotionResult& r) {
    verdict[i] = codeOf(inBounds, r.verdict);
    time[i] = r.time >= 0 ? r.time : std::numeric_limits<double>::quiet_NaN();
    gap[i] = r.gap;
    pairs[2 * i] = r.pair ? static_cast<std::int64_t>(checker.bodyOf(r.pair->bodyA)) : -1;
    pairs[2 * i + 1] = r.pair ? static_cast<std::int64_t>(checker.bodyOf(r.pair->bodyB)) : -1;
  }
  std::int8_t* verdict;
  double *time, *gap;
  std::int64_t* pairs;
};

py::tuple tupleOf(const Results& r) {
  return py::make_tuple(r.verdict, r.time, r.gap, r.pairs);
}

/// Returns a box around a body under a map, and `distance` more on each side.
Corners boxOf(const Body& body, const Transform& X, double distance) {
  Corners box{Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = corner >> k & 1 ? body.upper()[k] : body.lower()[k];
    const Vec3 p_W = X * p;
    // Rounded, with room for it.
    const Vec3 room = Vec3::Constant(distance) + 0x1p-40 * (p_W.cwiseAbs() + p.cwiseAbs());
    box.lower = box.lower.cwiseMin(p_W - room);
    box.upper = box.upper.cwiseMax(p_W + room);
  }
  return box;
}

py::tuple check(const NativeProblem& problem, const Array& states, std::size_t threads) {
  const Checker& checker = problem.checker();
  const std::vector<Configuration> rows = configurationsOf(states, checker.space(), "states");
  Results results(rows.size());
  Rows out(results);
  forEachUnlocked(rows.size(), threads, [&](std::size_t i) {
    out.set(i, checker, checker.inBounds(rows[i]), checker.certifyState(rows[i]));
  });
  return tupleOf(results);
}

/// Returns, for each point, whether it is at most `distance` from a shape of a robot at a state.
py::array_t<bool> nearRobot(const NativeProblem& problem, const Array& points, const Array& state,
                            double distance, std::size_t threads) {
  if (!(distance >= 0 && std::isfinite(distance)))
    refuse("distance", "a finite number of 0 or more is needed");
  const Checker& checker = problem.checker();
  const Model& model = checker.model();
  const std::vector<Vec3> all = pointsOf(points, "points");
  const std::vector<Transform> X_WF =
      framePoses(model.tree, configurationOf(state, checker.space(), "state"));
  std::vector<Posed<Body>> links;
  std::vector<Corners> boxes;
  const std::vector<Scene::Placed>& placed = checker.scene().bodies();
  for (std::size_t s = 0; s < placed.size(); ++s) {
    const ModelBody& body = model.bodies[checker.bodyOf(s)];
    if (!body.robot) continue;
    links.emplace_back(placed[s].body, X_WF[placed[s].frame]);
    boxes.push_back(boxOf(placed[s].body, X_WF[placed[s].frame], distance));
  }
  py::array_t<bool> near(static_cast<py::ssize_t>(all.size()));
  bool* const out = near.mutable_data();
  forEachUnlocked(all.size(), threads, [&](std::size_t i) {
    thread_local QueryContext context;
    out[i] = false;
    std::optional<Body> point;  // most points are far from all links
    for (std::size_t k = 0; k < links.size() && !out[i]; ++k) {
      if ((all[i].array() < boxes[k].lower.array()).any() ||
          (all[i].array() > boxes[k].upper.array()).any())
        continue;
      if (!point) point.emplace("point", ConvexPart{{all[i]}, 0});
      out[i] = closerThan(Posed<Body>(*point), links[k], distance, context);
    }
  });
  return near;
}

py::array_t<bool> isolated(const Array& points, double distance, std::size_t neighbours) {
  const std::vector<bool> found = isolatedPoints(pointsOf(points, "points"), distance, neighbours);
  py::array_t<bool> result(static_cast<py::ssize_t>(found.size()));
  std::copy(found.begin(), found.end(), result.mutable_data());
  return result;
}

Array clearance(const NativeProblem& problem, const Array& states, std::size_t threads) {
  const Checker& checker = problem.checker();
  const std::vector<Configuration> rows = configurationsOf(states, checker.space(), "states");
  Array result(static_cast<py::ssize_t>(rows.size()));
  double* const out = result.mutable_data();
  forEachUnlocked(rows.size(), threads,
                  [&](std::size_t i) { out[i] = checker.clearance(rows[i]); });
  return result;
}

py::tuple certify(const NativeProblem& problem, const Array& from, const Array& to, bool earliest,
                  std::size_t threads) {
  const Checker& checker = problem.checker();
  const std::vector<Configuration> a = configurationsOf(from, checker.space(), "q0"),
                                   b = configurationsOf(to, checker.space(), "q1");
  if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
    refuse("q1", "as many rows as in q0 are needed, " + std::to_string(a.size()) + ", not " +
                     std::to_string(b.size()));
  const std::size_t count = a.empty() || b.empty() ? 0 : std::max(a.size(), b.size());
  Results results(count);
  Rows out(results);
  forEachUnlocked(count, threads, [&](std::size_t i) {
    const Configuration &p = a[a.size() == 1 ? 0 : i], &q = b[b.size() == 1 ? 0 : i];
    out.set(i, checker, checker.inBounds(p) && checker.inBounds(q),
            checker.certifyEdge(p, q, {.earliest = earliest}));
  });
  return tupleOf(results);
}

}  // namespace

void bindChecks(py::module_& module) {
  using py::arg;
  module.def("check", &check, arg("problem"), arg("states"), arg("threads"));
  module.def("clearance", &clearance, arg("problem"), arg("states"), arg("threads"));
  module.def("near_robot", &nearRobot, arg("problem"), arg("points"), arg("state"), arg("distance"),
             arg("threads"));
  module.def("isolated", &isolated, arg("points"), arg("distance"), arg("neighbours"));
  module.def("certify", &certify, arg("problem"), arg("q0"), arg("q1"), arg("earliest"),
             arg("threads"));
}

}  // namespace corridor::python
