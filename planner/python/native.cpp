/// The module corridor._native: the compiled part of the package `corridor` (corridor/__init__.py).
#include <pybind11/pybind11.h>

#include "collision/core/error.h"
#include "planner/python/bindings.h"

namespace py = pybind11;

namespace {

/// Raises corridor.InputError with the faults as a list of tuples (file, line, text).
void raiseInputError(const corridor::InputError& error) {
  py::list faults;
  for (const corridor::Fault& fault : error.faults())
    faults.append(py::make_tuple(fault.file, fault.line, fault.text));
  const py::object type = py::module_::import("corridor._errors").attr("InputError");
  const py::object value = type(error.what(), faults);
  PyErr_SetObject(type.ptr(), value.ptr());
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  module.doc() = "The compiled part of the package corridor.";
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 prescribes the type
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const corridor::InputError& error) {
      raiseInputError(error);
    }
  });
  corridor::python::bindProblem(module);
  corridor::python::bindChecks(module);
  corridor::python::bindCertificates(module);
  corridor::python::bindSolve(module);
  corridor::python::bindBodies(module);
}
