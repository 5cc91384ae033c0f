#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/motion/check_certificate.h"
#include "collision/world/scene.h"
#include "planner/checker/held_pairs.h"
#include "planner/model/model.h"
#include "planner/model/pair_proofs.h"
#include "planner/model/settings.h"
#include "planner/model/task.h"
#include "planner/robot/curve.h"

namespace corridor {

class EdgeFilter;
struct Problem;

/// Returns the scene of a model. The scene has one body for each shape of each model body, in the
/// model's order. Its pairs are the pairs of shapes of all pairs of model bodies that the model's
/// filter does not exclude. Builds no tree.
/// @param need what the queries of the scene have to cover. Pairs that were proved never in contact
/// are left out if their proof covers it. Queries of the scene are then only for configurations in
/// `provedBox(model, need)`; `Checker` sees to it.
/// @param params how the trees of meshes are built, when queries need them.
/// @param earlier bodies with the same parameters. They are used for the same meshes, with the
/// trees that they have.
/// @throws std::invalid_argument if a body without a robot is on a frame that moves. Such a body
/// would be taken to be at rest.
Scene makeScene(const Model& model, const Required& need, const TreeParams& params = {},
                std::span<const Body> earlier = {});

/// The options of a checker: the margin, tube and tolerance of its proofs, the method, the trees.
struct CheckerOptions {
  double margin = 0;     ///< metres that all tested pairs must keep apart; 0: touching is contact
  Padding padding = {};  ///< distances of bodies and pairs beyond the margin
  /// The tube that the proofs cover, as `tubeOf` returns it; empty: rounding only.
  Configuration tube = {};
  std::optional<double> tolerance = {};  ///< metres; unset: default_tolerance.h
  EdgeMethod method = EdgeMethod::certified;
  TreeChoice trees = {};
};

/// Returns the options that a task and settings describe.
/// @throws std::invalid_argument if the name of a volume, fit, overlap test or way of building is
/// unknown, or cannot be combined with the other names (`invalidNameIn`).
CheckerOptions checkerOptions(const Task& task, const CheckerSettings& settings);

/// Returns what the proofs of a checker with these options have to cover.
Required requiredBy(const CheckerOptions& options, const ConfigurationSpace& space);

/// What an edge is tested for. The pointers must be valid during the query.
struct EdgeQuery {
  bool earliest = false;  ///< whether to search for the first contact, as in `MotionOptions`
  /// One margin for each pair of `Scene::pairs()`, metres, beyond the margin of the options. They
  /// replace the padding. Null: the padding.
  const PairMargins* margins = nullptr;
  /// Where to store what was proved; null: nowhere. The pairs of the certificate are those of
  /// `Scene::pairs()`. Every pair is then proved by itself, without a broad phase, which takes
  /// longer. A certificate is about surfaces, so it is empty if the verdict follows from
  /// containment in a solid mesh. Not with `margins`, which `faultOf` does not know.
  MotionCertificate* certificate = nullptr;
};

/// Checks states and edges of a model. The OMPL classes in this folder forward to it, except
/// `DiscreteMotionValidator`, which samples edges itself.
///
/// Thread safety: all functions may be called from several threads at once, except `counters`. Each
/// thread has its own QueryContext and EdgeMotion.
class Checker {
 public:
  /// The model must outlive the checker; its bodies are copied.
  /// @throws std::invalid_argument in these cases:
  /// - A body without a robot is on a frame that moves (`makeScene`).
  /// - The margin, a padding or the tolerance is not finite, the margin or a padding is negative,
  ///   or the tolerance is not above 0.
  /// - The method does not prove edges (`discrete`).
  /// - The tube is not empty and has another length than a configuration, or a half width is
  ///   negative or NaN.
  /// - The method measures distances (`adaptive`, `advancement`), and the trees have another
  ///   overlap test than their volume's default.
  /// - A mesh is invalid, or a solid mesh is not watertight.
  /// @param earlier see `makeScene`
  explicit Checker(const Model& model, const CheckerOptions& options = {},
                   std::span<const Body> earlier = {});
  /// Makes the checker of a problem's model, with `checkerOptions`.
  explicit Checker(const Problem& problem, std::span<const Body> earlier = {});
  ~Checker();

