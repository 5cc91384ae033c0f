#include "collision/geometry/collada_asset.h"

#include <algorithm>
#include <optional>
#include <string>

#include "collision/core/spelling.h"
#include "collision/geometry/column_names.h"
#include "collision/geometry/stated_unit.h"

namespace corridor {
namespace {

/// Replaces each part of the text from `open` up to the next `close`, or up to the end of the text,
/// by blanks. Line ends stay.
void blank(std::string& text, std::string_view open, std::string_view close) {
  for (auto from = text.find(open); from != text.npos; from = text.find(open, from)) {
    const auto end = text.find(close, from);
    const auto to = text.begin() + static_cast<std::ptrdiff_t>(std::min(end, text.size()));
    std::replace_if(
        text.begin() + static_cast<std::ptrdiff_t>(from), to, [](char c) { return c != '\n'; },
        ' ');
  }
}

bool isSpace(char c) {
  return isLineEnd(c) || isBlank(c);
}

int lineOf(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

/// Returns the value of an attribute in a tag's text; nullopt if the tag does not have the
/// attribute.
std::optional<std::string_view> attributeOf(std::string_view tag, const std::string& name) {
  for (auto at = tag.find(name); at != tag.npos; at = tag.find(name, at + 1)) {
    const std::string_view rest = trimmed(tag.substr(at + name.size()));
    if (!rest.starts_with('=') || !isSpace(tag[at - 1])) continue;
    const std::string_view value = trimmed(rest.substr(1));
    if (value.empty()) return value;
    return value.substr(1, value.find(value[0], 1) - 1);
  }
  return std::nullopt;
}

}  // namespace

char checkColladaAsset(std::string_view text, MeshFaults& faults, std::vector<std::string>& notes) {
  std::string file(text);
  blank(file, "<!--", "-->");
  blank(file, "<![CDATA[", "]]>");
  const std::string_view asset = std::string_view(file).substr(0, file.find("</asset>"));
  if (const auto at = asset.find("<unit"); at != asset.npos) {
    const std::string_view tag = asset.substr(at, asset.find('>', at) - at);
    const auto meter = attributeOf(tag, "meter");
    double metres = meter ? 0 : 1;
    if (meter && (parseCoordinate(trimmed(*meter), metres) || !(metres > 0)))
      faults.add(lineOf(asset, at), "<unit meter=" + inQuotes(*meter) +
                                        ">: the unit must be a number of metres above 0");
    else if (meter && !meter->empty() && isSpace(meter->front()))
      faults.add(lineOf(asset, at), "<unit meter=" + inQuotes(*meter) +
                                        ">: assimp reads no number after a blank; remove it");
    const std::string name(attributeOf(tag, "name").value_or(""));
    const double named = metresOfUnit(lowered(name));
    if (named > 0 && !isSameUnit(named, metres))
      notes.push_back("<unit name=" + inQuotes(name) +
                      (meter ? "> has the meter of another unit, which is used"
                             : "> has no meter, so a unit of 1 m is used"));
  }
  char up = 'y';
  if (const auto at = asset.find("<up_axis"); at != asset.npos) {
    const auto begin = std::min(asset.find('>', at), asset.size() - 1) + 1;
    const std::string_view axis = trimmed(asset.substr(begin, asset.find('<', begin) - begin));
    if (axis != "X_UP" && axis != "Y_UP" && axis != "Z_UP")
      faults.add(lineOf(asset, at),
                 "<up_axis> is " + inQuotes(axis) + "; X_UP, Y_UP or Z_UP is needed");
    else
      up = axis.front() == 'X' ? 'x' : axis.front() == 'Y' ? 'y' : 'z';
  }
  faults.throwIfAny();
  return up;
}

}  // namespace corridor
