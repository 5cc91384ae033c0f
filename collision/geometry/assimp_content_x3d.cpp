#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "collision/core/spelling.h"
#include "collision/geometry/assimp_content_xml.h"

namespace corridor {
namespace {

/// Left out: nodes that assimp skips (<LOD>, <CADPart> …), prototypes, curved shapes (<Sphere> …),
/// which assimp replaces by polyhedra within them, and rare ones (<Extrusion> …), in which it is
/// not tested. assimp itself refuses <PhysicalMaterial> and <UnlitMaterial>.
constexpr XmlRules kX3d{
    "X3D",
    " X3D head meta component unit Scene Group StaticGroup Transform Inline Shape "
    "Box ElevationGrid IndexedFaceSet IndexedTriangleSet IndexedTriangleFanSet TriangleSet "
    "IndexedLineSet LineSet PointSet Coordinate Color ColorRGBA Normal TextureCoordinate "
    "TextureCoordinateGenerator FogCoordinate "
    "Appearance Material TwoSidedMaterial FillProperties LineProperties ImageTexture PixelTexture "
    "MovieTexture MultiTexture TextureTransform TextureProperties "
    "MetadataBoolean MetadataDouble MetadataFloat MetadataInteger MetadataSet MetadataString "
    "DirectionalLight PointLight SpotLight Background TextureBackground Fog NavigationInfo "
    "Viewpoint OrthoViewpoint WorldInfo Sound AudioClip ",
    "",
    "",
    " Scene Coordinate ",
    " Scene/X3D Box/Shape ElevationGrid/Shape IndexedFaceSet/Shape IndexedTriangleSet/Shape "
    "IndexedTriangleFanSet/Shape TriangleSet/Shape Shape/Scene Shape/Group Shape/StaticGroup "
    "Shape/Transform "
    "Transform/Scene Transform/Group Transform/StaticGroup Transform/Transform "
    "Group/Scene Group/Group Group/StaticGroup Group/Transform "
    "StaticGroup/Scene StaticGroup/Group StaticGroup/StaticGroup StaticGroup/Transform "
    "Inline/Scene Inline/Group Inline/StaticGroup Inline/Transform "};

/// The attributes of the elements that hold or move geometry, by the standard (X3D 4.0); those of
/// all elements are under "".
struct Attributes {
  std::string_view elements, names;
};
constexpr std::array<Attributes, 10> kAttributes{
    {{"", " DEF USE containerField class id style "},
     {" Transform Group StaticGroup Shape Inline ",
      " bboxCenter bboxSize bboxDisplay visible castShadow render "},
     {" Transform ", " translation rotation scale scaleOrientation center "},
     {" Inline ", " url load global description autoRefresh autoRefreshTimeLimit "},
     {" Box ", " size solid "},
     {" IndexedFaceSet IndexedTriangleSet IndexedTriangleFanSet TriangleSet ElevationGrid ",
      " ccw solid colorPerVertex normalPerVertex "},
     {" IndexedFaceSet ", " coordIndex colorIndex normalIndex texCoordIndex convex creaseAngle "},
     {" IndexedTriangleSet IndexedTriangleFanSet ", " index "},
     {" ElevationGrid ", " height xDimension zDimension xSpacing zSpacing creaseAngle "},
     {" Coordinate ", " point "}}};

/// The attributes whose numbers are or move geometry, and how many numbers they have (0: any
/// number).
struct Numbers {
  std::string_view element, attribute;
  std::size_t size;
};
constexpr std::array<Numbers, 15> kNumbers{{{"Transform", "translation", 3},
                                            {"Transform", "center", 3},
                                            {"Transform", "scale", 3},
                                            {"Transform", "rotation", 4},
                                            {"Transform", "scaleOrientation", 4},
                                            {"Coordinate", "point", 0},
                                            {"IndexedFaceSet", "coordIndex", 0},
                                            {"IndexedTriangleSet", "index", 0},
                                            {"IndexedTriangleFanSet", "index", 0},
                                            {"Box", "size", 3},
                                            {"ElevationGrid", "height", 0},
                                            {"ElevationGrid", "xDimension", 1},
                                            {"ElevationGrid", "zDimension", 1},
                                            {"ElevationGrid", "xSpacing", 1},
                                            {"ElevationGrid", "zSpacing", 1}}};

/// Attributes that assimp reads as whole numbers, up to the first other character.
constexpr std::string_view kWhole = " coordIndex index xDimension zDimension ";

/// Returns the numbers of a list in which a comma may follow each number, before a blank.
std::vector<double> listedNumbers(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto isBlank = [&](char c) { return blanks.find(c) != blanks.npos; };
  std::string list(text);
  for (std::size_t i = 1; i < list.size(); ++i)
    if (list[i] == ',' && !isBlank(list[i - 1]) && (i + 1 == list.size() || isBlank(list[i + 1])))
      list[i] = ' ';
  return numbersIn(list);
}

/// Returns the texts in quotes of a list.
std::vector<std::string> quotedTexts(std::string list) {
  constexpr std::string_view kQuote = "&quot;";
  for (auto at = list.find(kQuote); at != list.npos; at = list.find(kQuote, at))
    list.replace(at, kQuote.size(), "\"");
  std::vector<std::string> texts;
  for (auto at = list.find('"'); at != list.npos;) {
    const auto end = list.find('"', at + 1);
    if (end == list.npos) break;
    texts.push_back(list.substr(at + 1, end - at - 1));
    at = list.find('"', end + 1);
  }
  return texts;
}

class X3dCheck : public XmlCheck {
 public:
  using XmlCheck::XmlCheck;

