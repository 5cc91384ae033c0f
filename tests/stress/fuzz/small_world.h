#pragma once

#include <string>

#include "collision/core/read_file.h"
#include "tests/stress/fuzz/fuzz.h"

namespace corridor::fuzz {

/// Returns the text of a mesh file with a tetrahedron, for the extensions .obj, .ply and .stl; ""
/// for any other extension.
inline std::string tetrahedron(const std::string& ending) {
  if (ending == ".obj")
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  if (ending == ".ply")
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
           "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  if (ending != ".stl") return "";
  const char* const corners[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  const int faces[][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::string text = "solid t\n";
  for (const auto& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) text += std::string("vertex ") + corners[corner] + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid t\n";
}

/// Copies the YAML, URDF and SRDF files of the project's problems/ and robots/ into a folder, and
/// writes a tetrahedron for every OBJ, PLY and STL file. So the robots and meshes that inputs name
/// exist, and are read fast. The tetrahedra are also written into problems/p/, because the inputs
/// are written there.
inline void writeSmallWorld(const Folder& folder) {
  const std::filesystem::path source = CORRIDOR_SOURCE_DIR;
  for (const char* part : {"problems", "robots"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / part)) {
      if (!entry.is_regular_file()) continue;
      const std::string ending = entry.path().extension().string(), mesh = tetrahedron(ending),
                        name = std::filesystem::relative(entry.path(), source).string();
      if (!mesh.empty()) {
        folder.write(name, mesh);
        folder.write("problems/p/" + entry.path().filename().string(), mesh);
      } else if (ending == ".yaml" || ending == ".urdf" || ending == ".srdf") {
        folder.write(name, readFile(entry.path(), "an input"));
      }
    }
}

/// A small arm, for files that name a URDF: continuous, revolute, fixed, prismatic and mimicking
/// joints.
inline constexpr const char* kArmUrdf = R"(<robot name='armbot'>
<link name='base'><collision><geometry><box size='0.2 0.2 0.2'/></geometry></collision></link>
<link name='upper'><collision><origin xyz='0 0 0.25'/><geometry><mesh filename='wedge.obj' scale='0.1 0.1 0.5'/></geometry></collision></link>
<link name='lower'><collision><geometry><cylinder radius='0.05' length='0.4'/></geometry></collision></link>
<link name='flange'/>
<link name='finger'><collision><geometry><sphere radius='0.02'/></geometry></collision></link>
<link name='thumb'><collision><geometry><sphere radius='0.02'/></geometry></collision></link>
<joint name='pan' type='continuous'><parent link='base'/><child link='upper'/><origin xyz='0 0 0.2'/><axis xyz='0 0 1'/></joint>
<joint name='lift' type='revolute'><parent link='upper'/><child link='lower'/><origin xyz='0 0 0.5'/><axis xyz='0 1 0'/><limit lower='-3.14159' upper='3.14159' effort='1' velocity='1'/></joint>
<joint name='wrist' type='fixed'><parent link='lower'/><child link='flange'/><origin xyz='0 0 0.4'/></joint>
<joint name='slide' type='prismatic'><parent link='flange'/><child link='finger'/><axis xyz='1 0 0'/><limit lower='0.01' upper='0.05' effort='1' velocity='1'/></joint>
<joint name='follow' type='prismatic'><parent link='flange'/><child link='thumb'/><axis xyz='1 0 0'/><limit lower='-0.05' upper='0' effort='1' velocity='1'/><mimic joint='slide' multiplier='-1'/></joint>
</robot>
)";
inline constexpr const char* kArmSrdf = R"(<robot name='armbot'>
<group name='arm'><joint name='pan'/><joint name='lift'/></group>
<group name='hand'><chain base_link='flange' tip_link='finger'/></group>
<group name='all'><group name='arm'/><group name='hand'/></group>
<group_state name='ready' group='arm'><joint name='pan' value='0'/><joint name='lift' value='0.5'/></group_state>
<disable_collisions link1='base' link2='lower' reason='Never'/>
</robot>
)";
inline void writeArm(const Folder& folder) {
  folder.write("arm.urdf", kArmUrdf);
  folder.write("arm.srdf", kArmSrdf);
  folder.write("wedge.obj", tetrahedron(".obj"));
}

}  // namespace corridor::fuzz
