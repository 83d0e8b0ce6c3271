// array.hpp — a vector whose index may be signed.
#pragma once
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace molmesh {

/// std::vector, whose index may be any integer type: numbers of points and elements are signed here, and -1 means
/// none. Builds without NDEBUG check the index.
template <class T, class Allocator = std::allocator<T>>
class Array : public std::vector<T, Allocator> {
public:
  using Vector = std::vector<T, Allocator>;
  using Vector::Vector;
  Array() = default;
  Array(const Vector& v) : Vector(v) {}
  Array(Vector&& v) noexcept : Vector(std::move(v)) {}

  template <std::integral Index>
  T& operator[](Index i) {
    assert(holds(static_cast<int64_t>(i)));
    return this->data()[i];
  }
  template <std::integral Index>
  const T& operator[](Index i) const {
    assert(holds(static_cast<int64_t>(i)));
    return this->data()[i];
  }

private:
  bool holds(int64_t i) const { return 0 <= i && i < static_cast<int64_t>(this->size()); }
};

} // namespace molmesh