 private:
  /// assimp reads such a file, if another file names it, as an empty one.
  void malformed() override { fault(0, "no complete XML file whose root is <X3D>"); }

  void enter(const XmlTag& tag) override {
    checkCase(tag, {"DEF", "USE", "url", "load", "category", "conversionFactor"});
    if (tag.name == "unit") checkUnit(tag);
    if (tag.name == "Inline" && tag.value("load") == "false")
      fault(tag.line, "<Inline load=\"false\"> is not read; remove it, or load=\"false\"");
    for (const Numbers& numbers : kNumbers)
      if (tag.name == numbers.element) checkNumbers(tag, numbers);
    if (tag.name == "Coordinate" && around(0) == "TriangleSet") checkTriangles(tag, "point", 9);
    if (tag.name == "IndexedTriangleSet") checkTriangles(tag, "index", 3);
    if (tag.name == "ElevationGrid" && !tag.find("USE")) checkGrid(tag);
    noteUnknown(tag);
    checkNames(tag);
  }

  /// Collects the attributes that the standard does not have.
  void noteUnknown(const XmlTag& tag) {
    const auto isKnown = [&](std::string_view name, std::string_view element) {
      return std::any_of(kAttributes.begin(), kAttributes.end(), [&](const Attributes& rule) {
        return (rule.elements == element || isListed(rule.elements, element)) &&
               isListed(rule.names, name);
      });
    };
    const bool isGeometry =
        std::any_of(kAttributes.begin() + 1, kAttributes.end(),
                    [&](const Attributes& rule) { return isListed(rule.elements, tag.name); });
    if (!isGeometry) return;
    for (const std::string_view name : tag.names())
      if (!isKnown(name, "") && !isKnown(name, tag.name) && name.find(':') == name.npos)
        unknown_.insert(std::string(name) + " of <" + std::string(tag.name) + ">");
  }

  void end() override {
    if (unknown_.empty()) return;
    report_.note("not read, because X3D does not have these attributes: " +
                 joinedFirst(std::vector<std::string>(unknown_.begin(), unknown_.end())));
  }

  /// Checks that a grid has a height for each of its points.
  void checkGrid(const XmlTag& tag) {
    const std::size_t count = listedNumbers(tag.value("height")).size();
    const double points = numberIn(tag.value("xDimension")) * numberIn(tag.value("zDimension"));
    if (static_cast<double>(count) != points)
      fault(tag.line, "the <ElevationGrid> has " + std::to_string(count) +
                          " heights; xDimension times zDimension are needed");
  }

  /// Checks DEF and USE. To assimp all files of an import are one name space, in which a later node
  /// hides an earlier one of the same name. By the specification each file has its own.
  void checkNames(const XmlTag& tag) {
    const std::string def(tag.value("DEF")), use(tag.value("USE"));
    if (!def.empty()) {
      if (!ids_.insert(def).second)
        fault(tag.line, "two nodes have the name DEF=\"" + def +
                            "\", of which assimp uses one; give each a name of its own");
      ContentReport::NodeName& name = report_.nodeNames[def];
      if (!name.definedIn.empty() && name.definedIn != file_) name.isInSeveral = true;
      name.definedIn = file_;
      if (name.isInSeveral && name.isUsed) faultOfSeveral(tag.line, def);
    }
    if (!use.empty()) {
      if (!ids_.contains(use))
        fault(tag.line, "USE=\"" + use + "\" names no earlier node of this file");
      ContentReport::NodeName& name = report_.nodeNames[use];
      name.isUsed = true;
      if (name.isInSeveral) faultOfSeveral(tag.line, use);
    }
  }

