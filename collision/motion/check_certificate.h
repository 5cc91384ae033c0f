#pragma once

#include <optional>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// A fault in the certificate of a motion query.
struct CertificateFault {
  enum class Kind {
    /// The input is not valid. An interval is not part of [0, 1] on the grid of 2^-48, names no
    /// pair, or claims less than the query requested. Or `until` is not in [0, 1], or no query
    /// accepts the options.
    malformed,
    gap,  ///< the intervals of the pair do not cover `t`
    /// At `t` the pair is closer than an interval there claims, or one body is inside the other,
    /// which is a solid mesh.
    refuted,
    /// At `t` the claim holds for the edge itself, but this method cannot prove it with tube and
    /// rounding included: it bounds their effect on all of b, not only on the region close to a.
    unproved,
    workLimit,      ///< `MotionOptions::workLimit` was reached at `t`: not proved
    ambiguous,      ///< the motion defines no curve: a half turn, or a displacement that overflows
    floatingPoint,  ///< no bound holds with these processor settings (core/floating_point.h)
  };
  Kind kind = Kind::malformed;
  std::size_t pair = 0;
  double t = 0;
};

/// Checks a certificate and returns its first fault, or nothing if it holds.
///
/// The check proves again that the intervals of every pair cover [0, until]. It also proves the
/// clearances: throughout each interval, for the whole tube, the bodies stay farther apart than the
/// margin plus half of what the interval claims beyond it. Containment in solid meshes is tested
/// once per pair, where the first part of an interval from t = 0 is proved.
///
/// Guarantee: if no fault is found and until > 0, no pair comes as close as the margin on
/// [0, until]. Nor is any body inside a solid mesh there (collision/PROMISES.md, promise 4).
///
/// The method and the trees differ from those of the proof: tolerance queries on the binary trees
/// at the middles of ever shorter time intervals, against an isotropic motion bound. The check
/// shares with `certifyMotion` only the motion itself and the isotropic bound of `motionBound`. Its
/// work is proportional to the length of the motion divided by its clearance.
/// @param options those of the query; `workLimit` limits the box and triangle tests of the check.
/// @param until `certifiedUntil` of the answer.
std::optional<CertificateFault> checkCertificate(MotionSource& motion,
                                                 std::span<const MotionPair> pairs,
                                                 const MotionOptions& options, double until,
                                                 const MotionCertificate& certificate,
                                                 QueryContext& context);

}  // namespace corridor
