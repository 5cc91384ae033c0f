#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "collision/geometry/mesh_text.h"

/// Strict reading of the JSON of glTF files. Internal: included by the reader of glTF only.
namespace corridor::gltf {

using Json = nlohmann::json;

/// Parses a text. @throws InputError if it is no JSON, or if an object has a key twice: parsers
/// differ in which they take.
Json parse(std::string_view text, MeshFaults& faults);

/// Returns a member of an object; null if there is none.
const Json* find(const Json& object, const char* name);
/// Returns a member of an object; a JSON null if there is none.
const Json& member(const Json& object, const char* name);

/// A glTF file while it is read: its JSON, and what was found in it.
class Document {
 public:
  Document(const Json& root, MeshFaults& faults) : root_(root), faults_(faults) {}

  const Json& root() const { return root_; }
  MeshFaults& faults() { return faults_; }
  void fault(const std::string& text) { faults_.add(0, text); }
  const std::vector<std::string>& notes() const { return notes_; }
  void note(const std::string& text);

  /// Checks that a value is an object. Adds faults for keys whose letters have another case than
  /// one of the known keys, and a note on each key that is not known.
  /// @param what the name of the object in messages, such as "node 3"
  void check(const Json& object, const std::string& what,
             std::initializer_list<std::string_view> known);
  /// Checks the extensions of the file, and those that objects have. Extensions that move, copy or
  /// pack geometry, and required ones that are not about looks, are faults; others are noted.
  void checkExtensions();

  /// Returns a member that is a whole number from 0 to 2^31 - 1; nullopt without the member. Adds a
  /// fault for another value.
  std::optional<std::uint32_t> whole(const Json& object, const char* name, const std::string& what);
  /// Returns the whole numbers of a member that is an array; none without the member.
  std::vector<std::uint32_t> wholes(const Json& object, const char* name, const std::string& what);
  /// Returns the numbers of a member that is an array of `count` numbers, each 0 or from 1e-250 to
  /// 1e250; nothing without the member. Adds a fault for another value.
  std::optional<std::vector<double>> numbers(const Json& object, const char* name,
                                             std::size_t count, const std::string& what);
  /// Returns an element of a list of the file; null, after a fault, if there is none.
  const Json* elementOf(const char* list, std::uint32_t index, const std::string& what);
  /// Returns the element of a list to which a member of an object refers; null without the member.
  const Json* referred(const Json& object, const char* name, const char* list,
                       const std::string& what);

 private:
  void checkExtension(const std::string& name, bool isRequired);

  const Json& root_;
  MeshFaults& faults_;
  std::vector<std::string> notes_;
};

}  // namespace corridor::gltf
