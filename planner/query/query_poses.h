#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "collision/motion/rigid_motion.h"

namespace corridor::app {

/// Reads poses of mesh B, with A at the identity, one per line: 12 numbers, r00 r01 r02 r10 … r22
/// tx ty tz, blank or comma separated. A point b of B is at R·b + t. The rest of a line from `#` on
/// is a comment. The file may be a pipe; "-" is the standard input.
///
/// Verdicts are exact for these 12 doubles, even if R is not quite a rotation. A matrix that is far
/// from a rotation is refused as a mistake: if ‖RᵀR − I‖_max exceeds `kRotationDefect`, or if R
/// mirrors or is singular.
/// @throws InputError with all faults; a file without poses is a fault.
std::vector<Transform> readPoses(const std::filesystem::path& file);

/// A motion of B: its first and its last pose. `readMotions` reads such motions: each line has the
/// 12 numbers of both poses. In all else, the format is that of `readPoses`. Each matrix M is
/// replaced by the nearest rotation R, as a unit quaternion; `defect` bounds |M − R|. If the
/// rotation of the motion's tube has the half width `defect`, then the verdict `free` holds for the
/// matrices in the file, too.
struct PoseMotion {
  RigidPose from, to;
  double defect = 0;  ///< the larger |M − R| of the two, rounded up; metres per metre of lever
};
std::vector<PoseMotion> readMotions(const std::filesystem::path& file);

/// The largest ‖RᵀR − I‖_max that counts as rounding. A rotation written with four decimals has
/// entries off by up to 0.5e-4, so entries of RᵀR are off by up to 2·√3·0.5e-4 < 1.8e-4. The limit
/// also keeps queries fast. If the defects of map and trees add up to 2^-10/3 or more, then
/// `boxPairMargins` makes every box test fail to separate, and a query tests all pairs of
/// triangles.
inline constexpr double kRotationDefect = 2e-4;

/// A lattice of positions, repeated for each of several rotations.
struct PoseGrid {
  std::array<std::size_t, 3> counts{};  ///< along x, y, z
  std::size_t rotations = 1;
  std::uint64_t seed = 1;
  std::optional<Vec3> lower, upper;  ///< metres; defaults: see `gridPoses`
};

/// The maximum number of poses that a grid may have: together they take 960 MB.
inline constexpr std::size_t kMostPoses = 10'000'000;

/// Returns the poses of a grid. They put the centre of B's bounding box on every point of the
/// lattice from `lower` to `upper` in A's frame; x changes fastest. If the lattice has only one
/// point along an axis, this point is halfway between `lower` and `upper`. The lattice is repeated
/// for each rotation of B about that centre: first the identity, then uniformly random rotations
/// from the seed. By default `lower` and `upper` are the corners of A's bounding box, enlarged on
/// each side by half the diagonal of B's bounding box. With the centre of B outside of this
/// enlarged box, the meshes can't touch.
/// @throws InputError if `lower` is above `upper`, or for more than `kMostPoses` poses.
std::vector<Transform> gridPoses(const PoseGrid& grid, const TriangleMesh& a,
                                 const TriangleMesh& b);

/// Reads three counts, such as "10x10x5". @throws InputError for any other text.
std::array<std::size_t, 3> parseCounts(const std::string& text);
/// Reads three numbers "x,y,z", metres. @throws InputError for any other text; the message begins
/// with `option`.
Vec3 parsePoint(const std::string& option, const std::string& text);

/// Writes poses as `readPoses` reads them. The file appears whole or not at all.
/// @throws InputError if it can't be written.
void writePoses(const std::filesystem::path& file, const std::vector<Transform>& poses);

}  // namespace corridor::app
