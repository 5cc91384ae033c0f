#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "collision/geometry/assimp_content.h"

namespace corridor {
namespace {

/// What is accepted of a format that is based on XML.
struct XmlRules {
  std::string_view root;
  std::string_view accepted;  ///< the elements that are read, or cannot matter; empty: all others
  std::string_view refused;
  std::string_view numbered;  ///< the element whose `id` must be unique: assimp drops repeated ones
};

/// Collada's elements <technique> and <extra> may hold anything, so a list of all others is not
/// possible. assimp's skins and morphs are not applied; it reads holes <ph> as no face.
constexpr XmlRules kCollada{"COLLADA", "", " instance_controller convex_mesh brep skew ph ",
                            "geometry"};
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
    "", ""};
/// Left out: constellations, which assimp moves by angles instead of lengths, and normals and
/// edges, which make triangles curved.
constexpr XmlRules kAmf{"amf",
                        " amf object mesh vertices vertex coordinates x y z volume triangle v1 v2 "
                        "v3 metadata material color r g b a composite texture texmap map utex1 "
                        "utex2 utex3 vtex1 vtex2 vtex3 u1 u2 u3 ",
                        "", "object"};

constexpr std::string_view kBlanks = " \t\r\n";

bool contains(std::string_view list, std::string_view name) {
  return list.find(" " + std::string(name) + " ") != list.npos;
}

struct XmlTag {
  std::string_view name, attributes;
  bool isEnd = false, isEmpty = false;
  int line = 0;

