#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "planner/model/task.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/robot/robot_description.h"

namespace corridor {

class FileCache;

/// A joint that is planned for, or the pose of a rigid robot.
struct PlannedJoint {
  std::string name;  ///< name of the joint; "" for a rigid robot
  JointType type = JointType::revolute;
  std::size_t coordinate = 0;  ///< index of its (first) coordinate in Model::space
};

/// A robot of a model: its description, the joints that are planned for, and the robot's frames and
/// coordinates in the model.
struct ModelRobot {
  /// "left" for the robot `left` of several robots. Empty for a single robot: the names of its
  /// links, joints and coordinates then have no prefix.
  std::string name;
  RobotDescription description;
  RigidPose base;  ///< X_WB

  /// The joints that are planned for, as indices into `description.joints`. Their order is that of
  /// the coordinates. The keys of `held`, `heldPoses` and `heldFrom` are such indices, too.
  std::vector<std::size_t> planned;
  std::map<std::size_t, double> held;  ///< values of the other joints with one value, rad or m
  std::map<std::size_t, RigidPose> heldPoses;  ///< poses of the other planar and floating joints
  /// The source of each held value, for messages: "hold", "start: ready". Held joints without a
  /// source are at 0, or at the limit nearest to 0.
  std::map<std::size_t, std::string> heldFrom;
  std::set<std::size_t> heldByFile;  ///< joints whose held value the robot's file gives (`hold`)
  bool jointsAreChosen = false;      ///< whether files choose the joints that are planned for
  std::map<std::string, double> jointWeights;  ///< joints that are not listed have weight 1
  double rotationWeight = 0.5;  ///< metres per radian of rotation; OMPL's default for SE2 and SE3

  // Set by ModelBuilder:
  std::vector<std::size_t>
      linkFrames;  ///< for each link of `description`, its frame in Model::tree
  std::vector<PlannedJoint> plannedJoints;  ///< in the order of `planned`

  bool isRigid() const { return description.mount != JointType::fixed; }
};

/// A link or an obstacle: all shapes that are tested under one name.
struct ModelBody {
  std::string name;  ///< "hand", "left/hand", "table"; for a rigid robot, the robot's name
  /// Index of the body's frame in Model::tree. For an obstacle, the frame is 0 (the world), or the
  /// obstacle's own frame, which is fixed to the world.
  std::size_t frame = 0;
  std::optional<std::size_t> robot;  ///< index in Model::robots; empty for an obstacle
  std::vector<PlacedShape> shapes;   ///< at least one, in the coordinates of `frame`
};

/// What is proved about two links of one robot (planner/checker/never_in_contact.h): they keep more
/// than `margin` metres for all configurations whose numbers are in the `ranges`, or beyond them by
/// at most `beyondLimits`.
struct PairProof {
  /// The limits of a joint that moves one link against the other, and the index of its number in a
  /// Configuration. Infinite if the proof is for all values.
  struct Range {
    std::size_t number = 0;
    double lower = 0, upper = 0;
  };

  double margin = 0;          ///< metres
  double beyondLimits = 0;    ///< rad or m
  std::vector<Range> ranges;  ///< empty: the links never move against each other
};

/// Decides which pairs of bodies are tested. By default, no pair is excluded.
///
/// Most pairs are excluded for good. A pair with a proof is excluded only from tests whose
/// requirements the proof covers, so every question about a pair comes with its requirements.
class PairFilter {
 public:
  /// Excludes a pair of bodies from all tests. A later reason for the same pair replaces the
  /// earlier one.
  /// @param reason not empty: "adjacent", "SRDF: Never", "allow", …
  void skip(std::size_t a, std::size_t b, std::string reason);
  /// Excludes a pair from the tests whose requirements the proof covers. @pre the two bodies are
  /// links of the same robot.
  void skipProved(std::size_t a, std::size_t b, PairProof proof);
  /// Undoes `skip` for a pair. The pair is then tested, unless the two bodies have the same mover,
  /// or a proof covers the requirements.
  void include(std::size_t a, std::size_t b) { reasons_.erase(std::minmax(a, b)); }
  /// Returns the filter for other indices of the bodies. The movers must be set anew.
  /// @param places the new index of each body, or nullopt if the body is gone. A body beyond the
  /// end of `places` is gone.
  PairFilter renumbered(const std::vector<std::optional<std::size_t>>& places) const;
  /// Excludes pairs of bodies that never move relative to each other.
  /// @param movers for each body, the frame that moves it (moversOf). Two bodies with the same
  /// mover stand still relative to each other.
  /// @param parts for each body, its part (fixedPartsOf). Two bodies of different parts that stand
  /// still have held joints between them. Empty: all bodies have the same part.
  void setMovers(std::vector<std::size_t> movers, std::vector<std::size_t> parts = {}) {
    movers_ = std::move(movers);
    parts_ = std::move(parts);
  }

