#include "planner/robot/urdfdom.h"

#include <algorithm>
#include <console_bridge/console.h>
#include <exception>
#include <mutex>
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

void removeAll(XmlFile::Element& parent, const char* name) {
  for (XmlFile::Element* child = parent.FirstChildElement(name); child;) {
    XmlFile::Element* const next = child->NextSiblingElement(name);
    parent.DeleteChild(child);
    child = next;
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
  removeAll(robot, "material");
  for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
    removeAll(*link, "visual");
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
