// Tests of the notes on angles that are given in radians and seem to be degrees.
#include "tests/planner/problem/arm_fixture.h"

namespace corridor {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

class Degrees : public test::ArmTest {
 protected:
  /// Returns the notes of a problem, the folder's path left out.
  std::vector<std::string> notesOf(const std::string& text) const {
    std::vector<std::string> notes = textsOf(read(text).source.notes);
    const std::string prefix = folder_.string() + '/';
    for (std::string& note : notes)
      if (note.starts_with(prefix)) note.erase(0, prefix.size());
    return notes;
  }
};

TEST_F(Degrees, Rotations) {
  const auto post = [&](const std::string& rotation) {
    return notesOf(
        "format: corridor-problem-1\nrobot: arm.yaml\nworld:\n  post: {box: [0.1, 0.1, "
        "1], at: [0.5, 0.5, 0.5], " +
        rotation + "}\n" + armStates);
  };
  EXPECT_EQ(post("rpy: [0, 0, 90]").front(),
            "world.post.rpy: [0, 0, 90] is in radians; for degrees, write rpy_deg: [0, 0, 90]");
  EXPECT_THAT(post("rpy: [-45, 0, 0.5]"), Contains(HasSubstr("write rpy_deg: [-45, 0, 0.5]")));
  for (const char* sound : {"rpy: [0, 0, 6.2]", "rpy: [0, 0, 7]", "rpy: [0, 0, 31.41592653589793]",
                            "rpy_deg: [0, 0, 90]"})
    EXPECT_THAT(post(sound), Each(Not(HasSubstr("radians")))) << sound;
  EXPECT_THAT(notesOf(armHead + armStates + "base: {at: [0, 0, 0], rpy: [180, 0, 0]}\n"),
              Contains(HasSubstr("base.rpy: [180, 0, 0] is in radians")));
  EXPECT_THAT(notesOf(planarHead + "start: {at: [5, 0], yaw: 90}\ngoal: {at: [0, 5]}\nbounds: {at: "
                                   "[[-9, -9], [9, 9]]}\n"),
              Contains(AllOf(HasSubstr("start.yaw: 90 is read as "),
                             HasSubstr("; for degrees, write yaw_deg: 90"))));
}

TEST_F(Degrees, Limits) {
  EXPECT_THAT(notesOf(armHead + armStates + "bounds: {pan: [-180, 180]}\n"),
              Contains("bounds.pan: [-180, 180] is in radians; for degrees, write pan_deg"));
  std::string text = urdf;
  const std::string limit = "lower='-3.14159' upper='3.14159'";
  text.replace(text.find(limit), limit.size(), "lower='-90' upper='90'");
  const std::string origin = "<origin xyz='0 0 0.2'/>";
  text.replace(text.find(origin), origin.size(), "<origin xyz='0 0 0.2' rpy='0 0 45'/>");
  write("arm.urdf", text);
  const auto notes = notesOf(armHead + armStates);
  EXPECT_THAT(notes, Contains(HasSubstr("joint \"lift\": its limits, [-90, 90], are in radians, as "
                                        "URDF requires; are these degrees?")));
  EXPECT_THAT(notes, Contains(HasSubstr("joint \"pan\": origin rpy=\"0 0 45\" is in radians, as "
                                        "URDF requires; are these degrees?")));
}

}  // namespace
}  // namespace corridor
