#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "planner/robot/placed_shape.h"

/// Shapes and poses as the Python package passes them (corridor/shapes.py).
namespace corridor::python {

namespace py = pybind11;

/// Reads a 4×4 matrix; None: the identity.
RigidPose poseOf(const py::object& matrix);

/// Makes a shape of a tuple: its kind, its numbers and its pose.
PlacedShape shapeFrom(const std::string& name, const py::tuple& shape);

/// Makes the shapes of a body; at least one.
std::vector<PlacedShape> shapesFrom(const std::string& name, const py::list& shapes);

}  // namespace corridor::python
