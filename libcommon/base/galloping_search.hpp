// galloping_search.hpp — searches a sorted list from a hint, such as the last answer, in steps that double.
#pragma once
#include <algorithm>
#include <cstddef>

namespace molmesh {

/// std::lower_bound of random-access iterators, searched from place `hint`, any number; sets `hint` to the place
/// found. O(log d), d the distance from the hint.
template <class Iterator, class Value, class Before>
Iterator galloping_lower_bound(Iterator begin, Iterator end, size_t& hint, const Value& value, Before&& before) {
  const auto n = static_cast<size_t>(end - begin);
  const auto at = [&](size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
  size_t lo = std::min(hint, n), hi = lo; // all before lo are before the value, none from hi on
  for (size_t step = 1; lo > 0 && !before(*at(lo - 1), value); step *= 2) {
    hi = lo - 1;
    lo -= std::min(step, lo);
  }
  for (size_t step = 1; hi < n && before(*at(hi), value); step *= 2) {
    lo = hi + 1;
    hi = std::min(lo + step, n);
  }
  const Iterator found = std::lower_bound(at(lo), at(hi), value, before);
  hint = static_cast<size_t>(found - begin);
  return found;
}

} // namespace molmesh
