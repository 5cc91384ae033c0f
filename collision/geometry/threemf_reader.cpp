// Reads 3MF (3MF Consortium, Core Specification 1.3): the objects of the build, under their
// transforms. minizip unpacks the archive.
#include <map>
#include <memory>
#include <minizip/unzip.h>
#include <optional>
#include <set>

#include "collision/core/spelling.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/scene_mesh.h"
#include "collision/geometry/xml_tree.h"

namespace corridor {
namespace {

using xml::childrenOf;
using xml::Element;
using xml::nameOf;
using xml::onlyChild;

constexpr const char* kInstead = "; save the mesh as OBJ, STL, PLY or OFF";
/// An unpacked file needs a multiple of its size; the largest is that of other mesh files.
constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 30;

class Archive {
 public:
  Archive(const std::string& file, MeshFaults& faults)
      : faults_(faults), zip_(unzOpen(file.c_str()), unzClose) {
    if (!zip_) faults.fail(0, "the file is no ZIP archive" + std::string(kInstead));
  }

  /// Returns the bytes of the file of this name. Capital and small letters are one, as in OPC.
  std::string bytesOf(std::string_view wanted) {
    std::optional<std::string> found;
    for (int status = unzGoToFirstFile(zip_.get()); status == UNZ_OK;
         status = unzGoToNextFile(zip_.get())) {
      unz_file_info info;
      if (lowered(current(info)) != lowered(wanted)) continue;
      if (found) faults_.fail(0, "has " + inQuotes(wanted) + " twice" + kInstead);
      if (info.uncompressed_size == 0xFFFFFFFF || info.compressed_size == 0xFFFFFFFF)
        faults_.fail(0,
                     "is a ZIP64 archive, which is not read; pack it as an ordinary ZIP, or save "
                     "the mesh in another format");
      // A few kilobytes could be packed gigabytes. Models have a tenth to a fiftieth of their size.
      if (info.uncompressed_size / 200 > info.compressed_size + (std::size_t{1} << 17))
        faults_.fail(
            0, "a file in it has more than 200 times its packed size" + std::string(kInstead));
      if (info.compression_method != 0 && info.compression_method != Z_DEFLATED)
        faults_.fail(0, "a file in it is packed by another method than that of ordinary ZIP files" +
                            std::string(kInstead));
      found = unpacked(info.uncompressed_size);
    }
    if (!found) faults_.fail(0, "the archive has no file " + inQuotes(wanted) + kInstead);
    return *found;
  }

  /// Returns the names of all files.
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (int status = unzGoToFirstFile(zip_.get()); status == UNZ_OK;
         status = unzGoToNextFile(zip_.get())) {
      unz_file_info info;
      all.push_back(current(info));
    }
    return all;
  }

 private:
  /// Returns the name of the file at which the archive stands.
  std::string current(unz_file_info& info) {
    char name[65536];
    if (unzGetCurrentFileInfo(zip_.get(), &info, name, sizeof name, nullptr, 0, nullptr, 0) !=
        UNZ_OK)
      faults_.fail(0, "its directory is damaged" + std::string(kInstead));
    return {name, info.size_filename};
  }
  std::string unpacked(std::size_t size) {
    if (size > kMostUnpackedBytes)
      faults_.fail(0, "its model has more than 1 GiB" + std::string(kInstead));
    std::string bytes(size, '\0');
    // One byte more than promised would be an error, too.
    char more = 0;
    if (unzOpenCurrentFile(zip_.get()) != UNZ_OK ||
        unzReadCurrentFile(zip_.get(), bytes.data(), static_cast<unsigned>(size)) !=
            static_cast<int>(size) ||
        unzReadCurrentFile(zip_.get(), &more, 1) != 0 || unzCloseCurrentFile(zip_.get()) != UNZ_OK)
      faults_.fail(0, "a file in it is damaged or encrypted" + std::string(kInstead));
    return bytes;
  }

  MeshFaults& faults_;
  std::unique_ptr<void, int (*)(unzFile)> zip_;
};

/// Returns 3MF's unit in metres; 0 if it is unknown.
double metresOf(std::string_view name) {
  return name == "millimeter"   ? 0.001
         : name == "micron"     ? 1e-6
         : name == "centimeter" ? 0.01
         : name == "inch"       ? 0.0254
         : name == "foot"       ? 0.3048
         : name == "meter"      ? 1
                                : 0;
}

class ModelReader {
 public:
  ModelReader(const Element& model, MeshFaults& faults)
      : model_(model), faults_(faults), scene_(faults) {}

