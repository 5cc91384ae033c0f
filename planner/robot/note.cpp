#include "planner/robot/note.h"

namespace corridor {

std::vector<std::string> textsOf(const std::vector<Note>& notes) {
  std::vector<std::string> texts;
  for (const NoteWeight weight : {NoteWeight::coverage, NoteWeight::motion, NoteWeight::detail})
    for (const Note& note : notes)
      if (note.weight == weight) texts.push_back(note.text);
  return texts;
}

}  // namespace corridor
