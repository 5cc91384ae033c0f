#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "collision/world/scene.h"
#include "tests/planner/problem/problem_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

class OmplAppCfg : public ProblemTest {
 protected:
  std::filesystem::path cfg(const std::string& text) const { return write("problem.cfg", text); }
  /// Lines 1 to 3 of a file.
  inline static const std::string meshes = "[problem]\nrobot = wedge.obj\nworld=wedge.obj\n";
  /// Lines 4 to 9 of a file.
  inline static const std::string planar =
      "start.x = 5\nstart.y = 0\nstart.theta = 7\ngoal.x = 0\ngoal.y = 5\ngoal.theta = 0\n";
  inline static const std::string spatial =
      planar +
      "start.z = 1\nstart.axis.x = 0\nstart.axis.y = 0\nstart.axis.z = 2\n"
      "goal.z = 1\ngoal.axis.x = 0\ngoal.axis.y = 0\ngoal.axis.z = 0\n";
};

TEST_F(OmplAppCfg, PlanarProblem) {
  const Problem p = readProblem(cfg(meshes + planar));
  EXPECT_EQ(p.source.name, "problem");
  EXPECT_TRUE(isPlanar(p));
  EXPECT_EQ(p.model.space.coordinates().at(2).weight, 0.5);
  EXPECT_EQ(p.task.start.head(2), Eigen::Vector2d(5, 0));
  EXPECT_DOUBLE_EQ(p.task.start[2], 7 - 2 * std::numbers::pi);
  EXPECT_EQ(p.source.lines.at("start"), 4);
  EXPECT_EQ(lowerOf(p), Vec3(0, 0, 0)) << "the world's box";
  EXPECT_EQ(upperOf(p), Vec3(5, 5, 0)) << "enlarged to hold start and goal";
  double lowest = 1;
  for (const Vec3& v : meshOf(p, "wedge").vertices) lowest = std::min(lowest, v.z());
  EXPECT_EQ(lowest, 0) << "z is not recentred in the plane";
  EXPECT_EQ(p.model.bodies.back().name, "world/wedge") << "the robot has the name wedge, too";
}

TEST_F(OmplAppCfg, SpatialProblemWithEverything) {
  const Problem p = readProblem(cfg(
      meshes + spatial +
      "name = Wedges # comment\nthreshold = 0.1\nobjective = length_of_path\nobjective.threshold = "
      "3\n"
      "sampler = gaussian\nlongest_valid_segment_fraction = 0.02\nprojection.cellsize_factor = 2\n"
      "volume.min.x = -1\nvolume.min.y = -1\nvolume.min.z = -1\n"
      "volume.max.x = 4\nvolume.max.y = 9\nvolume.max.z = 9\n"
      "[benchmark]\ntime_limit = 3.5\nmem_limit = 100\n[planner]\naps=\nRRT=\nrrt.range=0.25"));
  EXPECT_EQ(p.source.name, "Wedges");
  EXPECT_FALSE(isPlanar(p));
  EXPECT_EQ(p.model.space.coordinates().at(3).weight, 1);
  EXPECT_DOUBLE_EQ(p.task.start[6], std::cos(3.5));
  EXPECT_DOUBLE_EQ(p.task.start[5], std::sin(3.5)) << "the axis is normalised";
  EXPECT_EQ(p.task.goals.at(0).tail(4), Eigen::Vector4d(0, 0, 0, 1)) << "a zero axis turns nothing";
  EXPECT_EQ(p.task.goalThreshold, 0.1);
  EXPECT_EQ(p.settings.objective, Objective::length);
  EXPECT_EQ(p.settings.objectiveThreshold, 3);
  EXPECT_EQ(p.settings.sampler, ValidSampler::gaussian);
  EXPECT_EQ(p.settings.checker.resolution, 0.02);
  EXPECT_EQ(lowerOf(p), Vec3(-1, -1, -1));
  EXPECT_EQ(upperOf(p), Vec3(5, 9, 9));
  EXPECT_EQ(p.settings.planner.time, 3.5);
  EXPECT_EQ(p.settings.planner.name, "RRT");
  EXPECT_EQ(p.settings.planner.params, (std::map<std::string, std::string>{{"range", "0.25"}}));
  EXPECT_EQ(p.source.lines.at("planner.params.range"), 37);
  EXPECT_THAT(textsOf(p.source.notes),
              testing::IsSupersetOf(
                  {testing::Eq("bounds: enlarged to contain start and goal"),
                   testing::Eq("not used: problem.projection.cellsize_factor, benchmark.mem_limit"),
                   testing::Eq("planners with unknown names are skipped: aps")}));
}

