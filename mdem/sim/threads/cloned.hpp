// A pointer that copies its object, by the object's copy().
#pragma once

#include <memory>
#include <utility>

namespace ropewalk {

template <class T>
struct Cloned : std::unique_ptr<T> {
  using std::unique_ptr<T>::unique_ptr;
  Cloned(std::unique_ptr<T> owned) : std::unique_ptr<T>(std::move(owned)) {}
  Cloned(const Cloned& other) : std::unique_ptr<T>(other ? other->copy() : nullptr) {}
  Cloned(Cloned&&) = default;
  Cloned& operator=(Cloned other) noexcept {
    this->swap(other);
    return *this;
  }
};

}  // namespace ropewalk
