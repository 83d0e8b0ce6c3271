// launcher.hpp — passes over arrays on the host's threads, for algorithms that host and device share.
#pragma once
#include "density/large_array.hpp"
#include "par/par.hpp"
#include "par/work.hpp"
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::par {

/// The part of cuda/par/backend.hpp that such an algorithm, a template over its launcher, may ask for.
class Launcher {
public:
  explicit Launcher(int threads) : threads_(threads) {}

  template <class T>
  using Array = LargeArray<T>;

  /// Uninitialized.
  template <class T>
  Array<T> array(int64_t n) {
    return Array<T>(static_cast<size_t>(n));
  }
  template <class T>
  Array<T> filled(int64_t n, T value) {
    return Array<T>(static_cast<size_t>(n), value);
  }
  template <class T>
  void download(const Array<T>& from, int64_t n, T* to) {
    std::copy_n(from.data(), n, to);
  }
  /// item(i) for i in [0, n), each independent of the others.
  template <class Item>
  void for_n(const char*, int64_t n, const Item& item, const Work& = {}) {
    par::for_n(n, threads_, 256, item);
  }
  /// count[i] → sum of count[0..i), in place; slot n, one more, gets the total.
  template <class T>
  T scan(const char*, T* count, int64_t n) {
    return count[n] = exclusive_scan(count, n);
  }
  /// Ascending keys; equal keys by their values.
  template <class K, class V>
  void sort_pairs(const char*, K* keys, V* values, int64_t n) {
    std::vector<std::pair<K, V>> pair(static_cast<size_t>(n));
    par::for_n(n, threads_, [&](int64_t i) { pair[static_cast<size_t>(i)] = {keys[i], values[i]}; });
    par::sort(pair, threads_);
    par::for_n(n, threads_, [&](int64_t i) {
      keys[i] = pair[static_cast<size_t>(i)].first;
      values[i] = pair[static_cast<size_t>(i)].second;
    });
  }

private:
  int threads_;
};

} // namespace molmesh::par
