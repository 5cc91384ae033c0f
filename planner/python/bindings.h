#pragma once

#include <pybind11/pybind11.h>

#include "planner/robot/note.h"

namespace corridor::python {

namespace py = pybind11;

// Each function adds one part of the interface to the module.
void bindProblem(py::module_& module);
void bindChecks(py::module_& module);
void bindCertificates(py::module_& module);
void bindSolve(py::module_& module);
void bindBodies(py::module_& module);

/// Returns whether a signal such as Ctrl-C has an exception for the calling thread, which must not
/// hold Python's lock. The caller throws py::error_already_set soon afterwards.
inline bool hasPendingSignal() {
  const py::gil_scoped_acquire lock;
  return PyErr_CheckSignals() != 0;
}

}  // namespace corridor::python
