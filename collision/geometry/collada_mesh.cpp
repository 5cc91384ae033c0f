#include "collision/geometry/collada_mesh.h"

#include <algorithm>
#include <optional>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

using xml::childrenOf;
using xml::Element;
using xml::nameOf;
using xml::onlyChild;

class MeshReader {
 public:
  MeshReader(ColladaDocument& document, ScenePart& part) : document_(document), part_(part) {}

  void read(const Element& mesh) {
    document_.check(mesh,
                    {"source", "vertices", "lines", "linestrips", "polygons", "polylist",
                     "triangles", "trifans", "tristrips"},
                    {});
    const Element* const vertices = onlyChild(mesh, "vertices", document_.faults());
    bool areRead = false;
    for (const Element* child = mesh.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      const std::string_view name = nameOf(*child);
      if (name == "lines" || name == "linestrips") document_.note(kNoteOnLines);
      if (name != "triangles" && name != "polylist" && name != "polygons" && name != "trifans" &&
          name != "tristrips")
        continue;
      if (!vertices) return document_.fault(*child, "the <mesh> has no <vertices>");
      if (!areRead) readVertices(mesh, *vertices);
      areRead = true;
      document_.faults().throwIfAny();
      readFaces(*child, *vertices);
    }
  }

 private:
  /// Returns the element of a <mesh> that has an id.
  const Element* withId(const Element& mesh, const char* name, std::string_view url,
                        const Element& from) {
    const Element* found = nullptr;
    for (const Element* element : childrenOf(mesh, name)) {
      if (!url.starts_with('#') || xml::attribute(*element, "id") != url.substr(1)) continue;
      if (found)
        document_.fault(*element, "two elements <" + std::string(name) + "> of one <" +
                                      printable(mesh.Name()) + "> have the id " +
                                      inQuotes(url.substr(1)) + "; give each an id of its own");
      found = element;
    }
    if (!found)
      document_.fault(from, "the source " + inQuotes(url) + " is no <" + std::string(name) +
                                "> of its <" + printable(mesh.Name()) + ">");
    return found;
  }

  void readVertices(const Element& mesh, const Element& vertices) {
    document_.check(vertices, {"input"}, {"id", "name"});
    const Element* positions = nullptr;
    for (const Element* input : childrenOf(vertices, "input")) {
      document_.check(*input, {}, {"semantic", "source"});
      if (xml::required(*input, "semantic", document_.faults()) != "POSITION") continue;
      if (positions)
        document_.fault(*input, "<vertices> have a second <input> of semantic POSITION");
      positions = input;
    }
    if (!positions)
      return document_.fault(vertices, "<vertices> have no <input> of semantic POSITION");
    const Element* const source =
        withId(mesh, "source", xml::required(*positions, "source", document_.faults()), *positions);
    if (source) readPositions(*source);
  }

  void readPositions(const Element& source) {
    document_.check(source, {"asset", "float_array", "technique_common", "technique"},
                    {"id", "name"});
    document_.checkAsset(source);
    const Element* const technique = onlyChild(source, "technique_common", document_.faults());
    if (!technique)
      return document_.fault(source, "the <source> of positions has no <technique_common>");
    document_.check(*technique, {"accessor"}, {});
    const Element* const accessor = onlyChild(*technique, "accessor", document_.faults());
    if (!accessor) return document_.fault(source, "the <source> of positions has no <accessor>");
    document_.check(*accessor, {"param"}, {"source", "count", "offset", "stride"});
    const Element* const array = withId(
        source, "float_array", xml::required(*accessor, "source", document_.faults()), *accessor);
    if (!array) return;
    document_.check(*array, {}, {"id", "name", "count", "digits", "magnitude"});
    std::vector<std::string_view> names;
    for (const Element* param : childrenOf(*accessor, "param")) {
      document_.check(*param, {}, {"name", "type", "sid", "semantic"});
      names.push_back(xml::attribute(*param, "name").value_or(""));
    }
    if (names != std::vector<std::string_view>{"X", "Y", "Z"})
      return document_.fault(
          *accessor,
          "the <accessor> of positions needs <param>s of the names X, Y and Z in this "
          "order, and no others");
    const std::vector<double> numbers =
        xml::numbersIn(xml::textOf(*array, document_.faults()), "<float_array>",
                       array->GetLineNum(), document_.faults());
    document_.faults().throwIfAny();
    const std::uint64_t count =
        xml::wholeNumber(*accessor, "count", std::nullopt, document_.faults());
    const std::uint64_t stride = xml::wholeNumber(*accessor, "stride", 1, document_.faults());
    const std::uint64_t offset = xml::wholeNumber(*accessor, "offset", 0, document_.faults());
    if (numbers.size() != xml::wholeNumber(*array, "count", std::nullopt, document_.faults()))
      return document_.fault(*array, "<float_array> has " + std::to_string(numbers.size()) +
                                         " numbers, and the count is " +
                                         inQuotes(xml::attribute(*array, "count").value_or("")) +
                                         "; correct one of them");
    if (stride < 3)
      return document_.fault(*accessor, "the <accessor> of positions needs a stride of 3 or more");
    if (count > 0 && offset + stride * (count - 1) + 3 > numbers.size())
      return document_.fault(
          *accessor,
          "the <accessor> of positions reads beyond the end of its <float_array>; correct "
          "its count, stride or offset");
    document_.faults().requireFew(count, "vertices", accessor->GetLineNum());
    for (std::uint64_t i = 0; i < count; ++i)
      part_.vertices.emplace_back(&numbers[offset + stride * i]);
  }

