#include "planner/robot/urdfdom.h"

#include <algorithm>
#include <console_bridge/console.h>
#include <exception>
#include <initializer_list>
#include <mutex>
#include <string_view>
#include <urdf_parser/urdf_parser.h>

namespace corridor {
namespace {

/// Collects the errors that are printed through console_bridge during its lifetime. The destructor
/// restores the previous handler and log level.
class ErrorCatcher final : private console_bridge::OutputHandler {
 public:
  explicit ErrorCatcher(std::vector<std::string>& errors)
      : errors_(errors),
        before_(console_bridge::getOutputHandler()),
        levelBefore_(console_bridge::getLogLevel()) {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  }
  ~ErrorCatcher() override {
    console_bridge::setLogLevel(levelBefore_);
    if (before_)
      console_bridge::useOutputHandler(before_);
    else
      console_bridge::noOutputHandler();
  }
  ErrorCatcher(const ErrorCatcher&) = delete;
  ErrorCatcher& operator=(const ErrorCatcher&) = delete;

 private:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
  }

  std::vector<std::string>& errors_;
  console_bridge::OutputHandler* before_;
  console_bridge::LogLevel levelBefore_;
};

using Element = XmlFile::Element;

/// Removes the children of other names.
void keepOnly(Element& parent, std::initializer_list<std::string_view> names) {
  for (Element* child = parent.FirstChildElement(); child;) {
    Element* const next = child->NextSiblingElement();
    if (std::find(names.begin(), names.end(), child->Name()) == names.end())
      parent.DeleteChild(child);
    child = next;
  }
}

/// Keeps what Corridor takes from urdfdom: sizes of shapes, positions and axes. The rest was read
/// before, and urdfdom would refuse some of it, such as masses and efforts that are missing.
void simplify(Element& robot) {
  robot.DeleteAttribute("version");
  keepOnly(robot, {"link", "joint"});
  for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
    keepOnly(*link, {"collision"});
  for (auto* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    keepOnly(*joint, {"origin", "parent", "child", "axis"});
    Element* const limit = joint->InsertNewChildElement("limit");  // urdfdom requires it
    limit->SetAttribute("effort", "0");
    limit->SetAttribute("velocity", "0");
  }
}

}  // namespace

std::string urdfdomName(std::string name) {
  // urdfdom passes its messages to printf as the format string. A % in a user's name would be read
  // as a conversion.
  std::replace(name.begin(), name.end(), '%', '?');
  return name;
}

urdf::ModelInterfaceSharedPtr parseByUrdfdom(XmlFile::Element& robot,
                                             std::vector<std::string>& errors) {
  simplify(robot);
  tinyxml2::XMLPrinter text;
  robot.Accept(&text);
  // console_bridge has one message handler for the whole program, so one thread at a time may
  // parse.
  static std::mutex turn;
  const std::lock_guard lock(turn);
  const ErrorCatcher catcher(errors);
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(urdfdomName(text.CStr()));
  } catch (const std::exception& error) {
    errors.push_back(error.what());
  }
  if (!model && errors.empty()) errors.push_back("it returned no robot");
  return errors.empty() ? model : nullptr;
}

}  // namespace corridor
