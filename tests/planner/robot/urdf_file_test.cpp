#include <cmath>
#include <numbers>

#include "planner/robot/rpy.h"
#include "tests/planner/robot/urdf_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

class UrdfFile : public UrdfTest {};

TEST_F(UrdfFile, JointsOfAllTypesInTheTreesOrder) {
  const RobotDescription model = modelOf(
      joint("lift", "prismatic", "b", "c", limit + "<axis xyz=\"0 0 3\"/>") +
      joint("fly", "floating", "c", "d") +
      joint("slip", "planar", "root", "e", "<axis xyz=\"0 0 1\"/>") +
      joint("turn", "continuous", "root", "b", limit) +
      joint("bend", "revolute", "e", "f",
            limit + "<origin xyz=\"1 2 3\" rpy=\"0.1 0.2 0.3\"/><axis xyz=\"0 -1e-200 0\"/>") +
      joint("weld", "fixed", "c", "g", "<limit effort=\"1\" velocity=\"1\"/>") + link("b") +
      link("c") + link("d") + link("root") + link("e") + link("f") + link("g"));
  EXPECT_EQ(model.name, "r");
  EXPECT_EQ(model.links[model.root].name, "root");
  EXPECT_EQ(model.mount, JointType::fixed);
  ASSERT_EQ(model.joints.size(), 6u);
  std::string order;
  for (const JointModel& joint : model.joints) {
    order += joint.name + " ";
    EXPECT_EQ(joint.name == "lift" || joint.name == "bend", std::isfinite(joint.lower));
  }
  EXPECT_EQ(order, "slip bend turn lift fly weld ");
  const JointModel& bend = model.joints[1];
  EXPECT_EQ(bend.type, JointType::revolute);
  EXPECT_EQ(model.links[bend.parent].name, "e");
  EXPECT_EQ(model.links[bend.child].name, "f");
  EXPECT_EQ(bend.lower, -1);
  EXPECT_EQ(bend.upper, 2);
  EXPECT_EQ(bend.line, 6);
  EXPECT_EQ(bend.X_PJ.p, Vec3(1, 2, 3));
  EXPECT_EQ(bend.X_PJ.q.coeffs(), quaternionFromRpy({0.1, 0.2, 0.3}).coeffs());
  EXPECT_EQ(bend.axis.x(), 0);
  EXPECT_LE(bend.axis.y(), -1);
  EXPECT_EQ(model.joints[0].axis, Vec3::UnitZ());
  EXPECT_EQ(model.joints[2].axis, Vec3::UnitX()) << "URDF's default";
  EXPECT_EQ(model.joints[3].axis.normalized(), Vec3::UnitZ());
  ASSERT_EQ(model.allowed.size(), 4u) << "links that a planar or floating joint parts are tested";
  EXPECT_EQ(model.allowed[0].a, "e");
  EXPECT_EQ(model.allowed[0].b, "f");
  EXPECT_EQ(model.allowed[0].reason, "adjacent");
  EXPECT_EQ(files_, std::vector{folder_ / "r.urdf"});
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_THAT(model.notes[0].text, testing::HasSubstr("joint \"turn\": is continuous, so lower"));
}

TEST_F(UrdfFile, MimicsOfMimicsFollowTheOneThatMoves) {
  const std::string wide = R"(<limit lower="-20" upper="20" effort="0" velocity="0"/>)";
  const RobotDescription model =
      modelOf(link("a") + link("b") + link("c") + link("d") +
              joint("k", "prismatic", "a", "b",
                    wide + "<mimic joint=\"l\" multiplier=\"-3\" offset=\"0.25\"/>") +
              joint("l", "revolute", "b", "c",
                    wide + "<mimic joint=\"m\" multiplier=\"2\" offset=\"1\"/>") +
              joint("m", "revolute", "c", "d", limit));
  EXPECT_FALSE(model.joints[2].mimic);
  ASSERT_TRUE(model.joints[0].mimic && model.joints[1].mimic);
  EXPECT_EQ(model.joints[0].mimic->joint, 2u);
  EXPECT_EQ(model.joints[0].mimic->multiplier, -6);
  EXPECT_EQ(model.joints[0].mimic->offset, -3 * 1 + 0.25);
  EXPECT_EQ(model.joints[1].mimic->joint, 2u);
  EXPECT_EQ(model.joints[1].mimic->multiplier, 2);
}

