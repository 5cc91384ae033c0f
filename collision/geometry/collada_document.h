#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/xml_tree.h"

namespace corridor {

/// A Collada document while it is read: its unit and up-axis, and what was found in it. Internal:
/// included by the readers of Collada only.
class ColladaDocument {
 public:
  explicit ColladaDocument(MeshFaults& faults) : faults_(faults) {}

  /// What an `<asset>` says. It holds for the element around it.
  struct Asset {
    double metres = 1;
    char up = 'y';
    bool operator==(const Asset&) const = default;
  };
  const Asset& asset() const { return asset_; }
  /// Reads the `<asset>` of the root.
  void readAsset(const xml::Element& root);
  /// Adds a fault if the `<asset>` of an inner element has another unit or up-axis.
  void checkAsset(const xml::Element& element);

  MeshFaults& faults() { return faults_; }
  void fault(const xml::Element& element, std::string text) {
    faults_.add(element.GetLineNum(), std::move(text));
  }
  const std::vector<std::string>& notes() const { return notes_; }
  void note(const std::string& text);
  void check(const xml::Element& element, std::initializer_list<std::string_view> children,
             std::initializer_list<std::string_view> attributes) {
    xml::check(element, children, attributes, faults_, notes_);
  }

 private:
  Asset assetOf(const xml::Element& element, Asset asset);

  MeshFaults& faults_;
  std::vector<std::string> notes_;
  Asset asset_;
};

}  // namespace corridor
