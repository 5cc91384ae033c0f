// Pairs of links that robot.yaml lists as proved never in contact. They are tested all the same if
// the proof does not cover the problem's margin or tube, or if the digest does not match.
#include "collision/core/shortest.h"
#include "planner/problem/proof_digest.h"
#include "planner/robot/urdf_file.h"
#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class NeverInContactPairs : public ArmTest {
 protected:
  using Pairs = std::vector<std::array<std::string, 2>>;

  /// Returns the key never_in_contact, with the digest for the arm as it is read now.
  std::string listOf(const Pairs& pairs, AllowedPair::Proof proof, UrdfRules rules = {}) const {
    std::vector<Fault> faults;
    std::vector<std::filesystem::path> files;
    const RobotDescription robot = readUrdf(folder_ / "arm.urdf", rules, faults, files).value();
    std::string list;
    for (const auto& [a, b] : pairs) list += (list.empty() ? "[" : ", [") + a + ", " + b + "]";
    return "never_in_contact: {margin: " + shortest(proof.margin) +
           ", beyond_limits: " + shortest(proof.beyondLimits) +
           ", digest: " + proofDigest(digestOfRobot(robot), proof, pairs) + ", pairs: [" + list +
           "]}\n";
  }
  Problem readWith(const Pairs& pairs, const std::string& more) const {
    write("arm.yaml", std::string(arm) + listOf(pairs, {0.01, 0.002}));
    return read(armHead + "start: ready\ngoal: {pan: 1, lift: 0.5}\n" + more);
  }
};

constexpr const char* kReason = "robot.yaml: never_in_contact";

TEST_F(NeverInContactPairs, AreTestedBeyondTheProof) {
  const Pairs pairs = {{"base", "finger"}};
  for (const char* within :
       {"", "margin: 0.01\n", "tube: {joints: 0.002}\n", "margin: {self: 0.01, world: 0}\n",
        "margin: {self: 0.01, world: 0.005}\n",
        "margin: 0.005\npadding: {pairs: [[finger, base, 0.005]]}\n",
        "margin: 0.005\npadding: {bodies: {finger: 9}, pairs: [[finger, base, "
        "0.004]]}\n"}) {
    const Problem p = readWith(pairs, within);
    EXPECT_EQ(skipped(p, "base", "finger"), kReason) << within;
    EXPECT_THAT(textsOf(p.source.notes), Not(Contains(HasSubstr("never_in_contact"))));
  }
  for (const char* beyond :
       {"margin: 0.0100001\n", "tube: {joints: 0.0021}\n", "tube: {pan: 0.01}\n",
        "margin: 0.005\npadding: {pairs: [[finger, base, 0.006]]}\n",
        "margin: {self: 0.0100001, world: 0}\n",
        // The rounded sum is that of the proof, but the real sum is larger.
        "margin: 0.0021\npadding: {pairs: [[finger, base, 0.0079]]}\n"}) {
    const Problem p = readWith(pairs, beyond);
    EXPECT_EQ(skipped(p, "base", "finger"), "") << beyond;
    EXPECT_THAT(textsOf(p.source.notes),
                Contains("1 pair of never_in_contact is tested: the proof covers a margin of up "
                         "to 0.01 m and a tube of up to 0.002 rad or m"));
  }
}

/// Pairs that are excluded for another reason, too, are never tested.
TEST_F(NeverInContactPairs, OtherReasonsStay) {
  const Problem p = readWith({{"base", "lower"}, {"base", "upper"}, {"upper", "finger"}},
                             "margin: 0.05\nallow: [[upper, "
                             "finger]]\n");
  EXPECT_EQ(skipped(p, "base", "lower"), "SRDF: Never");
  EXPECT_EQ(skipped(p, "base", "upper"), "adjacent");
  EXPECT_EQ(skipped(p, "upper", "finger"), "allow");
}

