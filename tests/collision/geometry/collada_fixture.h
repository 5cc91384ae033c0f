#pragma once

#include <string>

namespace corridor::test {

/// The places of a small Collada file of the triangle (0, 0, 0), (1, 0, 0), (0, 2, 0).
struct ColladaParts {
  std::string asset, libraries;       ///< line 1
  std::string inLibrary, inGeometry;  ///< line 2, before the <geometry> and <mesh>
  std::string array = R"(count="9">0 0 0 1 0 0 0 2 0)";
  std::string accessor = R"(count="3" stride="3")";
  std::string params = R"(<param name="X" type="float"/><param name="Y" type="float"/>)"
                       R"(<param name="Z" type="float"/>)";
  std::string inSource;  ///< after its <technique_common>
  std::string inputs = R"(<input semantic="POSITION" source="#p"/>)";  ///< line 3
  std::string faces = R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>)"
                      R"(<p>0 1 2</p></triangles>)";
  std::string inScene, node;  ///< line 4, before the <node> and in it
};

inline std::string colladaOf(const ColladaParts& parts) {
  return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         parts.asset + "</asset>" + parts.libraries + "\n<library_geometries>" + parts.inLibrary +
         R"(<geometry id="g">)" + parts.inGeometry +
         R"(<mesh><source id="p"><float_array id="pa" )" + parts.array +
         R"(</float_array><technique_common><accessor source="#pa" )" + parts.accessor + ">" +
         parts.params + "</accessor></technique_common>" + parts.inSource + R"(</source>
<vertices id="v">)" +
         parts.inputs + "</vertices>" + parts.faces + R"(</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">)" +
         parts.inScene + R"(<node id="n">)" + parts.node +
         R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

}  // namespace corridor::test
