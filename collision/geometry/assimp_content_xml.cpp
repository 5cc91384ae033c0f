#include <algorithm>
#include <charconv>
#include <cmath>
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
  std::string_view single;    ///< elements that may be in another once: assimp drops all but one
};

/// Collada's elements <technique> and <extra> may hold anything, so a list of all others is not
/// possible. assimp's skins and morphs are not applied; it reads holes <ph> as no face.
constexpr XmlRules kCollada{"COLLADA", "", " instance_controller convex_mesh brep skew ph ",
                            "geometry", " asset "};
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
    "", "", " Scene "};
/// Left out: constellations, which assimp moves by angles instead of lengths, and normals and
/// edges, which make triangles curved.
constexpr XmlRules kAmf{"amf",
                        " amf object mesh vertices vertex coordinates x y z volume triangle v1 v2 "
                        "v3 metadata material color r g b a composite texture texmap map utex1 "
                        "utex2 utex3 vtex1 vtex2 vtex3 u1 u2 u3 ",
                        "", "object", " mesh vertices volume "};

constexpr std::string_view kBlanks = " \t\r\n";

bool contains(std::string_view list, std::string_view name) {
  for (auto at = list.find(name); at != list.npos; at = list.find(name, at + 1)) {
    const auto end = at + name.size();
    if (at > 0 && list[at - 1] == ' ' && end < list.size() && list[end] == ' ') return true;
  }
  return false;
}

std::string_view trimmed(std::string_view text) {
  const auto first = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// Returns the number that is all of a text but blanks; NaN if there is none.
double numberIn(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size() ? value : std::nan("");
}

struct XmlTag {
  std::string_view name, attributes;
  std::string_view content;  ///< what is between an element's tags; set when it ends
  bool isEnd = false, isEmpty = false;
  int line = 0;
  std::size_t from = 0, to = 0;  ///< the tag's place in the file
  std::string single;            ///< those of `XmlRules::single` that are in the element

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
        open_.back().content = text_.substr(open_.back().to, tag->from - open_.back().to);
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
    if (std::any_of(targets_.begin(), targets_.end(),
                    [&](std::string_view id) { return !urls_.contains(id); }))
      report_.note("geometries that are in no node of the scene are not read");
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
    if (!open_.empty() && contains(rules_.single, name)) {
      std::string& single = open_.back().single;
      if (contains(single, name))
        fault(tag.line, "a second <" + name + "> is in one <" + std::string(open_.back().name) +
                            ">, and assimp drops one" + kInstead);
      single += ' ' + name + ' ';
    }
    if (rules_.root == kX3d.root) enterX3d(tag);
    if (rules_.root == kCollada.root) enterCollada(tag);
    if (name == kAmf.root && open_.empty()) report_.amfUnit = amfUnit(tag.value("unit"));
    if (name == rules_.numbered && !ids_.insert(std::string(tag.value("id"))).second)
      fault(tag.line, "two elements <" + name + "> have the id \"" + std::string(tag.value("id")) +
                          "\", so assimp drops one; give each an id of its own");
  }

  void enterX3d(const XmlTag& tag) {
    if (tag.name == "unit") checkUnit(tag);
    if (tag.name == "Inline" && tag.value("load") == "false")
      fault(tag.line, "<Inline load=\"false\"> is not read; remove it, or load=\"false\"");
    const std::string_view name = tag.value("DEF");
    if (!name.empty() && !ids_.insert(std::string(name)).second)
      fault(tag.line, "two nodes have the name DEF=\"" + std::string(name) +
                          "\", of which assimp uses one; give each a name of its own");
  }

  /// Finds out what could be in the scene, and what is.
  void enterCollada(const XmlTag& tag) {
    const bool isInLibrary = !open_.empty() && open_.back().name == "library_nodes";
    if (contains(" geometry visual_scene ", tag.name) || (tag.name == "node" && isInLibrary))
      targets_.insert(tag.value("id"));
    if (const std::string_view url = tag.value("url");
        tag.name.starts_with("instance_") && url.starts_with('#'))
      urls_.insert(url.substr(1));
  }

  void leave(const XmlTag& tag) {
    if (rules_.root == kCollada.root) leaveCollada(tag);
    if (rules_.root == kX3d.root) leaveX3d(tag);
    if (rules_.root == kAmf.root && contains(" x y z v1 v2 v3 ", tag.name) &&
        std::isnan(numberIn(tag.content)))
      fault(tag.line, "<" + std::string(tag.name) +
                          "> is not a number; write decimal numbers such as -1.25e-3");
  }

  /// Checks that an <asset> within the document says what the document's own says: assimp reads
  /// that one only. @pre `tag` is the last of `open_`
  void leaveCollada(const XmlTag& tag) {
    const std::size_t depth = open_.size();
    if (!contains(" unit up_axis ", tag.name) || depth < 3 || open_[depth - 2].name != "asset")
      return;
    double unit = unit_;
    std::string_view up = up_;
    if (tag.name == "up_axis") up = trimmed(tag.content);
    if (const std::string_view meter = tag.value("meter"); tag.name == "unit")
      unit = meter.empty() ? 1 : numberIn(meter);
    hasInnerAsset_ |= depth > 3;
    if (hasInnerAsset_ && (unit != unit_ || up != up_))
      fault(tag.line, "an <asset> within the document has another <" + std::string(tag.name) +
                          "> than the document, which assimp does not apply" + kInstead);
    unit_ = unit;
    up_ = up;
  }

  /// Checks the groups of X3D: after one that is empty, or that uses another, assimp attaches what
  /// follows to a wrong parent.
  void leaveX3d(const XmlTag& tag) {
    if (contains(" Group StaticGroup Transform ", tag.name) &&
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
    tag.from = at;
    char quote = 0;
    for (at_ = at + 1; at_ < text_.size() && (quote || text_[at_] != '>'); ++at_) {
      const char c = text_[at_];
      if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? '\0' : c;
    }
    tag.to = std::min(at_ + 1, text_.size());
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
  // Only for Collada: the document's unit and up-axis, and the ids of what may be instanced.
  double unit_ = 1;
  std::string_view up_ = "Y_UP";
  bool hasInnerAsset_ = false;
  std::set<std::string_view> targets_, urls_;
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
