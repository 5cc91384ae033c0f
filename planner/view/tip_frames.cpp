#include "planner/view/tip_frames.h"

#include <map>
#include <utility>

namespace corridor::view {

std::vector<std::size_t> tipFrames(const Model& model) {
  std::vector<std::size_t> joints(model.tree.frames.size(), 0);  // moving joints up to each frame
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const Frame& frame = model.tree.frames[i];
    joints[i] = joints[frame.parent] + (frame.moves() ? 1 : 0);
  }
  std::map<std::size_t, std::size_t> tips;  // by robot
  for (const ModelBody& body : model.bodies) {
    if (!body.robot || joints[body.frame] == 0) continue;
    std::size_t& tip = tips.emplace(*body.robot, body.frame).first->second;
    if (std::pair(joints[body.frame], body.frame) > std::pair(joints[tip], tip)) tip = body.frame;
  }
  std::vector<std::size_t> frames;
  for (const auto& [robot, tip] : tips) frames.push_back(tip);
  return frames;
}

}  // namespace corridor::view
