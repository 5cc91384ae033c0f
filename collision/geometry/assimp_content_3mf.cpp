// The model in 3MF archives.
#include <algorithm>
#include <cmath>

#include "collision/geometry/assimp_content_xml.h"

namespace corridor {
namespace {

/// The elements of 3MF's core, and those in which Cura writes its settings. `numbered` is empty,
/// because all resources share their ids.
constexpr XmlRules kThreeMf{
    "model",
    " model metadata metadatagroup resources basematerials base object mesh vertices vertex "
    "triangles triangle components component build item settings setting ",
    "",
    "",
    " resources build mesh components vertices triangles ",
    " resources/model build/model object/resources basematerials/resources mesh/object "
    "vertices/mesh vertex/vertices triangles/mesh triangle/triangles components/object "
    "component/components item/build "};
/// The elements of 3MF's extensions for materials and sets of triangles, without their prefix.
constexpr std::string_view kLooksOfThreeMf =
    " colorgroup color texture2d texture2dgroup tex2coord compositematerials composite "
    "multiproperties multi pbspecular pbspeculardisplayproperties pbmetallic "
    "pbmetallicdisplayproperties pbspeculartexturedisplayproperties "
    "pbmetallictexturedisplayproperties translucent translucentdisplayproperties trianglesets "
    "triangleset ref refrange ";

/// Returns 3MF's unit in metres; 0 if it is unknown.
double threeMfUnit(std::string_view name) {
  return name == "millimeter"   ? 0.001
         : name == "micron"     ? 1e-6
         : name == "centimeter" ? 0.01
         : name == "inch"       ? 0.0254
         : name == "foot"       ? 0.3048
         : name == "meter"      ? 1
                                : 0;
}

class ThreeMfCheck : public XmlCheck {
 public:
  using XmlCheck::XmlCheck;

 private:
  bool isAccepted(std::string_view name) const override {
    const auto colon = name.find(':');
    return colon == name.npos ? XmlCheck::isAccepted(name)
                              : isListed(kLooksOfThreeMf, name.substr(colon + 1));
  }

  void malformed() override { fault(0, "its model is no complete XML file whose root is <model>"); }

  void enter(const XmlTag& tag) override {
    if (tag.name == "model") checkModel(tag);
    if (tag.name == "object" || (around(0) == "resources" && tag.find("id"))) checkId(tag);
    if (tag.name == "vertex")
      for (const std::string name : {"x", "y", "z"})
        if (std::isnan(numberIn(tag.value(name))))
          fault(tag.line, "<vertex> has no number " + name + kDecimals);
    if (tag.name == "triangle" && around(0) == "triangles")
      for (const std::string name : {"v1", "v2", "v3"})
        if (wholeNumberIn(tag.value(name)) < 0)
          fault(tag.line, "<triangle> has no whole number " + name + " from 0 to 2^31 - 1");
    if (tag.name == "item" || tag.name == "component") checkReference(tag);
  }

  void checkModel(const XmlTag& tag) {
    checkCase(tag, {"unit", "requiredextensions"});
    const std::string_view unit = tag.find("unit").value_or("millimeter");
    report_.fileUnit = threeMfUnit(unit);
    if (report_.fileUnit == 0)
      fault(tag.line, "the unit \"" + std::string(unit) +
                          "\" is not one of 3MF; write micron, millimeter, centimeter, inch, foot "
                          "or meter");
    std::string_view rest = withoutBlanks(tag.value("requiredextensions"));
    while (!rest.empty()) {
      const std::string prefix(rest.substr(0, rest.find_first_of(" \t\r\n")));
      rest = withoutBlanks(rest.substr(prefix.size()));
      const std::string_view space = tag.value("xmlns:" + prefix);
      if (space.find("/material/") == space.npos && space.find("/trianglesets/") == space.npos &&
          space.find("/production/") == space.npos)
        fault(tag.line, "the required extension \"" + prefix + "\" is not supported" + kInstead);
    }
  }

  void checkId(const XmlTag& tag) {
    const long id = wholeNumberIn(tag.value("id"));
    if (!ids_.insert(std::to_string(id)).second || id < 0)
      fault(tag.line, "the id \"" + std::string(tag.value("id")) + "\" of <" +
                          std::string(tag.name) +
                          "> is used twice or is no whole number; give each resource a number of "
                          "its own");
    if (tag.name == "object") objects_.insert(id);
  }

  void checkReference(const XmlTag& tag) {
    const std::string name(tag.name);
    references_.push_back({wholeNumberIn(tag.value("objectid")), name, tag.line});
    if (tag.attributes.find(":path") != tag.attributes.npos)
      fault(tag.line, "<" + name + "> is in another model, which assimp does not read" + kInstead);
    checkCase(tag, {"objectid", "transform"});
    const auto transform = tag.find("transform");
    if (!transform) return;
    const std::vector<double> numbers = numbersIn(*transform);
    if (numbers.size() != 12 ||
        std::any_of(numbers.begin(), numbers.end(), [](double x) { return std::isnan(x); }))
      fault(tag.line, "the transform of <" + name + "> needs 12 decimal numbers");
  }

  void end() override {
    std::set<long> used;
    for (const auto& [object, name, line] : references_) {
      used.insert(object);
      if (!objects_.contains(object))
        fault(line,
              "<" + name + "> names an object that is not in the model; correct its objectid");
    }
    if (used.size() < objects_.size())
      report_.note("objects that are in no item of the build are not read");
  }

  struct Reference {
    long object;
    std::string name;
    int line;
  };
  std::set<long> objects_;
  std::vector<Reference> references_;
};

}  // namespace

void checkThreeMfModel(const std::string& file, std::string_view text, ContentReport& report) {
  ThreeMfCheck(kThreeMf, file, text, report).run();
}

}  // namespace corridor