  ReadMesh read() {
    check(model_, {"metadata", "metadatagroup", "resources", "build"},
          {"unit", "requiredextensions", "recommendedextensions", "thumbnail"});
    const std::string_view unit = xml::attribute(model_, "unit").value_or("millimeter");
    const double metres = metresOf(unit);
    if (metres == 0)
      fault(model_, "the unit " + inQuotes(unit) +
                        " is not one of 3MF; write micron, millimeter, centimeter, inch, foot or "
                        "meter");
    checkExtensions();
    const Element* const resources = onlyChild(model_, "resources", faults_);
    const Element* const build = onlyChild(model_, "build", faults_);
    if (!resources || !build)
      faults_.fail(model_.GetLineNum(), "the model has no resources or no build");
    findObjects(*resources);
    faults_.throwIfAny();
    check(*build, {"item"}, {});
    for (const Element* item : childrenOf(*build, "item")) {
      check(*item, {"metadatagroup"}, {"objectid", "transform", "partnumber", "printable"});
      place(*item, {}, 1);
    }
    if (used_.size() < objects_.size())
      scene_.note("objects that are in no item of the build are not read");
    for (const std::string& text : notes_) scene_.note(text);
    ReadMesh read = scene_.take("3MF");
    read.fileUnit = metres;
    return read;
  }

 private:
  void fault(const Element& element, std::string text) {
    faults_.add(element.GetLineNum(), std::move(text));
  }
  void check(const Element& element, std::initializer_list<std::string_view> children,
             std::initializer_list<std::string_view> attributes) {
    xml::check(element, children, attributes, faults_, notes_);
  }

  /// Only extensions that are about looks, or lists of triangles, may be required.
  void checkExtensions() {
    TextCursor cursor(xml::attribute(model_, "requiredextensions").value_or(""));
    for (std::string_view prefix = cursor.word(); !prefix.empty(); prefix = cursor.word()) {
      const std::string name = "xmlns:" + std::string(prefix);
      const std::string_view space = xml::attribute(model_, name.c_str()).value_or("");
      if (space.find("/material/") == space.npos && space.find("/trianglesets/") == space.npos &&
          space.find("/production/") == space.npos)
        fault(model_,
              "the required extension " + inQuotes(prefix) + " is not supported" + kInstead);
    }
  }

  /// Finds the objects by their ids. All resources share their ids. Resources of extensions have a
  /// prefix; they are about looks.
  void findObjects(const Element& resources) {
    std::set<std::uint32_t> ids;
    xml::check(resources, {"object", "basematerials"}, {}, faults_, notes_, isLooks);
    for (const Element* resource = resources.FirstChildElement(); resource;
         resource = resource->NextSiblingElement()) {
      const bool isObject = nameOf(*resource) == "object";
      if (!isObject && !xml::attribute(*resource, "id")) continue;
      const std::uint32_t id = xml::wholeNumber(*resource, "id", std::nullopt, faults_);
      if (!ids.insert(id).second)
        fault(*resource, "the id " + std::to_string(id) +
                             " is used twice; give each resource a number of its own");
      if (isObject) objects_[id] = resource;
    }
  }
  /// Returns whether an element with a prefix belongs to the extensions for materials and for sets
  /// of triangles.
  static bool isLooks(std::string_view name) {
    constexpr std::string_view kExtensions =
        " colorgroup texture2d texture2dgroup compositematerials multiproperties "
        "pbspeculardisplayproperties pbmetallicdisplayproperties "
        "pbspeculartexturedisplayproperties pbmetallictexturedisplayproperties "
        "translucentdisplayproperties trianglesets ";
    const auto colon = name.find(':');
    return colon != name.npos &&
           kExtensions.find(" " + std::string(name.substr(colon + 1)) + " ") != kExtensions.npos;
  }

  /// Places the object of an item or a component.
  void place(const Element& reference, NodePath path, int depth) {
    const std::string tag = "<" + printable(reference.Name()) + ">";
    for (const auto* a = reference.FirstAttribute(); a; a = a->Next())
      if (std::string_view(a->Name()).ends_with(":path"))
        fault(reference, tag + " is in another model, which is not supported" + kInstead);
    const std::uint32_t id = xml::wholeNumber(reference, "objectid", std::nullopt, faults_);
    if (const auto transform = xml::attribute(reference, "transform"))
      path = path.below(transformOf(*transform, reference, tag));
    faults_.throwIfAny();
    const auto object = objects_.find(id);
    if (object == objects_.end())
      return fault(reference,
                   tag + " names an object that is not in the model; correct its objectid");
    used_.insert(id);
    const Element& element = *object->second;
    scene_.visit(depth, xml::childCount(element));
    const Element* const components = onlyChild(element, "components", faults_);
    const Element* const mesh = onlyChild(element, "mesh", faults_);
    if ((components == nullptr) == (mesh == nullptr))
      return fault(element, "an <object> needs a <mesh> or <components>");
    if (mesh) {
      const ScenePart& part = partOf(element, *mesh);
      faults_.throwIfAny();
      return scene_.add(part, path);
    }
    checkObject(element);
    check(*components, {"component"}, {});
    for (const Element* component : childrenOf(*components, "component")) {
      check(*component, {}, {"objectid", "transform"});
      place(*component, path, depth + 1);
    }
  }