TEST_F(UrdfFile, AMimicOfAnUnknownJointMovesByItself) {
  const RobotDescription model = modelOf(
      link("a") + link("b") + link("c") + joint("pan", "revolute", "a", "b", limit) +
      joint("tilt", "revolute", "b", "c", limit + "<mimic joint=\"pam\" multiplier=\"2\"/>"));
  EXPECT_FALSE(model.joints[1].mimic);
  EXPECT_THAT(
      textsOf(model.notes),
      testing::ElementsAre((folder_ / "r.urdf").string() +
                           ":6: joint \"tilt\" mimics \"pam\", which is not a joint of this "
                           "robot; it is used as a joint of its own (did you mean \"pan\"?)"));
}

TEST_F(UrdfFile, AJointThatCannotLeadIsNoLeader) {
  for (const char* const type : {"fixed", "planar", "floating"}) {
    const RobotDescription model =
        modelOf(link("a") + link("b") + link("c") + joint("pan", type, "a", "b") +
                joint("tilt", "revolute", "b", "c", limit + "<mimic joint=\"pan\"/>"));
    EXPECT_FALSE(model.joints[1].mimic);
    EXPECT_EQ(model.joints[1].upper, 2);
    EXPECT_THAT(
        textsOf(model.notes),
        testing::ElementsAre((folder_ / "r.urdf").string() + ":6: joint \"tilt\" mimics " +
                             "\"pan\", which is " + type +
                             ", not a joint of one variable; it is used as a joint of its own"));
  }
}

/// The reader passes ? in place of % to urdfdom, so urdfdom sees the same name twice. The joint
/// "j?", which the mimic names, does not exist.
TEST_F(UrdfFile, LeadersAreFoundByTheirNamesInTheFile) {
  const RobotDescription model = modelOf(
      link("a") + link("b") + joint("j%", "revolute", "a", "b", limit + "<mimic joint=\"j?\"/>"));
  EXPECT_FALSE(model.joints[0].mimic);
  EXPECT_EQ(model.notes.size(), 1u);
}

TEST_F(UrdfFile, FixedJointsMayMimicEachOther) {
  const RobotDescription model =
      modelOf(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "b") +
              joint("k", "fixed", "a", "c", "<mimic joint=\"j\"/>"));
  EXPECT_FALSE(model.joints[1].mimic);
}

TEST_F(UrdfFile, PrimitivesStandWhereTheirOriginSays) {
  const RobotDescription model = modelOf(
      link("a",
           "<collision><origin xyz=\"1 2 3\" rpy=\"0 0 1.5707963267948966\"/>"
           "<geometry><box size=\"2 4 6\"/></geometry><material name=\"grey\"/></collision>" +
               collision("<sphere radius=\"0.5\"/>") +
               collision("<cylinder radius=\"0.25\" length=\"2\"/>")));
  const auto& shapes = model.links[0].shapes;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].name, "a/1");
  EXPECT_EQ(shapes[2].name, "a/3");
  for (const PlacedShape& shape : shapes) {
    EXPECT_TRUE(shape.solid);
    EXPECT_FALSE(shape.mesh);
    ASSERT_TRUE(!shape.parts.empty() && shape.primitive);
  }
  EXPECT_EQ(std::get<Box>(*shapes[0].primitive).size, Vec3(2, 4, 6));
  EXPECT_EQ(shapes[0].at.p, Vec3(1, 2, 3));
  Vec3 min = shapes[0].parts.at(0).points[0], max = min;
  for (const Vec3& p : shapes[0].parts.at(0).points) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  EXPECT_EQ(min, Vec3(-1, 1, 0)) << "a quarter turn is exact";
  EXPECT_EQ(max, Vec3(3, 3, 6));
  EXPECT_EQ(std::get<Sphere>(*shapes[1].primitive).radius, 0.5);
  EXPECT_EQ(std::get<Cylinder>(*shapes[2].primitive).radius, 0.25);
  EXPECT_EQ(std::get<Cylinder>(*shapes[2].primitive).length, 2);
}

