#include "collision/geometry/collada_document.h"

#include <algorithm>

#include "collision/core/spelling.h"
#include "collision/geometry/column_names.h"
#include "collision/geometry/scene_mesh.h"
#include "collision/geometry/stated_unit.h"

namespace corridor {
namespace {

using xml::Element;
using xml::onlyChild;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string withoutPrefix(const std::string& name) {
  return name.substr(name.rfind(':') + 1);
}

}  // namespace

void ColladaDocument::note(const std::string& text) {
  addNote(notes_, text);
}

void ColladaDocument::readAsset(const Element& root) {
  if (const Element* const asset = onlyChild(root, "asset", faults_)) asset_ = assetOf(*asset, {});
}

void ColladaDocument::checkAsset(const Element& element) {
  if (const Element* const asset = onlyChild(element, "asset", faults_);
      asset && assetOf(*asset, asset_) != asset_)
    fault(*asset,
          "this <asset> has another unit or up-axis than the document's, which is not supported; "
          "save the mesh with one unit and one up-axis");
}

ColladaDocument::Asset ColladaDocument::assetOf(const Element& element, Asset asset) {
  xml::requireNoText(element, faults_);
  if (const Element* const unit = onlyChild(element, "unit", faults_)) {
    check(*unit, {}, {"meter", "name"});
    const auto meter = xml::attribute(*unit, "meter");
    asset.metres = 1;
    if (meter && (parseCoordinate(trimmed(*meter), asset.metres) || !(asset.metres > 0) ||
                  !wrongMagnitude(asset.metres).empty())) {
      fault(*unit,
            "<unit meter=" + inQuotes(*meter) + ">: the unit must be a number of metres above 0");
      asset.metres = 1;
    }
    const std::string name(xml::attribute(*unit, "name").value_or(""));
    if (const double named = metresOfUnit(lowered(name));
        named > 0 && !isSameUnit(named, asset.metres))
      note("<unit name=" + inQuotes(name) +
           (meter ? "> has the meter of another unit, which is used"
                  : "> has no meter, so a unit of 1 m is used"));
  }
  if (const Element* const up = onlyChild(element, "up_axis", faults_)) {
    check(*up, {}, {});
    const std::string text = xml::textOf(*up, faults_);
    const std::string_view axis = trimmed(text);
    if (axis != "X_UP" && axis != "Y_UP" && axis != "Z_UP")
      fault(*up, "<up_axis> is " + inQuotes(axis) + "; X_UP, Y_UP or Z_UP is needed");
    else
      asset.up = static_cast<char>(axis[0] - 'X' + 'x');
  }
  for (const Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    constexpr std::string_view kKnown =
        " contributor coverage created extra keywords modified revision subject title unit "
        "up_axis ";
    const std::string name = withoutPrefix(lowered(child->Name()));
    if ((name == "unit" || name == "up_axis") && name != child->Name())
      fault(*child, "<" + printable(child->Name()) + "> is not read; write <" + name + ">");
    else if (kKnown.find(' ' + name + ' ') == kKnown.npos)
      note("<" + printable(child->Name()) + "> of <asset> is not read");
    xml::requireNamespace(*child, faults_);
  }
  return asset;
}

}  // namespace corridor
