#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/body.h"
#include "collision/motion/motion_query.h"
#include "collision/motion/relative_motion.h"

namespace corridor {

class BroadPhase;

/// Decides whether a motion is free of contact: every pair keeps the margin for all t in [0, 1] and
/// for every curve in the tube. Meshes are surfaces here: a body inside a mesh touches nothing
/// (`Scene` tests solid meshes). Convex parts are solid. The query is fastest if pairs with the
/// same motion are adjacent and if, among them, pairs with the same b are adjacent.
///
/// Method. A time interval is halved if some boxes, triangles or convex parts of a pair of bodies
/// cannot be separated in it (`descend`: descend.h; for trees of any volume, descend_volumes.h).
/// Each interval passes only its unseparated node pairs on to its halves. If the bounds of two
/// bodies are separated, their trees are neither built nor walked.
///
/// If only the verdict is requested, the pairs whose bounds are not separated are first tested for
/// contact at the end of the motion, before any interval is walked. At the middles of the first
/// intervals, the node pairs that are not separated yet are also tested for contact. These two
/// tests decide most motions that have a contact.
/// @param certificate if not null, receives the certificate, which `checkCertificate`
/// (check_certificate.h) can prove again. Recording it never changes the verdict; the query then
/// takes about 1.5 times as long.
/// @param broadPhase if not null, the broad phase of these pairs. It finds the pairs that may come
/// close, so that not every pair is tested. A query with a certificate does not use it, because the
/// certificate has an entry for every pair.
/// @throws std::invalid_argument as `requireValid`.
MotionResult certifyMotion(MotionSource& motion, std::span<const MotionPair> pairs,
                           const MotionOptions& options, QueryContext& context,
                           MotionCertificate* certificate = nullptr,
                           const BroadPhase* broadPhase = nullptr);

/// Returns the numbers of the pairs that are not proved to keep their margins on the whole motion
/// by their bounds and hulls alone, in ascending order. No tree is built or walked, so some of
/// these pairs may keep their margins; the other pairs do, as `certifyMotion` proves it, and no
/// body of theirs is inside a solid one. Callers can leave them out of searches for near pairs. If
/// the motion defines no curve, all pairs are returned. The options for the first contact and the
/// work limit are ignored.
/// @throws std::invalid_argument as `requireValid`.
std::vector<std::uint32_t> pairsLeftByHulls(MotionSource& motion, std::span<const MotionPair> pairs,
                                            const MotionOptions& options, QueryContext& context,
                                            const BroadPhase* broadPhase = nullptr);

}  // namespace corridor
