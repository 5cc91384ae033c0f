#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tinyxml2.h>
#include <vector>

#include "planner/robot/note.h"
#include "planner/robot/robot_faults.h"

/// Internal: this header includes TinyXML2, which users of the library don't need.
namespace corridor {

/// An XML file with root <robot>, and the list of its faults. In all functions `owner` names the
/// element for messages: `joint "elbow"`.
class XmlFile : public RobotFaults {
 public:
  using Element = tinyxml2::XMLElement;

  /// A file whose name ends in .xacro is expanded first (xacro.h). Line numbers are then those of
  /// the expanded text.
  /// @param what describes the expected file in messages: "a robot (URDF)".
  /// @param xacro arguments of xacro.
  XmlFile(std::filesystem::path file, const std::string& what,
          const std::vector<std::string>& xacro = {});

  /// Returns the root element, or nullptr if the file couldn't be read or has another root. A fault
  /// was then reported.
  Element* root() { return root_; }
  const std::filesystem::path& path() const { return path_; }
  /// Returns the text that xacro made of the file, or "" if it was read as it is.
  const std::string& expanded() const { return expanded_; }

  /// Returns a required attribute, which must not be empty. Returns nullopt if a fault was
  /// reported.
  std::optional<std::string> text(const Element& element, const char* attribute,
                                  const std::string& owner);
  /// Reads an attribute of `count` finite numbers. The attribute is rewritten in plain decimals,
  /// which every reader reads as the same doubles. Returns nullopt if the attribute is missing, or
  /// if a fault was reported.
  std::optional<std::vector<double>> numbers(Element& element, const char* attribute,
                                             std::size_t count, const std::string& owner);
  /// Reports a fault if the element lacks the attribute.
  void require(const Element& element, const char* attribute, const std::string& owner);
  /// Returns the first child of that name, or nullptr if there is none. Reports a fault for each
  /// further child of that name.
  Element* child(Element& parent, const char* name, const std::string& owner);
  /// Checks for children whose names are in neither list. Such a child is a fault if its name is
  /// similar to one in `read`, or if it has collision geometry, because ignoring such a child may
  /// lose data. For the other children, one note is added per name, for at most 100 names. Elements
  /// of other formats ("drake:other") are ignored; a note names those whose name after the colon is
  /// in `read`. An element that includes another file is a fault. If a child in `ignored` has a
  /// <collision> in it, a note says that it is not read. In <gazebo>, only a <collision> with a
  /// <geometry> counts: its extensions have <collision> elements of their own.
  ///
  /// Text in `parent` has no meaning: it is a fault if it seems to have an attribute, since an
  /// element has perhaps lost its "<". Other text is a note, one for each name of `parent` in the
  /// file.
  void checkChildren(Element& parent, const std::vector<std::string>& read,
                     const std::vector<std::string>& ignored, const std::string& owner,
                     std::vector<Note>& notes);
  /// Checks for attributes whose names are not in `read`. Such an attribute is a fault if its name
  /// is similar to one in `read`. For other attributes a note is added: one for each name of an
  /// element and an attribute in the file. Attributes of other formats ("xmlns:xacro") are ignored,
  /// except that a note names those whose name after the colon is in `read`.
  void checkAttributes(const Element& element, const std::vector<std::string>& read,
                       const std::string& owner, std::vector<Note>& notes);
  /// Checks the text in an element that has only elements. `checkChildren` calls this function.
  void checkText(const Element& element, const std::string& owner, std::vector<Note>& notes);
  /// `checkAttributes` for an element that has nothing but attributes. Text in it is a fault, and
  /// so is a child that has the name of an attribute in `read`. Other children are as for
  /// `checkChildren`.
  void checkLeaf(Element& element, const std::vector<std::string>& read, const std::string& owner,
                 std::vector<Note>& notes);

 private:
  void open(const std::string& what, const std::vector<std::string>& xacro);
  /// Returns whether this is the first call with this key.
  bool isFirst(const std::string& key) { return noted_.insert(key).second; }

  std::filesystem::path path_;
  std::string expanded_;
  tinyxml2::XMLDocument document_;
  Element* root_ = nullptr;
  std::set<std::string> noted_;  // kinds of notes that were added
};

/// Calls `read` for each child of that name.
template <class Read>
void forEach(XmlFile::Element& parent, const char* name, const Read& read) {
  for (XmlFile::Element* child = parent.FirstChildElement(name); child;
       child = child->NextSiblingElement(name))
    read(*child);
}

}  // namespace corridor
