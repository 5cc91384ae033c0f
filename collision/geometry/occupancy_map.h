#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Rules that decide which cells of a map are obstacles.
struct OccupancyRules {
  /// True: a cell without a measurement also counts as an obstacle if it is in the bounding box of
  /// the measured cells.
  bool unknownIsOccupied = false;
  /// A cell is occupied if its probability is at least `threshold`, which must be in (0, 1).
  /// Probability and threshold are compared as log-odds in float, as OctoMap compares them. A .bt
  /// file has no probabilities: its cells are either free or occupied.
  double threshold = 0.5;
};

/// The obstacles of an octree map of the library OctoMap (Hornung, Wurm, Bennewitz, Stachniss,
/// Burgard 2013).
struct OccupancyMap {
  /// A cube of cells. Its corner with the lowest coordinates is at `corner` times the resolution.
  /// Its edges are `size` times the resolution long.
  struct Cube {
    std::array<std::int32_t, 3> corner{};
    std::int32_t size = 1;
  };
  double resolution = 0;  ///< edge length of the smallest cell, metres
  /// The occupied cubes, and also the unknown cubes if `OccupancyRules::unknownIsOccupied` is true.
  /// Eight occupied children of one octree node are joined into one cube.
  std::vector<Cube> cubes;
  std::size_t free = 0;           ///< number of free leaves of the octree
  bool hasProbabilities = false;  ///< false if the data are as in .bt
  std::string format;             ///< "OctoMap (.bt)", "OctoMap (.ot)", "octomap_msgs/Octomap"

  Vec3 centerOf(const Cube& cube) const;
  double sizeOf(const Cube& cube) const { return cube.size * resolution; }
};

/// Reads an octree map: .bt (OcTree), or .ot (OcTree and ColorOcTree).
/// @throws InputError that names the file: unreadable, another format, cut short, deeper than 16
/// levels, more than 10^7 cubes, a threshold that is not in (0, 1).
OccupancyMap readOccupancyMap(const std::filesystem::path& file, const OccupancyRules& rules = {});

/// Reads an octree map like `readOccupancyMap`, from the bytes of a file. @param name the file's
/// name, for messages.
OccupancyMap parseOccupancyMap(std::string_view bytes, const OccupancyRules& rules,
                               const std::string& name);

/// A map without a file's header, as the ROS message octomap_msgs/Octomap contains it.
struct OccupancyMessage {
  bool binary = false;    ///< true: `data` is as in .bt; false: as in .ot
  std::string id;         ///< the type of the tree: OcTree or ColorOcTree
  double resolution = 0;  ///< edge length of the smallest cell, metres
  std::string data;       ///< bytes; no bytes: a map without any measured cell
};

/// Reads an octree map like `readOccupancyMap`, from a ROS message. @param name the name of that
/// message, for error messages.
OccupancyMap parseOccupancyMessage(const OccupancyMessage& message, const OccupancyRules& rules,
                                   const std::string& name);

}  // namespace corridor
