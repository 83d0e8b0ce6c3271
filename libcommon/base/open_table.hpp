// open_table.hpp — maps 64-bit keys to small numbers by open addressing; numbers the vertices of a neighbourhood.
#pragma once
#include "base/large_array.hpp"
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh {

/// Emptied at once by a clock.
class OpenTable {
public:
  /// O(1): no key is known; the memory stays.
  void clear() {
    used_ = 0;
    if (++clock_ == 0) { // no slot may look filled after 2^32 times
      std::fill(slot_.begin(), slot_.end(), Slot{});
      clock_ = 1;
    }
  }
  void reserve(size_t keys) {
    if (2 * keys > slot_.size())
      resize(std::bit_ceil(2 * keys));
  }
  /// The key's number; null when it was never asked for with [].
  const int32_t* find(uint64_t key) const {
    if (slot_.empty())
      return nullptr;
    const Slot& s = slot_[place(key)];
    return is_used(s) ? &s.number : nullptr;
  }
  /// -1 at first. Valid until the next call.
  int32_t& operator[](uint64_t key) {
    if (2 * (used_ + 1) > slot_.size())
      resize(std::max<size_t>(64, 2 * slot_.size()));
    Slot& s = slot_[place(key)];
    if (!is_used(s)) {
      s = {key, -1, clock_};
      ++used_;
    }
    return s.number;
  }
  /// f(key, number) for every key, in no order.
  template <class F>
  void for_each(F&& f) const {
    for (const Slot& s : slot_)
      if (is_used(s))
        f(s.key, s.number);
  }

private:
  struct Slot {
    uint64_t key = 0;
    int32_t number = -1;
    uint32_t clock = 0; ///< when it was filled
  };
  using Slots = std::vector<Slot, LargeAllocator<Slot>>;
  void resize(size_t slots) {
    Slots old(slots);
    old.swap(slot_);
    for (const Slot& s : old)
      if (is_used(s))
        slot_[place(s.key)] = s;
  }
  bool is_used(const Slot& s) const { return s.clock == clock_; }
  /// Where the key is or would go. Keys next to each other are asked for together, and lie so.
  size_t place(uint64_t key) const {
    const size_t mask = slot_.size() - 1;
    const uint64_t high = key >> 5;
    size_t i = size_t(((high ^ high >> 24) * 0xBF58476D1CE4E5B9u >> 7) + (key & 31)) & mask;
    while (is_used(slot_[i]) && slot_[i].key != key)
      i = (i + 1) & mask;
    return i;
  }
  Slots slot_; ///< a power of two
  size_t used_ = 0;
  uint32_t clock_ = 1;
};

/// Small numbers of vertices or elements, in the order they are met.
class SmallNumbers {
public:
  SmallNumbers() = default;
  explicit SmallNumbers(const std::vector<int32_t>& all) {
    for (const int32_t id : all)
      (*this)(id);
  }
  /// O(1): what was met before is forgotten.
  void clear() {
    number_.clear();
    met_.clear();
  }
  /// Those met so far, by their numbers.
  const std::vector<int32_t>& met() const { return met_; }
  /// -1 of what was not met, and of -1.
  int32_t find(int32_t id) const {
    const int32_t* const number = id < 0 ? nullptr : number_.find(static_cast<uint32_t>(id));
    return number ? *number : -1;
  }
  bool knows(int32_t id) const { return find(id) >= 0; }
  /// met().size() of before when it is new.
  size_t operator()(int32_t id) {
    int32_t& number = number_[static_cast<uint32_t>(id)];
    if (number < 0) {
      number = static_cast<int32_t>(met_.size());
      met_.push_back(id);
    }
    return static_cast<size_t>(number);
  }

private:
  OpenTable number_;
  std::vector<int32_t> met_;
};

} // namespace molmesh
