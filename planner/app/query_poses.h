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

/// Poses of mesh B, with A at the identity, one a line: 12 numbers, r00 r01 r02 r10 … r22 tx ty tz,
/// blank or comma separated; a point b of B is at R·b + t. From `#` on a line is a comment. The
/// file may be a pipe; "-" is the standard input.
///
/// Verdicts are those of the 12 doubles as they stand, rotation or not; but what is far from a
/// rotation is a mistake: of ‖RᵀR − I‖_max at most `kRotationDefect` is let pass, and no mirror.
/// @throws InputError with all faults; a file without poses is one.
std::vector<Transform> readPoses(const std::filesystem::path& file);

/// Two poses of B, where a motion begins and where it ends, 24 numbers a line; the rest as
/// `readPoses`. What moves is the rotation nearest to each matrix, as a unit quaternion. How far
/// the two matrices are from those is a tube around the motion: what is proved free is free for the
/// maps in the file, too.
struct PoseMotion {
  RigidPose from, to;
  double defect = 0;  ///< rounded up; the larger |M − R|, metres per metre of lever
};
std::vector<PoseMotion> readMotions(const std::filesystem::path& file);

/// A rotation written with four decimals has entries off by 0.5e-4, and an entry of RᵀR that is off
/// by up to 2·√3·0.5e-4 = 1.8e-4. It is, too, what boxes still prune under (`boxPairMargins`
/// takes defects up to 2^-10/3); with more, each query would be all triangles against all.
inline constexpr double kRotationDefect = 2e-4;

/// A lattice of positions and, at each, rotations.
struct PoseGrid {
  std::array<std::size_t, 3> counts{};  ///< along x, y, z
  std::size_t rotations = 1;
  std::uint64_t seed = 1;
  std::optional<Vec3> lower, upper;  ///< metres; unset: as `gridPoses` says
};

/// At most so many poses, of a grid: what fits in memory anywhere.
inline constexpr std::size_t kMostPoses = 10'000'000;

/// The poses of a grid: the centre of B's bounds is put on every point of the lattice from `lower`
/// to `upper` in A's frame (one point along an axis: the middle), B turned about it by the first
/// rotation, then all again with the next one; x changes first. The first rotation is none, the
/// others are random, uniform, from the seed. Unset, the box is that of A's bounds grown by half
/// the diagonal of B's: beyond it nothing can touch.
/// @throws InputError: lower above upper, too many poses.
std::vector<Transform> gridPoses(const PoseGrid& grid, const TriangleMesh& a,
                                 const TriangleMesh& b);

/// "10x10x5". @throws InputError
std::array<std::size_t, 3> parseCounts(const std::string& text);
/// "x,y,z" in metres. @throws InputError that begins with `option`
Vec3 parsePoint(const std::string& option, const std::string& text);

/// The file appears whole or not at all. @throws InputError: can't be written.
void writePoses(const std::filesystem::path& file, const std::vector<Transform>& poses);

}  // namespace corridor::app
