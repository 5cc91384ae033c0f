#pragma once

/// Corridor's collision library in one header. This comment is the library's manual. The header
/// includes everything that most programs need.
///
/// Everything is in namespace `corridor`. Lengths are metres, angles are radians. Vectors and
/// matrices are Eigen's. `p_A` is a point in the coordinates of frame A; `X_WA` maps points of
/// frame A to frame W.
///
/// # Types
///
/// * `Transform`: an affine map x ↦ m·x + t. It is used exactly as it is stored: a map that scales,
///   shears or mirrors is legal.
/// * `TriangleMesh`: a point set, the union of its triangles with their interiors. `readMeshFile`
///   reads OBJ, STL, PLY, OFF, Collada, glTF and more. If a file has a fault, `readMeshFile` throws
///   InputError, whose message names the file and, if it is known, the line.
/// * `ConvexPart`: a convex solid that is never tessellated. `placed(Box{size}, X)` makes a box
///   with the pose X; instead of Box, use Sphere, Capsule, Cylinder or Convex.
/// * `Body`: a named mesh, a convex part, or the union of many convex parts. A mesh stands for its
///   surface, and with `solid` also for the space that the surface encloses. The trees of a body
///   are built when a query first needs them. The constructor throws std::invalid_argument for
///   these faults: a mesh without triangles, an index out of range, a coordinate that is not
///   finite, a solid mesh that is not watertight, a convex part that is not valid.
/// * `readPointCloud` and `readOccupancyMap` read the points of a scan, and the occupied cubes of a
///   map of OctoMap. A `Body` can have balls about the points, or the cubes, as its convex parts.
/// * `Posed`: a body or tree with its pose, for example `Posed(cup, X_WCup)`. `Posed(table)` has
///   the identity as its pose.
/// * `QueryContext`: counters and scratch memory. Each thread needs its own.
/// * `LastPair`: the pair of triangles that decided the last query of two bodies. If the bodies are
///   meshes and move in small steps, passing the pair to the next query saves a tenth to two thirds
///   of the time.
///
/// # Seven questions about two bodies
///
///     #include "collision/collision.h"
///     using namespace corridor;
///
///     const Body cup("cup", readMeshFile("cup.obj").mesh);
///     const Body table("table", placed(Box{{1, 1, 0.05}}, Transform()));
///     QueryContext context;
///     const Posed a(cup, X_WCup), b(table);
///
/// Queries of bodies throw std::invalid_argument for maps that are not finite. `a` and `b` refer to
/// the bodies: never keep a `Posed` of a temporary body.
///
/// 1. Do they touch? For meshes the answer is exact: the verdict is that of real arithmetic on the
///    stored numbers, and touching is contact. With a convex part, a gap below 2^-44 of the largest
///    coordinate may be reported as contact. This is the cheapest question. It takes a few
///    microseconds for most pairs of meshes, and a hundred microseconds if two surfaces of 20,000
///    triangles run side by side.
///
///        if (const auto hit = interference(a, b, context)) …        // hit->a, hit->b: triangles
///
/// 2. Which triangles touch, and where? This question is for meshes only. The set of pairs is
///    exact. The cost grows with the number of pairs.
///
///        for (const TriangleContact& c : contacts(a, b, context)) …  // c.a, c.b, c.p_W, c.q_W
///
/// 3. How far apart are they, and where are they closest to each other? The distance is 0 if and
///    only if the bodies touch. Otherwise the error is at most 1e-12·distance + 4·2^-53·S, plus the
///    error that the options allow. S is the largest number Σ_k |m_ik||v_k| + |t_i| over the
///    coordinates i of all corners v of both bodies, where x ↦ m·x + t is the map of the corner's
///    body. This question costs 10 to 70 times as much as the first one.
///
///        const Distance d = distance(a, b, {}, context);             // d.distance, d.p_WA, d.p_WB
///
/// 4. Are they at most d apart? `false` is a proof that they are more than d apart. This question
///    costs about as much as the first one, or, if d is close to the distance, as much as the third
///    one.
///
///        if (closerThan(a, b, 0.05, context)) …
///
/// 5. Is one body, or a component of its mesh, inside the other body? The other body must be a
///    solid mesh. Questions 1, 3, 4, 6 and 7 include this question. The caller of
///    `findOneInsideOther` must know that the surfaces do not touch. The answer "no" is a proof.
///    The answer "yes" is exact, except that a point counts as inside if none of 64 rays decides
///    whether it is.
///
///        if (findOneInsideOther(a, b, context)) …
///
/// 6. Do they touch along a motion, and when for the first time? `free` is never wrong: it is
///    proved for every t in [0, 1], rounding included. `contact`: at the rounded pose at
///    `time` the bodies touch, or are within the margin. `undecided`: neither is proved, and
///    `reason` says why. The usual reason is a clearance below twice the tolerance (PROMISES.md,
///    promise 2). This question costs 10 to 20 times as much as the first one.
///
///        std::vector<Body> moving, fixed;        // bodies are moved into the scene
///        moving.emplace_back("piano", piano);
///        fixed.emplace_back("walls", walls);
///        const RigidScene scene(std::move(moving), std::move(fixed));
///        MotionOptions options;
///        options.tolerance = scene.defaultTolerance();
///        options.earliest = true;                // find the first contact, not just the verdict
///        const MotionResult r = scene.certifyEdge(from, to, options, context);
///        if (r.verdict == MotionVerdict::free) …
///
/// 7. How deep are they in each other? The depth is the length of the shortest translation of b
///    that separates the bodies. The answer has two proved bounds of the depth, and a direction. A
///    translation of b along this direction by the upper bound separates the bodies. The two bounds
///    may differ much for bodies that are not convex. This question costs some 15 times as much as
///    question 6. It needs collision/course/body_depth.h, and the library corridor::course.
///
///        // X_CupTable maps the table into the frame of the cup.
///        const DepthBounds d = depthBounds(cup, table, X_CupTable, {}, context);  // d.lower …
///
/// # Many bodies
///
/// A `Scene` has frames, bodies that are fixed to the frames, and the pairs of bodies to test. Its
/// queries take the pose of each frame, or a `MotionSource` that describes how frames move relative
/// to each other.
///
/// # Trees
///
/// Programs that use no `Body` can build trees themselves: `Obb4Tree` (fast), or
/// `VolumeTree<Volume>` of any bounding volume (for comparison). The functions for questions 1 to 4
/// have the same names for trees. For trees of convex parts, question 2 is not defined. Queries of
/// trees do not test whether maps are finite.
///
/// # What every query assumes
///
/// The processor rounds to nearest, and long double keeps 64 bits. If one of these two conditions
/// does not hold, the constructors of bodies and trees throw std::runtime_error. The program is
/// compiled with -ffp-contract=off, which the CMake target adds, and without -ffast-math or any of
/// the options that -ffast-math sets (core/floating_point.h). Threads may share bodies, trees and
/// scenes.

#include "collision/core/error.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_file.h"
#include "collision/geometry/occupancy_map.h"
#include "collision/geometry/point_cloud.h"
#include "collision/queries/contacts.h"
#include "collision/queries/distance.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/world/body_queries.h"
#include "collision/world/rigid_scene.h"
#include "collision/world/scene.h"
