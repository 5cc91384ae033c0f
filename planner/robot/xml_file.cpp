#include "planner/robot/xml_file.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "collision/core/decimal_number.h"
#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"
#include "planner/robot/xacro.h"

namespace corridor {
namespace {

constexpr const char* blanks = " \t\r\n";

std::vector<std::string> wordsOf(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

/// Reads a number. Sets `value` and returns "" on success; otherwise returns a complaint.
std::string parseNumber(const std::string& word, double& value) {
  const auto number = decimalNumber(word);
  if (!number) return "a number is needed, not " + quotedWord(word);
  value = *number;
  if (!std::isfinite(value)) return "a finite number is needed, not " + quotedWord(word);
  return "";
}

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

/// Returns the part of a name after its prefix: "xyz" of "u:xyz".
std::string localName(const std::string& name) {
  return name.substr(name.rfind(':') + 1);
}

/// Returns the first text in the element, outside of its children, that is not blank, or nullptr.
const tinyxml2::XMLText* textIn(const XmlFile::Element& element) {
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node; node = node->NextSibling())
    if (const tinyxml2::XMLText* const text = node->ToText();
        text && !wordsOf(text->Value()).empty())
      return text;
  return nullptr;
}

/// Returns whether the text seems to have an attribute: an = and a quote.
bool seemsAttribute(std::string_view text) {
  for (std::size_t equals = text.find('='); equals != text.npos;
       equals = text.find('=', equals + 1)) {
    const std::size_t next = text.find_first_not_of(blanks, equals + 1);
    if (next != text.npos && (text[next] == '"' || text[next] == '\'')) return true;
  }
  return false;
}

/// Returns the text without blanks around it, for messages.
std::string quotedText(const tinyxml2::XMLText& text) {
  std::string joinedWords;
  for (const std::string& word : wordsOf(text.Value()))
    joinedWords += (joinedWords.empty() ? "" : " ") + word;
  return quotedWord(joinedWords);
}

/// Returns a <collision> in the element that has a <geometry>, or nullptr.
const XmlFile::Element* shapedCollisionIn(const XmlFile::Element& element) {
  if (std::string_view(element.Name()) == "collision" && element.FirstChildElement("geometry"))
    return &element;
  for (const XmlFile::Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement())
    if (const XmlFile::Element* const found = shapedCollisionIn(*child)) return found;
  return nullptr;
}

/// Returns whether ignoring the element would lose collision geometry. This is so if the element is
/// or contains a <collision>, or if its name contains "collision" ("collision_model") and it
/// contains a <geometry>.
const XmlFile::Element* collisionIn(const XmlFile::Element& element) {
  const std::string_view name = element.Name();
  if (name == "collision") return &element;
  if (lowered(name).find("collision") != std::string::npos && element.FirstChildElement("geometry"))
    return &element;
  for (const XmlFile::Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement())
    if (const XmlFile::Element* const found = collisionIn(*child)) return found;
  return nullptr;
}

/// Returns the reason why TinyXML2 would need gigabytes (too many elements and attributes) or
/// quadratic time (too many attributes of one element). If there is no such reason, returns "".
/// Entities need no limit: TinyXML2 expands only the five entities that XML itself defines.
std::string whyTooMuch(std::string_view text) {
  constexpr std::size_t mostMarks = 10'000'000, mostInTag = 100;
  std::size_t marks = 0, inTag = 0;
  for (std::size_t at = text.find_first_of("<="); at != text.npos;
       at = text.find_first_of("<=", at + 1)) {
    if (text[at] == '<') {
      inTag = 0;
    } else {
      const std::size_t next = text.find_first_not_of(blanks, at + 1);
      if (next == text.npos || (text[next] != '"' && text[next] != '\'')) continue;
      ++inTag;
    }
    if (++marks > mostMarks)
      return "has more than " + std::to_string(mostMarks) + " tags and attributes";
    if (inTag > mostInTag)
      return "has a tag of more than " + std::to_string(mostInTag) + " attributes";
  }
  return "";
}

std::string explained(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute cannot be read; name=\"value\" is needed";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element cannot be read";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "the element that begins here has no end tag of its own name";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment is not closed";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deep";
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "there is no element";
    default:
      return "text, an element or an end tag is misplaced";
  }
}

/// Returns whether a <robot> is opened and never closed.
bool isUnclosed(std::string_view text) {
  const std::size_t robot = text.find("<robot");
  if (robot == text.npos || text.find("</robot", robot) != text.npos) return false;
  const std::size_t end = text.find('>', robot);
  return end == text.npos || text[end - 1] != '/';
}

}  // namespace