TEST_F(OmplAppCfg, DefaultPlannerIfTheFileListsSeveral) {
  const Problem p =
      readProblem(cfg(meshes + planar + "[planner]\nprm=\nrrt=\nrrt=\nrrt.range=3\n"));
  EXPECT_EQ(p.settings.planner.name, "RRTConnect");
  EXPECT_TRUE(p.settings.planner.params.empty());
  EXPECT_THAT(
      textsOf(p.source.notes),
      testing::Contains("planner: RRTConnect, since the file lists several (prm, rrt, rrt)"));
}

TEST_F(OmplAppCfg, TheLastOfRepeatedKeysOfAPlannerIsUsed) {
  const Problem p = readProblem(
      cfg(meshes + planar +
          "[planner]\nrrt=\nrrt.range=3\nproblem.sampler=uniform\n"
          "problem.longest_valid_segment_fraction=0.03\nrrt.range=4\nproblem.sampler=gaussian\n"
          "problem.longest_valid_segment_fraction=0.04\n"));
  EXPECT_EQ(p.settings.planner.params, (std::map<std::string, std::string>{{"range", "4"}}));
  EXPECT_EQ(p.settings.sampler, ValidSampler::gaussian);
  EXPECT_EQ(p.settings.checker.resolution, 0.04);
}

TEST_F(OmplAppCfg, IncompleteVolumeIsIgnored) {
  const Problem p = readProblem(cfg(meshes + planar + "volume.min.x = -100\n"));
  EXPECT_EQ(lowerOf(p), Vec3(0, 0, 0));
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains("bounds: those of the world, since volume is incomplete"));
}

TEST_F(OmplAppCfg, Faults) {
  EXPECT_EQ(complaint(cfg("")),
            "problem.cfg: is empty; a problem ([problem], robot = …, world = …) is needed");
  EXPECT_EQ(complaint(cfg("[problem]\n")),
            "problem.cfg: start and goal need x, y, theta (2D), or x, y, z, theta, axis.x, axis.y, "
            "axis.z (3D); missing: start.x, "
            "start.y, start.theta, goal.x, goal.y, goal.theta\n"
            "problem.cfg: missing key \"robot\": a mesh file in the folder of this file\n"
            "problem.cfg: missing key \"world\": a mesh file in the folder of this file");
  EXPECT_EQ(complaint(cfg(meshes + planar + "start.z = 1\n")),
            "problem.cfg: start and goal need x, y, theta (2D), or x, y, z, theta, axis.x, axis.y, "
            "axis.z (3D); missing: start.axis.x, "
            "start.axis.y, start.axis.z, goal.z, goal.axis.x, goal.axis.y, goal.axis.z");
  EXPECT_EQ(complaint(cfg("[problem]\nrobot = gone.dae\nworld = wedge.obj\n" + planar +
                          "goal.x = 7\nnonsense\n"
                          "control = dynamic_car\nstatespace = dubins\nobjective = "
                          "beauty\nthreshold = -1\n[benchmark]\ntime_limit = soon\n")),
            "problem.cfg:2: robot: gone.dae: no such file\n"
            "problem.cfg:10: duplicate key \"goal.x\", first on line 7\n"
            "problem.cfg:11: [section] or key = value is needed, not \"nonsense\"\n"
            "problem.cfg:12: control: \"dynamic_car\" is not supported: Corridor plans for rigid "
            "bodies without dynamics\n"
            "problem.cfg:13: statespace: \"dubins\" is not supported: Corridor plans in SE2 and "
            "SE3, where edges are straight\n"
            "problem.cfg:14: objective: one of length, max_min_clearance, mechanical_work is "
            "needed, not \"beauty\"\n"
            "problem.cfg:15: threshold: must be 0 or more, not -1\n"
            "problem.cfg:17: time_limit: a number is needed, not \"soon\"");
  EXPECT_EQ(complaint(cfg(meshes + "start.x = 5,0\nstart.y = nan\nstart.theta = 0\ngoal.x = "
                                   "0\ngoal.y = 5\ngoal.theta = 1 2\n")),
            "problem.cfg:4: start.x: a number is needed, not \"5,0\"; decimals need a point, not a "
            "comma\n"
            "problem.cfg:5: start.y: a finite number is needed, not \"nan\"\n"
            "problem.cfg:9: goal.theta: a number is needed, not \"1 2\"");
  EXPECT_EQ(
      complaint(cfg(meshes + planar +
                    "volume.min.x = 3\nvolume.min.y = 0\nvolume.max.x = 2\nvolume.max.y = 1\n")),
      "problem.cfg:10: volume.min.x: 3 is above volume.max.x, 2");
}

