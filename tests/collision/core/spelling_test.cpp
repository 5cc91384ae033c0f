#include "collision/core/spelling.h"

#include <gtest/gtest.h>

namespace corridor::test {
namespace {

TEST(EditDistance, CountsChanges) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("checkr", "checker"), 1u);
  EXPECT_EQ(editDistance("rnage", "range"), 1u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(editDistance("ca", "abc"), 3u);  // optimal string alignment; Damerau-Levenshtein has 2
}

TEST(Spelling, SuggestsOnlyWhatMayBeMeant) {
  const std::vector<std::string> planners{"RRT", "RRTConnect", "PRM", "KPIECE1"};
  EXPECT_EQ(mostSimilar("rrtconect", planners), "RRTConnect");
  EXPECT_EQ(mostSimilar("KPIECE", planners), "KPIECE1");
  EXPECT_EQ(mostSimilar("prm", planners), "PRM");
  EXPECT_EQ(mostSimilar("RTT", planners), "RRT");
  EXPECT_EQ(mostSimilar("w", {"x", "y"}), std::nullopt);
  EXPECT_EQ(mostSimilar("AStar", planners), std::nullopt);
  EXPECT_EQ(mostSimilar(std::string(100000, 'R'), planners), std::nullopt);
  EXPECT_EQ(didYouMean("rrt", planners), " (did you mean \"RRT\"?)");
  EXPECT_EQ(didYouMean("dijkstra", planners), "");
}

TEST(Spelling, PercentSignsOfUris) {
  EXPECT_EQ(percentDecoded("my%20scene%2ebin"), "my scene.bin");
  EXPECT_EQ(percentDecoded("%25%32%30"), "%20") << "once";
  for (const char* const text : {"", "%", "50%", "%2", "%zz", "%2 0", "%00", "a%%"})
    EXPECT_EQ(percentDecoded(text), text);
}

TEST(Spelling, KnownWords) {
  EXPECT_EQ(knownWords({"a", "b"}), " (known: a, b)");
  EXPECT_EQ(knownWords({}), "");
}

TEST(Spelling, QuotesForMessages) {
  EXPECT_EQ(quotedWord("a\nb"), "\"a?b\"");
  EXPECT_EQ(quotedWord("Tür"), "\"Tür\"");
  EXPECT_EQ(quotedWord(std::string(59, 'x') + "ü"), "\"" + std::string(59, 'x') + "…\"");
}

TEST(Spelling, ControlCharactersAreReplaced) {
  EXPECT_EQ(withoutControls("Tür\x1b[2J\t\x7f.yaml"), "Tür?[2J??.yaml");
  EXPECT_EQ(withoutControls("\u009b2J \u202etxt \u2066a\u2069 \u2028b \u00a0 \u200d"),
            "?2J ?txt ?a? ?b \u00a0 \u200d");
  EXPECT_EQ(withoutControls("T\xFCr \xE2\x82 \xC0\x80"), "T?r ?? ??") << "not UTF-8";
}

TEST(QuotedPath, KeepsTheEndOfALongName) {
  EXPECT_EQ(quotedPath("meshes/a\nb.stl"), "\"meshes/a?b.stl\"");
  EXPECT_EQ(quotedPath(std::string(60, 'x')), "\"" + std::string(60, 'x') + "\"");
  EXPECT_EQ(quotedPath(std::string(61, 'x')), "\"…" + std::string(60, 'x') + "\"");
  EXPECT_EQ(quotedPath("ü" + std::string(59, 'x')), "\"…" + std::string(59, 'x') + "\"");
  EXPECT_EQ(quotedPath(std::string(50, 'x') + "/collision/link5.stl"), "\"…/collision/link5.stl\"");
  EXPECT_EQ(quotedPath(std::string(61, 'x') + "/"), "\"…" + std::string(59, 'x') + "/\"");
}

}  // namespace
}  // namespace corridor::test
