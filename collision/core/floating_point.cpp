#include "collision/core/floating_point.h"

#include <stdexcept>
#include <string>

namespace corridor {

void requireStandardFloatingPoint() {
  const FloatingPoint state = floatingPoint();
  if (state != FloatingPoint::standard)
    throw std::runtime_error(std::string("Corridor can prove nothing: ") + described(state));
}

}  // namespace corridor
