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

/// Runs Python's handlers of the signals that have arrived, such as the signal of Ctrl-C. Returns
/// whether a handler raised an exception. If so, the caller must throw py::error_already_set. @pre
/// the calling thread does not hold Python's lock.
inline bool runSignalHandlers() {
  const py::gil_scoped_acquire lock;
  return PyErr_CheckSignals() != 0;
}

}  // namespace corridor::python
