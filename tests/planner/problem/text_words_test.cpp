// Tests of how texts are written into YAML files.
#include "planner/problem/text_words.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(TextWords, ControlCharactersAreEscapedInYaml) {
  EXPECT_EQ(yamlText("a\x1b[31m\n\"b\"\\c\x7f \u2265"),
            "\"a\\x1b[31m\\x0a\\\"b\\\"\\\\c\\x7f \u2265\"");
}

}  // namespace
}  // namespace corridor
