#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "planner/robot/robot_description.h"
#include "planner/robot/xml_file.h"

/// Internal to readSrdf(): finds the links and joints that an SRDF names.
namespace corridor {

/// Unique names with their indices.
class NameIndex {
 public:
  void add(const std::string& name) {
    indices_.emplace(name, names_.size());
    names_.push_back(name);
  }
  /// Returns the index of a name, or nullopt for an unknown name.
  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = indices_.find(name);
    return found == indices_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::vector<std::string>& all() const { return names_; }
  const std::string& operator[](std::size_t i) const { return names_[i]; }
  std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> indices_;
};

/// The names, in SRDF elements of one kind, that do not occur in the URDF.
class UnknownNames {
 public:
  void add(const XmlFile::Element& element, const std::string& name);
  void add(const UnknownNames& other);

  const std::vector<std::string>& names() const { return names_; }  ///< each once
  std::size_t count() const { return count_; }  ///< number of elements with such a name
  int line() const { return line_; }            ///< line of the first such element

 private:
  void addName(const std::string& name);

  std::vector<std::string> names_;
  std::unordered_set<std::string> seen_;
  std::size_t count_ = 0;
  int line_ = 0;
  const XmlFile::Element* last_ = nullptr;
};

/// Finds the links and joints of a robot by the names in an SRDF, and counts unknown names.
class SrdfNames {
 public:
  SrdfNames(XmlFile& file, const RobotDescription& model);

  const NameIndex& links() const { return links_; }
  const NameIndex& joints() const { return joints_; }

  /// Adds a virtual joint, unless the URDF has a joint of this name. `findJoint` does not find a
  /// virtual joint, and does not report it as unknown either. Virtual joints are not used, because
  /// the problem file places the robot in the world.
  /// @param moves whether the virtual joint is planar or floating.
  /// @returns whether the virtual joint was added.
  bool addVirtual(const std::string& joint, bool moves);
  bool isVirtual(const std::string& joint) const { return virtualJoints_.contains(joint); }
  /// Returns whether `joint` is a virtual joint that was added with `moves`.
  bool isMovingVirtual(const std::string& joint) const {
    const auto found = virtualJoints_.find(joint);
    return found != virtualJoints_.end() && found->second;
  }

  /// Return the index of the link or joint that an attribute names. nullopt: the attribute is
  /// missing (a fault was reported), the name was added to `unknown`, or the name is that of a
  /// virtual joint.
  std::optional<std::size_t> findLink(const XmlFile::Element& element, const char* attribute,
                                      const std::string& owner, UnknownNames& unknown);
  std::optional<std::size_t> findJoint(const XmlFile::Element& element, const char* attribute,
                                       const std::string& owner, UnknownNames& unknown);

  /// Adds a note that counts the elements with unknown names and lists these names: "1 " + `one` +
  /// "a", or "5 " + `many` + the names, of which at most three are listed. A single name gets a
  /// suggestion, except root_joint: many SRDF files give this virtual joint a value without
  /// declaring it, and no joint of the URDF is meant.
  void note(const UnknownNames& unknown, const std::string& one, const std::string& many,
            std::vector<Note>& notes) const;
  /// Returns the note that the file seems to be made for another robot, or nullopt. The note is
  /// given if at least five names, and at least half of all names, are unknown.
  std::optional<std::string> noteOnOtherRobot() const;

 private:
  std::optional<std::size_t> find(const XmlFile::Element& element, const char* attribute,
                                  const std::string& owner, const NameIndex& known,
                                  UnknownNames& unknown);

  XmlFile& file_;
  NameIndex links_, joints_;
  std::unordered_map<std::string, bool> virtualJoints_;  // value: `moves` of addVirtual
  std::unordered_set<std::string> used_, unknown_;       // names of links and joints in the SRDF
};

}  // namespace corridor