/// Values of one of OMPL.app's own problems, which an independent reader computed from its files.
struct Reference {
  const char* file;
  bool spatial;
  std::size_t robotTriangles, worldTriangles;
  int importedVertices;
  Vec3 centre;    ///< centre of the robot, in its file's coordinates
  Vec3 robotMin;  ///< lower corner of the robot's bounding box, before recentring
  Vec3 worldMin, worldMax;
};

const std::vector<Reference>& references() {
  static const std::vector<Reference> all{{"2D/BugTrap_planar.cfg",
                                           false,
                                           28,
                                           264,
                                           56,
                                           {0.0250001, 0, 0},
                                           {-2.475, -1.25, 0},
                                           {-55, -55.01, -0.001485},
                                           {55, 55.011, 8.1695}},
                                          {"2D/Maze_planar.cfg",
                                           false,
                                           40,
                                           1892,
                                           80,
                                           {0.00999999, -0.15, 0},
                                           {-1.99, -2, 0},
                                           {-55, -55, 0},
                                           {55, 55, 10.63}},
                                          {"3D/Abstract.cfg",
                                           true,
                                           48,
                                           1400,
                                           112,
                                           {-8.01944, 0, -7.835296},
                                           {-25.791, -9.4488, -34.962},
                                           {-233.12, -222.2, -3.9451},
                                           {239.92, 250.74, 468.98}},
                                          {"3D/Easy.cfg",
                                           true,
                                           56,
                                           176,
                                           112,
                                           {270.4043, 160.6562, -297.8237},
                                           {251.12, 142.75, -322.66},
                                           {14.46, -24.25, -504.86},
                                           {457.96, 321.25, -72.855}},
                                          {"3D/Home.cfg",
                                           true,
                                           120,
                                           696,
                                           280,
                                           {-0.04602013, 0.05111809, 9.192626},
                                           {-23.541, -35.433, -12.58},
                                           {-383.8, -371.47, -0.19685},
                                           {325, 337.89, 142.33}},
                                          {"3D/Twistycool.cfg",
                                           true,
                                           56,
                                           176,
                                           112,
                                           {270.4043, 160.6562, -297.8237},
                                           {251.12, 142.75, -322.66},
                                           {14.46, -24.25, -504.86},
                                           {457.96, 321.25, -72.855}},
                                          {"3D/alpha-1.5.cfg",
                                           true,
                                           2016,
                                           2016,
                                           10248,
                                           {-21.90987, -11.10698, -14.13554},
                                           {-73.176, -59.949, -102.64},
                                           {-131.87, -42.493, -91.763},
                                           {106.82, 125.33, -3.0743}},
                                          {"3D/cubicles.cfg",
                                           true,
                                           40,
                                           626,
                                           72,
                                           {-4.958012, -40.62011, 70.56501},
                                           {-27.2, -87.356, 55.692},
                                           {-508.88, -230.13, -123.75},
                                           {319.62, 531.87, 101}},
                                          {"3D/cubicles_opt.cfg",
                                           true,
                                           40,
                                           626,
                                           72,
                                           {-4.958012, -40.62011, 70.56501},
                                           {-27.2, -87.356, 55.692},
                                           {-508.88, -230.13, -123.75},
                                           {319.62, 531.87, 101}}};
  return all;
}

