#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_components.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/motion/certify_motion.h"

namespace corridor {

/// A named shape, a mesh or a convex primitive, whose trees are built when a query first needs them
/// (thread-safe). Immutable otherwise. In the coordinates of the frame that it is fixed to.
class Body {
 public:
  /// A mesh: its surface, or with `solid` all that it encloses, too.
  /// @throws std::invalid_argument if the mesh has no triangle, or `checkMesh` complains, or it is
  /// to be solid and has a component that isn't watertight.
  Body(std::string name, TriangleMesh mesh, bool solid = false, const TreeParams& params = {});
  /// A solid primitive.
  Body(std::string name, ConvexPart part);
  ~Body();
  Body(Body&&) noexcept;
  Body& operator=(Body&&) noexcept;

  const std::string& name() const;
  const TriangleMesh& mesh() const;  ///< empty for a primitive
  const ConvexPart* part() const;    ///< null for a mesh
  bool solid() const;                ///< true for primitives
  const ObbTree& tree() const;       ///< builds it if nobody has
  /// Of a mesh, for queries at rest, which are several times faster on it; builds it if nobody has.
  const WideObbTree& wideTree() const;
  const MeshComponents& components() const;  ///< of a mesh; found if nobody has
  bool treeBuilt() const;                    ///< any of them
  /// Radius about the origin of the frame of all points, rounded up.
  double radius() const;
  /// A sphere around all points: centre, and radius rounded up.
  const Vec3& sphereCenter() const;
  double sphereRadius() const;
  const Vec3& lower() const;  ///< axis-aligned bounds
  const Vec3& upper() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Bodies on frames that move, and which of them are tested against which. Frame 0 is the world. It
/// knows nothing of why frames move: a `MotionSource` says how each pair of frames does, or a list
/// of transforms where they are. All const after construction, trees apart (built at first need):
/// with one QueryContext (and one MotionSource) a thread every query may be called in parallel.
class Scene {
 public:
  struct Placed {
    Body body;
    std::size_t frame = 0;
  };
  struct Pair {
    std::size_t a = 0, b = 0;  ///< bodies, by index
  };
  /// Of frames; b is seen from a. The index in `framePairs()` is the motion's number.
  struct FramePair {
    std::size_t a = 0, b = 0;
  };

  /// Only `pairs` are ever tested. Within a pair the order is kept where the frames differ in rank:
  /// a is on the frame of lower index.
  Scene(std::vector<Placed> bodies, std::vector<Pair> pairs);

  const std::vector<Placed>& bodies() const { return bodies_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// The distinct pairs of frames among `pairs()`: what a MotionSource has to tell the motion of.
  const std::vector<FramePair>& framePairs() const { return framePairs_; }
  /// 1e-7 of the smallest of the frames' radii (each frame's bodies in one sphere; frames in no
  /// pair don't count).
  double defaultTolerance() const;

  /// All queries throw std::invalid_argument for transforms that are not finite and options that
  /// are not finite or out of range; they build the trees that they need.

  /// Exact for meshes under the maps X_WF of the frames (contract 1), in the band of 2^-44 for
  /// primitives; solids included. First contact found.
  std::optional<Contact> interference(std::span<const Transform> X_WF, QueryContext& context) const;

  /// Is the motion free? (`certifyMotion`; a solid that has another body inside is a contact at t =
  /// 0.) `motion` numbers its motions as `framePairs()`.
  MotionResult certify(MotionSource& motion, const MotionOptions& options,
                       QueryContext& context) const;
  /// What `certify` says of each pair of bodies on its own, in the order of `pairs()`.
  std::vector<MotionResult> certifyEachPair(MotionSource& motion, const MotionOptions& options,
                                            QueryContext& context) const;

 private:
  MotionResult certifyPairs(std::span<const std::size_t> pairs, MotionSource& motion,
                            const MotionOptions& options, QueryContext& context) const;

  std::vector<Placed> bodies_;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> motionOf_;  // of each pair
  std::vector<std::size_t> order_;     // of the pairs: those of one motion together
  std::vector<FramePair> framePairs_;
};

}  // namespace corridor
