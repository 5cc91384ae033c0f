#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <tinyxml2.h>
#include <vector>

#include "collision/core/error.h"

/// Not for users of the library: it brings TinyXML2.
namespace corridor {

/// An XML file and what is wrong in it. "Owner" is whose element it is, for messages: `joint
/// "elbow"`.
class XmlFile {
 public:
  using Element = tinyxml2::XMLElement;

  /// @param what the file is to be, for messages: "a robot (URDF)". Its root is <robot>.
  XmlFile(std::filesystem::path file, const std::string& what);

  /// nullptr: the file is faulted as a whole.
  Element* root() { return root_; }
  const std::filesystem::path& path() const { return path_; }

  void fault(int line, std::string text);
  /// "file:line: text", for notes.
  std::string at(int line, const std::string& text) const;
  bool sound() const { return faultCount_ == 0; }
  /// All, also those that are not kept: of a thousand and more, the first.
  std::size_t faultCount() const { return faultCount_; }
  /// Whether a hint is still worth its time: a file may have any number of faults and of names.
  bool hints() const { return faultCount_ < 100; }
  /// By line.
  std::vector<Fault> takeFaults();

  /// An attribute that must be there and not be empty. nullopt: faulted.
  std::optional<std::string> text(const Element& element, const char* attribute,
                                  const std::string& owner);
  /// An attribute of `count` finite numbers, which is rewritten in plain decimals that every reader
  /// takes for the same doubles. nullopt: not there, or faulted.
  std::optional<std::vector<double>> numbers(Element& element, const char* attribute,
                                             std::size_t count, const std::string& owner);
  /// Faults an attribute that isn't there.
  void require(const Element& element, const char* attribute, const std::string& owner);
  /// The child of that name, if there is one; further ones are faulted.
  Element* child(Element& parent, const char* name, const std::string& owner);
  /// Children that are neither read nor rightly ignored: faulted where something would be lost (the
  /// name is nearly one that is read, or there is a <geometry> within), else noted. Those of other
  /// formats ("drake:joint") are ignored.
  void checkChildren(Element& parent, const std::vector<std::string>& read,
                     const std::vector<std::string>& ignored, const std::string& owner,
                     std::vector<std::string>& notes);
  /// The same for attributes that may be left out.
  void checkAttributes(const Element& element, const std::vector<std::string>& read,
                       const std::string& owner, std::vector<std::string>& notes);

 private:
  void open(const std::string& what);

  std::filesystem::path path_;
  std::vector<Fault> faults_;
  std::size_t faultCount_ = 0;
  tinyxml2::XMLDocument document_;
  Element* root_ = nullptr;
};

/// "joint" and "elbow" to `joint "elbow"`.
std::string owned(const std::string& kind, std::string_view name);

std::string shortestText(double value);

}  // namespace corridor
