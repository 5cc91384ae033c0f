// Tests that the robots in the shared data agree with the tables in the guide of these data.
#include <algorithm>

#include "collision/geometry/mesh_health.h"
#include "tests/planner/robot/urdf_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

struct Row {
  const char* file;
  const char* root;
  std::size_t links, revolute, continuous, meshes, boxes;
};

const std::string kinova = "example-robot-data/robots/kinova_description/";
const std::string pendulum =
    "example-robot-data/robots/double_pendulum_description/urdf/double_pendulum";

class SharedRobots : public testing::Test {
 protected:
  RobotDescription read(const std::string& file) {
    std::vector<Fault> faults;
    files_.clear();
    auto model =
        readUrdf(*data_ / "robots" / file,
                 {.packages = {{"example-robot-data", *data_ / "robots" / "example-robot-data"}}},
                 faults, files_);
    EXPECT_TRUE(faults.empty()) << InputError(faults).what();
    return model.value_or(RobotDescription());
  }
  void readGroups(const std::string& file, RobotDescription& model) {
    std::vector<Fault> faults;
    readSrdf(*data_ / "robots" / file, model, faults);
    EXPECT_TRUE(faults.empty()) << InputError(faults).what();
  }

  std::optional<std::filesystem::path> data_ = dataFolder();
  std::vector<std::filesystem::path> files_;
};

#define SKIP_WITHOUT_DATA() \
  if (!data_) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data"

TEST_F(SharedRobots, HaveTheGuidesFigures) {
  SKIP_WITHOUT_DATA();
  const std::string simple = pendulum + "_simple.urdf", continuous = pendulum + "_continuous.urdf",
                    plain = pendulum + ".urdf", arm = kinova + "robots/kinova.urdf";
  for (const Row& row : {Row{"panda/panda.urdf", "panda_link0", 13, 7, 0, 11, 0},
                         Row{"ur5/ur5.urdf", "offset_link", 22, 6, 0, 17, 1},
                         Row{plain.c_str(), "base_link", 3, 2, 0, 3, 0},
                         Row{continuous.c_str(), "base_link", 3, 0, 2, 3, 0},
                         Row{simple.c_str(), "base_link", 4, 2, 0, 0, 3},
                         Row{arm.c_str(), "base", 13, 3, 3, 11, 0}}) {
    SCOPED_TRACE(row.file);
    const RobotDescription model = read(row.file);
    ASSERT_EQ(model.links.size(), row.links);
    EXPECT_EQ(model.links[model.root].name, row.root);
    EXPECT_EQ(model.joints.size() + 1, row.links);
    const auto count = [&](JointType type) {
      return static_cast<std::size_t>(
          std::count_if(model.joints.begin(), model.joints.end(),
                        [&](const JointModel& joint) { return joint.type == type; }));
    };
    EXPECT_EQ(count(JointType::revolute), row.revolute);
    EXPECT_EQ(count(JointType::continuous), row.continuous);
    EXPECT_EQ(count(JointType::fixed), model.joints.size() - row.revolute - row.continuous);
    EXPECT_EQ(model.allowed.size(), model.joints.size());
    std::size_t meshes = 0, boxes = 0;
    for (const LinkModel& link : model.links)
      for (const PlacedShape& shape : link.shapes) {
        meshes += shape.mesh != nullptr;
        boxes += shape.primitive && std::holds_alternative<Box>(*shape.primitive);
      }
    EXPECT_EQ(meshes, row.meshes);
    EXPECT_EQ(boxes, row.boxes);
    std::vector<bool> placed(row.links, false);
    placed[model.root] = true;
    for (const JointModel& joint : model.joints) {
      EXPECT_TRUE(placed[joint.parent]) << joint.name << ": parents come first";
      placed[joint.child] = true;
    }
    auto sorted = files_;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
  }
}

