// Pairs of links that robot.yaml lists as proved never in contact. They are tested all the same if
// the proof does not cover the problem's margin or tube.
#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class NeverInContactPairs : public ArmTest {
 protected:
  Problem readWith(const std::string& pairs, const std::string& more) const {
    write("arm.yaml", std::string(arm) +
                          "never_in_contact: {margin: 0.01, beyond_limits: 0.002, "
                          "pairs: " +
                          pairs + "}\n");
    return read(armHead + "start: ready\ngoal: {pan: 1, lift: 0.5}\n" + more);
  }
};

constexpr const char* kReason = "robot.yaml: never_in_contact";

TEST_F(NeverInContactPairs, AreTestedBeyondTheProof) {
  const std::string pairs = "[[base, finger]]";
  for (const char* within : {"", "margin: 0.01\n", "tube: {joints: 0.002}\n",
                             "margin: 0.005\npadding: {bodies: {finger: 9}, pairs: [[finger, base, "
                             "0.004]]}\n"}) {
    const Problem p = readWith(pairs, within);
    EXPECT_EQ(skipped(p, "base", "finger"), kReason) << within;
    EXPECT_THAT(textsOf(p.source.notes), Not(Contains(HasSubstr("never_in_contact"))));
  }
  for (const char* beyond :
       {"margin: 0.0100001\n", "tube: {joints: 0.0021}\n", "tube: {pan: 0.01}\n",
        "margin: 0.005\npadding: {pairs: [[finger, base, 0.006]]}\n",
        // The sum is that of the proof, but it is rounded up: a rounded sum proves nothing.
        "margin: 0.005\npadding: {pairs: [[finger, base, 0.005]]}\n"}) {
    const Problem p = readWith(pairs, beyond);
    EXPECT_EQ(skipped(p, "base", "finger"), "") << beyond;
    EXPECT_THAT(textsOf(p.source.notes),
                Contains("1 pair of never_in_contact is tested: the proof covers a margin of up "
                         "to 0.01 m and a tube of up to 0.002 rad or m"));
  }
}

/// Pairs that are excluded for another reason, too, are never tested.
TEST_F(NeverInContactPairs, OtherReasonsStay) {
  const Problem p = readWith("[[base, lower], [base, upper], [upper, finger]]",
                             "margin: 0.05\nallow: [[upper, "
                             "finger]]\n");
  EXPECT_EQ(skipped(p, "base", "lower"), "SRDF: Never");
  EXPECT_EQ(skipped(p, "base", "upper"), "adjacent");
  EXPECT_EQ(skipped(p, "upper", "finger"), "allow");
}

TEST_F(NeverInContactPairs, OfSeveralRobots) {
  write("arm.yaml",
        std::string(arm) +
            "never_in_contact: {margin: 0, beyond_limits: 0.1, pairs: [[base, finger]]}\n");
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