  void faultOfSeveral(int line, const std::string& name) {
    fault(line, "nodes of two files have the name DEF=\"" + name +
                    "\", and assimp does not keep them apart; give one another name");
  }

  /// Checks the groups: after one that is empty, or that uses another, assimp attaches what follows
  /// to a wrong parent.
  void leave(const XmlTag& tag) override {
    if (isListed(" Group StaticGroup Transform ", tag.name) &&
        (tag.isEmpty || !tag.value("USE").empty()))
      fault(tag.line, "assimp misplaces what comes after a <" + std::string(tag.name) +
                          "> that is empty or has USE" + kInstead);
  }

  void checkUnit(const XmlTag& tag) {
    const std::string_view category = tag.value("category");
    if ((category == "length" || category == "angle") &&
        numberIn(tag.value("conversionFactor")) != 1)
      fault(tag.line, "the file's unit of " + std::string(category) +
                          " is not applied; store metres and radians, without <unit>");
  }

  /// Checks that the numbers of an attribute make whole triangles: assimp drops the others. The
  /// points of a <Coordinate> that is used again are those of its DEF.
  void checkTriangles(const XmlTag& tag, std::string_view attribute, std::size_t size) {
    const auto points = points_.find(tag.value("USE"));
    const std::size_t count =
        points == points_.end() ? listedNumbers(tag.value(attribute)).size() : points->second;
    if (count % size != 0)
      fault(tag.line, "the numbers of " + std::string(attribute) +
                          " make no whole triangles, and assimp drops the last ones; write " +
                          std::to_string(size) + " numbers for each");
  }

  /// Checks an attribute's numbers. assimp looks for blanks only: it reads "0,1" as 0.
  void checkNumbers(const XmlTag& tag, const Numbers& rule) {
    checkCase(tag, {rule.attribute});
    const auto text = tag.find(rule.attribute);
    if (!text) return;
    const std::string name(rule.attribute);
    const std::vector<double> numbers = listedNumbers(*text);
    if (rule.element == "Coordinate" && !tag.value("DEF").empty())
      points_.emplace(tag.value("DEF"), numbers.size());
    if (isListed(kWhole, name) && text->find_first_not_of("0123456789-, \t\r\n") != text->npos)
      return fault(tag.line, name + " may have whole numbers only");
    if (isListed(kWhole, name) && std::any_of(numbers.begin(), numbers.end(),
                                              [](double x) { return std::abs(x) > INT32_MAX; }))
      return fault(tag.line, name + " may have numbers below 2^31 only");
    if (std::any_of(numbers.begin(), numbers.end(), [](double x) { return std::isnan(x); }))
      return fault(tag.line, name + " has a word that is no number; put a blank after each comma");
    if (rule.size > 0 && numbers.size() != rule.size)
      return fault(tag.line, name + " has " + std::to_string(numbers.size()) + " numbers; write " +
                                 std::to_string(rule.size));
    if (rule.size == 4 && numbers[3] != 0 && !hasLengthOne(numbers.data(), 3))
      fault(tag.line, "the axis of " + name +
                          " is not of length 1, and assimp would distort the mesh; write the axis "
                          "with length 1, with six digits or more");
  }

  std::set<std::string> unknown_;                   // attributes
  std::map<std::string_view, std::size_t> points_;  // the numbers of each <Coordinate> with a DEF
};

}  // namespace

std::string withPlainUrls(std::string_view x3d, const std::filesystem::path& folder) {
  std::string result;
  std::size_t done = 0;
  for (auto at = x3d.find("<Inline"); at != x3d.npos; at = x3d.find("<Inline", at + 1)) {
    const auto url = xmlTagAt(x3d, at).find("url");
    const std::vector<std::string> urls = quotedTexts(std::string(url.value_or("")));
    if (urls.empty()) continue;
    std::error_code error;
    const auto found = std::find_if(urls.begin(), urls.end(), [&](const std::string& name) {
      return std::filesystem::is_regular_file(folder / name, error);
    });
    const auto from = static_cast<std::size_t>(url->data() - x3d.data());
    result += x3d.substr(done, from - done);
    for (const char c : found == urls.end() ? urls[0] : *found)  // assimp splits names at blanks
      result += c == ' ' ? std::string("%20") : std::string(1, c);
    done = from + url->size();
  }
  return result.append(x3d.substr(done));
}

void checkX3d(const std::string& file, std::string_view text, ContentReport& report) {
  X3dCheck(kX3d, file, text, report).run();
}

}  // namespace corridor