TEST_F(UrdfFile, MeshesAreScaledTurnedAndShifted) {
  const RobotDescription model =
      modelOf(link("a", collision("<mesh filename=\"wedge.obj\"/>")) +
              link("b",
                   "<collision><origin xyz=\"0 0 5\" rpy=\"1.5707963267948966 0 0\"/><geometry>"
                   "<mesh filename=\"wedge.obj\" scale=\"-1 2 1\"/></geometry></collision>") +
              joint("j", "fixed", "a", "b"));
  const PlacedShape &plain = model.links[0].shapes[0], &placed = model.links[1].shapes[0];
  EXPECT_EQ(plain.name, "a");
  EXPECT_FALSE(plain.solid);
  EXPECT_EQ(plain.file, folder_ / "wedge.obj");
  ASSERT_EQ(plain.mesh->mesh.vertices.size(), placed.mesh->mesh.vertices.size());
  for (std::size_t i = 0; i < plain.mesh->mesh.vertices.size(); ++i) {
    const Vec3& v = plain.mesh->mesh.vertices[i];
    EXPECT_EQ(placed.mesh->mesh.vertices[i], Vec3(-v.x(), -v.z(), 2 * v.y() + 5));
  }
  EXPECT_EQ(placed.mesh->mesh.triangles, plain.mesh->mesh.triangles) << "mirrored, as they are";
  EXPECT_EQ(placed.mesh->unitRule, plain.mesh->unitRule + "; times the URDF's scale -1 2 1");
  EXPECT_EQ(files_, (std::vector{folder_ / "r.urdf", folder_ / "wedge.obj"})) << "each once";
}

/// What collision does not need is not tested, nor passed on to urdfdom, which would refuse it.
TEST_F(UrdfFile, PartsThatCollisionDoesNotNeed) {
  const RobotDescription model = modelOf(
      link("base", "<inertial/>") +
      link("a", "<inertial><mass value=\"\"/><inertia/></inertial><visual><geometry/></visual>" +
                    collision("<sphere radius=\"1\"/>")) +
      joint("j", "revolute", "base", "a",
            "<limit lower=\"-1\" upper=\"2\" effort=\"N/A\" velocity=\"3\"/><dynamics/>"
            "<safety_controller soft_lower_limit=\"-1\"/><calibration rising=\"x\"/>") +
      link("b") +
      joint("k", "prismatic", "a", "b",
            "<limit lower=\"-1\" upper=\"2\" effort=\"inf\" velocity=\"inf\"/>") +
      "<transmission/><gazebo><plugin/></gazebo>");
  ASSERT_EQ(model.joints.size(), 2u);
  EXPECT_EQ(model.joints[0].velocity, 3);
  EXPECT_EQ(model.joints[1].velocity, HUGE_VAL);
  EXPECT_THAT(
      textsOf(model.notes),
      testing::ElementsAre(testing::HasSubstr("joint \"k\": its velocity is not limited (inf)")));
}

TEST_F(UrdfFile, Capsules) {
  const RobotDescription model = modelOf(
      link("a",
           "<collision><origin xyz=\"1 0 0\" rpy=\"0 1.5707963267948966 0\"/><geometry><capsule "
           "radius=\"0.5\" length=\"2\"/></geometry></collision>") +
      link("b", collision("<cylinder radius=\"0.5\" length=\"2\"/>")) +
      joint("j", "fixed", "a", "b"));
  const PlacedShape& shape = model.links.at(0).shapes.at(0);
  const Capsule* const capsule = std::get_if<Capsule>(&shape.primitive.value());
  ASSERT_TRUE(capsule);
  EXPECT_EQ(capsule->radius, 0.5);
  EXPECT_EQ(capsule->length, 2) << "between the centres of its ends (urdfdom's rule)";
  // Along x: its ends are half-spheres about (0, 0, 0) and (2, 0, 0).
  const ConvexPart& part = shape.parts.at(0);
  ASSERT_EQ(part.points.size(), 2u);
  EXPECT_EQ(part.radius, 0.5);
  EXPECT_LT(
      std::min((part.points[0] - Vec3(2, 0, 0)).norm(), (part.points[1] - Vec3(2, 0, 0)).norm()),
      1e-15);
  EXPECT_TRUE(std::get_if<Cylinder>(&model.links.at(1).shapes.at(0).primitive.value()));
}

