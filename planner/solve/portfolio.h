#pragma once

#include <cstdint>
#include <memory>

#include <ompl/base/Planner.h>

namespace ompl::geometric {
class RRTConnect;
}  // namespace ompl::geometric

namespace corridor {

class Checker;
class SlidingConnect;

/// The number of edges after which a search for a robot with joints starts again. The time of a
/// search by random trees has a heavy tail. Measured on arms (mbm, two-armed robots), most searches
/// of RRTConnect test fewer edges, and those that need more are found sooner by a new search.
inline constexpr std::uint64_t kRestartEdges = 8000;

/// Returns the i-th number, i ≥ 1, of the sequence of Luby, Sinclair and Zuckerman (Optimal speedup
/// of Las Vegas algorithms, 1993): 1 1 2 1 1 2 4 1 …. Restarts after these multiples of a unit take
/// at most a logarithmic factor longer than restarts after the best fixed number.
std::uint64_t luby(std::uint64_t i);

/// Takes turns between searches of two kinds, until one finds a path:
/// - RRTConnect goes first, for as many edges as most problems need: `kRestartEdges`, or 2000 for
///   rigid bodies. It goes on later, in its turns. For robots with joints, it starts again after
///   `kRestartEdges`, twice as many, …
/// - SlidingConnect starts again and again, after numbers of edges that `luby` determines. Its runs
///   take turns between several values of its parameters, because none suits all problems.
///
/// For robots with joints, both kinds test the same number of edges; for rigid bodies, RRTConnect
/// tests a quarter of those of SlidingConnect. Turns are counted in edges, so that the same random
/// numbers give the same path, however fast the machine is.
/// Parameter: `range`, the longest edge of RRTConnect, from which SlidingConnect's are derived; 0:
/// a fifth of the space's extent.
class Portfolio final : public ompl::base::Planner {
 public:
  /// The state space of `si` must be a ProblemStateSpace.
  /// @param checker tests the motions of `si`, and measures distances; null: nothing slides. It
  /// must outlive the planner.
  Portfolio(const ompl::base::SpaceInformationPtr& si, const Checker* checker);
  ~Portfolio() override;

  void setup() override;
  void clear() override;
  /// May be called again to go on.
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void setProblemDefinition(const ompl::base::ProblemDefinitionPtr& definition) override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

  void setRange(double range) { range_ = range; }
  double getRange() const { return range_; }

 private:
  template <class Member>
  ompl::base::PlannerStatus run(Member& member, std::uint64_t edges,
                                const ompl::base::PlannerTerminationCondition& stop);
  ompl::base::PlannerStatus connect(std::uint64_t edges,
                                    const ompl::base::PlannerTerminationCondition& stop);
  ompl::base::PlannerStatus slide(const ompl::base::PlannerTerminationCondition& stop);

  const Checker* checker_;
  double range_ = 0;
  std::shared_ptr<ompl::geometric::RRTConnect> connect_;
  std::shared_ptr<SlidingConnect> sliding_;  // null before its first run
  bool restarts_ = false;                    // whether RRTConnect starts again
  std::uint64_t turns_ = 0;                  // of SlidingConnect
  std::uint64_t left_ = 0;   // edges before RRTConnect starts again; with `restarts_` only
  std::uint64_t limit_ = 0;  // edges of the present search of RRTConnect
};

}  // namespace corridor
