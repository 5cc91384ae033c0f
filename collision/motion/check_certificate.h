#pragma once

#include <optional>
#include <span>

#include "collision/core/query_context.h"
#include "collision/motion/motion_query.h"

namespace corridor {

/// A fault in the certificate of a motion query.
struct CertificateFault {
  enum class Kind {
    /// The input is not valid, for one of these reasons: an interval is not within [0, 1], has an
    /// end that is not on the grid of 2^-48, names a pair that does not exist, or claims less than
    /// the query requested; `until` is not in [0, 1]; or the options are out of range.
    malformed,
    gap,  ///< the intervals of the pair do not cover `t`
    /// At `t` the two bodies are closer than an interval claims, or one body is inside the other,
    /// which is a solid mesh.
    refuted,
    /// At `t` the edge itself keeps the margin and more than three quarters of the claim beyond it.
    /// But this method cannot prove the interval with tube and rounding included. The method bounds
    /// the effect of tube and rounding on all of b, not only on the region close to a. The fault is
    /// also reported if halving has made an interval too short to have an exact middle.
    unproved,
    workLimit,      ///< `MotionOptions::workLimit` was reached at `t`, so nothing is proved there
    ambiguous,      ///< a half turn or an overflow, so that the motion defines no curve
    floatingPoint,  ///< no bound holds with these processor settings (core/floating_point.h)
  };
  Kind kind = Kind::malformed;
  std::size_t pair = 0;
  double t = 0;
};

/// Checks a certificate. Returns its first fault, or nothing if it has none.
///
/// The check proves again that the intervals of every pair cover [0, until]. It also proves the
/// clearances: throughout each interval, for the whole tube, the bodies stay farther apart than the
/// margin plus half of the claim beyond the margin. Containment in solid meshes is tested only in
/// the first interval of each pair: containment cannot change while the surfaces do not touch.
///
/// Guarantee: if no fault is found and until > 0, no pair comes as close as the margin on
/// [0, until]. Nor is any body inside a solid mesh there (collision/PROMISES.md, promise 4).
///
/// The method and the trees differ from those of the proof. The check makes tolerance queries on
/// the binary trees, at the middles of ever shorter time intervals, with an isotropic motion bound.
/// It shares with `certifyMotion` only the motion itself and the isotropic bound of `motionBound`.
/// The work of the check is proportional to the length of the motion divided by the clearance.
/// @param options the options of the query. `workLimit` limits the box and triangle tests of the
/// check.
/// @param until `certifiedUntil` of the answer.
std::optional<CertificateFault> checkCertificate(MotionSource& motion,
                                                 std::span<const MotionPair> pairs,
                                                 const MotionOptions& options, double until,
                                                 const MotionCertificate& certificate,
                                                 QueryContext& context);

}  // namespace corridor