  /// Returns the value of an attribute; "" without it.
  std::string_view value(std::string_view attribute) const {
    for (std::string_view rest = attributes;;) {
      const auto equals = rest.find('=');
      const auto quote = rest.find_first_of("\"'", equals);
      if (equals == rest.npos || quote == rest.npos) return "";
      const auto end = std::min(rest.find(rest[quote], quote + 1), rest.size());
      const auto first = rest.find_first_not_of(kBlanks);
      const auto last = rest.find_last_not_of(kBlanks, equals - 1);
      if (first < equals && rest.substr(first, last + 1 - first) == attribute)
        return rest.substr(quote + 1, end - quote - 1);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
};

/// Returns AMF's unit in metres; 0 if none is stated. (assimp refuses other units.)
double amfUnit(std::string_view name) {
  return name == "millimeter" ? 0.001
         : name == "inch"     ? 0.0254
         : name == "feet"     ? 0.3048
         : name == "meter"    ? 1
         : name == "micron"   ? 1e-6
                              : 0;
}

class XmlCheck {
 public:
  XmlCheck(const XmlRules& rules, const std::string& file, std::string_view text,
           ContentReport& report)
      : rules_(rules), file_(file), text_(text), report_(report) {}

  void run() {
    bool isFirst = true;
    while (const auto tag = next()) {
      if (tag->isEnd) {
        if (open_.empty() || open_.back().name != tag->name) return malformed();
        leave(open_.back());
        open_.pop_back();
        continue;
      }
      if (isFirst && tag->name != rules_.root) return malformed();
      isFirst = false;
      if (!open_.empty()) open_.back().isEmpty = false;
      enter(*tag);
      open_.push_back(*tag);
      open_.back().isEmpty = true;  // until a child comes
      if (!tag->isEmpty) continue;
      leave(open_.back());
      open_.pop_back();
    }
    if (isFirst || !open_.empty()) malformed();
  }

 private:
  void fault(int line, const std::string& text) { report_.fault(file_, line, text); }

  /// assimp reads an X3D file with such a fault, if another file names it, as an empty one.
  void malformed() {
    if (rules_.root == kX3d.root)
      report_.fault(file_, 0, "no complete XML file whose root is <X3D>");
  }

  void enter(const XmlTag& tag) {
    const std::string name(tag.name);
    if (open_.size() <= refused_) refused_ = kNone;
    if (refused_ != kNone) return;  // within an element that is refused
    if ((!rules_.accepted.empty() && !contains(rules_.accepted, name)) ||
        contains(rules_.refused, name)) {
      fault(
          tag.line,
          "<" + name + "> may be or move geometry, and assimp does not read it rightly" + kInstead);
      refused_ = open_.size();
    }
    if (name == "unit" && rules_.root == kX3d.root) checkUnit(tag);
    if (name == kAmf.root && open_.empty()) report_.amfUnit = amfUnit(tag.value("unit"));
    if (name == rules_.numbered && !ids_.insert(std::string(tag.value("id"))).second)
      fault(tag.line, "two elements <" + name + "> have the id \"" + std::string(tag.value("id")) +
                          "\", so assimp drops one; give each an id of its own");
  }

  /// Checks the groups of X3D: after one that is empty, or that uses another, assimp attaches what
  /// follows to a wrong parent.
  void leave(const XmlTag& tag) {
    if (rules_.root == kX3d.root && contains(" Group StaticGroup Transform ", tag.name) &&
        (tag.isEmpty || !tag.value("USE").empty()))
      fault(tag.line, "assimp misplaces what comes after a <" + std::string(tag.name) +
                          "> that is empty or has USE" + kInstead);
  }

  void checkUnit(const XmlTag& tag) {
    const std::string_view category = tag.value("category"), factor = tag.value("conversionFactor");
    double value = 0;
    std::from_chars(factor.data(), factor.data() + factor.size(), value);
    if ((category == "length" || category == "angle") && value != 1)
      fault(tag.line, "the file's unit of " + std::string(category) +
                          " is not applied; store metres and radians, without <unit>");
  }

  /// Returns the next tag. Text, comments and the like are skipped.
  std::optional<XmlTag> next() {
    while (true) {
      const std::size_t at = at_ = text_.find('<', at_);
      if (at == text_.npos) return std::nullopt;
      line_ += static_cast<int>(
          std::count(text_.begin() + std::exchange(counted_, at), text_.begin() + at, '\n'));
      const std::string_view rest = text_.substr(at);
      if (rest.starts_with("<!--")) {
        skipTo("-->");
      } else if (rest.starts_with("<![CDATA[")) {
        skipTo("]]>");
      } else if (rest.starts_with("<?")) {
        skipTo("?>");
      } else if (rest.starts_with("<!")) {
        skipTo(">");
        if (text_.substr(at, at_ - at).find('[') != text_.npos)
          fault(line_, "a DOCTYPE with declarations is not read; save the file without it");
      } else {
        return tagAt(at);
      }
    }
  }

  void skipTo(std::string_view end) {
    const auto found = text_.find(end, at_);
    at_ = found == text_.npos ? found : found + end.size();
  }

  XmlTag tagAt(std::size_t at) {
    XmlTag tag;
    tag.line = line_;
    char quote = 0;
    for (at_ = at + 1; at_ < text_.size() && (quote || text_[at_] != '>'); ++at_) {
      const char c = text_[at_];
      if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? '\0' : c;
    }
    std::string_view inside = text_.substr(at + 1, at_ - at - 1);
    tag.isEnd = inside.starts_with('/');
    if (tag.isEnd) inside.remove_prefix(1);
    tag.isEmpty = inside.ends_with('/');
    if (tag.isEmpty) inside.remove_suffix(1);
    tag.name = inside.substr(0, inside.find_first_of(kBlanks));
    tag.attributes = inside.substr(tag.name.size());
    return tag;
  }

  static constexpr std::size_t kNone = std::string::npos;
  static constexpr const char* kInstead = "; save the mesh as OBJ, STL, PLY or OFF";

  const XmlRules& rules_;
  const std::string& file_;
  std::string_view text_;
  ContentReport& report_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0;  // the lines up to this place are counted in `line_`
  int line_ = 1;
  std::vector<XmlTag> open_;     // the elements around the current place
  std::size_t refused_ = kNone;  // the depth of the element that is refused, around the current one
  std::set<std::string> ids_;
};

}  // namespace

void checkXml(ContentKind kind, const std::string& file, std::string_view text,
              ContentReport& report) {
  XmlCheck(kind == ContentKind::Collada ? kCollada
           : kind == ContentKind::X3d   ? kX3d
                                        : kAmf,
           file, text, report)
      .run();
}

}  // namespace corridor