/// Compares with a tolerance of 1e-4 (relative for values above 1), since the reference values have
/// five digits.
void expectNear(const Vec3& a, const Vec3& b, const std::string& what) {
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(a[k], b[k], 1e-4 * std::max(1.0, std::abs(b[k]))) << what << " "
                                                                  << "xyz"[k];
}

std::pair<Vec3, Vec3> boundsOf(const TriangleMesh& mesh) {
  Vec3 low = mesh.corner(0, 0), high = low;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      low = low.cwiseMin(mesh.corner(t, i)), high = high.cwiseMax(mesh.corner(t, i));
  return {low, high};
}

double numberOf(const std::filesystem::path& cfg, const std::string& key) {
  std::ifstream stream(cfg);
  for (std::string word, equals; stream >> word;)
    if (word == key && stream >> equals) {
      double value;
      if (stream >> value) return value;
    }
  ADD_FAILURE() << key << " is not in " << cfg;
  return 0;
}

TEST(OmplAppProblems, AgreeWithTheReference) {
  const auto folder = omplAppFolder();
  if (!folder) GTEST_SKIP() << "set CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  for (const Reference& r : references()) {
    SCOPED_TRACE(r.file);
    const Problem p = readProblem(*folder / r.file);
    EXPECT_EQ(isPlanar(p), !r.spatial);
    const TriangleMesh &robot = p.model.bodies.at(0).shapes.at(0).mesh->mesh,
                       &world = p.model.bodies.at(1).shapes.at(0).mesh->mesh;
    EXPECT_EQ(robot.triangles.size(), r.robotTriangles);
    EXPECT_EQ(world.triangles.size(), r.worldTriangles);
    const auto [worldMin, worldMax] = boundsOf(world);
    expectNear(worldMin, r.worldMin, "world's lower corner");
    expectNear(worldMax, r.worldMax, "world's upper corner");
    // The centre is what recentring subtracted from the robot's coordinates in its file.
    const OmplAppMesh file = readOmplAppMesh(p.model.bodies[0].shapes[0].file);
    EXPECT_EQ(file.importedVertices, r.importedVertices);
    const Vec3 centre = boundsOf(file.mesh).first - boundsOf(robot).first;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(centre[k], r.centre[k], 1e-5 * std::max(1.0, std::abs(r.centre[k])));
    expectNear(boundsOf(file.mesh).first, r.robotMin, "robot's lower corner");

    const auto number = [&](const std::string& key) { return numberOf(*folder / r.file, key); };
    const bool spatial = r.spatial;
    EXPECT_EQ(p.task.start.head(2), Eigen::Vector2d(number("start.x"), number("start.y")));
    EXPECT_EQ(p.task.goals.at(0).head(2), Eigen::Vector2d(number("goal.x"), number("goal.y")));
    if (spatial) {
      EXPECT_EQ(p.task.start[2], number("start.z"));
      EXPECT_EQ(p.task.goals[0][2], number("goal.z"));
      const Eigen::Quaterniond q(Eigen::AngleAxisd(
          number("goal.theta"),
          Vec3(number("goal.axis.x"), number("goal.axis.y"), number("goal.axis.z")).normalized()));
      EXPECT_LT((p.task.goals[0].tail(4) - q.coeffs()).norm(), 1e-15);
    } else {
      EXPECT_EQ(p.task.goals[0][2], number("goal.theta"));
    }
    EXPECT_EQ(lowerOf(p), Vec3(number("volume.min.x"), number("volume.min.y"),
                               spatial ? number("volume.min.z") : 0));
    EXPECT_EQ(upperOf(p), Vec3(number("volume.max.x"), number("volume.max.y"),
                               spatial ? number("volume.max.z") : 0));
    EXPECT_EQ(p.settings.planner.name, "RRTConnect");
    EXPECT_EQ(p.task.goalThreshold, 1e-6);
  }
  EXPECT_EQ(readProblem(*folder / "3D/alpha-1.5.cfg").settings.sampler,
            ValidSampler::obstacleBased);
  EXPECT_EQ(readProblem(*folder / "3D/Home.cfg").settings.objective, Objective::length);
  EXPECT_EQ(readProblem(*folder / "3D/cubicles_opt.cfg").settings.planner.time, 300);
}

