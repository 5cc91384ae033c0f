// Where the meshes of a URDF are found.
#include <cstdlib>
#include <filesystem>

#include "tests/planner/robot/urdf_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

class UrdfMeshes : public UrdfTest {};

TEST_F(UrdfMeshes, MeshesAreFoundInPackagesBesideAndAbove) {
  const std::string wedge = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  write("else/where/in_map.obj", wedge);
  write("beside/in_beside.obj", wedge);
  rules_.packages["mapped"] = folder_ / "else";
  const std::string above = folder_.filename().string();
  const RobotDescription model = modelOf(link(
      "a", collision("<mesh filename=\"package://mapped/where/in_map.obj\"/>") +
               collision("<mesh filename=\"package://beside/in_beside.obj\"/>") +
               collision("<mesh filename=\"package://" + above + "/wedge.obj\"/>") +
               collision("<mesh filename=\"file://" + (folder_ / "wedge.obj").string() + "\"/>") +
               collision("<mesh filename=\"beside/../wedge.obj\"/>")));
  EXPECT_EQ(files_, (std::vector{folder_ / "r.urdf", folder_ / "else/where/in_map.obj",
                                 folder_ / "beside/in_beside.obj", folder_ / "wedge.obj"}));
  ASSERT_EQ(model.links[0].shapes.size(), 5u);
}

/// Names with a scheme are URIs; a name that is not encoded counts where no file has the decoded
/// one.
TEST_F(UrdfMeshes, MeshesWithBytesInHexadecimal) {
  const std::string wedge = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  for (const std::string name : {"a b.obj", "c%20d.obj", "c d.obj", "e%20f.obj"})
    write("hand/" + name, wedge);
  const auto named = [&](const std::string& name) {
    return collision("<mesh filename=\"" + name + "\"/>");
  };
  modelOf(link("a", named("package://hand/a%20b.obj") + named("package://hand/c%20d.obj") +
                        named("package://hand/e%20f.obj") + named("hand/e%20f.obj")));
  EXPECT_EQ(files_, (std::vector{folder_ / "r.urdf", folder_ / "hand/a b.obj",
                                 folder_ / "hand/c d.obj", folder_ / "hand/e%20f.obj"}));
}

TEST_F(UrdfMeshes, ThreeSlashesAreReadAsTwo) {
  write("hand/a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  const std::string three = collision("<mesh filename=\"package:///hand/a.obj\"/>");
  const std::string note = ": package:///NAME/FILE is read as package://NAME/FILE";
  const RobotDescription one = modelOf(link("a", three));
  EXPECT_EQ(files_, (std::vector{folder_ / "r.urdf", folder_ / "hand/a.obj"}));
  EXPECT_THAT(textsOf(one.notes), testing::ElementsAre((folder_ / "r.urdf").string() +
                                                       ": mesh \"package:///hand/a.obj\"" + note));
  const RobotDescription two =
      modelOf(link("a", three + collision("<mesh filename=\"package://hand/a.obj\"/>") + three));
  EXPECT_THAT(textsOf(two.notes),
              testing::ElementsAre((folder_ / "r.urdf").string() +
                                   ": mesh \"package:///hand/a.obj\" and 1 more" + note));
}

TEST_F(UrdfMeshes, PackagesBesideAFolderAboveOrOfAnotherName) {
  const std::string wedge = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  write("src/hand/meshes/a.obj", wedge);
  write("src/clone/meshes/b.obj", wedge);
  std::vector<Fault> faults;
  const auto read = [&](const std::string& first, const std::string& second) {
    write("src/clone/urdf/r.urdf",
          "<robot name=\"r\">" +
              link("a", collision("<mesh filename=\"package://" + first + "\"/>") +
                            collision("<mesh filename=\"package://" + second + "\"/>")) +
              "</robot>");
    files_.clear();
    faults.clear();
    return readUrdf(folder_ / "src/clone/urdf/r.urdf", {}, faults, files_);
  };
  auto model = read("hand/meshes/a.obj", "arm/meshes/b.obj");
  ASSERT_TRUE(model) << faults.front().str();
  EXPECT_EQ(files_,
            (std::vector{folder_ / "src/clone/urdf/r.urdf", folder_ / "src/hand/meshes/a.obj",
                         folder_ / "src/clone/meshes/b.obj"}));
  ASSERT_EQ(model->notes.size(), 1u);
  EXPECT_THAT(model->notes[0].text,
              testing::EndsWith(
                  "package \"arm\" was not found; its files are taken from " +
                  (folder_ / "src/clone").string() +
                  ", above the URDF (packages: {arm: FOLDER} in robot.yaml sets another folder)"));
  // The folder belongs to another package, too, so the mesh may be one of that package.
  EXPECT_FALSE(read("clone/meshes/b.obj", "arm/meshes/b.obj"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_THAT(faults[0].str(), testing::HasSubstr("is the folder of another package"));
  // The package.xml of the folder names the wanted package, or another one.
  write("src/clone/package.xml", "<package><name> arm </name></package>");
  model = read("hand/meshes/a.obj", "arm/meshes/b.obj");
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->notes.empty());
  write("src/clone/package.xml", "<package><name>foot</name></package>");
  EXPECT_FALSE(read("hand/meshes/a.obj", "arm/meshes/b.obj"));
  EXPECT_EQ(faults.size(), 1u);
}

TEST_F(UrdfMeshes, MeshesAreFoundInTheFoldersOfRos) {
  const std::string wedge = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  write("installed/share/hand/meshes/a.obj", wedge);
  write("workspace/src/repository/arm/meshes/b.obj", wedge);
  write("single/base/c.obj", wedge);
  write("workspace/.git/arm/meshes/b.obj", "v 0 0 0\n");
  const WithVariable ament("AMENT_PREFIX_PATH",
                           (folder_ / "none").string() + ":" + (folder_ / "installed").string());
  const WithVariable ros("ROS_PACKAGE_PATH", (folder_ / "workspace/src").string() +
                                                 "::" + (folder_ / "single/base").string());
  modelOf(link("a", collision("<mesh filename=\"package://hand/meshes/a.obj\"/>") +
                        collision("<mesh filename=\"package://arm/meshes/b.obj\"/>") +
                        collision("<mesh filename=\"package://base/c.obj\"/>")));
  EXPECT_EQ(files_, (std::vector{folder_ / "r.urdf", folder_ / "installed/share/hand/meshes/a.obj",
                                 folder_ / "workspace/src/repository/arm/meshes/b.obj",
                                 folder_ / "single/base/c.obj"}));
  EXPECT_EQ(complaintOfParts(link("a", collision("<mesh filename=\"package://arm/none.obj\"/>"))),
            "r.urdf:2: link \"a\": mesh \"package://arm/none.obj\": package \"arm\" is found at "
            "workspace/src/repository/arm, but has no none.obj");
}

}  // namespace
}  // namespace corridor::test
