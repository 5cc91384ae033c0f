#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "collision/world/body_queries.h"
#include "collision/world/rigid_scene.h"
#include "planner/python/arrays.h"
#include "planner/python/bindings.h"
#include "planner/python/fingerprint.h"
#include "planner/python/parallel.h"
#include "planner/python/shapes.h"

namespace corridor::python {
namespace {

using BodyPointer = std::shared_ptr<Body>;

/// The poses of two bodies, one pose of each body for each query. If a body has only one pose, this
/// pose is used in all queries.
struct Poses {
  Poses(const Array& a, const Array& b)
      : X_WA(transformsOf(a, "pose_a")), X_WB(transformsOf(b, "pose_b")) {
    if (X_WA.size() != X_WB.size() && X_WA.size() != 1 && X_WB.size() != 1)
      refuse("pose_b", std::to_string(X_WA.size()) + " poses as in pose_a, or 1, are needed, not " +
                           std::to_string(X_WB.size()));
    count = X_WA.empty() || X_WB.empty() ? 0 : std::max(X_WA.size(), X_WB.size());
  }
  const Transform& a(std::size_t i) const { return X_WA[X_WA.size() == 1 ? 0 : i]; }
  const Transform& b(std::size_t i) const { return X_WB[X_WB.size() == 1 ? 0 : i]; }
  std::vector<Transform> X_WA, X_WB;
  std::size_t count = 0;
};

/// Runs query(i, context) for each row, without Python's lock.
template <class Query>
void run(std::size_t count, std::size_t threads, const Query& query) {
  forEachUnlocked(count, threads, [&](std::size_t i) {
    thread_local QueryContext context;
    query(i, context);
  });
}

py::array_t<bool> touch(const Body& a, const Body& b, const Array& poseA, const Array& poseB,
                        std::size_t threads) {
  const Poses poses(poseA, poseB);
  py::array_t<bool> result(static_cast<py::ssize_t>(poses.count));
  bool* const out = result.mutable_data();
  run(poses.count, threads, [&](std::size_t i, QueryContext& context) {
    out[i] = interference(Posed(a, poses.a(i)), Posed(b, poses.b(i)), context).has_value();
  });
  return result;
}

py::array_t<bool> closer(const Body& a, const Body& b, double d, const Array& poseA,
                         const Array& poseB, std::size_t threads) {
  if (!(d >= 0) || !std::isfinite(d)) refuse("distance", "a finite number of 0 or more is needed");
  const Poses poses(poseA, poseB);
  py::array_t<bool> result(static_cast<py::ssize_t>(poses.count));
  bool* const out = result.mutable_data();
  run(poses.count, threads, [&](std::size_t i, QueryContext& context) {
    out[i] = closerThan(Posed(a, poses.a(i)), Posed(b, poses.b(i)), d, context);
  });
  return result;
}

py::tuple distances(const Body& a, const Body& b, const Array& poseA, const Array& poseB,
                    std::size_t threads) {
  const Poses poses(poseA, poseB);
  const std::size_t n = poses.count;
  Array metres(static_cast<py::ssize_t>(n)), onA({n, std::size_t{3}}), onB({n, std::size_t{3}});
  double *const d = metres.mutable_data(), *const p = onA.mutable_data(),
                *const q = onB.mutable_data();
  run(n, threads, [&](std::size_t i, QueryContext& context) {
    const Distance result = distance(Posed(a, poses.a(i)), Posed(b, poses.b(i)), {}, context);
    d[i] = result.distance;
    for (int k = 0; k < 3; ++k) p[3 * i + k] = result.p_WA[k], q[3 * i + k] = result.p_WB[k];
  });
  return py::make_tuple(metres, onA, onB);
}

/// Returns the pairs of triangles that touch, N×2, and the segments that they share, N×2×3.
py::tuple contactsOf(const Body& a, const Body& b, const Array& poseA, const Array& poseB) {
  const Poses poses(poseA, poseB);
  if (poses.count != 1) refuse("pose_a", "one pair of poses is needed");
  std::vector<TriangleContact> all;
  {
    const py::gil_scoped_release unlocked;
    QueryContext context;
    all = contacts(Posed(a, poses.a(0)), Posed(b, poses.b(0)), context);
  }
  py::array_t<std::int64_t> pairs({all.size(), std::size_t{2}});
  Array segments({all.size(), std::size_t{2}, std::size_t{3}});
  std::int64_t* index = pairs.mutable_data();
  double* number = segments.mutable_data();
  for (const TriangleContact& c : all) {
    *index++ = c.a, *index++ = c.b;
    for (const Vec3& point : {c.p_W, c.q_W})
      for (int k = 0; k < 3; ++k) *number++ = point[k];
  }
  return py::make_tuple(pairs, segments);
}

/// Returns the first contact of A, which moves from one pose to another, with B, which rests.
py::tuple firstContact(const Body& a, const Body& b, const Array& from, const Array& to,
                       double tolerance) {
  const RigidPose start = rigidPoseOf(from, "start"), end = rigidPoseOf(to, "end");
  MotionResult result;
  {
    const py::gil_scoped_release unlocked;
    std::vector<Body> moving, fixed;
    moving.push_back(a.renamed("a"));
    fixed.push_back(b.renamed("b"));
    const RigidScene scene(std::move(moving), std::move(fixed));
    MotionOptions options;
    options.tolerance =
        tolerance > 0 ? tolerance : scene.defaultTolerance(std::max(start.p.norm(), end.p.norm()));
    options.earliest = true;
    QueryContext context;
    result = scene.certifyEdge(start, end, options, context);
  }
  return py::make_tuple(static_cast<int>(result.verdict), result.certifiedUntil, result.time);
}

BodyPointer bodyFrom(const py::tuple& shape) {
  const PlacedShape placed = shapeFrom("body", shape);
  if (!placed.mesh) return std::make_shared<Body>("body", placed.parts.at(0));
  const std::shared_ptr<const TriangleMesh> mesh(placed.mesh, &placed.mesh->mesh);
  return std::make_shared<Body>("body", mesh, placed.solid);
}

}  // namespace

void bindBodies(py::module_& module) {
  const py::class_<Body, BodyPointer> type(module, "Body");
  module.def("body", &bodyFrom, py::arg("shape"));
  module.def(
      "shape_fingerprint",
      [](const py::tuple& shape) {
        const PlacedShape placed = shapeFrom("body", shape);
        return fingerprintOf({&placed, 1});
      },
      py::arg("shape"));
  const auto a = py::arg("a"), b = py::arg("b"), poseA = py::arg("pose_a"),
             poseB = py::arg("pose_b"), threads = py::arg("threads");
  module.def("touch", &touch, a, b, poseA, poseB, threads);
  module.def("closer_than", &closer, a, b, py::arg("distance"), poseA, poseB, threads);
  module.def("distance", &distances, a, b, poseA, poseB, threads);
  module.def("contacts", &contactsOf, a, b, poseA, poseB);
  module.def("first_contact", &firstContact, a, b, py::arg("start"), py::arg("end"),
             py::arg("tolerance"));
}

}  // namespace corridor::python
