// Fuzz target: files of `corridor query`: poses (12 numbers per line) and motions (24 numbers per
// line).
#include "planner/query/query_poses.h"
#include "tests/stress/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  const auto file = folder.write("poses.txt", fuzz::textOf(data, size));
  fuzz::readsOrRefuses([&] {
    for (const Transform& pose : app::readPoses(file))
      if (!pose.isFinite()) fuzz::fail("a pose that is not finite");
  });
  fuzz::readsOrRefuses([&] {
    for (const app::PoseMotion& motion : app::readMotions(file))
      for (const RigidPose& pose : {motion.from, motion.to})
        if (!pose.p.allFinite() || !(std::abs(pose.q.norm() - 1) < 1e-9))
          fuzz::fail("a motion's pose that is not rigid");
  });
  return 0;
}
