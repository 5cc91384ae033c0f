// Tests of the exception for bad input.
#include "collision/core/error.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(InputError, ControlCharactersAreReplaced) {
  const InputError error(Fault{"a\x1b[2J\n.obj", 3, "bad\tword\x7f \u2265"});
  EXPECT_STREQ(error.what(), "a?[2J?.obj:3: bad?word? \u2265");
  ASSERT_EQ(error.faults().size(), 1u);
  EXPECT_EQ(error.faults()[0], (Fault{"a?[2J?.obj", 3, "bad?word? \u2265"}));
}

TEST(Fault, LinesAndFilesAreOptional) {
  EXPECT_EQ((Fault{"a.obj", 3, "x"}).str(), "a.obj:3: x");
  EXPECT_EQ((Fault{"a.obj", 0, "x"}).str(), "a.obj: x");
  EXPECT_EQ((Fault{"", 3, "x"}).str(), "line 3: x");
  EXPECT_EQ((Fault{"", 0, "x"}).str(), "x");
}

}  // namespace
}  // namespace corridor
