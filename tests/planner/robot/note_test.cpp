#include "planner/robot/note.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corridor {
namespace {

using testing::ElementsAre;

TEST(Notes, AreSortedByWeightAndElseKeepTheirOrder) {
  EXPECT_THAT(textsOf({{"a"},
                       {"b", NoteWeight::motion},
                       {"c", NoteWeight::coverage},
                       {"d"},
                       {"e", NoteWeight::coverage}}),
              ElementsAre("c", "e", "b", "a", "d"));
}

TEST(Notes, AreKeptWithFaults) {
  std::vector<Note> notes;
  try {
    readWithNotes(notes, [&] {
      notes.push_back({"a note"});
      throw InputError(Fault{"file", 1, "a fault"});
    });
    FAIL();
  } catch (const NotedInputError& error) {
    EXPECT_STREQ(error.what(), "file:1: a fault");
    EXPECT_THAT(textsOf(error.notes()), ElementsAre("a note"));
  }
}

}  // namespace
}  // namespace corridor
