#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Core>

#include "collision/core/spelling.h"
#include "collision/geometry/assimp_content_xml.h"

namespace corridor {
namespace {

/// Collada's elements <technique> and <extra> may hold anything, so a list of all others is not
/// possible. assimp's skins and morphs are not applied; it reads holes <ph> as no face.
constexpr XmlRules kCollada{
    "COLLADA",
    "",
    " instance_controller convex_mesh brep skew lookat ph ",
    " geometry visual_scene ",
    " asset vertices accessor technique_common unit up_axis vcount float_array "
    "int_array bool_array Name_array IDREF_array ",
    ""};

constexpr std::string_view kPrimitives = " triangles polylist polygons tristrips trifans ";

/// The elements that may be in the elements that hold geometry, or move it: assimp drops others,
/// such as miswritten ones.
struct Children {
  std::string_view parents, children;
};
constexpr std::array<Children, 11> kChildren{
    {{" node ",
      " asset lookat matrix rotate scale skew translate instance_camera instance_controller "
      "instance_geometry instance_light instance_node node extra "},
     {" mesh ",
      " source vertices lines linestrips polygons polylist triangles trifans tristrips extra "},
     {" triangles polylist polygons tristrips trifans ", " input vcount p ph extra "},
     {" geometry ", " asset mesh convex_mesh spline brep extra "},
     {" vertices ", " input extra "},
     {" accessor ", " param "},
     {" visual_scene ", " asset node evaluate_scene extra "},
     {" library_geometries ", " asset geometry extra "},
     {" library_nodes ", " asset node extra "},
     {" library_visual_scenes ", " asset visual_scene extra "},
     {" scene ",
      " instance_visual_scene instance_physics_scene instance_kinematics_scene extra "}}};

/// Returns whether an element is one of those that are read, by its name without a prefix.
bool isRead(std::string_view name) {
  return isListed(
             " asset unit up_axis scene source float_array technique_common accessor param p "
             "vcount library_geometries library_nodes library_visual_scenes ",
             name) ||
         std::any_of(kChildren.begin(), kChildren.end(), [&](const Children& rule) {
           return isListed(rule.children, name) && name != "extra";
         });
}

/// Returns whether an element may be in another. In <asset> and the root, all may be whose names
/// are not miswritten ones of those that are read.
bool isKnownIn(std::string_view parent, std::string_view name) {
  for (const Children& rule : kChildren)
    if (isListed(rule.parents, parent)) return isListed(rule.children, name);
  return !(parent == "asset" || parent == "COLLADA") || name == lowered(name);
}

/// The numbers that a node's transforms have. assimp reads as many, and drops further ones.
std::size_t sizeOfTransform(std::string_view name) {
  return name == "rotate"                         ? 4
         : name == "translate" || name == "scale" ? 3
         : name == "matrix"                       ? 16
                                                  : 0;
}

class ColladaCheck : public XmlCheck {
 public:
  using XmlCheck::XmlCheck;

 private:
  /// How positions are read from an array. assimp looks for the names X, Y and Z, reads the first
  /// value for each that it does not find, and takes 1 for a missing stride.
  struct Accessor {
    std::string_view array;
    long count = 0, offset = 0, stride = 1;
    std::string names;  // of the parameters, with a blank behind each
    long parameters = 0;
    int line = 0;
  };

