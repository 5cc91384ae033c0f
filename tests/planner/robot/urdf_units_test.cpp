#include "tests/planner/robot/urdf_fixture.h"

namespace corridor::test {
namespace {

/// Lengths in millimetres, and angles in degrees, are noted.
using UrdfUnits = UrdfTest;

TEST_F(UrdfUnits, MeshesInMillimetresAreNoted) {
  write("big.obj", "v 0 0 0\nv 1000 0 0\nv 0 200 0\nf 1 2 3\n");
  const RobotDescription model = modelOf(link("a", collision("<mesh filename=\"big.obj\"/>")));
  EXPECT_THAT(textsOf(model.notes),
              testing::ElementsAre((folder_ / "r.urdf").string() +
                                   ":2: shape \"a\" is 1000 m long; if its mesh is in "
                                   "millimetres, it needs scale=\"0.001 0.001 0.001\""));
  EXPECT_TRUE(modelOf(link("a", collision("<mesh filename=\"big.obj\" scale=\"1e-3 1e-3 1e-3\"/>")))
                  .notes.empty());
}

/// A unit in a comment of a mesh is compared with the scale of the URDF.
TEST_F(UrdfUnits, UnitsThatMeshesState) {
  write("cm.obj", "# unit: cm\nv 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  const auto notesAt = [&](const std::string& scale) {
    return modelOf(link("a", collision("<mesh filename=\"cm.obj\"" + scale + "/>")))
        .links.at(0)
        .shapes.at(0)
        .mesh->notes;
  };
  const std::string note = "line 1 says \"unit: cm\", but coordinates are read with a unit of ";
  EXPECT_THAT(notesAt(""), testing::ElementsAre(note + "1 m"));
  EXPECT_THAT(notesAt(" scale=\"0.001 0.001 0.001\""), testing::ElementsAre(note + "0.001 m"));
  EXPECT_THAT(notesAt(" scale=\"0.01 0.01 0.02\""), testing::ElementsAre(note + "0.02 m"));
  EXPECT_THAT(notesAt(" scale=\"0.01 -0.01 0.01\""), testing::IsEmpty());
}

TEST_F(UrdfUnits, OriginsInMillimetresAreNoted) {
  const auto notesAt = [&](const std::string& xyz) {
    return textsOf(modelOf(link("a") + link("b") +
                           joint("j", "continuous", "a", "b", "<origin xyz=\"" + xyz + "\"/>"))
                       .notes);
  };
  EXPECT_THAT(notesAt("-82.5 384 0"),
              testing::ElementsAre((folder_ / "r.urdf").string() +
                                   ":4: joint \"j\": its origin, [-82.5, 384, 0], is in metres, as "
                                   "URDF requires; are these millimetres?"));
  EXPECT_THAT(notesAt("0 -20 3"), testing::IsEmpty());
}

TEST_F(UrdfUnits, LimitsInDegreesAreNoted) {
  const auto notesOf = [&](const std::string& type, const std::string& lower,
                           const std::string& upper) {
    return textsOf(modelOf(link("a") + link("b") +
                           joint("j", type, "a", "b",
                                 "<limit lower=\"" + lower + "\" upper=\"" + upper +
                                     "\" effort=\"0\" velocity=\"0\"/>"))
                       .notes);
  };
  const std::string of = (folder_ / "r.urdf").string() + ":4: joint \"j\": its limits, ";
  EXPECT_THAT(notesOf("revolute", "-166", "166"),
              testing::ElementsAre(of + "[-166, 166], are in radians, as URDF requires; are these "
                                        "degrees?"));
  EXPECT_THAT(notesOf("revolute", "-90", "1"), testing::SizeIs(1));
  EXPECT_THAT(notesOf("revolute", "-1e16", "1e16"),
              testing::ElementsAre(of + "[-1e+16, 1e+16], are in radians; a joint without limits "
                                        "is of type continuous"));
  EXPECT_THAT(notesOf("revolute", "-29", "29"), testing::IsEmpty()) << "a joint of several turns";
  EXPECT_THAT(notesOf("prismatic", "-166", "166"), testing::IsEmpty());
}

}  // namespace
}  // namespace corridor::test
