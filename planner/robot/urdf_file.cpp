#include "planner/robot/urdf_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <numbers>
#include <unordered_map>
#include <urdf_model/model.h>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/rpy.h"
#include "planner/robot/urdf_outline.h"
#include "planner/robot/urdfdom.h"
#include "planner/robot/xacro.h"

namespace corridor {
namespace {

/// Reports a single fault with everything that urdfdom printed. The fault's line is the line of the
/// joint or link that the text names.
void faultErrors(const std::vector<std::string>& errors, const UrdfOutline& outline,
                 XmlFile& file) {
  std::string text = "the library urdfdom refuses this URDF";
  for (const std::string& error : errors) text += (&error == errors.data() ? ": " : "; ") + error;
  const auto lineOf = [&](const auto& all) {
    for (const auto& named : all) {
      const std::string name = urdfdomName(named.name);
      if (text.find("[" + name + "]") != text.npos || text.find("'" + name + "'") != text.npos)
        return named.line;
    }
    return 0;
  };
  const int joint = lineOf(outline.joints);
  file.fault(joint > 0 ? joint : lineOf(outline.links), text);
}

RigidPose poseOf(const urdf::Pose& pose, const Vec3& rpy) {
  return {Vec3(pose.position.x, pose.position.y, pose.position.z), quaternionFromRpy(rpy)};
}

std::optional<Primitive> primitiveOf(const urdf::Geometry& geometry, bool isCapsule) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry))
    return Box{Vec3(box->dim.x, box->dim.y, box->dim.z)};
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry))
    return Sphere{sphere->radius};
  const auto* const cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry);
  if (cylinder && isCapsule) return Capsule{cylinder->radius, cylinder->length};
  if (cylinder) return Cylinder{cylinder->radius, cylinder->length};
  return std::nullopt;
}

/// Makes the note on units anew, for a mesh that was read in metres and is then scaled.
void noteScaledUnits(MeshFile& file, const Vec3& scale) {
  if (const auto before = noteOnUnits(file.statedUnits, 1)) std::erase(file.notes, *before);
  for (const double factor : scale)
    if (auto note = noteOnUnits(file.statedUnits, std::abs(factor)))
      return file.notes.push_back(std::move(*note));
}

MeshFile placedMesh(MeshFile result, const Vec3& scale, const Transform& X) {
  if (scale != Vec3::Ones()) {
    for (Vec3& vertex : result.mesh.vertices) vertex = vertex.cwiseProduct(scale);
    result.unitRule += "; times the URDF's scale " + shortest(scale.x()) + " " +
                       shortest(scale.y()) + " " + shortest(scale.z());
    noteScaledUnits(result, scale);
  }
  if (!(X == Transform{}))
    for (Vec3& vertex : result.mesh.vertices) vertex = X * vertex;
  return result;
}

class UrdfBuilder {
 public:
  UrdfBuilder(const UrdfOutline& outline, const urdf::ModelInterface& urdf, const MeshStore& meshes,
              XmlFile& file)
      : outline_(outline), urdf_(urdf), meshes_(meshes), file_(file) {}

  /// @param order  the outline's joints in the tree's order.
  /// @param mimics for each of the outline's joints.
  RobotDescription build(const std::vector<std::size_t>& order,
                         const std::vector<std::optional<Mimic>>& mimics) {
    model_.name = model_.urdfName = outline_.name;
    for (std::size_t i = 0; i < outline_.links.size(); ++i) {
      linkIndex_[outline_.links[i].name] = i;
      addLink(outline_.links[i]);
    }
    for (const std::size_t j : order) addJoint(outline_.joints[j]);
    finishRobot(order, mimics, model_);
    return std::move(model_);
  }

 private:
  void addLink(const UrdfLink& outline) {
    LinkModel& link = model_.links.emplace_back();
    link.name = outline.name;
    const auto source = urdf_.getLink(urdfdomName(outline.name));
    const std::size_t count = source ? source->collision_array.size() : 0;
    if (count != outline.collisions.size())
      return file_.fault(outline.line, owned("link", outline.name) + ": it has " +
                                           std::to_string(outline.collisions.size()) +
                                           " <collision>, but urdfdom returns " +
                                           std::to_string(count));
    for (std::size_t i = 0; i < count; ++i)
      addShape(*source->collision_array[i], outline.collisions[i],
               count == 1 ? link.name : link.name + "/" + std::to_string(i + 1));
  }