  void enter(const XmlTag& tag) override {
    if (std::none_of(open_.begin(), open_.end(), [](const XmlTag& around) {
          return isListed(" extra technique ", around.name);
        })) {
      checkCase(tag, {"id", "url", "meter", "source", "offset", "stride", "count", "semantic"});
      if (!isKnownIn(around(0), tag.name))
        fault(tag.line, "<" + std::string(tag.name) + "> is not known in <" +
                            std::string(around(0)) +
                            ">, and assimp drops it; correct its name, or remove it");
      else if (const auto colon = tag.name.find(':');
               colon != tag.name.npos && isRead(tag.name.substr(colon + 1)))
        fault(tag.line, "<" + std::string(tag.name) +
                            "> has a namespace prefix, and assimp drops it; remove the prefix");
    }
    const bool isInLibrary = around(0) == "library_nodes";
    if (tag.name == "node") {
      if (tag.find("id")) requireOwnId(tag);
      nodes_.push_back(tag);
    }
    if (tag.name == "instance_node") instanced_.insert(tag.value("url"));
    if (isListed(" instance_node instance_geometry instance_visual_scene ", tag.name) &&
        !tag.find("url"))
      fault(tag.line, "<" + std::string(tag.name) + "> has no url; add it, or remove the element");
    if (isListed(" geometry visual_scene ", tag.name) || (tag.name == "node" && isInLibrary))
      targets_.insert(tag.value("id"));
    if (const std::string_view url = tag.value("url");
        tag.name.starts_with("instance_") && url.starts_with('#'))
      urls_.insert(url.substr(1));
    if (tag.name == "mesh") {
      accessors_.clear();
      arrays_.clear();
      numbers_.clear();
      positions_.clear();
      hasFaces_ = false;
    }
    if (tag.name == "source" && around(0) == "mesh") {
      source_ = tag.value("id");
      if (!accessors_.try_emplace(source_).second)
        fault(tag.line, "two elements <source> of one <mesh> have the id \"" +
                            std::string(source_) + "\"; give each an id of its own");
    }
    if (tag.name.ends_with("_array") && around(0) == "source" && around(1) == "mesh" &&
        tag.find("id") &&
        !arrays_
             .try_emplace(tag.value("id"),
                          tag.name == "float_array" ? wholeNumberIn(tag.value("count")) : 0)
             .second)
      fault(tag.line, "two arrays of one <mesh> have the id \"" + std::string(tag.value("id")) +
                          "\"; give each an id of its own");
    if (tag.name == "shape" && isInPhysics())
      report_.note("the shapes of physics models are not read");
    if (tag.name == "accessor" && around(0) == "technique_common" && around(1) == "source")
      accessors_[source_] = accessorOf(tag);
    if (tag.name == "param" && around(0) == "accessor") {
      Accessor& accessor = accessors_[source_];
      ++accessor.parameters;
      if (!tag.value("name").empty()) accessor.names += std::string(tag.value("name")) + ' ';
    }
    if (tag.name == "input" && tag.value("semantic") == "POSITION") {
      if (around(0) != "vertices")
        fault(tag.line,
              "an <input> of semantic POSITION is not in <vertices>" + std::string(kInstead));
      positions_.push_back(tag.value("source"));
    }
    hasFaces_ |= isListed(kPrimitives, tag.name) && around(0) == "mesh";
  }

  bool isInPhysics() const {
    return std::any_of(open_.begin(), open_.end(), [](const XmlTag& around) {
      return around.name == "library_physics_models";
    });
  }

  static Accessor accessorOf(const XmlTag& tag) {
    Accessor accessor;
    accessor.array = tag.value("source");
    accessor.count = wholeNumberIn(tag.value("count"));
    accessor.offset = wholeNumberIn(tag.find("offset").value_or("0"));
    accessor.stride = wholeNumberIn(tag.find("stride").value_or("1"));
    accessor.line = tag.line;
    return accessor;
  }

  void leave(const XmlTag& tag) override {
    if (tag.name == "mesh" && hasFaces_) checkPositions(tag);
    if (tag.name == "float_array" && around(1) == "source" && around(2) == "mesh" &&
        tag.content.find(',') != tag.content.npos)
      fault(tag.line, "<float_array> has commas" + std::string(kDecimals));
    if (tag.name == "float_array" && around(1) == "source") numbers_[tag.value("id")] = tag;
    if (tag.name == "p" && isListed(kPrimitives, around(1))) checkIndices(tag);
    if (tag.name == "vcount" && around(1) == "polylist") checkCorners(tag);
    if (const std::size_t size = sizeOfTransform(tag.name); size > 0 && around(1) == "node")
      checkTransform(tag, size);
    if (isListed(" unit up_axis ", tag.name) && around(1) == "asset") checkAsset(tag);
  }

  /// Checks the positions of a mesh that has faces.
  void checkPositions(const XmlTag& mesh) {
    if (positions_.size() != 1)
      return fault(mesh.line,
                   "the <vertices> of a <mesh> need one <input> of semantic POSITION, "
                   "and have " +
                       std::to_string(positions_.size()));
    const auto found = accessors_.find(positions_[0].substr(positions_[0].starts_with('#')));
    if (found == accessors_.end())
      return fault(mesh.line, "the source \"" + std::string(positions_[0]) +
                                  "\" of positions is not in the <mesh>" + kInstead);
    const Accessor& a = found->second;
    const int line = a.line > 0 ? a.line : mesh.line;
    if (a.names != "X Y Z ")
      return fault(line,
                   "the <accessor> of positions needs <param>s of the names X, Y and Z in this "
                   "order, because assimp reads no others");
    if (a.stride < a.parameters)
      return fault(line, "the <accessor> of positions needs a stride of at least " +
                             std::to_string(a.parameters) + ", its number of <param>s");
    const auto array = arrays_.find(a.array.substr(a.array.starts_with('#')));
    const long size = array == arrays_.end() ? 0 : array->second;
    // The divisions keep large counts from overflowing.
    if (a.count < 0 || a.offset < 0 || size < 0 ||
        (a.count > 0 && (a.offset > size || size - a.offset < a.parameters ||
                         (size - a.offset - a.parameters) / a.stride < a.count - 1)))
      fault(line,
            "the <accessor> of positions reads beyond the end of its <float_array>; correct its "
            "count, stride or offset");
    if (array != arrays_.end()) checkDecimals(numbers_[array->first]);
  }