XmlFile::XmlFile(std::filesystem::path file, const std::string& what,
                 const std::vector<std::string>& xacro)
    : RobotFaults(file.string()), path_(std::move(file)) {
  open(what, xacro);
}

namespace {

/// Returns whether a declaration "DOCTYPE robot …" may set attributes or entities. TinyXML-2 ends
/// it at the first >, also within a quoted name, behind which declarations may follow.
bool mayDeclare(std::string_view text) {
  char quote = 0;
  for (const char c : text)
    if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? '\0' : c;
  return quote || !text.starts_with("DOCTYPE") || text.find_first_of("[<") != text.npos;
}

}  // namespace

void XmlFile::open(const std::string& what, const std::vector<std::string>& xacro) {
  std::string text;
  try {
    if (isXacro(path_)) {
      text = expanded_ = expandXacro(path_, xacro);
      if (!text.empty()) setLabel(path_.string() + ", expanded by xacro");
    } else {
      text = xmlAsUtf8(readTextFile(path_, what), path_.string());
    }
  } catch (const InputError& error) {
    return setFaults(error.faults());
  }
  if (const std::string why = whyTooMuch(text); !why.empty()) return fault(0, why);
  if (const auto error = document_.Parse(text.data(), text.size()); error != tinyxml2::XML_SUCCESS)
    return fault(document_.ErrorLineNum(),
                 "is not valid XML: " + explained(error) +
                     (error != tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED && isUnclosed(text)
                          ? "; there is no </robot>, so the file may end early"
                          : ""));
  for (const auto* node = document_.FirstChild(); node; node = node->NextSibling())
    if (node->ToText() || (node->ToUnknown() && mayDeclare(node->Value())))
      return fault(node->GetLineNum(),
                   "a DOCTYPE with declarations is not read; save the file without it");
  Element* const first = document_.RootElement();
  if (!first) return fault(0, "<robot> is missing; " + what + " is needed");
  if (std::string_view(first->Name()) != "robot")
    return fault(first->GetLineNum(), "the root element is <" + std::string(first->Name()) +
                                          ">, not <robot>; " + what + " is needed");
  if (const Element* second = first->NextSiblingElement())
    return fault(second->GetLineNum(),
                 "another element follows </robot>; only one root is allowed");
  root_ = first;
}

void XmlFile::require(const Element& element, const char* attribute, const std::string& owner) {
  if (!element.FindAttribute(attribute))
    fault(element.GetLineNum(), owner + ": <" + element.Name() + "> has no " + attribute);
}

std::optional<std::string> XmlFile::text(const Element& element, const char* attribute,
                                         const std::string& owner) {
  const tinyxml2::XMLAttribute* const found = element.FindAttribute(attribute);
  if (found && *found->Value()) return found->Value();
  fault(element.GetLineNum(),
        (owner.empty() ? "" : owner + ": ") + "<" + element.Name() + "> has no " + attribute);
  return std::nullopt;
}

std::optional<std::vector<double>> XmlFile::numbers(Element& element, const char* attribute,
                                                    std::size_t count, const std::string& owner) {
  const tinyxml2::XMLAttribute* const found = element.FindAttribute(attribute);
  if (!found) return std::nullopt;
  const auto complain = [&](const std::string& complaint) {
    fault(found->GetLineNum(), owner + ": " + element.Name() + " " + attribute + ": " + complaint);
    return std::nullopt;
  };
  const std::vector<std::string> words = wordsOf(found->Value());
  if (words.size() != count)
    return complain((count == 1 ? "a number is" : std::to_string(count) + " numbers are") +
                    " needed, not " + quotedWord(found->Value()));
  std::vector<double> values(count);
  std::string plain;
  for (std::size_t i = 0; i < count; ++i) {
    if (const std::string complaint = parseNumber(words[i], values[i]); !complaint.empty())
      return complain(complaint);
    plain += (i == 0 ? "" : " ") + shortest(values[i]);
  }
  element.SetAttribute(attribute, plain.c_str());
  return values;
}

XmlFile::Element* XmlFile::child(Element& parent, const char* name, const std::string& owner) {
  Element* const first = parent.FirstChildElement(name);
  if (!first) return nullptr;
  for (Element* next = first->NextSiblingElement(name); next; next = next->NextSiblingElement(name))
    fault(next->GetLineNum(), owner + ": a second <" + name + ">; the first is on line " +
                                  std::to_string(first->GetLineNum()) + "; only one is allowed");
  return first;
}

