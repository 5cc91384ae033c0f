#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/stress/audit/quad.h"
#include "tests/stress/audit/shapes.h"

/// Trajectory files of three joints, and the meaning of their rows, evaluated without code of
/// planner/trajectory.
namespace corridor::audit {

inline constexpr std::size_t kRowJoints = 3;

/// A row of a file: time, and for each joint position, velocity and acceleration.
struct FileRow {
  double time = 0;
  std::array<double, kRowJoints> p{}, v{}, a{};
};

/// What is large or small in a file.
enum class RowKind { usual, tinyDurations, longDurations, largeTimes, large, small, mixed };
inline constexpr RowKind kRowKinds[] = {
    RowKind::usual, RowKind::tinyDurations, RowKind::longDurations, RowKind::largeTimes,
    RowKind::large, RowKind::small,         RowKind::mixed};

std::vector<FileRow> randomRows(Dice& dice, RowKind kind, std::size_t count);

/// Returns the text of a CSV file with these rows, for joints with the names slide, pan and lift.
/// @param degree 1, 3 or 5; decides which columns the file has.
std::string textOf(const std::vector<FileRow>& rows, int degree, bool timed);

/// Returns the value at τ, in [0, 1], of the curve between two rows, as
/// planner/trajectory/README.md defines it.
Quad trueValue(const FileRow& from, const FileRow& to, int degree, std::size_t joint, Quad tau);

/// Returns what a controller computes in doubles, t seconds after the row `from`: it sums a power
/// series. @param T the duration, as the controller knows it.
double controllerValue(const FileRow& from, const FileRow& to, int degree, std::size_t joint,
                       double T, double t);

/// Returns a time as a controller knows it that adds seconds and nanoseconds: with three roundings.
double controllerTime(Dice& dice, double time);

}  // namespace corridor::audit
