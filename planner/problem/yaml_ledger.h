#pragma once

#include <string>
#include <vector>

#include "planner/problem/yaml_value.h"
#include "planner/robot/note.h"

/// What a reader left unread in a YAML document. A proof must not depend on a value that was
/// dropped in silence: each value is used, is a fault, or is in a note.
namespace corridor {

/// A key that no reader has read, or several such keys that differ only in the index of a list's
/// item.
struct UnreadKey {
  std::string path;       ///< "world.collision_objects[].type"
  int line = 0;           ///< of the first such key
  std::size_t count = 1;  ///< number of such keys
};

/// Whether values that messages of ROS have by default count as unread: 0, false, "", an empty list
/// or map, and a list or map of such values only.
enum class DefaultValues { count, sayNothing };

/// Returns the keys that were neither read nor ignored, in the order of the file. If a map was
/// never opened although its key was read, the result has the key of the map.
std::vector<UnreadKey> unreadKeys(const YamlValue& document, DefaultValues defaults);

/// Returns one note that lists the unread keys of a file, or no note if there is none.
/// @param file for the note's text.
std::vector<Note> notesOnUnread(const YamlValue& document, const std::string& file,
                                DefaultValues defaults);

/// Marks a value and all values in it as read.
void markRead(const YamlValue& value);

}  // namespace corridor