TEST_F(NeverInContactPairs, PaddingOfALinkWithoutShapes) {
  for (const char* padding :
       {"padding: {bodies: {hollow: 0.1}}\n", "padding: {pairs: [[finger, hollow, 0.1]]}\n"}) {
    write("hollow.urdf",
          "<robot name='h'><link name='hollow'/><link name='finger'><collision><geometry><sphere "
          "radius='1'/></geometry></collision></link><joint name='j' type='prismatic'><parent "
          "link='hollow'/><child link='finger'/><axis xyz='1 0 0'/><limit lower='0' upper='1' "
          "effort='1' velocity='1'/></joint></robot>");
    const Problem p = read(
        "format: corridor-problem-1\nrobot: hollow.urdf\nstart: {j: 0}\ngoal: "
        "{j: 1}\n" +
        std::string(padding));
    EXPECT_THAT(textsOf(p.source.notes),
                Contains("padding of \"hollow\" is not used, because this link has no shapes"));
  }
}

/// A padding of a pair that is not tested has a note, unless a proof covers it.
TEST_F(NeverInContactPairs, PaddingsThatAreNotKept) {
  const auto notes = [&](const std::string& pair, const std::string& more = "") {
    std::vector<std::string> texts = textsOf(
        readWith({{"base", "finger"}}, "padding: {pairs: [[" + pair + "]]}\n" + more).source.notes);
    std::erase_if(texts, [](const std::string& text) { return !text.starts_with("padding"); });
    return texts;
  };
  const auto note = [](const std::string& pair, const std::string& why) {
    return testing::ElementsAre("padding.pairs is not kept between " + pair +
                                ", which are not tested (" + why + ")");
  };
  EXPECT_THAT(notes("base, upper, 0.1"), note("base and upper", "adjacent"));
  EXPECT_THAT(notes("lower, base, 0.1"), note("base and lower", "SRDF: Never"));
  EXPECT_THAT(notes("upper, finger, 0.1", "allow: [[upper, finger]]\n"),
              note("upper and finger", "allow"));
  for (const char* kept : {"upper, finger, 0.1", "base, finger, 0.004", "base, finger, 0.1",
                           "base, upper, 0", "upper, post, 0.1"})
    EXPECT_THAT(notes(kept), testing::IsEmpty()) << kept;
}

TEST_F(NeverInContactPairs, OfSeveralRobots) {
  write("arm.yaml", std::string(arm) + listOf({{"base", "finger"}}, {0.0005, 0.1}));
  const auto with = [&](const std::string& more) {
    return read(
        "format: corridor-problem-1\nrobots:\n  left: {file: arm.yaml, base: {at: [0, 2, 0]}}\n  "
        "right: {file: arm.yaml}\nworld: {}\nstart: {left: ready, right: ready}\ngoal: {left: "
        "{pan: 1, lift: 0.5}, right: ready}\n" +
        more);
  };
  EXPECT_EQ(skipped(with(""), "right/base", "right/finger"), kReason);
  const Problem wide = with("margin: 0.001\n");
  EXPECT_EQ(skipped(wide, "right/base", "right/finger"), "");
  EXPECT_EQ(skipped(wide, "left/base", "left/finger"), "");
  EXPECT_THAT(textsOf(wide.source.notes), Contains(HasSubstr("2 pairs of never_in_contact")));
}

