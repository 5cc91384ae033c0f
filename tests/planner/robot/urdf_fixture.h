#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "planner/robot/urdf_file.h"

namespace corridor::test {

/// A fixture that writes small URDF and SRDF files, and a mesh, into a temporary folder.
class UrdfTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("corridor_" + std::string(info->test_suite_name()) + '_' + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    write("wedge.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  /// Returns the faults, one per line, without the folder's name.
  std::string textOf(const std::vector<Fault>& faults) const {
    if (faults.empty()) return "no complaint";
    std::string text = InputError(faults).what();
    const std::string prefix = folder_.string() + '/';
    for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
      text.erase(at, prefix.size());
    return text;
  }

  std::string complaintOf(const std::string& urdf) {
    std::vector<Fault> faults;
    const auto model = readUrdf(write("r.urdf", urdf), rules_, faults, files_);
    EXPECT_EQ(model.has_value(), faults.empty());
    return textOf(faults);
  }
  /// Returns the faults of elements in a <robot> that begins on line 1. The elements are on lines
  /// 2, 3 …, one per line.
  std::string complaintOfParts(const std::string& parts) {
    return complaintOf("<robot name=\"r\">\n" + parts + "\n</robot>\n");
  }

  RobotDescription modelOf(const std::string& parts) {
    std::vector<Fault> faults;
    auto model = readUrdf(write("r.urdf", "<robot name=\"r\">\n" + parts + "\n</robot>\n"), rules_,
                          faults, files_);
    EXPECT_EQ(textOf(faults), "no complaint");
    return model.value_or(RobotDescription());
  }

  std::filesystem::path folder_;
  UrdfRules rules_;
  std::vector<std::filesystem::path> files_;
};

/// These functions return a URDF element on one line.
inline std::string link(const std::string& name, const std::string& content = "") {
  return "<link name=\"" + name + "\">" + content + "</link>\n";
}
inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& content = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/>" + content + "</joint>\n";
}
inline std::string collision(const std::string& shape) {
  return "<collision><geometry>" + shape + "</geometry></collision>";
}
inline const std::string limit = R"(<limit lower="-1" upper="2" effort="0" velocity="0"/>)";

}  // namespace corridor::test
