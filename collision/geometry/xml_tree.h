#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <tinyxml2.h>
#include <vector>

#include "collision/geometry/mesh_text.h"

/// Strict reading of XML in mesh files: each element and each attribute that is met is known, is a
/// fault, or is noted. Internal: included by the readers of Collada and 3MF only.
namespace corridor::xml {

using Element = tinyxml2::XMLElement;

/// Parses a document and returns its root. @throws InputError if it is no complete XML, if its root
/// has another name, or if its DOCTYPE has declarations.
const Element& parse(tinyxml2::XMLDocument& document, std::string_view text, const char* root,
                     MeshFaults& faults);

inline std::string_view nameOf(const Element& element) {
  return element.Name();
}
/// Returns the value of an attribute; nullopt without it.
std::optional<std::string_view> attribute(const Element& element, const char* name);
/// Returns the value of an attribute. Adds a fault and returns "" without it.
std::string_view required(const Element& element, const char* name, MeshFaults& faults);

/// Adds a fault if an element says that it is of another namespace than the root.
void requireNamespace(const Element& element, MeshFaults& faults);
/// Adds a fault for a text in an element that has only elements.
void requireNoText(const Element& element, MeshFaults& faults);
/// Checks an element's children and attributes. Attributes that are not known are added to `notes`;
/// names in another case, children of other names or namespaces, and texts are faults. In Collada,
/// `<extra>`, which is for the program that wrote it, is skipped. Without `children`, a text is
/// allowed.
/// @param isOther  if not null, says of other children whether they may be there, unread
void check(const Element& element, std::initializer_list<std::string_view> children,
           std::initializer_list<std::string_view> attributes, MeshFaults& faults,
           std::vector<std::string>& notes, bool (*isOther)(std::string_view) = nullptr);

std::size_t childCount(const Element& element);
/// Returns the children of an element that have this name.
std::vector<const Element*> childrenOf(const Element& element, const char* name);
/// Returns the only child of this name; null if there is none. Adds a fault if there are several.
const Element* onlyChild(const Element& element, const char* name, MeshFaults& faults);

/// Returns the text of an element, comments left out. Adds a fault if it has elements.
std::string textOf(const Element& element, MeshFaults& faults);
/// Reads the numbers of a text in which they are separated by blanks. Adds a fault, and returns
/// fewer numbers, if one is not a finite number, or is not 0 or from 1e-250 to 1e250.
std::vector<double> numbersIn(std::string_view text, const std::string& place, int line,
                              MeshFaults& faults);
/// The same for whole numbers from 0 to 2^31 - 1.
std::vector<std::uint32_t> indicesIn(std::string_view text, const std::string& place, int line,
                                     MeshFaults& faults);
/// Returns the whole number from 0 to 2^31 - 1 in an attribute, or `otherwise` without the
/// attribute. Adds a fault for another value, and returns 0.
std::uint32_t wholeNumber(const Element& element, const char* name,
                          std::optional<std::uint32_t> otherwise, MeshFaults& faults);

}  // namespace corridor::xml