/// After any change of what the proof rests on, the pairs are tested, and one note says so.
TEST_F(NeverInContactPairs, AreTestedWithoutAMatchingDigest) {
  const std::string mesh =
      "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  std::string urdfText = urdf;
  urdfText.insert(urdfText.find("</robot>"),
                  "<link name='skin'><visual><geometry><sphere radius='0.01'/></geometry></visual>"
                  "</link>" +
                      joint("to skin", "fixed", "base", "skin", "") +
                      "<link name='tool'><collision><geometry><mesh filename='tool.obj'/>"
                      "</geometry></collision></link>" +
                      joint("to tool", "fixed", "flange", "tool", ""));
  urdfText.insert(urdfText.find("<axis xyz='0 1 0'/>"),
                  "<safety_controller soft_lower_limit='-3' soft_upper_limit='3' k_velocity='1'/>");
  write("arm.urdf", urdfText);
  write("tool.obj", mesh);
  const std::string list = listOf({{"base", "finger"}, {"tool", "base"}}, {0.01, 0.1});
  const auto readNow = [&](const std::string& keys) {
    write("arm.yaml", std::string(arm) + keys);
    return read(armHead + "start: ready\ngoal: {pan: 1, lift: 0.5}\n");
  };
  const auto expectProved = [&](const std::string& keys, const char* what) {
    const Problem p = readNow(keys);
    EXPECT_EQ(skipped(p, "base", "finger"), kReason) << what;
    EXPECT_EQ(skipped(p, "base", "tool"), kReason) << what;
    EXPECT_THAT(textsOf(p.source.notes), Not(Contains(HasSubstr("never_in_contact")))) << what;
  };
  const std::string note =
      " pairs are tested, because its digest does not match: the shapes, joints or limits of the "
      "robot, or the list, have changed since the proof; corridor new robot proves the pairs "
      "again, and writes a never_in_contact with a digest";
  const auto expectTested = [&](const std::string& keys, const char* what, int pairs = 2) {
    const Problem p = readNow(keys);
    EXPECT_EQ(skipped(p, "base", "finger"), "") << what;
    EXPECT_EQ(skipped(p, "base", "tool"), "") << what;
    std::vector<Note> notes;
    for (const Note& each : p.source.notes)
      if (each.text.find("never_in_contact") != std::string::npos) notes.push_back(each);
    ASSERT_EQ(notes.size(), 1u) << what;
    EXPECT_EQ(notes[0].text, "never_in_contact: its " + std::to_string(pairs) + note) << what;
    EXPECT_EQ(notes[0].weight, NoteWeight::motion);
  };
  const auto replaced = [](std::string text, const std::string& old, const std::string& now) {
    const auto place = text.find(old);
    if (place == text.npos) throw std::logic_error(old);
    return text.replace(place, old.size(), now);
  };
  expectProved(list, "unchanged");

  // The URDF: a byte of a pose, a size, an axis, a limit and a mimic.
  for (const auto& [old, now] : std::vector<std::pair<std::string, std::string>>{
           {"xyz='0 0 0.5'", "xyz='0 0 0.6'"},
           {"size='0.2 0.2 0.2'", "size='0.2 0.3 0.2'"},
           {"<axis xyz='0 1 0'/>", "<axis xyz='0 1 1'/>"},
           {"lower='0.01' upper='0.05'", "lower='0.01' upper='0.06'"},
           {"multiplier='-1'", "multiplier='-2'"},
           {"type='continuous'", "type='revolute'"},
           {"name='thumb'", "name='thumc'"}}) {
    std::string changed = replaced(urdfText, old, now);
    if (old == "type='continuous'")
      changed =
          replaced(changed, "<axis xyz='0 0 1'/>",
                   "<axis xyz='0 0 1'/><limit lower='-9' upper='9' effort='1' velocity='1'/>");
    if (old == "name='thumb'")
      changed = replaced(changed, "child link='thumb'", "child link='thumc'");
    write("arm.urdf", changed);
    expectTested(list, old.c_str());
  }
  write("arm.urdf", urdfText + "<!-- a comment changes nothing that is proved -->");
  expectProved(list, "comment");
  write("arm.urdf", urdfText);

  write("tool.obj", replaced(mesh, "0.1 0 0", "0.2 0 0"));
  expectTested(list, "a vertex of the mesh");
  write("tool.obj", replaced(mesh, "f 1 3 2", "f 1 2 3"));
  expectTested(list, "a triangle of the mesh");
  write("tool.obj", mesh);

  expectTested("visuals: collide\n" + list, "visuals");
  expectTested("limits: soft\n" + list, "limits");
  write("arm.urdf", replaced(urdfText, "tool.obj", "package://other/tool.obj"));
  write("other/tool.obj", mesh);
  expectProved("packages: {other: other}\n" + list, "the same mesh in a package");
  write("other/tool.obj", replaced(mesh, "0.1 0 0", "0.2 0 0"));
  expectTested("packages: {other: other}\n" + list, "another mesh in a package");
  write("arm.urdf", urdfText);

  expectTested(replaced(list, "margin: 0.01", "margin: 0.02"), "margin");
  expectTested(replaced(list, "beyond_limits: 0.1", "beyond_limits: 0.2"), "beyond_limits");
  expectTested(replaced(list, "[tool, base]", "[tool, base], [finger, upper]"), "a pair was added",
               3);
  expectTested(replaced(list, "[tool, base]", "[finger, upper]"), "a pair was replaced");
  expectProved(replaced(list, "[base, finger], [tool, base]", "[base, tool], [finger, base]"),
               "the order does not matter");
  const auto digest = list.find("digest: ") + 8;
  std::string wrong = list;
  wrong[digest] = wrong[digest] == '0' ? '1' : '0';
  expectTested(wrong, "a digit of the digest");
  expectTested(replaced(list, list.substr(digest, 64), "none"), "no digest at all");

  const Problem p = readNow(replaced(list, "digest: " + list.substr(digest, 64) + ", ", ""));
  EXPECT_EQ(skipped(p, "base", "tool"), "");
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("never_in_contact: its 2 pairs are tested, because it has no digest; "
                       "corridor new robot proves the pairs again, and writes a never_in_contact "
                       "with a digest"));
}

