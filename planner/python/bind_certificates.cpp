#include <algorithm>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "planner/python/arrays.h"
#include "planner/python/bindings.h"
#include "planner/python/native_problem.h"
#include "planner/python/parallel.h"
#include "planner/robot/rpy.h"

namespace corridor::python {
namespace {

/// Makes a certificate from the arrays that Python passes: pairs, t0, t1 and clearances.
MotionCertificate certificateFrom(const Indices& pair, const Array& t0, const Array& t1,
                                  const Array& clearance) {
  const py::ssize_t n = pair.size();
  if (pair.ndim() != 1 || t0.ndim() != 1 || t1.ndim() != 1 || clearance.ndim() != 1 ||
      t0.size() != n || t1.size() != n || clearance.size() != n)
    refuse("certificate", "pair, t0, t1 and clearance must be arrays of one length");
  MotionCertificate certificate;
  for (py::ssize_t i = 0; i < n; ++i)  // a negative index becomes an index that no pair has
    certificate.free.push_back(
        {static_cast<std::size_t>(pair.at(i)), t0.at(i), t1.at(i), clearance.at(i)});
  return certificate;
}

const char* nameOf(CertificateFault::Kind kind) {
  switch (kind) {
    case CertificateFault::Kind::malformed:
      return "malformed";
    case CertificateFault::Kind::gap:
      return "gap";
    case CertificateFault::Kind::refuted:
      return "refuted";
    case CertificateFault::Kind::unproved:
      return "unproved";
    case CertificateFault::Kind::workLimit:
      return "work limit";
    case CertificateFault::Kind::ambiguous:
      return "ambiguous";
    case CertificateFault::Kind::floatingPoint:
      return "floating point";
  }
  return "";
}

/// Returns the tested pairs: the names of their shapes, the indices of their bodies, and their
/// margins.
py::dict certificatePairs(const NativeProblem& problem) {
  const Checker& checker = problem.checker();
  py::dict d;
  const auto pairs = checker.scene().motionPairs();
  py::array_t<std::int64_t> bodies({pairs.size(), std::size_t{2}});
  Array margins(static_cast<py::ssize_t>(pairs.size()));
  py::list shapes;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    shapes.append(py::make_tuple(pairs[k].a->name(), pairs[k].b->name()));
    const auto row = static_cast<py::ssize_t>(k);
    bodies.mutable_at(row, 0) = static_cast<std::int64_t>(checker.bodyOf(pairs[k].bodyA));
    bodies.mutable_at(row, 1) = static_cast<std::int64_t>(checker.bodyOf(pairs[k].bodyB));
    margins.mutable_at(row) = checker.options().marginOf(k);
  }
  d["shapes"] = shapes;
  d["pairs"] = bodies;
  d["margins"] = margins;
  return d;
}

void addIntervals(const MotionCertificate& certificate, py::dict& d) {
  const auto n = static_cast<py::ssize_t>(certificate.free.size());
  py::array_t<std::int64_t> pair(n);
  Array t0(n), t1(n), clearance(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const FreeInterval& interval = certificate.free[static_cast<std::size_t>(i)];
    pair.mutable_at(i) = static_cast<std::int64_t>(interval.pair);
    t0.mutable_at(i) = interval.t0;
    t1.mutable_at(i) = interval.t1;
    clearance.mutable_at(i) = interval.clearance;
  }
  d["pair"] = pair;
  d["t0"] = t0;
  d["t1"] = t1;
  d["clearance"] = clearance;
}

py::dict certificate(const NativeProblem& problem, const Array& q0, const Array& q1,
                     bool earliest) {
  const Checker& checker = problem.checker();
  const Configuration from = configurationOf(q0, checker.space(), "q0"),
                      to = configurationOf(q1, checker.space(), "q1");
  MotionCertificate proof;
  MotionResult result;
  {
    const py::gil_scoped_release unlocked;
    result = checker.certifyEdge(from, to, {.earliest = earliest, .certificate = &proof});
  }
  py::dict d = certificatePairs(problem);
  d["verdict"] =
      static_cast<int>(codeOf(checker.inBounds(from) && checker.inBounds(to), result.verdict));
  std::string reason = nameOf(result.reason);
  std::ranges::replace(reason, '_', ' ');
  d["reason"] = reason;
  d["free_until"] = result.certifiedUntil;
  d["time"] = result.time >= 0 ? py::cast(result.time) : py::none();
  addIntervals(proof, d);
  d["contact"] = py::none();
  if (result.pair)
    d["contact"] =
        py::make_tuple(checker.bodyOf(result.pair->bodyA), checker.bodyOf(result.pair->bodyB));
  d["point"] = py::none();
  if (proof.point_A) d["point"] = Array(3, proof.point_A->data());
  d["tolerance"] = checker.options().tolerance;
  return d;
}

/// Checks a certificate. Returns None, or the first fault: its kind, pair and time.
py::object certificateFault(const NativeProblem& problem, const Array& q0, const Array& q1,
                            double until, const Indices& pair, const Array& t0, const Array& t1,
                            const Array& clearance) {
  const Checker& checker = problem.checker();
  const Configuration from = configurationOf(q0, checker.space(), "q0"),
                      to = configurationOf(q1, checker.space(), "q1");
  const MotionCertificate proof = certificateFrom(pair, t0, t1, clearance);
  std::optional<CertificateFault> fault;
  {
    const py::gil_scoped_release unlocked;
    fault = checker.faultOf(proof, from, to, until);
  }
  if (!fault) return py::none();
  return py::make_tuple(nameOf(fault->kind), fault->pair, fault->t);
}

Array matrices(std::size_t rows, std::size_t bodies) {
  return Array({rows, bodies, std::size_t{4}, std::size_t{4}});
}

void writeMatrix(const Transform& X, double* out) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out[4 * row + column] = X.m(row, column);
    out[4 * row + 3] = X.t[row];
  }
  out[12] = out[13] = out[14] = 0;
  out[15] = 1;
}

/// Returns the poses of the bodies' frames at each state, N×B×4×4.
Array poses(const NativeProblem& problem, const Array& states) {
  const Model& model = problem.problem().model;
  const std::vector<Configuration> rows = configurationsOf(states, model.space, "states");
  Array result = matrices(rows.size(), model.bodies.size());
  double* out = result.mutable_data();
  const py::gil_scoped_release unlocked;
  FramePoses frames(model);
  for (const Configuration& q : rows) {
    const std::vector<Transform>& X_WF = frames.at(q);
    for (const ModelBody& body : model.bodies) {
      writeMatrix(X_WF[body.frame], out);
      out += 16;
    }
  }
  return result;
}

Array poseMatrix(const std::array<double, 3>& xyz, const std::array<double, 3>& rpy) {
  Array result({4, 4});
  writeMatrix({matrixFromRpy({rpy[0], rpy[1], rpy[2]}), {xyz[0], xyz[1], xyz[2]}},
              result.mutable_data());
  return result;
}

}  // namespace

void bindCertificates(py::module_& module) {
  using py::arg;
  module.def("certificate", &certificate, arg("problem"), arg("q0"), arg("q1"), arg("earliest"));
  module.def("certificate_pairs", &certificatePairs, arg("problem"));
  module.def("certificate_fault", &certificateFault, arg("problem"), arg("q0"), arg("q1"),
             arg("until"), arg("pair"), arg("t0"), arg("t1"), arg("clearance"));
  module.def("poses", &poses, arg("problem"), arg("states"));
  module.def("pose_matrix", &poseMatrix, arg("xyz"), arg("rpy"));
}

}  // namespace corridor::python
