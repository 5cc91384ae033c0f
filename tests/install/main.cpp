#include <iostream>

#include "collision/core/error.h"
#include "collision/geometry/mesh_file.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"

int main(int count, char** files) try {
  if (count != 3)
    throw corridor::InputError(corridor::Fault{files[0], 0, "two mesh files are needed"});
  const corridor::Obb4Tree a(corridor::readMeshFile(files[1]).mesh);  // metres; built once
  const corridor::Obb4Tree b(corridor::readMeshFile(files[2]).mesh);
  corridor::QueryContext context;  // scratch memory and counters: one per thread
  const corridor::Transform X_WA;  // where a stands in the world: x ↦ m·x + t, here the identity
  for (const double x : {0.5, 2.0}) {
    const corridor::Transform X_WB{corridor::Mat3::Identity(), {x, 0.25, 0.125}};
    if (const auto hit = interference(a, X_WA, b, X_WB, context))  // exact; touching is contact
      std::cout << "triangles " << hit->a << " and " << hit->b << " touch\n";
    std::cout << contacts(a, X_WA, b, X_WB, context).size() << " pairs of triangles touch\n";
    const corridor::Distance d = distance(a, X_WA, b, X_WB, {}, context);
    std::cout << "distance " << d.distance << " from " << d.p_WA.transpose() << " to "
              << d.p_WB.transpose() << "\n";
    const bool near = closerThan(a, X_WA, b, X_WB, 0.75, context);
    std::cout << (near ? "closer" : "farther") << " than 0.75\n";
  }
} catch (const corridor::InputError& error) {
  std::cerr << error.what() << "\n";
  return 2;
}
