#pragma once

#include <pybind11/pybind11.h>

#include "planner/model/model_builder.h"

/// Robots as the Python package describes them (corridor/robots.py).
namespace corridor::python {

namespace py = pybind11;

/// Adds a robot that is described by a URDF, by links and joints, or as a rigid body.
/// @throws InputError with all faults in the numbers of links and joints. `ModelBuilder::build`
/// finds all other faults later.
void addRobot(ModelBuilder& builder, const py::dict& robot);

}  // namespace corridor::python
