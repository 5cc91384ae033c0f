#include "planner/trajectory/trajectory_text.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "collision/core/shortest.h"
#include "planner/problem/text_words.h"

namespace corridor {
namespace {

constexpr double kPerSecond = 1e9;

std::string joined(const Configuration& values, const char* separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + shortest(value);
  return text;
}

/// Returns the indices of the numbers that have velocities: all except those of rotations.
std::vector<Eigen::Index> withVelocities(const ConfigurationSpace& space) {
  std::vector<Eigen::Index> all;
  for (const Coordinate& c : space.coordinates())
    if (c.kind != Coordinate::Kind::rotation) all.push_back(static_cast<Eigen::Index>(c.first));
  return all;
}

}  // namespace

bool hasRotation(const ConfigurationSpace& space) {
  for (const Coordinate& c : space.coordinates())
    if (c.kind == Coordinate::Kind::rotation) return true;
  return false;
}

double nearestNanosecond(double seconds) {
  return std::round(seconds * kPerSecond) / kPerSecond;
}

std::string csvText(const TrajectoryRows& rows, const ConfigurationSpace& space) {
  const std::vector<std::string> names = space.numberNames();
  const std::vector<Eigen::Index> moving = withVelocities(space);
  std::string text = rows.timed ? "time" : "";
  const auto add = [&](const std::string& word, bool isFirst) {
    text += (isFirst ? "" : ",") + word;
  };
  for (std::size_t i = 0; i < names.size(); ++i) add(names[i], i == 0 && !rows.timed);
  for (const auto& [has, ending] : {std::pair{rows.hasVelocities, "_velocity"},
                                    std::pair{rows.hasAccelerations, "_acceleration"}})
    if (has)
      for (const Eigen::Index i : moving) add(names[static_cast<std::size_t>(i)] + ending, false);
  text += "\n";
  for (const TrajectoryRow& row : rows.rows) {
    text += (rows.timed ? shortest(row.time) + "," : "") + joined(row.positions, ",");
    if (rows.hasVelocities)
      for (const Eigen::Index i : moving) text += "," + shortest(row.velocities[i]);
    if (rows.hasAccelerations)
      for (const Eigen::Index i : moving) text += "," + shortest(row.accelerations[i]);
    text += "\n";
  }
  return text;
}

std::string messageText(const TrajectoryRows& rows, const ConfigurationSpace& space) {
  if (hasRotation(space))
    throw std::invalid_argument("a JointTrajectory has no rotations of floating joints");
  if (!rows.timed) throw std::invalid_argument("a JointTrajectory needs times");
  std::string text = "joint_names: [";
  const std::vector<std::string> names = space.numberNames();
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + yamlText(names[i]);
  text += "]\npoints:\n";
  for (const TrajectoryRow& row : rows.rows) {
    if (!(row.time >= 0 && row.time < 0x1p53 / kPerSecond) ||
        nearestNanosecond(row.time) != row.time)
      throw std::invalid_argument("the time " + shortest(row.time) +
                                  " s is not a whole number of nanoseconds");
    const auto total = static_cast<std::uint64_t>(std::round(row.time * kPerSecond));
    text += "- positions: [" + joined(row.positions, ", ") + "]\n";
    if (rows.hasVelocities) text += "  velocities: [" + joined(row.velocities, ", ") + "]\n";
    if (rows.hasAccelerations)
      text += "  accelerations: [" + joined(row.accelerations, ", ") + "]\n";
    text += "  time_from_start: {sec: " + std::to_string(total / 1'000'000'000) +
            ", nanosec: " + std::to_string(total % 1'000'000'000) + "}\n";
  }
  return text;
}

}  // namespace corridor