  /// Checks the numbers of an array: of "0.3d1", assimp reads 0.3 and 1.
  void checkDecimals(const XmlTag& array) {
    std::string_view rest = array.content;
    long numbers = 0;
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest), ++numbers)
      if (word.find(',') == word.npos && std::isnan(numberIn(word)))
        return fault(array.line, "<float_array> has \"" + std::string(word.substr(0, 32)) +
                                     "\", which is no decimal number" + kDecimals);
    if (array.content.find(',') != array.content.npos) return;  // a fault of its own
    if (numbers != wholeNumberIn(array.value("count")))
      fault(array.line, "<float_array> has " + std::to_string(numbers) +
                            " numbers, and the count is \"" + std::string(array.value("count")) +
                            "\"; correct one of them");
    checkDigits(array, kMostLostDecimals);
  }

  /// Checks that assimp reads an element's numbers as they are. @param slack for lost decimals
  void checkDigits(const XmlTag& tag, double slack) {
    report_.isText = true;
    std::string_view rest = tag.content;
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest))
      if (!isReadRightly(word, numberIn(word), slack))
        return fault(tag.line, "<" + std::string(tag.name) + "> has \"" +
                                   std::string(word.substr(0, 64)) + '"' + kDigits);
  }

  /// Checks the numbers of corners of polygons: assimp reads as many polygons as `count` says.
  void checkCorners(const XmlTag& tag) {
    std::string_view rest = tag.content;
    long count = 0;
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest), ++count)
      if (wholeNumberIn(word) < 0) return fault(tag.line, "<vcount> may have whole numbers only");
    if (const XmlTag& polygons = open_[open_.size() - 2];
        count != wholeNumberIn(polygons.value("count")))
      fault(tag.line, "<vcount> has " + std::to_string(count) + " numbers, and the count is \"" +
                          std::string(polygons.value("count")) + "\"; correct one of them");
  }

  /// Checks indices: assimp takes negative ones for 0, stops at comments, and reads none where the
  /// count is 0.
  void checkIndices(const XmlTag& tag) {
    if (tag.content.find_first_not_of("0123456789 \t\r\n") != tag.content.npos)
      fault(tag.line, "<p> may have whole numbers only");
    std::string_view rest = tag.content;
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest))
      if (word.size() >= 10 && wholeNumberIn(word) < 0)
        return fault(tag.line, "<p> may have numbers below 2^31 only");
    const XmlTag& primitives = open_[open_.size() - 2];
    if (!withoutBlanks(tag.content).empty() && wholeNumberIn(primitives.value("count")) <= 0)
      fault(primitives.line, "<" + std::string(primitives.name) +
                                 "> needs the number of its primitives as its count");
  }

  void checkTransform(const XmlTag& tag, std::size_t size) {
    const std::vector<double> numbers = numbersIn(tag.content);
    if (numbers.size() != size ||
        std::any_of(numbers.begin(), numbers.end(), [](double x) { return std::isnan(x); }))
      return fault(tag.line, "<" + std::string(tag.name) + "> needs " + std::to_string(size) +
                                 " decimal numbers");
    checkDigits(tag, slackOf(tag, numbers));
    if (tag.name == "rotate" && numbers[3] != 0 && !hasLengthOne(numbers.data(), 3))
      fault(tag.line,
            "the axis of <rotate> is not of length 1, and assimp would distort the mesh; write the "
            "axis with length 1, with six digits or more");
    if (tag.name == "rotate" && std::abs(numbers[3]) > 720)
      fault(tag.line, "the angle of <rotate> is rounded to a float; write one from -720 to 720");
    addToNode(tag, numbers);
  }

  /// Returns what the numbers of a transform may lose. Those of a scale, and those of a matrix that
  /// turn and scale, multiply coordinates, so that they may lose nothing that counts beside them.
  static double slackOf(const XmlTag& tag, const std::vector<double>& numbers) {
    if (tag.name == "scale") return 0;
    if (tag.name != "matrix") return kMostLostDecimals;
    double largest = 0;
    for (const int i : {0, 1, 2, 4, 5, 6, 8, 9, 10})
      largest = std::max(largest, std::abs(numbers[static_cast<std::size_t>(i)]));
    return kMostLostDecimals * std::min(1.0, largest);
  }

  /// Adds a transform to those of its node. assimp multiplies them in floats. In their product,
  /// lengths may cancel, so they are added up without signs. Scales could cancel, too, so only one
  /// transform of a node may scale.
  void addToNode(const XmlTag& tag, const std::vector<double>& numbers) {
    Product& product = products_[open_[open_.size() - 2].from];
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (tag.name == "translate") moved = {numbers[0], numbers[1], numbers[2]};
    if (tag.name == "matrix") moved = {numbers[3], numbers[7], numbers[11]};
    product.bound.length += product.scale * (moved.norm() + kLostLength);
    ++product.count;
    // A product of two matrices rounds four terms of each entry, with factors of 2^-24.
    product.bound.rounding += 0x1p-21;
    if (tag.name == "rotate") {
      // The angle in radians has three roundings.
      constexpr double kRadians = 3.15 / 180;
      product.bound.rounding += 3 * 0x1p-24 * kRadians * std::abs(numbers[3]);
      if (numbers[3] != 0) product.bound.rounding += 2 * lengthError(numbers.data(), 3);
    }
    if (tag.name == "scale" || tag.name == "matrix") {
      if (product.scales)
        fault(tag.line,
              "a <node> has a second <scale> or <matrix>; multiply them, or write two nodes");
      product.scales = true;
    }
    if (tag.name == "scale")
      product.scale = std::max({std::abs(numbers[0]), std::abs(numbers[1]), std::abs(numbers[2])});
    if (tag.name == "matrix")
      product.scale =
          Eigen::Map<const Eigen::Matrix4d>(numbers.data()).topLeftCorner<3, 3>().norm();
    if (product.count > 1)  // else the length is that of the node's own translation
      report_.node.length = std::max(report_.node.length, product.bound.length);
    report_.node.rounding = std::max(report_.node.rounding, product.bound.rounding);
  }

  /// Checks that an <asset> within the document says what the document's own says: assimp reads
  /// that one only.
  void checkAsset(const XmlTag& tag) {
    const std::size_t depth = open_.size();
    if (depth < 3) return;
    double unit = unit_;
    std::string_view up = up_;
    if (tag.name == "up_axis") up = withoutBlanks(tag.content);
    if (const std::string_view meter = tag.value("meter"); tag.name == "unit")
      unit = meter.empty() ? 1 : numberIn(meter);
    if (tag.name == "unit" &&
        !isReadRightly(withoutBlanks(tag.find("meter").value_or("1")), unit, 0))
      fault(tag.line, "<unit> has a meter" + std::string(kDigits));
    hasInnerAsset_ |= depth > 3;
    if (hasInnerAsset_ && (unit != unit_ || up != up_))
      fault(tag.line, "an <asset> within the document has another <" + std::string(tag.name) +
                          "> than the document, which assimp does not apply" + kInstead);
    unit_ = unit;
    up_ = up;
  }

  void end() override {
    // assimp looks for the name before the id.
    for (const XmlTag& node : nodes_)
      if (const std::string url = "#" + std::string(node.value("name"));
          node.value("name") != node.value("id") && instanced_.contains(url))
        fault(node.line,
              "the name of this <node> is the id that an <instance_node> asks for; give "
              "the node another name");
    if (std::any_of(targets_.begin(), targets_.end(),
                    [&](std::string_view id) { return !urls_.contains(id); }))
      report_.note("geometries that are in no node of the scene are not read");
  }

  // The document's unit and up-axis, and the ids of what may be instanced.
  double unit_ = 1;
  std::string_view up_ = "Y_UP";
  bool hasInnerAsset_ = false;
  /// The transforms of a node.
  struct Product {
    int count = 0;
    double scale = 1;
    bool scales = false;  ///< one of them is a scale or a matrix
    ContentReport::NodeBound bound;
  };
  std::map<std::size_t, Product> products_;  // by the place of the node's tag
  std::set<std::string_view> targets_, urls_, instanced_;
  std::vector<XmlTag> nodes_;
  // The last <mesh>: its sources by their ids, the sizes of its arrays, and its positions.
  std::map<std::string_view, Accessor> accessors_;
  std::map<std::string_view, long> arrays_;
  std::map<std::string_view, XmlTag> numbers_;  // the arrays themselves
  std::string_view source_;
  std::vector<std::string_view> positions_;
  bool hasFaces_ = false;
};

}  // namespace

void checkCollada(const std::string& file, std::string_view text, ContentReport& report) {
  ColladaCheck(kCollada, file, text, report).run();
}

}  // namespace corridor
