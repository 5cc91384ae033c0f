// Tests that the forward kinematics of the robots in the shared data, from URDF to frames, agrees
// with the reference.
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "planner/model/model_builder.h"
#include "planner/model/planned_joints.h"
#include "planner/robot/edge_motion.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/urdf_file.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// The tolerance for positions, in metres, and for the components of quaternions. The reference has
/// 12 digits.
constexpr double kTolerance = 1e-9;

void expectPose(const Transform& X, const std::vector<double>& expected, const std::string& link) {
  const Vec3 p(expected[0], expected[1], expected[2]);
  const Eigen::Quaterniond q(expected[6], expected[3], expected[4], expected[5]);
  EXPECT_LT((X.t - p).norm(), kTolerance) << link;
  const Eigen::Vector4d is = Eigen::Quaterniond(X.m).coeffs(), should = q.coeffs();
  EXPECT_LT(std::min((is - should).norm(), (is + should).norm()), kTolerance) << link;
}

TEST(SharedKinematics, EveryLinkIsWhereTheReferenceHasIt) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  const std::filesystem::path robots = *data / "robots";
  const auto reference = nlohmann::json::parse(std::ifstream(robots / "fk_reference.json"));
  std::size_t poses = 0;
  for (const auto& robot : reference.at("robots")) {
    const std::string file = robot.at("urdf");
    SCOPED_TRACE(file);
    std::vector<Fault> faults;
    std::vector<std::filesystem::path> files;
    const auto model = readUrdf(
        robots / file, {.packages = {{"example-robot-data", robots / "example-robot-data"}}},
        faults, files);
    ASSERT_TRUE(model) << InputError(faults).what();
    ModelRobot arm;
    arm.description = *model;
    std::vector<std::size_t> moving;
    for (std::size_t j = 0; j < model->joints.size(); ++j)
      if (hasOwnValue(model->joints[j])) moving.push_back(j);
    chooseJoints(arm, moving);
    const Model built = ModelBuilder().addRobot(arm).buildForReader();
    const auto& frames = built.robots.front().linkFrames;
    const std::size_t root = frames[model->root];
    std::vector<Scene::FramePair> pairs;
    for (const std::size_t frame : frames) pairs.push_back({root, frame});
    const auto size = static_cast<Eigen::Index>(built.space.size());
    EdgeMotion motion(built.tree, built.space, pairs, Configuration::Zero(size));
    Configuration last = Configuration::Zero(size);
    for (const auto& state : robot.at("states")) {
      Configuration q(size);
      for (const Coordinate& c : built.space.coordinates())
        q[static_cast<Eigen::Index>(c.first)] = state.at("q").at(c.name);
      const std::vector<Transform> placed = framePoses(built.tree, q);
      motion.set(last, q);
      last = q;
      for (std::size_t link = 0; link < frames.size(); ++link) {
        const std::string& name = model->links[link].name;
        const std::vector<double> expected = state.at("links").at(name);
        expectPose(rigidInverse(placed[root]) * placed[frames[link]], expected, name);
        expectPose(motion.relativeMotion(link, 1, 0).X_AB, expected, name);
        ++poses;
      }
    }
  }
  EXPECT_GT(poses, 200u);
}

}  // namespace
}  // namespace corridor