  const Model& model() const { return model_; }
  const ConfigurationSpace& space() const { return model_.space; }
  const Scene& scene() const { return scene_; }
  /// What the proofs cover: margin, padding and tube. Pairs that were proved never in contact for
  /// at least this are not tested (`PairFilter`).
  const Required& required() const { return required_; }
  /// The tube that the proofs cover.
  const Configuration& tube() const { return required_.tube; }
  /// The options of motion queries, with tolerance and margin. The clearance slack is the
  /// tolerance: `free` requires a clearance of at least the tolerance beyond margin and tube. This
  /// requirement costs little, since less clearance may give `undecided` anyway. It has two
  /// advantages: no returned path depends on the last digits of a clearance, and the work to prove
  /// a path again is at most proportional to the path's length divided by the tolerance.
  const MotionOptions& options() const { return options_; }
  /// Returns the distance that two bodies of the model must keep, metres: margin plus padding,
  /// rounded up.
  double marginOf(std::size_t a, std::size_t b) const;
  /// Bodies that stand still relative to each other, because the joints between them are held, are
  /// tested once, by the constructor. Returns the pairs that are not proved free, such as a held
  /// arm that touches the table. They are tested like all other pairs from then on, so no state is
  /// free.
  const std::vector<HeldPair>& notFreeAtRest() const { return notFreeAtRest_; }
  /// Returns the index of the model's body to which a body of the scene (one shape) belongs.
  std::size_t bodyOf(std::size_t shape) const { return bodyOf_[shape]; }

  /// Returns whether a configuration is within the bounds, which are inclusive. A configuration
  /// that is not finite or has a zero quaternion is out of bounds.
  bool inBounds(const Configuration& q) const;

  /// Pairs of links that were proved never in contact, for the margin, padding and tube of the
  /// options, are not tested. This proof is for the limits of the joints, and for what it covers
  /// beyond them. If there are such pairs, and a state, an edge or a piece, with the tube, leaves
  /// these configurations, the answer of a motion query is `undecided`, with the reason
  /// `beyondProofs`.
  ///
  /// All queries below test no bounds. A motion query of a state, an edge or a piece in which a
  /// number is not finite, or a quaternion is zero, is `undecided`, with the reason `ambiguous`.
  /// Other queries (`interference`, `clearance`, `pairsWithin`) throw std::invalid_argument for
  /// such a configuration. @pre Configurations have the space's size.

