#include "collision/geometry/xml_tree.h"

#include <algorithm>
#include <charconv>

#include "collision/core/spelling.h"
#include "collision/geometry/scene_mesh.h"

namespace corridor::xml {
namespace {

/// Returns whether a DOCTYPE, whose text is cut at the first ">", has declarations or is cut within
/// quotes.
bool hasDeclarations(std::string_view doctype) {
  char quote = 0;
  for (const char c : doctype) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '<' || c == '?') {
      return true;
    }
  }
  return quote != 0;
}

/// Returns the first reference to a character by its number that names no character, such as `&#0;`
/// and `&#x110000;`; "" if there is none. At some of them TinyXML2 would cut a text.
std::string_view wrongReference(std::string_view text) {
  for (auto at = text.find("&#"); at != text.npos; at = text.find("&#", at + 2)) {
    std::string_view rest = text.substr(at + 2);
    const bool isHex = rest.starts_with('x');
    if (isHex) rest.remove_prefix(1);
    std::uint32_t value = 0;
    const auto [end, error] =
        std::from_chars(rest.data(), rest.data() + rest.size(), value, isHex ? 16 : 10);
    if (error != std::errc() || end == rest.data() + rest.size() || *end != ';' || value == 0 ||
        value > 0x10FFFF)
      return text.substr(at, std::min<std::size_t>(text.find(';', at) + 1 - at, 10));
  }
  return "";
}

bool isCollada(const Element& element) {
  return std::string_view(element.GetDocument()->RootElement()->Name()) == "COLLADA";
}

std::string tag(const Element& element) {
  return "<" + printable(element.Name()) + ">";
}

bool contains(std::initializer_list<std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

const Element& parse(tinyxml2::XMLDocument& document, std::string_view text, const char* root,
                     MeshFaults& faults) {
  if (text.find('\0') != text.npos)
    faults.fail(0, "has a byte 0, so it is no XML in UTF-8; save it in UTF-8");
  if (const std::string_view wrong = wrongReference(text); !wrong.empty())
    faults.fail(0, "has a reference " + inQuotes(wrong) + " to no character; correct it");
  const tinyxml2::XMLError error = document.Parse(text.data(), text.size());
  if (error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    faults.fail(document.ErrorLineNum(),
                "elements nest too deeply; save the mesh with fewer "
                "levels of nodes");
  if (error == tinyxml2::XML_ERROR_PARSING_ATTRIBUTE)
    faults.fail(document.ErrorLineNum(),
                "is no complete XML: an attribute is damaged, or there twice");
  if (error == tinyxml2::XML_ERROR_MISMATCHED_ELEMENT)
    faults.fail(document.ErrorLineNum(), "is no complete XML: an element is not closed");
  if (error == tinyxml2::XML_ERROR_PARSING_DECLARATION)
    faults.fail(document.ErrorLineNum(),
                "has a processing instruction (<?…?>) within an element; remove it");
  if (error != tinyxml2::XML_SUCCESS)
    faults.fail(document.ErrorLineNum(),
                "is no complete XML; it may be cut off, so save the mesh again");
  const Element* found = nullptr;
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToComment() || node->ToDeclaration()) continue;
    if (node->ToUnknown()) {
      if (found || !std::string_view(node->Value()).starts_with("DOCTYPE") ||
          hasDeclarations(node->Value()))
        faults.fail(node->GetLineNum(),
                    "a DOCTYPE with declarations is not read; save the file without it");
      continue;
    }
    if (!node->ToElement() || found)
      faults.fail(node->GetLineNum(), "something comes before or after the root element");
    found = node->ToElement();
  }
  if (found && attribute(*found, "xml:base"))
    faults.fail(found->GetLineNum(), "xml:base is not read; remove it");
  if (!found || nameOf(*found) != root)
    faults.fail(found ? found->GetLineNum() : 0,
                "the root element must be <" + std::string(root) + ">" +
                    (found ? ", not " + tag(*found) : std::string()));
  return *found;
}

std::optional<std::string_view> attribute(const Element& element, const char* name) {
  const char* const value = element.Attribute(name);
  return value ? std::optional<std::string_view>(value) : std::nullopt;
}

std::string_view required(const Element& element, const char* name, MeshFaults& faults) {
  const auto value = attribute(element, name);
  if (!value)
    faults.add(element.GetLineNum(),
               tag(element) + " has no " + name + "; add it, or remove the element");
  return value.value_or("");
}

void requireNamespace(const Element& element, MeshFaults& faults) {
  const auto own = attribute(element, "xmlns");
  if (own && own != attribute(*element.GetDocument()->RootElement(), "xmlns"))
    faults.add(element.GetLineNum(), tag(element) + " is of another namespace than the file, " +
                                         inQuotes(*own) + ", which is not read; remove it");
}

void requireNoText(const Element& element, MeshFaults& faults) {
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node; node = node->NextSibling())
    if (const auto* const text = node->ToText();
        text &&
        std::string_view(text->Value()).find_first_not_of(" \t\r\n") != std::string_view::npos)
      faults.add(node->GetLineNum(),
                 tag(element) + " has the text " + inQuotes(text->Value()) + "; remove it");
}

/// Returns whether an attribute with a prefix is known to say nothing about the geometry: those of
/// XML itself, of schemas, and the numbers by which 3MF names elements.
static bool isWithoutGeometry(std::string_view attribute) {
  return attribute.starts_with("xmlns:") || attribute.starts_with("xml:") ||
         attribute.starts_with("xsi:") || attribute.ends_with(":UUID");
}

