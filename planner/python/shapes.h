#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "planner/robot/placed_shape.h"

/// Shapes and poses as the Python package passes them (corridor/shapes.py).
namespace corridor::python {

namespace py = pybind11;

/// A pose as the user gave it, and the same pose as a map of points. If the user gave xyz and rpy,
/// both `pose` and `X` are computed from these numbers, not one from the other, as in the reader of
/// URDF. If the user gave a matrix, `X` is computed from `pose`.
struct GivenPose {
  RigidPose pose;
  Transform X;
};

/// Reads a pose: a 4×4 matrix, or a tuple of xyz and rpy (as in URDF). None: the identity.
GivenPose givenPose(const py::object& value, const char* name);
RigidPose poseOf(const py::object& value, const char* name = "pose");

/// Makes a shape from a tuple that has the shape's kind, numbers and pose.
PlacedShape shapeFrom(const std::string& name, const py::tuple& shape);

/// Makes the shapes of a body.
/// @throws py::value_error if the list is empty.
std::vector<PlacedShape> shapesFrom(const std::string& name, const py::list& shapes);

}  // namespace corridor::python