  /// Decides whether a state is free, as an edge of zero length, always by
  /// `EdgeMethod::certified`.
  MotionResult certifyState(const Configuration& q) const;
  /// Decides whether an edge is free. The method is that of the options; with `margins` or a
  /// `certificate` it is `EdgeMethod::certified`.
  /// @throws std::invalid_argument for margins that are negative or not finite, or if both
  /// `margins` and `certificate` are set.
  MotionResult certifyEdge(const Configuration& from, const Configuration& to,
                           const EdgeQuery& query = {}) const;
  /// Checks a certificate of an edge, by a method that is independent of the method that made the
  /// certificate (collision/motion/check_certificate.h). Returns the first fault of the
  /// certificate, or nullopt if it has none.
  /// If the edge leaves the values for which pairs that are not tested are proved, and the
  /// certificate claims anything, the fault is `unproved`.
  /// @param until `certifiedUntil` of the result that came with the certificate.
  std::optional<CertificateFault> faultOf(const MotionCertificate& certificate,
                                          const Configuration& from, const Configuration& to,
                                          double until) const;
  /// Decides whether a piece of a curve is free, for the tube widened by the piece's `error`. Times
  /// in the result are values of the piece's parameter τ. The method is always
  /// `EdgeMethod::certified`.
  /// @param earliest whether to search for the first contact, as in `EdgeQuery`.
  /// @throws std::invalid_argument if the piece has another number of rows than a configuration has
  /// numbers, a degree that is not from 1 to 9, or an `error` that is negative, not finite, or of
  /// another size; and for margins that are negative or not finite.
  /// @param margins as in `EdgeQuery`.
  MotionResult certifyCurve(const CurvePiece& piece, bool earliest = false,
                            const PairMargins* margins = nullptr) const;
  /// Returns a contact of a tested pair at the rounded poses of the frames, or nullopt if no pair
  /// is in contact. The test is exact for meshes, as `Scene::interference` states. Margin, padding,
  /// tolerance and tube are ignored.
  /// @throws std::runtime_error if the processor's floating-point mode makes the bounds invalid
  /// (collision/core/floating_point.h). `clearance`, `pairsWithin` and `pairsNotFree` throw it,
  /// too.
  std::optional<Contact> interference(const Configuration& q) const;
  /// Returns the smallest distance of the tested pairs minus the margin, metres. Padding is
  /// ignored. If the result is 0 or less, `certifyState` is not `free`. If it is below twice the
  /// tolerance plus the displacement that the tube allows, `certifyState` may be `undecided`. If a
  /// pair touches, the result is 0 − margin, since no penetration depth is computed. If no pair is
  /// tested, the result is infinite.
  double clearance(const Configuration& q) const;
  /// Returns the pairs of shapes whose distance is at most the pair's length in `within`
  /// (`Scene::pairsWithin`). The returned distances may exceed the true distances by a thousandth
  /// of their value.
  std::vector<Scene::NearPair> pairsWithin(const Configuration& q, const PairMargins& within,
                                           const Scene::NearSearch& search = {}) const;
  /// Returns the pairs of shapes that bounds and hulls do not prove to keep these margins on an
  /// edge, by their numbers in `Scene::pairs()`. The others are proved to keep them
  /// (`certifyEdge`), unless the edge leaves the configurations that are covered: then all pairs
  /// are returned.
  std::vector<std::uint32_t> pairsLeftByHulls(const Configuration& from, const Configuration& to,
                                              const PairMargins& margins) const;
  /// Two bodies of the model, by index, for which a state is not free.
  struct PairNotFree {
    std::size_t a = 0, b = 0;
    /// True if the verdict is `undecided` because the rounding of large coordinates may exceed the
    /// gap between the two bodies.
    bool tooLarge = false;
  };
  /// Returns all pairs of bodies because of which `certifyState` does not return `free`, each pair
  /// once. The result may be empty if the reason is `beyondProofs`.
  std::vector<PairNotFree> pairsNotFree(const Configuration& q) const;

  /// Returns whether q is in bounds and `certifyState` is `free`.
  bool isProvedFree(const Configuration& q) const;
  /// Returns whether both ends are in bounds (then the whole edge is) and the edge is proved free.
  /// Always uses `EdgeMethod::certified`, not the method of the options.
  bool isProvedFree(const Configuration& from, const Configuration& to) const;

  /// Returns the sum of the counters of all threads. No query may run during this call.
  Counters counters() const;

 private:
  struct Workspace;
  class Pool;
  Workspace& workspaceOfThread() const;
  /// Returns whether the pairs that are tested are enough for a query at q (`provedBox`).
  bool isCovered(const Configuration& q) const;
  MotionResult certify(const Configuration& from, const Configuration& to, const EdgeQuery& query,
                       EdgeMethod method) const;
  /// Decides the edge that the workspace's motion is set to, by `EdgeMethod::certified`. If there
  /// is a filter, it goes first.
  /// @param findsContacts whether any contact of the edge is an answer.
  MotionResult decide(const Configuration& from, const Configuration& to, MotionOptions options,
                      Workspace& workspace, bool findsContacts) const;

  const Model& model_;
  Required required_;
  Scene scene_;
  std::optional<ProvedBox> proved_;  // where the pairs that are not tested are proved apart
  std::vector<std::size_t> bodyOf_;
  std::vector<HeldPair> notFreeAtRest_;  // the scene has these pairs, too
  std::optional<PairMargins> paddings_;  // for each pair of the scene; unset: no padding
  MotionOptions options_;                // refers to `paddings_`
  EdgeMethod method_;
  std::unique_ptr<const EdgeFilter> filter_;  // null: none for this model
  std::unique_ptr<Pool> pool_;
};

}  // namespace corridor