void check(const Element& element, std::initializer_list<std::string_view> children,
           std::initializer_list<std::string_view> attributes, MeshFaults& faults,
           std::vector<std::string>& notes, bool (*isOther)(std::string_view)) {
  if (children.size() > 0) requireNoText(element, faults);
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToUnknown())
      faults.add(node->GetLineNum(), "<!" + printable(node->Value()) + "> is not read; remove it");
    const Element* const child = node->ToElement();
    if (!child) continue;
    const std::string_view name = child->Name();
    if (contains(children, name)) {
      if (name != "technique")
        requireNamespace(*child, faults);  // one of another program is skipped
      continue;
    }
    if ((name == "extra" && isCollada(element)) || (isOther && isOther(name))) continue;
    if (const auto colon = name.find(':');
        colon != name.npos && contains(children, name.substr(colon + 1))) {
      faults.add(child->GetLineNum(), tag(*child) +
                                          " has a namespace prefix, with which it is not read; "
                                          "remove the prefix");
    } else {
      faults.add(child->GetLineNum(), tag(*child) + " is not supported in " + tag(element) +
                                          ", and may be or move geometry; remove it, or save the "
                                          "mesh as OBJ, STL, PLY or OFF");
    }
  }
  int count = 0;
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
    if (++count > 100) faults.fail(element.GetLineNum(), tag(element) + " has over 100 attributes");
    const std::string_view name = a->Name();
    if (name == "xml:base") faults.add(element.GetLineNum(), "xml:base is not read; remove it");
    if (contains(attributes, name) || name == "xmlns" || isWithoutGeometry(name)) continue;
    const auto meant = std::find_if(
        attributes.begin(), attributes.end(),
        [&](std::string_view known) { return lowered(known) == lowered(std::string(name)); });
    if (meant != attributes.end())
      faults.add(element.GetLineNum(), "the attribute " + inQuotes(name) + " of " + tag(element) +
                                           " is not read; write " + inQuotes(*meant));
    else
      addNote(notes, "the attribute " + inQuotes(name) + " of " + tag(element) + " is not read");
  }
}

std::size_t childCount(const Element& element) {
  std::size_t count = 0;
  for (const auto* node = element.FirstChild(); node; node = node->NextSibling()) ++count;
  return count;
}

std::vector<const Element*> childrenOf(const Element& element, const char* name) {
  std::vector<const Element*> found;
  for (const Element* child = element.FirstChildElement(name); child;
       child = child->NextSiblingElement(name))
    found.push_back(child);
  return found;
}

const Element* onlyChild(const Element& element, const char* name, MeshFaults& faults) {
  const Element* const child = element.FirstChildElement(name);
  if (const Element* const second = child ? child->NextSiblingElement(name) : nullptr)
    faults.add(second->GetLineNum(),
               "a second <" + std::string(name) + "> is in one " + tag(element));
  return child;
}

std::string textOf(const Element& element, MeshFaults& faults) {
  std::string text;
  // TinyXML2 drops a blank that is alone between two comments or CDATA sections.
  bool mayLackBlank = false, wasPlain = true;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node; node = node->NextSibling()) {
    const tinyxml2::XMLText* const part = node->ToText();
    const bool isPlain = part && !part->CData();
    mayLackBlank |= !isPlain && !wasPlain && !text.empty();
    wasPlain = isPlain;
    if (part && mayLackBlank)
      faults.add(node->GetLineNum(),
                 "comments or CDATA are within the text of " + tag(element) + "; remove them");
    if (part) text += part->Value();
    if (node->ToElement() || node->ToUnknown())
      faults.add(node->GetLineNum(), "an element is in " + tag(element) + "; remove it");
  }
  return text;
}

std::vector<double> numbersIn(std::string_view text, const std::string& place, int line,
                              MeshFaults& faults) {
  std::vector<double> numbers;
  TextCursor cursor(text, line);
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word()) {
    double number = 0;
    std::string wrong = parseCoordinate(word, number).value_or("");
    if (wrong.empty()) wrong = wrongMagnitude(number);
    if (wrong.empty() && isRoundedToZero(word, number))
      wrong = "the number " + std::string(word) + " is not 0 or from 1e-250 to 1e250";
    if (!wrong.empty()) {
      faults.add(cursor.line(), place + ": " + wrong);
      return numbers;
    }
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<std::uint32_t> indicesIn(std::string_view text, const std::string& place, int line,
                                     MeshFaults& faults) {
  std::vector<std::uint32_t> indices;
  TextCursor cursor(text, line);
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word()) {
    std::int64_t number = -1;
    if (!parseInteger(word, number) || number < 0 || number > INT32_MAX) {
      faults.add(cursor.line(),
                 place + ": " + inQuotes(word) + " is no whole number from 0 to 2^31 - 1");
      return indices;
    }
    indices.push_back(static_cast<std::uint32_t>(number));
  }
  return indices;
}

std::uint32_t wholeNumber(const Element& element, const char* name,
                          std::optional<std::uint32_t> otherwise, MeshFaults& faults) {
  const auto value = attribute(element, name);
  if (!value && otherwise) return *otherwise;
  const auto numbers = indicesIn(required(element, name, faults), tag(element) + " " + name,
                                 element.GetLineNum(), faults);
  if (value && numbers.size() != 1)
    faults.add(element.GetLineNum(), tag(element) + " needs one whole number as its " + name);
  return numbers.size() == 1 ? numbers[0] : 0;
}

}  // namespace corridor::xml
