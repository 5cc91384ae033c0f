// Tests of how texts are written into YAML files.
#include "planner/problem/text_words.h"

#include <vector>

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(TextWords, ControlCharactersAreEscapedInYaml) {
  EXPECT_EQ(yamlText("a\x1b[31m\n\"b\"\\c\x7f \u2265"),
            "\"a\\x1b[31m\\x0a\\\"b\\\"\\\\c\\x7f \u2265\"");
}

TEST(TextWords, QuotedWordsMayHaveAnyCharacter) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(wordsOfLine("a, b\tc # d"), (Words{"a", "b", "c"}));
  EXPECT_EQ(wordsOfLine(R"("Revolute 1","a,b" "x # y" # z "c")"),
            (Words{"Revolute 1", "a,b", "x # y"}));
  EXPECT_EQ(wordsOfLine(R"("a ""b""",c,"d"#e)"), (Words{"a \"b\"", "c", "d"}));
  // A quote that is not closed, or not at the beginning of a word, is a character.
  EXPECT_EQ(wordsOfLine(R"("a b)"), (Words{"\"a", "b"}));
  EXPECT_EQ(wordsOfLine(R"(5" pipe,"" "a"b)"), (Words{"5\"", "pipe", "\"\"", "\"a\"b"}));
  EXPECT_EQ(commentStart(R"("a # b", c # d)"), 11u);
  EXPECT_EQ(commentStart("a b"), std::string::npos);
}

}  // namespace
}  // namespace corridor