/// Reads the poses of one of OMPL.app's sample solutions. OMPL.app's checker found these poses
/// free. If the reader placed the meshes wrongly, some of them would be in contact.
std::vector<Transform> posesOf(const std::filesystem::path& file, bool spatial) {
  std::vector<Transform> poses;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::vector<double> v;
    for (double number; words >> number;) v.push_back(number);
    if (spatial && v.size() == 7)
      poses.push_back({Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix(),
                       Vec3(v[0], v[1], v[2])});
    else if (!spatial && v.size() == 3)
      poses.push_back(
          {Eigen::AngleAxisd(v[2], Vec3::UnitZ()).toRotationMatrix(), Vec3(v[0], v[1], 0)});
  }
  return poses;
}

Scene sceneOf(const Problem& problem, const Vec3& shift) {
  TriangleMesh mesh = problem.model.bodies.at(0).shapes.at(0).mesh->mesh;
  for (Vec3& vertex : mesh.vertices) vertex += shift;
  std::vector<Scene::Placed> bodies;
  bodies.push_back({Body("robot", std::move(mesh)), 1});
  bodies.push_back({Body("world", problem.model.bodies.at(1).shapes.at(0).mesh->mesh), 0});
  return Scene(std::move(bodies), {{0, 1}});
}

TEST(OmplAppProblems, SampleSolutionsAreFreeWhereTheyShouldBe) {
  const auto folder = omplAppFolder();
  if (!folder) GTEST_SKIP() << "set CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  struct Sample {
    const char* name;
    std::size_t states;
    int contactsIfNotRecentred;  ///< -1: unknown
  };
  for (const Sample& sample :
       {Sample{"2D/BugTrap_planar", 115, -1}, Sample{"2D/Maze_planar", 77, -1},
        Sample{"3D/Easy", 40, -1}, Sample{"3D/Twistycool", 35, -1}, Sample{"3D/alpha-1.5", 103, 57},
        Sample{"3D/cubicles", 211, 122}}) {
    SCOPED_TRACE(sample.name);
    const Problem p = readProblem(*folder / (std::string(sample.name) + ".cfg"));
    const auto poses = posesOf(*folder / (std::string(sample.name) + ".path"), !isPlanar(p));
    EXPECT_EQ(poses.size(), sample.states);
    const Vec3 centre = readOmplAppMesh(p.model.bodies[0].shapes[0].file).vertexAverage;
    const Scene scene = sceneOf(p, Vec3::Zero()), wrong = sceneOf(p, centre);
    QueryContext context;
    int contacts = 0, wrongContacts = 0;
    for (const Transform& pose : poses) {
      const std::array<Transform, 2> frames{Transform{}, pose};
      contacts += scene.interference(frames, context).has_value();
      wrongContacts += wrong.interference(frames, context).has_value();
    }
    EXPECT_EQ(contacts, 0);
    if (sample.contactsIfNotRecentred >= 0) {
      EXPECT_EQ(wrongContacts, sample.contactsIfNotRecentred);
    }
  }
}

TEST(OmplAppProblems, EveryOtherProblemIsReadOrRefused) {
  const auto folder = omplAppFolder();
  if (!folder) GTEST_SKIP() << "set CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  int read = 0, dynamic = 0;
  for (const char* part : {"2D", "3D"})
    for (const auto& entry : std::filesystem::directory_iterator(*folder / part)) {
      if (entry.path().extension() != ".cfg") continue;
      try {
        readProblem(entry.path());
        ++read;
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::AnyOf(testing::HasSubstr("without dynamics"),
                                                 testing::HasSubstr("no such file")));
        ++dynamic;
      }
    }
  std::cout << read << " read, " << dynamic << " refused\n";
  EXPECT_GE(read, 9);
}

}  // namespace
}  // namespace corridor::test