TEST_F(UrdfFile, TextsInDeclaredEncodings) {
  const std::string robot = "<robot name='r'><link name='T\xFCr'/></robot>";
  std::vector<Fault> faults;
  const auto model =
      readUrdf(write("r.urdf", "<?xml version='1.0' encoding='ISO-8859-1'?>" + robot), rules_,
               faults, files_);
  ASSERT_TRUE(model) << textOf(faults);
  EXPECT_EQ(model->links.at(0).name, "T\u00fcr");
  EXPECT_THAT(
      complaintOf("<!-- -->\n" + robot),
      testing::StartsWith("r.urdf:2: is not in UTF-8 (byte 0xFC); save it in UTF-8, or name"));
}

TEST_F(UrdfFile, UrdfsByNameOrContent) {
  const std::string robot = "<?xml version='1.0'?><!-- a <link> > -->\n<robot name='r'/>";
  for (const std::string name : {"a.urdf", "a.URDF", "a.xacro", "a.xml", "a"})
    EXPECT_TRUE(isUrdf(write(name, robot))) << name;
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"b.xml", "<launch/>"},
                                                        {"b", "mesh"},
                                                        {"b.yaml", robot},
                                                        {"b.dae", robot},
                                                        {"c.xml", ""}})
    EXPECT_FALSE(isUrdf(write(name, text))) << name;
  EXPECT_FALSE(isUrdf(folder_ / "none.xml"));
}

/// Sets an environment variable during the lifetime of the object. @pre no other thread runs.
class WithVariable {
 public:
  WithVariable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~WithVariable() { unsetenv(name_); }
  WithVariable(const WithVariable&) = delete;
  WithVariable& operator=(const WithVariable&) = delete;

 private:
  const char* name_;
};

/// Links without <collision> are named in a note, or get the shapes of their visuals.
TEST_F(UrdfFile, Visuals) {
  const auto visual = [](const std::string& shape) {
    return "<visual><origin xyz=\"0 0 1\"/><geometry>" + shape +
           "</geometry><material name=\"m\"/></visual>";
  };
  const std::string parts =
      link("a", visual("<torus/>") + collision("<box size=\"1 1 1\"/>")) +
      link("b", visual("<sphere radius=\"2\"/>") + visual("<mesh filename=\"wedge.obj\"/>")) +
      link("c") + joint("j", "fixed", "a", "b") + joint("k", "fixed", "b", "c");
  const RobotDescription ignored = modelOf(parts);
  EXPECT_EQ(ignored.links[1].shapes.size(), 0u);
  EXPECT_THAT(textsOf(ignored.notes),
              testing::ElementsAre((folder_ / "r.urdf").string() +
                                   ":3: 1 link is not tested, having a <visual> and no "
                                   "<collision> (visuals: collide in robot.yaml uses the visuals): "
                                   "b"));
  rules_.visualsCollide = true;
  const RobotDescription used = modelOf(parts);
  EXPECT_TRUE(used.notes.empty());
  EXPECT_EQ(used.links[0].shapes.size(), 1u);
  ASSERT_EQ(used.links[1].shapes.size(), 2u);
  EXPECT_EQ(used.links[1].shapes[0].parts.at(0).radius, 2);
  EXPECT_EQ(used.links[1].shapes[1].mesh->mesh.vertices[0], Vec3(0, 0, 1));
  EXPECT_EQ(used.links[2].shapes.size(), 0u);
  EXPECT_EQ(complaintOfParts(link("a", visual("<torus/>"))),
            "r.urdf:2: link \"a\": unknown geometry <torus>; <box>, <cylinder>, <capsule>, "
            "<sphere> or <mesh> "
            "is needed");
}

/// ROS's rule ignores the up-axis of Collada files.
TEST_F(UrdfFile, UpAxesOfColladaFiles) {
  const auto collada = [](const std::string& up) {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
           up + R"(</asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0  1 0 0  0 2 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">
<node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  };
  write("y.dae", collada("<up_axis>Y_UP</up_axis>"));
  write("z.dae", collada("<up_axis>Z_UP</up_axis>"));
  const std::string parts =
      link("a", collision("<mesh filename=\"y.dae\"/>") + collision("<mesh filename=\"z.dae\"/>"));
  const RobotDescription ros = modelOf(parts);
  EXPECT_EQ(ros.links[0].shapes[0].mesh->mesh.vertices[2], Vec3(0, 2, 0));
  EXPECT_THAT(textsOf(ros.notes),
              testing::ElementsAre((folder_ / "r.urdf").string() +
                                   ": the up-axis of y.dae is not z; it is not applied (ROS's "
                                   "rule), and collada_up: file in robot.yaml applies it"));
  rules_.colladaUp = true;
  const RobotDescription file = modelOf(parts);
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(file.links[0].shapes[0].mesh->mesh.vertices[2], Vec3(0, 0, 2));
  EXPECT_EQ(file.links[0].shapes[1].mesh->mesh.vertices[2], Vec3(0, 2, 0));
}

