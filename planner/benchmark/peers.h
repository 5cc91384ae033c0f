#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/benchmark/variant.h"

namespace corridor {

/// A problem's scene as another library has it.
class PeerScene {
 public:
  virtual ~PeerScene() = default;
  /// Does any tested pair touch? @param X_WF of each frame of the problem's tree.
  virtual bool touches(const std::vector<Transform>& X_WF) = 0;

 protected:
  PeerScene() = default;
  PeerScene(const PeerScene&) = default;
  PeerScene& operator=(const PeerScene&) = default;
};

extern "C" {
/// Exported under this name by the module of FCL, which is opened at first need: so that the
/// program depends on it no more than its users do. The caller owns the scene, which may keep
/// the checker. @throws std::runtime_error for shapes that FCL isn't given (fcl_scene.h).
PeerScene* corridorFclScene(const Checker& checker);
const char* corridorFclVersion();  ///< "FCL 0.7.0"
}

/// The names of all peers that there could be.
const std::vector<std::string>& peerNames();
/// Why a peer can't take part here; "" if it can. @pre it is one of those names.
std::string whyNoPeer(const std::string& name);
/// The peer `fcl`: states tested by FCL (as fcl_scene.h has them: meshes as surfaces, no margin),
/// edges sampled by OMPL's rule. @pre it can take part.
BenchmarkPeer peerNamed(const std::string& name);
/// Those that can.
std::vector<BenchmarkPeer> peersHere();

}  // namespace corridor
