#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/benchmark/variant.h"

namespace corridor {

/// The scene of a problem, built in another library (a competitor).
class CompetitorScene {
 public:
  virtual ~CompetitorScene() = default;
  /// Returns whether the bodies of any tested pair touch. @param X_WF poses, in the world, of all
  /// frames of the problem's kinematic tree.
  virtual bool touches(const std::vector<Transform>& X_WF) = 0;

 protected:
  CompetitorScene() = default;
  CompetitorScene(const CompetitorScene&) = default;
  CompetitorScene& operator=(const CompetitorScene&) = default;
};

extern "C" {
/// The functions that the FCL module exports under these names. The module is opened when it is
/// first needed, so that the program does not depend on FCL. The caller owns the scene, which may
/// keep a reference to the checker. @throws std::runtime_error for shapes that fcl_scene.h can't
/// convert.
CompetitorScene* corridorFclScene(const Checker& checker);
const char* corridorFclVersion();  ///< "FCL 0.7.0"
}

/// Returns the names of all competitors, available or not.
const std::vector<std::string>& competitorNames();
/// Returns why a competitor is not available here, or "" if it is available. @pre the name is one
/// of `competitorNames`.
std::string whyUnavailable(const std::string& name);
/// Returns a competitor by its name. The only one is `fcl`: FCL tests the states (fcl_scene.h:
/// meshes as surfaces, no margin), and edges are sampled by OMPL's rule. @pre the competitor is
/// available here.
BenchmarkCompetitor competitorNamed(const std::string& name);
/// Returns all competitors that are available here.
std::vector<BenchmarkCompetitor> availableCompetitors();

}  // namespace corridor