  /// Returns "" if the pair is tested, or else the reason why not: that of `skip`, or
  /// kNeverInContact if the pair has a proof that covers `need`, or kTestedAtRest or kNeverMove if
  /// the two bodies never move relative to each other. A proof covers `need` in this case: margin
  /// plus the pair's padding, rounded up, is at most the proof's margin, and the half widths of the
  /// tube, for the numbers of the proof's ranges, are at most its `beyondLimits`. Takes logarithmic
  /// time in the number of excluded pairs.
  std::string_view whyNotTested(std::size_t a, std::size_t b, const Required& need) const;
  /// Returns the pairs with a proof, with the lower index first.
  const std::map<std::pair<std::size_t, std::size_t>, PairProof>& proofs() const { return proofs_; }

 private:
  std::map<std::pair<std::size_t, std::size_t>, std::string> reasons_;
  std::map<std::pair<std::size_t, std::size_t>, PairProof> proofs_;
  std::vector<std::size_t> movers_, parts_;
};

/// The reason of PairFilter for bodies that stand still relative to each other, because the joints
/// between them are fixed. Checkers and verifiers don't test these pairs.
inline constexpr std::string_view kNeverMove = "never move relative to each other";
/// The reason of PairFilter for bodies that stand still relative to each other, because joints
/// between them are held. One state decides such a pair for all states: checkers and verifiers test
/// it once.
inline constexpr std::string_view kTestedAtRest = "only held joints between them: tested once";

/// The robots, the obstacles, and the pairs of bodies that are tested. Plain data, which a
/// `ModelBuilder` makes. Lengths are in metres, angles in radians.
struct Model {
  std::vector<ModelRobot> robots;
  KinematicTree tree;
  /// The planned coordinates, by the names that `start` and `goal` of a problem file use.
  ConfigurationSpace space;
  std::vector<ModelBody> bodies;  ///< the robots' links that have shapes, then the obstacles
  PairFilter filter;              ///< decides which pairs of `bodies` are tested
  /// Where the bodies of scenes look for trees and hulls of meshes (`Body`); null: nowhere.
  std::shared_ptr<FileCache> cache;
};

/// Returns the padding of two bodies of a model, metres.
inline double paddingOf(const Model& model, const Padding& padding, std::size_t a, std::size_t b) {
  const auto &robotA = model.bodies[a].robot, &robotB = model.bodies[b].robot;
  return padding.of(a, b, robotA && robotA == robotB);
}

/// Calls visit(a, b, why) for every pair of two bodies, a < b, of which at least one belongs to a
/// robot, in ascending order. `why` is empty if the pair is tested, or else the reason why not.
/// @param need what the tests have to cover (`PairFilter::whyNotTested`).
template <class Visit>
void forEachPair(const Model& model, const Required& need, Visit visit) {
  const std::vector<ModelBody>& bodies = model.bodies;
  std::vector<std::size_t> ofRobots;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].robot) ofRobots.push_back(i);
  std::size_t later = 0;  // the first of `ofRobots` that comes after a
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    while (later < ofRobots.size() && ofRobots[later] <= a) ++later;
    if (bodies[a].robot)
      for (std::size_t b = a + 1; b < bodies.size(); ++b)
        visit(a, b, model.filter.whyNotTested(a, b, need));
    else
      for (std::size_t i = later; i < ofRobots.size(); ++i)
        visit(a, ofRobots[i], model.filter.whyNotTested(a, ofRobots[i], need));
  }
}

/// Calls visit(a, b) for every pair of two bodies that is tested, in the order of `forEachPair`.
template <class Visit>
void forEachTestedPair(const Model& model, const Required& need, Visit visit) {
  forEachPair(model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
    if (why.empty()) visit(a, b);
  });
}

/// Checks that every body without a robot is at rest. Scenes take such bodies to be at rest, and no
/// two of them are a pair.
/// @throws std::invalid_argument if such a body is on a frame that moves, or if a body's frame does
/// not exist.
void requireObstaclesAtRest(const Model& model);

/// Returns the number of pairs that `forEachPair` visits, in constant memory and linear time.
double pairCount(const Model& model);

/// Returns the mover of each frame. The mover is the nearest frame whose joint has a variable,
/// among the frame itself and its ancestors. If there is none, the mover is the world. Two frames
/// with the same mover never move relative to each other.
std::vector<std::size_t> moversOf(const KinematicTree& tree);

/// Returns a pose for each frame of the tree. Only the poses of frames that never move, such as all
/// frames of obstacles, are of use. The other poses may even be NaN: they are computed for a
/// configuration of zeros, whose quaternions are no rotations.
std::vector<Transform> staticFramePoses(const Model& model);

/// The poses of a model's frames, for states that follow each other. The poses of frames that never
/// move are computed once, so that obstacles on frames of their own add no cost per state.
class FramePoses {
 public:
  /// @param model must outlive the object.
  explicit FramePoses(const Model& model);
  /// Returns the poses of all frames at q, as `framePoses` does. The reference is valid until the
  /// next call.
  const std::vector<Transform>& at(const Configuration& q);

 private:
  const KinematicTree& tree_;
  std::vector<std::size_t> moving_;
  std::vector<Transform> X_WF_;
};

/// Returns whether the space has coordinates of a planar or floating joint, or of a rigid robot.
bool hasPoseJoints(const ConfigurationSpace& space);
/// Returns whether the space has a coordinate of a single joint (revolute, continuous or
/// prismatic).
bool hasSingleJoints(const ConfigurationSpace& space);

}  // namespace corridor
