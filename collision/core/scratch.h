#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace corridor {

/// Memory that queries keep for the next query, so that they need not allocate it again: one object
/// of each type that is requested. Each family of queries defines a type of its own, and no other
/// family knows it. What an object holds when a query begins has no meaning.
class Scratch {
 public:
  Scratch() = default;
  /// A copy has no memory yet.
  Scratch(const Scratch&) {}
  Scratch& operator=(const Scratch&) { return *this; }
  Scratch(Scratch&&) noexcept = default;
  Scratch& operator=(Scratch&&) noexcept = default;
  ~Scratch() = default;

  /// Returns the object of type T; creates it at the first call. It keeps its address.
  template <class T>
  T& of() {
    for (const Slot& slot : slots_)
      if (slot.type == &kType<T>) return *static_cast<T*>(slot.memory.get());
    slots_.push_back({&kType<T>, {new T, [](void* memory) { delete static_cast<T*>(memory); }}});
    return *static_cast<T*>(slots_.back().memory.get());
  }

 private:
  template <class T>
  static constexpr char kType = 0;  // its address identifies T
  struct Slot {
    const char* type;
    std::unique_ptr<void, void (*)(void*)> memory;
  };
  std::vector<Slot> slots_;  // a handful
};

}  // namespace corridor
