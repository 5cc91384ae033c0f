#pragma once

#include <cassert>
#include <memory>
#include <utility>
#include <vector>

namespace corridor {

/// Memory that queries keep, so that later queries need not allocate it again. It consists of one
/// object of each requested type. A query must not rely on the contents that an object has when the
/// query begins. While a function uses an object, it must not call a function that uses an object
/// of the same type; debug builds assert this.
class Scratch {
 public:
  /// The right to use an object, until this right is destroyed.
  template <class T>
  class Use {
   public:
    Use(T& object, bool& used) : object_(object), used_(used) {
      assert(!used && "two users of one scratch object");
      used_ = true;
    }
    ~Use() { used_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    T& operator*() const { return object_; }
    T* operator->() const { return &object_; }

   private:
    T& object_;
    bool& used_;
  };

  Scratch() = default;
  /// A copy begins without any object.
  Scratch(const Scratch&) {}
  Scratch& operator=(const Scratch&) { return *this; }
  Scratch(Scratch&&) noexcept = default;
  Scratch& operator=(Scratch&&) noexcept = default;
  ~Scratch() = default;

  /// Returns the right to use the object of type T; creates it at the first call. The object keeps
  /// its address.
  template <class T>
  [[nodiscard]] Use<T> use() {
    for (const Slot& slot : slots_)
      if (slot.type == &kType<T>) return held<T>(slot);
    slots_.push_back(
        {&kType<T>, {new Held<T>, [](void* memory) { delete static_cast<Held<T>*>(memory); }}});
    return held<T>(slots_.back());
  }

 private:
  template <class T>
  struct Held {
    T object;
    bool used = false;
  };
  // The address of `kType` identifies T. Not const, because linkers may merge constants.
  template <class T>
  static inline char kType = 0;
  struct Slot {
    const char* type;
    std::unique_ptr<void, void (*)(void*)> memory;  // a `Held` object
  };
  template <class T>
  static Use<T> held(const Slot& slot) {
    auto* const held = static_cast<Held<T>*>(slot.memory.get());
    return {held->object, held->used};
  }
  std::vector<Slot> slots_;  // a handful
};

}  // namespace corridor
