#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace corridor {

/// Memory that queries keep, so that later queries need not allocate it again. It consists of one
/// object of each requested type. A query must not rely on the contents that an object has when the
/// query begins. While a function uses an object, it must not call a function that uses an object
/// of the same type.
class Scratch {
 public:
  Scratch() = default;
  /// A copy begins without any object.
  Scratch(const Scratch&) {}
  Scratch& operator=(const Scratch&) { return *this; }
  Scratch(Scratch&&) noexcept = default;
  Scratch& operator=(Scratch&&) noexcept = default;
  ~Scratch() = default;

  /// Returns the object of type T; creates it at the first call. The object keeps its address.
  template <class T>
  T& of() {
    for (const Slot& slot : slots_)
      if (slot.type == &kType<T>) return *static_cast<T*>(slot.memory.get());
    slots_.push_back({&kType<T>, {new T, [](void* memory) { delete static_cast<T*>(memory); }}});
    return *static_cast<T*>(slots_.back().memory.get());
  }

 private:
  // The address of `kType` identifies T. Not const, because linkers may merge constants.
  template <class T>
  static inline char kType = 0;
  struct Slot {
    const char* type;
    std::unique_ptr<void, void (*)(void*)> memory;
  };
  std::vector<Slot> slots_;  // a handful
};

}  // namespace corridor