TEST_F(UrdfFile, ReportsIgnoredElements) {
  const RobotDescription model = modelOf(
      "<gazebo reference=\"a\"><x/></gazebo>\n<transmission name=\"t\"/>\n" +
      link("a",
           "<contact/><drake:x/><vsual/>"
           "<collision_group/>") +
      "<lamp name=\"b\"/>\n" + link("b") +
      joint(
          "j", "prismatic", "a", "b",
          R"(<limit effort="0" velocity="0"/><origin at="1"/><hardware/><safety_controller k_velocity="1"/>)"));
  const std::string file = (folder_ / "r.urdf").string();
  EXPECT_THAT(textsOf(model.notes),
              testing::UnorderedElementsAre(
                  file + ":4: link \"a\": <vsual> is not known, and is ignored (did you mean "
                         "<visual>?)",
                  file + ":4: link \"a\": <collision_group> is not known, and is ignored",
                  file + ":5: robot \"r\": <lamp> is not known, and is ignored",
                  file + ":7: joint \"j\": <hardware> is not known, and is ignored",
                  file + ":7: joint \"j\": origin: at is not known, and is ignored",
                  file + ":7: joint \"j\": <limit> has neither lower nor upper, so both are 0, "
                         "and the joint cannot move"));
}

TEST_F(UrdfFile, AcceptsUnusualNames) {
  const RobotDescription model =
      modelOf(link("100%s &lt;a&gt;") + link("b c") +
              joint("50%n", "revolute", "100%s &lt;a&gt;", "b c", limit));
  EXPECT_EQ(model.links[0].name, "100%s <a>");
  EXPECT_EQ(model.joints[0].name, "50%n");
  EXPECT_EQ(model.joints[0].upper, 2);
}

TEST(Rpy, QuarterTurnsAreExact) {
  constexpr double quarter = std::numbers::pi / 2;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        const Mat3 R = matrixFromRpy({i * quarter, j * quarter, k * quarter});
        EXPECT_EQ(R * R.transpose(), Mat3::Identity());
        EXPECT_EQ(R.cwiseAbs().sum(), 3);
        EXPECT_EQ(R.determinant(), 1);
      }
  EXPECT_EQ(matrixFromRpy({0, 0, quarter}) * Vec3::UnitX(), Vec3::UnitY());
  EXPECT_EQ(matrixFromRpy({quarter, 0, 0}) * Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_EQ(matrixFromRpy({0, quarter, 0}) * Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_EQ(quaternionFromRpy(Vec3::Zero()).coeffs(), Eigen::Vector4d(0, 0, 0, 1));
  EXPECT_EQ(quaternionFromRpy({2 * quarter, 0, 0}).coeffs(), Eigen::Vector4d(1, 0, 0, 0));
  const Eigen::Quaterniond q = quaternionFromRpy({0, 0, quarter});
  EXPECT_EQ(q.w(), q.z());
}

TEST(Rpy, TurnsAboutFixedAxesInTurn) {
  srand(static_cast<unsigned>(testSeed(3)));
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = 4 * Vec3::Random();
    const Mat3 R =
        (Eigen::AngleAxisd(a.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(a.y(), Vec3::UnitY()) *
         Eigen::AngleAxisd(a.x(), Vec3::UnitX()))
            .toRotationMatrix();
    EXPECT_LT((matrixFromRpy(a) - R).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((quaternionFromRpy(a).toRotationMatrix() - R).cwiseAbs().maxCoeff(), 2e-15);
    EXPECT_NEAR(quaternionFromRpy(a).norm(), 1, 2.3e-16);
  }
}

}  // namespace
}  // namespace corridor::test