  Eigen::Affine3d transformOf(std::string_view text, const Element& element,
                              const std::string& tag) {
    const auto m = xml::numbersIn(text, "the transform of " + tag, element.GetLineNum(), faults_);
    Eigen::Affine3d step = Eigen::Affine3d::Identity();
    if (m.size() != 12)
      fault(element, "the transform of " + tag + " needs 12 decimal numbers");
    else  // a row vector times a matrix of four rows: the columns of the map are its rows
      step.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(m.data());
    return step;
  }

  void checkObject(const Element& object) {
    check(object, {"mesh", "components", "metadatagroup"},
          {"id", "type", "name", "partnumber", "pid", "pindex", "thumbnail"});
  }

  const ScenePart& partOf(const Element& object, const Element& mesh) {
    const auto [entry, isNew] = parts_.try_emplace(&mesh);
    ScenePart& part = entry->second;
    if (!isNew) return part;
    checkObject(object);
    xml::check(mesh, {"vertices", "triangles"}, {}, faults_, notes_, isLooks);
    const Element* const vertices = onlyChild(mesh, "vertices", faults_);
    const Element* const triangles = onlyChild(mesh, "triangles", faults_);
    if (!vertices || !triangles) {
      fault(mesh, "a <mesh> needs <vertices> and <triangles>");
      return part;
    }
    check(*vertices, {"vertex"}, {});
    check(*triangles, {"triangle"}, {});
    for (const Element* v = vertices->FirstChildElement("vertex"); v;
         v = v->NextSiblingElement("vertex")) {
      check(*v, {}, {"x", "y", "z"});
      Vec3 vertex = Vec3::Zero();
      int k = 0;
      for (const char* const name : {"x", "y", "z"}) {
        const auto numbers =
            xml::numbersIn(xml::required(*v, name, faults_), "<vertex>", v->GetLineNum(), faults_);
        if (numbers.size() != 1)
          fault(*v, "<vertex> needs one decimal number " + std::string(name));
        else
          vertex[k] = numbers[0];
        ++k;
      }
      part.vertices.push_back(vertex);
      faults_.requireFew(part.vertices.size(), "vertices", v->GetLineNum());
    }
    for (const Element* t = triangles->FirstChildElement("triangle"); t;
         t = t->NextSiblingElement("triangle")) {
      check(*t, {}, {"v1", "v2", "v3", "p1", "p2", "p3", "pid"});
      std::uint32_t corner[3];
      for (int k = 0; k < 3; ++k) {
        const std::string name = "v" + std::to_string(k + 1);
        corner[k] = xml::wholeNumber(*t, name.c_str(), std::nullopt, faults_);
        if (corner[k] >= part.vertices.size())
          fault(*t, name + " of <triangle> is vertex " + std::to_string(corner[k]) +
                        " (from 0), and there are " + std::to_string(part.vertices.size()));
      }
      part.addFace({corner[0], corner[1], corner[2]}, t->GetLineNum());
    }
    return part;
  }

  const Element& model_;
  MeshFaults& faults_;
  SceneMesh scene_;
  std::vector<std::string> notes_;
  std::map<std::uint32_t, const Element*> objects_;
  std::set<std::uint32_t> used_;
  std::map<const Element*, ScenePart> parts_;
};

/// Returns the name of the model to which the archive's relations point.
std::string modelNamed(const std::string& relations, MeshFaults& faults) {
  tinyxml2::XMLDocument document;
  const Element& root = xml::parse(document, relations, "Relationships", faults);
  std::vector<std::string> notes;  // on attributes that have nothing to do with the model
  xml::check(root, {"Relationship"}, {}, faults, notes);
  std::string target;
  for (const Element* relation : childrenOf(root, "Relationship")) {
    xml::check(*relation, {}, {"Id", "Type", "Target", "TargetMode"}, faults, notes);
    if (xml::attribute(*relation, "Type") !=
        "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel")
      continue;
    if (!target.empty())
      faults.add(
          relation->GetLineNum(),
          "_rels/.rels names a second model, which is not supported" + std::string(kInstead));
    target = xml::required(*relation, "Target", faults);
    if (xml::attribute(*relation, "TargetMode").value_or("Internal") != "Internal")
      faults.add(relation->GetLineNum(),
                 "_rels/.rels names a model outside the archive" + std::string(kInstead));
  }
  if (target.empty())
    faults.add(0, "_rels/.rels must name the model of the archive" + std::string(kInstead));
  faults.throwIfAny();
  return target.substr(std::min(target.find_first_not_of('/'), target.size()));
}

}  // namespace

ReadMesh readThreeMf(const std::string& file, MeshFaults& faults) {
  Archive archive(file, faults);
  const std::string name = modelNamed(archive.bytesOf("_rels/.rels"), faults);
  const std::string model = archive.bytesOf(name);
  tinyxml2::XMLDocument document;
  ReadMesh read = ModelReader(xml::parse(document, model, "model", faults), faults).read();
  for (const std::string& other : archive.names())
    if (const std::string small = lowered(other);
        small.ends_with(".model") && !small.starts_with("__macosx/") && small != lowered(name))
      addNote(read.notes, "the model " + inQuotes(other) + " of the archive is not read");
  return read;
}

}  // namespace corridor