void XmlFile::checkChildren(Element& parent, const std::vector<std::string>& read,
                            const std::vector<std::string>& ignored, const std::string& owner,
                            std::vector<Note>& notes) {
  constexpr std::size_t mostNames = 100;
  std::vector<std::string> known = read;
  known.insert(known.end(), ignored.begin(), ignored.end());
  std::set<std::string> noted;
  checkText(parent, owner, notes);
  for (Element* element = parent.FirstChildElement(); element;
       element = element->NextSiblingElement()) {
    const std::string name = element->Name();
    if (contains(read, name)) continue;
    if (contains(ignored, name)) {
      if (const Element* const lost =
              name == "gazebo" ? shapedCollisionIn(*element) : collisionIn(*element);
          lost && isFirst("collision in " + name))
        notes.push_back({at(lost->GetLineNum(), owner + ": the <collision> in <" + name +
                                                    "> is not read; move it into its <link>"),
                         NoteWeight::coverage});
      continue;
    }
    const std::string local = localName(name);
    if (local == "include") {
      fault(element->GetLineNum(), owner + ": <" + name +
                                       ">: files are not included; put the elements of that file "
                                       "into this one");
      continue;
    }
    const std::string unknown = owner + ": <" + name + "> is not known";
    const auto near = mostSimilar(name, known);
    const std::string hint = near ? " (did you mean <" + *near + ">?)" : "";
    if (near && contains(read, *near))
      fault(element->GetLineNum(), unknown + hint);
    else if (collisionIn(*element))
      fault(element->GetLineNum(), unknown + ", and the collision geometry in it would be lost" +
                                       hint +
                                       "; move it into the <collision> of its link, or remove it");
    else if (local != name && contains(read, local) && noted.size() < mostNames &&
             noted.insert(name).second)
      notes.push_back({at(element->GetLineNum(), owner + ": <" + name +
                                                     "> belongs to another format, and is not "
                                                     "read; <" +
                                                     local + "> would be"),
                       NoteWeight::coverage});
    else if (local == name && noted.size() < mostNames && noted.insert(name).second)
      notes.push_back({at(element->GetLineNum(), unknown + ", and is ignored" + hint)});
  }
}

void XmlFile::checkAttributes(const Element& element, const std::vector<std::string>& read,
                              const std::string& owner, std::vector<Note>& notes) {
  for (const tinyxml2::XMLAttribute* attribute = element.FirstAttribute(); attribute;
       attribute = attribute->Next()) {
    const std::string name = attribute->Name();
    const std::string local = localName(name);
    if (contains(read, name)) continue;
    if (local != name) {
      if (contains(read, local) && isFirst(std::string(element.Name()) + "/" + name))
        notes.push_back({at(attribute->GetLineNum(), owner + ": " + element.Name() + ": " + name +
                                                         " belongs to another format, and is not "
                                                         "read; " +
                                                         local + " would be"),
                         NoteWeight::coverage});
      continue;
    }
    const std::string unknown = owner + ": " + element.Name() + ": " + name + " is not known";
    if (const std::string hint = didYouMean(name, read); !hint.empty())
      fault(attribute->GetLineNum(), unknown + hint);
    else if (isFirst(std::string(element.Name()) + "/" + name))
      notes.push_back({at(attribute->GetLineNum(), unknown + ", and is ignored")});
  }
}

void XmlFile::checkLeaf(Element& element, const std::vector<std::string>& read,
                        const std::string& owner, std::vector<Note>& notes) {
  checkAttributes(element, read, owner, notes);
  const std::string place = owner + ": <" + element.Name() + ">: ";
  const std::string advice = "; values are attributes: " + joined(read);
  if (const tinyxml2::XMLText* const text = textIn(element))
    return fault(text->GetLineNum(),
                 place + "the text " + quotedText(*text) + " is not read" + advice);
  for (const Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement())
    if (contains(read, localName(child->Name())))
      return fault(child->GetLineNum(), place + "<" + child->Name() + "> is not read" + advice);
    else if (localName(child->Name()) != child->Name() &&
             isFirst(std::string(element.Name()) + "/" + child->Name()))
      notes.push_back({at(child->GetLineNum(), place + "<" + child->Name() +
                                                   "> belongs to another format, and is not read"),
                       NoteWeight::coverage});
  checkChildren(element, {}, {}, owner + ": " + element.Name(), notes);
}

void XmlFile::checkText(const Element& element, const std::string& owner,
                        std::vector<Note>& notes) {
  const tinyxml2::XMLText* const text = textIn(element);
  if (!text) return;
  const std::string said =
      owner + ": the text " + quotedText(*text) + " in <" + element.Name() + "> is not read";
  if (seemsAttribute(text->Value()))
    fault(text->GetLineNum(), said + "; has an element lost its \"<\"?");
  else if (isFirst("text in " + std::string(element.Name())))
    notes.push_back({at(text->GetLineNum(), said), NoteWeight::coverage});
}

}  // namespace corridor