/// The proof is for all values of all joints within their limits. So it does not matter which
/// joints are planned for, or at which values the others are held.
TEST_F(NeverInContactPairs, AreProvedForAllHeldValues) {
  const std::string list = listOf({{"base", "finger"}}, {0.01, 0.1});
  for (const char* keys : {"", "hold: {slide: 0.05}\n",
                           "states: {ready: {pan: 0, lift: 0.5, slide: "
                           "0.04}}\n"}) {
    write("arm.yaml", std::string(arm) + keys + list);
    const Problem p = read(armHead + "start: ready\ngoal: {pan: 1, lift: 0.5}\n");
    EXPECT_EQ(skipped(p, "base", "finger"), kReason) << keys;
  }
  std::string all = arm;
  all.replace(all.find("group: arm"), 10, "joints: [pan, lift, slide]");
  write("arm.yaml", all + list);
  const Problem p = read(armHead +
                         "start: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, lift: 0.5, slide: "
                         "0.03}\n");
  EXPECT_EQ(skipped(p, "base", "finger"), kReason);
}

/// The digest of a robot of one link, computed by another program from the description of the bytes
/// in proof_digest.h.
TEST(ProofDigest, HasTheDescribedBytes) {
  RobotDescription robot;
  PlacedShape ball;
  ball.parts = {{{Vec3(1, 2, 3)}, 0.5, false}};
  MeshFile file;
  file.mesh = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  PlacedShape triangle;
  triangle.mesh = std::make_shared<const MeshFile>(file);
  robot.links = {{"a", {ball}}, {"b", {triangle}}};
  JointModel joint;
  joint.name = "j", joint.type = JointType::revolute, joint.child = 1;
  joint.lower = -1, joint.upper = 2, joint.mimic = Mimic{0, 2, 0.25};
  robot.joints = {joint};
  EXPECT_EQ(proofDigest(digestOfRobot(robot), {0.01, 0.5}, {{"b", "a"}}),
            "2affdadcbb1795fc1f049638ddfd01ceae2e71eae9a8bf55a982674e64359408");
}

TEST_F(NeverInContactPairs, Faults) {
  const auto faults = [&](const std::string& value) {
    write("arm.yaml", std::string(arm) + "never_in_contact: " + value + "\n");
    return complaintOf(armHead + "start: ready\ngoal: {pan: 1, lift: 0.5}\n");
  };
  EXPECT_EQ(faults("[[base, finger]]"),
            "arm.yaml:6: never_in_contact: a map such as {margin: …} is needed, not a list");
  EXPECT_EQ(faults("{margin: 0.01, pairs: [[base, finger]]}"),
            "arm.yaml:6: missing key \"beyond_limits\" in never_in_contact: rad or m: how far "
            "the proof goes beyond the limits of joints");
  EXPECT_EQ(faults("{margin: -1, beyond_limits: 0, pairs: []}"),
            "arm.yaml:6: never_in_contact.margin: must be 0 or more, not -1");
  EXPECT_EQ(faults("{margin: 0, beyond_limits: 0, pairs: [[base]]}"),
            "arm.yaml:6: never_in_contact.pairs: two links are needed, such as [hand, finger], not "
            "1");
  EXPECT_EQ(faults("{margin: 0, beyond_limits: 0, pairs: [[base, fingr]]}"),
            "arm.yaml:6: never_in_contact.pairs: there is no link \"fingr\" (did you mean "
            "\"finger\"?) (known: base, upper, lower, flange, finger, thumb)");
  EXPECT_EQ(faults("{margin: 0, beyond_limits: 0, pairs: 7}"),
            "arm.yaml:6: never_in_contact.pairs: a list of pairs of links is needed, such as "
            "[[hand, finger]], not \"7\"");
}

}  // namespace
}  // namespace corridor::test
