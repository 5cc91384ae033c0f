#pragma once

#include <optional>
#include <pybind11/numpy.h>
#include <vector>

#include "collision/core/rigid_pose.h"
#include "collision/core/transform.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/robot/configuration_space.h"

/// Conversions between NumPy arrays and the types of the libraries. Arrays of other number types,
/// and arrays that are not contiguous, are copied. Arrays of the wrong shape, and numbers that are
/// not finite, raise a ValueError that names the argument.
namespace corridor::python {

namespace py = pybind11;

/// An array of doubles, in rows.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// An array of indices, in rows.
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Throws a py::value_error with the message "NAME: TEXT".
[[noreturn]] void refuse(const char* name, const std::string& text);

/// Returns the shape of an array as Python writes it: "(10, 7)".
std::string shapeOf(const py::array& array);

/// Reads one configuration, an array of J numbers.
Configuration configurationOf(const Array& array, const ConfigurationSpace& space,
                              const char* name);
/// Reads configurations: an array of N×J numbers, or an array of J numbers for a single
/// configuration.
std::vector<Configuration> configurationsOf(const Array& array, const ConfigurationSpace& space,
                                            const char* name);
/// Returns the configurations `rows` as an array with `columns` numbers in each row.
Array arrayOf(const std::vector<Configuration>& rows, std::size_t columns);

/// Reads 4×4 matrices of rigid motions or other affine maps: an array of N×4×4 numbers, or of 4×4
/// numbers for a single map. The last row of each matrix must be 0, 0, 0, 1.
std::vector<Transform> transformsOf(const Array& array, const char* name);
/// Reads a 4×4 matrix of a rigid motion. Let M be its upper left 3×3 matrix. Each element of MᵀM
/// must differ by at most 1e-6 from that of the identity. M stands for the nearest rotation, which
/// moves a point by less than 2e-6 of the point's distance from the origin.
RigidPose rigidPoseOf(const Array& array, const char* name);

/// Reads points, an array of N×3 numbers.
std::vector<Vec3> pointsOf(const Array& array, const char* name);
/// Makes a mesh of vertices (V×3 numbers, metres) and triangles (T×3 indices from 0).
TriangleMesh meshOf(const Array& vertices, const Indices& triangles);

}  // namespace corridor::python