  void addShape(const urdf::Collision& source, const UrdfCollision& outline, std::string name) {
    PlacedShape shape;
    shape.name = std::move(name);
    shape.at = poseOf(source.origin, outline.rpy);
    const Transform X{matrixFromRpy(outline.rpy), shape.at.p};
    bool finite = true;
    if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(source.geometry.get())) {
      shape.file = outline.mesh;
      shape.mesh = meshAt(outline.mesh, Vec3(mesh->scale.x, mesh->scale.y, mesh->scale.z), X);
      for (const Vec3& vertex : shape.mesh->mesh.vertices) finite &= vertex.allFinite();
    } else {
      shape.primitive = primitiveOf(*source.geometry, outline.isCapsule);
      shape.parts.push_back(placed(*shape.primitive, X));
      shape.solid = true;
      for (const Vec3& point : shape.parts.front().points) finite &= point.allFinite();
    }
    if (shape.mesh && finite) noteLargeMesh(*shape.mesh, shape.name, outline.line);
    if (!finite)
      file_.fault(outline.line, owned("shape", shape.name) +
                                    ": its origin, size or scale is out of the range of doubles");
    model_.links.back().shapes.push_back(std::move(shape));
  }

  /// Returns the mesh of a file, scaled, in the link's coordinates. For equal scales and
  /// placements, the mesh is made once.
  const std::shared_ptr<const MeshFile>& meshAt(const std::filesystem::path& file,
                                                const Vec3& scale, const Transform& X) {
    const auto& source = meshes_.get(file);
    if (scale == Vec3::Ones() && X == Transform{}) return source;
    std::array<double, 15> numbers;
    std::copy_n(scale.data(), 3, numbers.begin());
    std::copy_n(X.m.data(), 9, numbers.begin() + 3);
    std::copy_n(X.t.data(), 3, numbers.begin() + 12);
    std::shared_ptr<const MeshFile>& mesh = placed_[{file, numbers}];
    if (!mesh) mesh = std::make_shared<const MeshFile>(placedMesh(*source, scale, X));
    return mesh;
  }

  /// Adds a note if a mesh is longer than 20 m. The coordinates of such a mesh are probably in
  /// millimetres; the link would then be longer than 20 mm.
  void noteLargeMesh(const MeshFile& file, const std::string& shape, int line) {
    Vec3 lower = file.mesh.vertices.front(), upper = lower;
    for (const Vec3& vertex : file.mesh.vertices) {
      lower = lower.cwiseMin(vertex);
      upper = upper.cwiseMax(vertex);
    }
    if (const double length = (upper - lower).maxCoeff(); length > kLongest)
      model_.notes.push_back({file_.at(line, owned("shape", shape) + " is " + shortest(length) +
                                                 " m long; if its mesh is in millimetres, it needs "
                                                 "scale=\"0.001 0.001 0.001\""),
                              NoteWeight::coverage});
  }

  /// Adds a note if a coordinate of a joint's origin has a magnitude above 20 m: such an origin is
  /// probably given in millimetres, too.
  void noteFarOrigin(const JointModel& joint) {
    const Vec3& p = joint.X_PJ.p;
    if (p.cwiseAbs().maxCoeff() > kLongest)
      model_.notes.push_back(
          {file_.at(joint.line, owned("joint", joint.name) + ": its origin, [" + shortest(p.x()) +
                                    ", " + shortest(p.y()) + ", " + shortest(p.z()) +
                                    "], is in metres, as URDF requires; are "
                                    "these millimetres?"),
           NoteWeight::coverage});
  }

  void addJoint(const UrdfJoint& outline) {
    JointModel& joint = model_.joints.emplace_back();
    joint.name = outline.name;
    joint.type = *outline.type;
    joint.parent = linkIndex_.at(outline.parent);
    joint.child = linkIndex_.at(outline.child);
    joint.line = outline.line;
    const auto source = urdf_.getJoint(urdfdomName(outline.name));
    if (!source)
      return file_.fault(outline.line,
                         owned("joint", outline.name) + ": urdfdom doesn't return it");
    joint.X_PJ = poseOf(source->parent_to_joint_origin_transform, outline.rpy);
    noteFarOrigin(joint);
    if (joint.type != JointType::fixed && joint.type != JointType::floating)
      joint.axis = scaledAxis({source->axis.x, source->axis.y, source->axis.z});
    if (joint.type == JointType::revolute || joint.type == JointType::prismatic) {
      const UrdfLimit limit = outline.limit.value_or(UrdfLimit());
      joint.lower = limit.lower.value_or(0);  // 0 as in urdfdom
      joint.upper = limit.upper.value_or(0);
    }
    // urdfdom requires the attribute, so files whose authors don't know the velocity have the
    // velocity 0.
    if (joint.type != JointType::fixed && !isPoseJoint(joint.type) && outline.limit &&
        outline.limit->velocity.value_or(0) > 0)
      joint.velocity = *outline.limit->velocity;
  }

  /// Metres. Meshes that are longer, and origins that are farther away, are probably in
  /// millimetres.
  static constexpr double kLongest = 20;

  const UrdfOutline& outline_;
  const urdf::ModelInterface& urdf_;
  const MeshStore& meshes_;
  XmlFile& file_;
  RobotDescription model_;
  std::unordered_map<std::string, std::size_t> linkIndex_;
  /// The meshes that `meshAt` made, by file and by the numbers of scale and placement.
  std::map<std::pair<std::filesystem::path, std::array<double, 15>>,
           std::shared_ptr<const MeshFile>>
      placed_;
};

}  // namespace

