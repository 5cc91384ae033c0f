#include "planner/problem/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/core/shortest.h"
#include "planner/robot/angles.h"
#include "planner/robot/rpy.h"

namespace corridor {
namespace {

/// The largest deviation from 1 that the norm of a quaternion in a file may have. Rounding to three
/// digits after the point causes a deviation of at most 0.001: four components, each off by at most
/// 0.0005, change the norm by at most 0.0005·√4.
constexpr double normSlack = 1e-3;

std::optional<Orientation> readQuaternion(const YamlMap& map) {
  const auto xyzw = map.numbers("quat_xyzw", 4);
  if (!xyzw) return std::nullopt;
  const Eigen::Quaterniond q((*xyzw)[3], (*xyzw)[0], (*xyzw)[1], (*xyzw)[2]);
  const double norm = q.coeffs().stableNorm();
  if (norm == 0) {
    map.fault("quat_xyzw", "a quaternion of zeros is no rotation; [0, 0, 0, 1] is the identity");
    return std::nullopt;
  }
  if (!(std::abs(norm - 1) <= normSlack)) {
    map.fault("quat_xyzw", "[x, y, z, w] of norm 1 is needed, not of norm " + shortest(norm) +
                               "; a mistyped number?");
    return std::nullopt;
  }
  return Orientation{q, rotationMatrix(q)};
}

std::string wrongKind(const std::string& path, const PoseForm& form) {
  return path + " of the wrong kind: " + form.mover + ", so " +
         (form.spatial ? "{at: [x, y, z], rpy_deg: [roll, pitch, yaw]}"
                       : "{at: [x, y], yaw_deg: yaw}") +
         " is needed";
}

bool isWrongKind(const YamlValue& value, const PoseForm& form) {
  if (value.kind != YamlValue::Kind::Map) return true;
  const std::vector<std::string>& legal = form.keys->legal;
  bool hasLegal = false;
  for (const auto& [key, line, entry, use] : value.entries) {
    hasLegal |= std::find(legal.begin(), legal.end(), key) != legal.end();
    const bool planar = key == "yaw" || key == "yaw_deg";
    const bool spatial = key == "rpy" || key == "rpy_deg" || key == "quat_xyzw";
    if (form.spatial ? planar : spatial) return true;
    if (key == "at" && entry.kind == YamlValue::Kind::List &&
        entry.items.size() == (form.spatial ? 2u : 3u))
      return true;
  }
  return !hasLegal;
}

/// Returns `yaw` or `yaw_deg` in radians. Returns 0 if both are absent, and nullopt if a fault was
/// added.
std::optional<double> readYaw(const YamlMap& map, std::vector<Note>& notes) {
  if (!map.find("yaw") && !map.find("yaw_deg")) return 0;
  if (map.find("yaw") && map.find("yaw_deg")) return map.angle("yaw");
  const bool degrees = map.find("yaw_deg");
  const char* const key = degrees ? "yaw_deg" : "yaw";
  const auto given = map.number(key);
  if (!given) return std::nullopt;
  const double used = degrees ? wrappedYawDegrees(*given) : wrappedYaw(*given);
  if (used != *given)
    notes.push_back(
        {map.pathOf(key) + ": " + shortest(*given) + " is read as " + shortest(used) +
             ", the same angle up to full turns" +
             (!degrees && seemsDegrees(*given) ? "; for degrees, write yaw_deg: " + shortest(*given)
                                               : ""),
         !degrees && seemsDegrees(*given) ? NoteWeight::coverage : NoteWeight::detail});
  return degrees ? used * (std::numbers::pi / 180) : used;
}

}  // namespace

Orientation fromRpyDegrees(const Vec3& degrees) {
  return {quaternionFromRpyDegrees(degrees), matrixFromRpyDegrees(degrees)};
}

Orientation fromRpy(const Vec3& radians) {
  return {quaternionFromRpy(radians), matrixFromRpy(radians)};
}

Eigen::Quaterniond ofOrdinarySize(const Eigen::Quaterniond& q) {
  const double norm = q.coeffs().stableNorm();
  return 0.5 < norm && norm < 2 ? q : Eigen::Quaterniond(q.coeffs().stableNormalized());
}

double wrappedYaw(double radians) {
  return intoCircle(radians);
}

double wrappedYawDegrees(double degrees) {
  const double rest = std::remainder(degrees, 360);
  return rest == -180 ? 180 : rest;
}

std::optional<Orientation> readOrientation(const YamlMap& map) {
  std::vector<const char*> given;
  for (const char* key : {"rpy_deg", "rpy", "quat_xyzw"})
    if (map.find(key)) given.push_back(key);
  if (given.empty()) return Orientation{};
  if (given.size() > 1) {
    map.fault(given[1], std::string("one rotation is needed, and ") + given[0] +
                            " is given already; leave one out");
    return std::nullopt;
  }
  const std::string key = given[0];
  if (key == "quat_xyzw") return readQuaternion(map);
  const auto angles = map.numbers(key, 3);
  if (!angles) return std::nullopt;
  const Vec3 rpy((*angles)[0], (*angles)[1], (*angles)[2]);
  if (key == "rpy" && std::any_of(angles->begin(), angles->end(), seemsDegrees)) {
    const std::string text =
        "[" + shortest(rpy.x()) + ", " + shortest(rpy.y()) + ", " + shortest(rpy.z()) + "]";
    map.source().notes.push_back(
        {map.pathOf(key) + ": " + text + " is in radians; for degrees, write rpy_deg: " + text,
         NoteWeight::coverage});
  }
  return key == "rpy" ? fromRpy(rpy) : fromRpyDegrees(rpy);
}

Placement operator*(const Placement& a, const Placement& b) {
  return {{a.X * b.pose.p, a.pose.q * b.pose.q}, a.X * b.X};
}

std::optional<Placement> readPlacement(const YamlMap& map) {
  Vec3 at = Vec3::Zero();
  const auto numbers = map.numbers("at", 3);
  if (numbers) at = Vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  const auto orientation = readOrientation(map);
  if ((map.find("at") && !numbers) || !orientation) return std::nullopt;
  return Placement{{at, orientation->q}, {orientation->R, at}};
}

std::optional<PlanarOrSpatialPose> readPose(const YamlValue& value, const std::string& path,
                                            const PoseForm& form, YamlSource& source,
                                            std::vector<Note>& notes) {
  if (isWrongKind(value, form)) {
    source.fault(value.line, wrongKind(path, form));
    return std::nullopt;
  }
  const YamlMap map(value, path, form.keys, source);
  map.require("at", form.spatial ? "the position [x, y, z] of the robot's reference point"
                                 : "the position [x, y] of the robot's reference point");
  const auto at = map.numbers("at", form.spatial ? 3 : 2);
  PlanarOrSpatialPose result;
  std::optional<Orientation> orientation;
  if (form.spatial) {
    orientation = readOrientation(map);
  } else if (const auto yaw = readYaw(map, notes)) {
    result.yaw = *yaw;
    orientation = fromRpy({0, 0, *yaw});
  }
  if (!at || !orientation) return std::nullopt;
  result.pose = {Vec3((*at)[0], (*at)[1], form.spatial ? (*at)[2] : 0), orientation->q};
  return result;
}

}  // namespace corridor
