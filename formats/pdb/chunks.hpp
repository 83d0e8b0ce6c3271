// chunks.hpp — a sequence that grows without being copied, so that its memory never is twice what it holds.
#pragma once
#include "base/give_back_memory.hpp"
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace molmesh::formats {

template <class T>
class Chunks {
public:
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](size_t i) {
    return i < first ? chunk_[0][i] : chunk_[1 + (i - first) / length][(i - first) % length];
  }
  const T& operator[](size_t i) const { return const_cast<Chunks&>(*this)[i]; }
  T& back() { return chunk_.back().back(); }

  template <class... Args>
  T& emplace_back(Args&&... args) {
    if (chunk_.empty())
      chunk_.emplace_back();
    if (size_ >= first && (size_ - first) % length == 0)
      chunk_.emplace_back().reserve(length);
    ++size_;
    return chunk_.back().emplace_back(std::forward<Args>(args)...);
  }
  void pop_back() {
    chunk_.back().pop_back();
    if (chunk_.size() > 1 && chunk_.back().empty())
      chunk_.pop_back();
    --size_;
  }
  /// Moves all behind `out`; none are left here. An empty `out` has no more room than it needs then.
  void move_to(std::vector<T>& out) {
    if (out.empty())
      out.reserve(size_);
    for (std::vector<T>& part : chunk_) {
      out.insert(out.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
      part.clear();
      if (size_ > first) { // each as soon as it has been moved
        std::vector<T>().swap(part);
        give_back_memory();
      }
    }
    chunk_.resize(size_ == 0 ? 0 : 1);
    size_ = 0;
  }

  /// Calls take(i, element) for each, in order; none are left here, and each chunk's memory is given back.
  template <class Take>
  void move_each(Take take) {
    size_t i = 0;
    for (std::vector<T>& part : chunk_) {
      for (T& element : part)
        take(i++, std::move(element));
      std::vector<T>().swap(part);
      if (size_ > first)
        give_back_memory();
    }
    chunk_.clear();
    size_ = 0;
  }

private:
  static constexpr size_t first = 4096;             ///< of the first chunk; all others are of `length`:
  static constexpr size_t length = size_t{1} << 16; ///< so large that their memory is worth giving back

  std::vector<std::vector<T>> chunk_;
  size_t size_ = 0;
};

} // namespace molmesh::formats