bool isUrdf(const std::filesystem::path& file) {
  const std::string extension = lowered(file.extension().string());
  if (extension == ".urdf" || isXacro(file)) return true;
  if ((!extension.empty() && extension != ".xml") || !whyNotOrdinaryFile(file).empty())
    return false;
  std::ifstream stream(file, std::ios::binary);
  std::string text(65536, '\0');  // comments, such as a licence, may come first
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  std::size_t at = text.find('<');
  while (at != text.npos && at + 1 < text.size() && (text[at + 1] == '?' || text[at + 1] == '!'))
    at = text.find('<', text.compare(at, 4, "<!--") == 0 ? text.find("-->", at) : at + 1);
  return at != text.npos && text.compare(at, 6, "<robot") == 0;
}

std::optional<RobotDescription> readUrdf(const std::filesystem::path& file, const UrdfRules& rules,
                                         std::vector<Fault>& faults,
                                         std::vector<std::filesystem::path>& files,
                                         std::vector<Note>* notesOfFaulty) {
  files.push_back(file);
  XmlFile xml(file, "a robot (URDF)", rules.xacro);
  MeshStore meshes(file, rules, files);
  std::optional<RobotDescription> model;
  std::vector<Note> notes;
  if (XmlFile::Element* const root = xml.root()) {
    const UrdfOutline outline = readUrdfOutline(xml, rules, meshes, notes);
    const std::vector<std::size_t> order = checkUrdfTree(outline, xml);
    const std::vector<std::optional<Mimic>> mimics = resolveMimics(outline, xml, notes);
    for (const auto& [package, folder] : meshes.guessedPackages()) {
      const std::string missing = "package " + quotedWord(package) + " was not found; ";
      if (meshes.isDoubtful(package))
        xml.fault(0, missing + folder.string() +
                         " has files of its meshes' names, but is the folder of another package; "
                         "add packages: {" +
                         package + ": FOLDER} to robot.yaml");
      else
        notes.push_back({file.string() + ": " + missing + "its files are taken from " +
                             folder.string() + ", above the URDF (packages: {" + package +
                             ": FOLDER} in robot.yaml sets another folder)",
                         NoteWeight::coverage});
    }
    if (const std::string slashes = meshes.noteOnSlashes(); !slashes.empty())
      notes.push_back({file.string() + ": " + slashes});
    for (const bool ofCollada : {true, false})
      if (const auto ignored = meshes.ignoredUpAxes(ofCollada); !ignored.empty())
        notes.push_back(
            {file.string() + ": " +
                 noteOnUp(joinedFirst(ignored),
                          ofCollada ? "collada_up: file in robot.yaml" : "a rotation in <origin>"),
             NoteWeight::coverage});
    std::vector<std::string> errors;
    if (xml.sound()) {
      if (const auto urdf = parseByUrdfdom(*root, errors))
        model = UrdfBuilder(outline, *urdf, meshes, xml).build(order, mimics);
      else
        faultErrors(errors, outline, xml);
    }
  }
  const bool sound = xml.sound();
  for (Fault& fault : xml.takeFaults()) faults.push_back(std::move(fault));
  if (!sound) {
    if (notesOfFaulty) addAll(notes, *notesOfFaulty);
    return std::nullopt;
  }
  model->notes.insert(model->notes.begin(), notes.begin(), notes.end());
  if (!xml.expanded().empty()) model->expanded[file] = xml.expanded();
  return model;
}

}  // namespace corridor