  /// Reads the faces of <triangles>, <polylist>, <polygons>, <trifans> or <tristrips>.
  void readFaces(const Element& faces, const Element& vertices) {
    const std::string_view kind = nameOf(faces);
    if (kind == "polylist")
      document_.check(faces, {"input", "vcount", "p"}, {"count", "material", "name"});
    else
      document_.check(faces, {"input", "p"},
                      {"count", "material", "name"});  // <ph>: polygons with holes
    std::optional<std::uint32_t> offset;
    std::uint32_t stride = 0;
    for (const Element* input : childrenOf(faces, "input")) {
      document_.check(*input, {}, {"semantic", "source", "offset", "set"});
      const std::uint32_t at = xml::wholeNumber(*input, "offset", std::nullopt, document_.faults());
      stride = std::max(stride, at + 1);
      const std::string_view semantic = xml::required(*input, "semantic", document_.faults());
      if (semantic == "POSITION")
        document_.fault(*input, "an <input> of semantic POSITION is not in <vertices>");
      if (semantic != "VERTEX") continue;
      if (offset)
        document_.fault(*input,
                        "<" + std::string(kind) + "> has a second <input> of semantic VERTEX");
      offset = at;
      const std::string_view source = xml::required(*input, "source", document_.faults());
      if (!source.starts_with('#') || xml::attribute(vertices, "id") != source.substr(1))
        document_.fault(*input,
                        "the source " + inQuotes(source) + " is not the <vertices> of the <mesh>");
    }
    const std::uint32_t count = xml::wholeNumber(faces, "count", std::nullopt, document_.faults());
    document_.faults().throwIfAny();
    const std::vector<const Element*> lists = childrenOf(faces, "p");
    if (lists.empty() && count == 0) return;
    if (!offset)
      return document_.fault(faces,
                             "<" + std::string(kind) + "> has no <input> of semantic VERTEX");
    const bool isOneList = kind == "triangles" || kind == "polylist";
    if (lists.size() != (isOneList ? 1 : count))
      return document_.fault(faces, "<" + std::string(kind) + "> has " +
                                        std::to_string(lists.size()) + " <p>, and needs " +
                                        std::to_string(isOneList ? 1 : count) +
                                        "; correct its count");
    std::vector<std::uint32_t> sizes;  // of polygons
    if (kind == "polylist") {
      const Element* const list = onlyChild(faces, "vcount", document_.faults());
      if (!list) return document_.fault(faces, "<polylist> has no <vcount>");
      sizes = xml::indicesIn(xml::textOf(*list, document_.faults()), "<vcount>", list->GetLineNum(),
                             document_.faults());
      if (sizes.size() != count)
        document_.fault(*list, "<vcount> has " + std::to_string(sizes.size()) +
                                   " numbers, and the count is " + std::to_string(count) +
                                   "; correct one of them");
    } else if (kind == "triangles") {
      document_.faults().requireFew(count, "triangles", faces.GetLineNum());
      sizes.assign(count, 3);
    }
    document_.faults().throwIfAny();
    for (const Element* list : lists) {
      document_.check(*list, {}, {});
      std::vector<std::uint32_t> corners;
      const auto indices = xml::indicesIn(xml::textOf(*list, document_.faults()), "<p>",
                                          list->GetLineNum(), document_.faults());
      document_.faults().throwIfAny();
      if (indices.size() % stride != 0)
        return document_.fault(*list, "<p> has " + std::to_string(indices.size()) +
                                          " numbers, which is no multiple of its " +
                                          std::to_string(stride) + " offsets");
      for (std::size_t i = *offset; i < indices.size(); i += stride) {
        if (indices[i] >= part_.vertices.size())
          return document_.fault(*list, "<p> names vertex " + std::to_string(indices[i]) +
                                            " (from 0), and there are " +
                                            std::to_string(part_.vertices.size()));
        corners.push_back(indices[i]);
      }
      addFaces(kind, corners, sizes, *list);
    }
  }

  void addFaces(std::string_view kind, const std::vector<std::uint32_t>& corners,
                std::vector<std::uint32_t> sizes, const Element& list) {
    const int line = list.GetLineNum();
    if (kind == "trifans" || kind == "tristrips") {
      if (corners.size() < 3) document_.note(kNoteOnLines);
      for (std::size_t i = 2; i < corners.size(); ++i) {
        const std::uint32_t before = corners[kind == "trifans" ? 0 : i - 2];
        if (kind == "tristrips" && i % 2 != 0)  // every second triangle of a strip is turned over
          part_.addFace({corners[i - 1], before, corners[i]}, line);
        else
          part_.addFace({before, corners[i - 1], corners[i]}, line);
      }
      return;
    }
    if (kind == "polygons") sizes = {static_cast<std::uint32_t>(corners.size())};
    std::uint64_t all = 0;
    for (const std::uint32_t size : sizes) all += size;
    if (all != corners.size())
      return document_.fault(list, "<p> has " + std::to_string(corners.size()) +
                                       " corners, and needs " + std::to_string(all) +
                                       "; correct the count");
    auto corner = corners.begin();
    for (const std::uint32_t size : sizes) {
      if (size < 3) {
        document_.note(kNoteOnLines);
      } else {
        part_.corners.insert(part_.corners.end(), corner, corner + size);
        part_.faces.push_back({size, line});
      }
      corner += size;
    }
  }

  ColladaDocument& document_;
  ScenePart& part_;
};

}  // namespace

void readColladaMesh(const Element& mesh, ColladaDocument& document, ScenePart& part) {
  MeshReader(document, part).read(mesh);
}

}  // namespace corridor
