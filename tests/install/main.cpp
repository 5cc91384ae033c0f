#include <iostream>

#include "collision/collision.h"

int main(int count, char** files) try {
  using namespace corridor;
  if (count != 3) throw InputError(Fault{files[0], 0, "two mesh files are needed"});
  const Obb4Tree a(readMeshFile(files[1]).mesh);  // metres; built once
  const Obb4Tree b(readMeshFile(files[2]).mesh);
  QueryContext context;  // scratch memory and counters: one per thread
  const Transform X_WA;  // where a stands in the world: x ↦ m·x + t, here the identity
  for (const double x : {0.5, 2.0}) {
    const Transform X_WB{Mat3::Identity(), {x, 0.25, 0.125}};
    if (const auto hit = interference({a, X_WA}, {b, X_WB}, context))  // touching is contact
      std::cout << "triangles " << hit->a << " and " << hit->b << " touch\n";
    std::cout << contacts({a, X_WA}, {b, X_WB}, context).size() << " pairs of triangles touch\n";
    const Distance d = distance({a, X_WA}, {b, X_WB}, {}, context);
    std::cout << "distance " << d.distance << " from " << d.p_WA.transpose() << " to "
              << d.p_WB.transpose() << "\n";
    const bool near = closerThan({a, X_WA}, {b, X_WB}, 0.75, context);
    std::cout << (near ? "closer" : "farther") << " than 0.75\n";
  }
} catch (const corridor::InputError& error) {
  std::cerr << error.what() << "\n";
  return 2;
}
