#include "planner/robot/srdf_names.h"

#include "collision/core/spelling.h"

namespace corridor {

void UnknownNames::add(const XmlFile::Element& element, const std::string& name) {
  if (line_ == 0) line_ = element.GetLineNum();
  if (&element != last_) ++count_;
  last_ = &element;
  addName(name);
}

void UnknownNames::add(const UnknownNames& other) {
  if (line_ == 0) line_ = other.line_;
  count_ += other.count_;
  for (const std::string& name : other.names_) addName(name);
}

void UnknownNames::addName(const std::string& name) {
  if (seen_.insert(name).second) names_.push_back(name);
}

SrdfNames::SrdfNames(XmlFile& file, const RobotDescription& model) : file_(file) {
  for (const LinkModel& link : model.links) links_.add(link.name);
  for (const JointModel& joint : model.joints) joints_.add(joint.name);
}

bool SrdfNames::addVirtual(const std::string& joint, bool moves) {
  return !joints_.find(joint) && virtualJoints_.emplace(joint, moves).second;
}

std::optional<std::size_t> SrdfNames::find(const XmlFile::Element& element, const char* attribute,
                                           const std::string& owner, const NameIndex& known,
                                           UnknownNames& unknown) {
  const auto name = file_.text(element, attribute, owner);
  if (!name) return std::nullopt;
  used_.insert(*name);
  const auto found = known.find(*name);
  if (found) return found;
  unknown_.insert(*name);
  unknown.add(element, *name);
  return std::nullopt;
}

std::optional<std::size_t> SrdfNames::findLink(const XmlFile::Element& element,
                                               const char* attribute, const std::string& owner,
                                               UnknownNames& unknown) {
  return find(element, attribute, owner, links_, unknown);
}

std::optional<std::size_t> SrdfNames::findJoint(const XmlFile::Element& element,
                                                const char* attribute, const std::string& owner,
                                                UnknownNames& unknown) {
  const char* const name = element.Attribute(attribute);
  if (name && isVirtual(name)) return std::nullopt;
  return find(element, attribute, owner, joints_, unknown);
}

void SrdfNames::note(const UnknownNames& unknown, const std::string& one, const std::string& many,
                     std::vector<Note>& notes) const {
  if (unknown.names().empty()) return;
  std::string text =
      (unknown.count() == 1 ? "1 " + one : std::to_string(unknown.count()) + " " + many) +
      joinedFirst(unknown.names(), 3);
  if (unknown.names().size() == 1 && unknown.names()[0] != "root_joint" && !noteOnOtherRobot()) {
    std::vector<std::string> known = links_.all();
    known.insert(known.end(), joints_.all().begin(), joints_.all().end());
    text += didYouMean(unknown.names()[0], known);
  }
  notes.push_back({file_.at(unknown.line(), text)});
}

std::optional<std::string> SrdfNames::noteOnOtherRobot() const {
  constexpr std::size_t least = 5;  // fewer unknown names are probably misspelt
  if (unknown_.size() < least || 2 * unknown_.size() < used_.size()) return std::nullopt;
  return std::to_string(unknown_.size()) + " of the " + std::to_string(used_.size()) +
         " links and joints that it names are not in the URDF; it seems to be the SRDF of another "
         "robot";
}

}  // namespace corridor
