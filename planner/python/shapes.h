#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "planner/robot/placed_shape.h"

/// Shapes and poses as the Python package passes them (corridor/shapes.py).
namespace corridor::python {

namespace py = pybind11;

/// A pose as the user gave it, and the same pose as a map of points. For xyz and rpy, each is
/// computed from the given numbers, not from the other, as in the reader of URDF. For a matrix, the
/// map is computed from the pose.
struct GivenPose {
  RigidPose pose;
  Transform X;
};

/// Reads a pose: a 4×4 matrix, or a tuple of xyz and rpy (as in URDF). None: the identity.
GivenPose givenPose(const py::object& value, const char* name);
RigidPose poseOf(const py::object& value, const char* name = "pose");

/// Makes a shape from a tuple of its kind, its numbers and its pose.
PlacedShape shapeFrom(const std::string& name, const py::tuple& shape);

/// Makes the shapes of a body.
/// @throws py::value_error if the list is empty.
std::vector<PlacedShape> shapesFrom(const std::string& name, const py::list& shapes);

}  // namespace corridor::python
