#pragma once

#include <string>
#include <vector>

#include "collision/core/error.h"

namespace corridor {

/// The importance of a note. The enumerators begin with the most important one.
enum class NoteWeight {
  coverage,  ///< a proof may cover less, or something else, than the user expects
  motion,    ///< values, limits or joints differ from those in a file
  detail     ///< other decisions of the reader, and content that it ignored without harm
};

/// A decision of a reader that a user may want to know.
struct Note {
  std::string text;
  NoteWeight weight = NoteWeight::detail;
};

/// Returns the texts of the notes, the most important first. Notes of the same weight keep their
/// order.
std::vector<std::string> textsOf(const std::vector<Note>& notes);

/// Appends the notes in `from` to `to`.
inline void addAll(const std::vector<Note>& from, std::vector<Note>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

/// An error in the input, with the notes on what was read before the error.
class NotedInputError : public InputError {
 public:
  NotedInputError(std::vector<Fault> faults, std::vector<Note> notes)
      : InputError(std::move(faults)), notes_(std::move(notes)) {}

  const std::vector<Note>& notes() const { return notes_; }

 private:
  std::vector<Note> notes_;
};

/// Calls `read`, which adds notes to `notes`. If `read` throws an InputError, this function throws
/// a NotedInputError with the same faults, and with the notes that were added before.
template <class Read>
void readWithNotes(const std::vector<Note>& notes, const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    throw NotedInputError(error.faults(), notes);
  }
}

}  // namespace corridor