TEST_F(SharedRobots, CanBeMadeOfSpheres) {
  SKIP_WITHOUT_DATA();
  for (const char* file : {"panda/panda_spherized.urdf", "ur5/ur5_spherized.urdf"}) {
    std::size_t spheres = 0;
    for (const LinkModel& link : read(file).links)
      for (const PlacedShape& shape : link.shapes) {
        EXPECT_TRUE(std::holds_alternative<Sphere>(shape.primitive.value()));
        ++spheres;
      }
    EXPECT_GT(spheres, 30u) << file;
  }
}

TEST_F(SharedRobots, ColladaMeshesAreReadByRossRule) {
  SKIP_WITHOUT_DATA();
  const RobotDescription model = read(kinova + "robots/kinova.urdf");
  // The guide gives five digits.
  const auto expectBounds = [&](const char* file, const Vec3& min, const Vec3& max) {
    for (const LinkModel& link : model.links)
      for (const PlacedShape& shape : link.shapes) {
        if (shape.file.filename() != file) continue;
        const MeshHealth health = inspectMesh(shape.mesh->mesh);
        EXPECT_LT((health.min - min).norm(), 3e-6) << file << " " << health.min.transpose();
        EXPECT_LT((health.max - max).norm(), 3e-6) << file << " " << health.max.transpose();
        return;
      }
    ADD_FAILURE() << file << " is in no link";
  };
  expectBounds("base.dae", {-0.04125, -0.04125, 0}, {0.04125, 0.04125, 0.15675});
  expectBounds("forearm.dae", {-0.04125, -0.04125, -0.043}, {0.041249, 0.20725, 0.02});
  expectBounds("arm.dae", {-0.04125, -0.45125, -0.043}, {0.04125, 0.04125, 0});
  expectBounds("hand_2finger.dae", {-0.0315, -0.054266, -0.1204}, {0.0315, 0.054266, 0});
}

TEST_F(SharedRobots, SrdfPairsGroupsAndStates) {
  SKIP_WITHOUT_DATA();
  const auto disabled = [](const RobotDescription& model) {
    // If two links are joined by a joint, the reason why they are allowed stays "adjacent".
    return std::count_if(model.allowed.begin(), model.allowed.end(),
                         [](const AllowedPair& pair) { return pair.reason.starts_with("SRDF: "); });
  };
  RobotDescription panda = read("panda/panda.urdf");
  readGroups("panda/panda.srdf", panda);
  EXPECT_EQ(panda.groups.at("panda_arm").joints.front(), "panda_joint1");
  EXPECT_EQ(panda.groups.at("panda_arm").joints.size(), 8u);
  EXPECT_EQ(panda.states.at("ready").values.size(), 7u);
  EXPECT_EQ(panda.states.at("ready").values.at("panda_joint4"), -2.356);
  EXPECT_EQ(panda.states.at("ready").group, "panda_arm");
  EXPECT_GT(disabled(panda), 20);
  EXPECT_LE(disabled(panda), 34);

  RobotDescription ur5 = read("ur5/ur5.urdf");
  readGroups("ur5/ur5.srdf", ur5);
  EXPECT_EQ(ur5.groups.at("manipulator").joints.size(), 7u);
  EXPECT_EQ(ur5.groups.at("gripper").joints.size(), 9u);
  EXPECT_EQ(ur5.states.at("home").values.at("wrist_1_joint"), -1.57);
  EXPECT_GT(disabled(ur5), 60);
  EXPECT_LE(disabled(ur5), 88);

  RobotDescription arm = read(kinova + "robots/kinova.urdf");
  readGroups(kinova + "srdf/kinova.srdf", arm);
  EXPECT_EQ(disabled(arm), 0);
  EXPECT_EQ(arm.states.at("arm_up").values.at("j2s6s200_joint_2"), 2.618);
  EXPECT_EQ(arm.states.at("arm_up").group, "");
}

}  // namespace
}  // namespace corridor::test
