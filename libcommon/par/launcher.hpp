// launcher.hpp — what an algorithm that host and device share asks of the machine it runs on, and the host's
// threads.
#pragma once
#include "base/hd.hpp"
#include "base/large_array.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace molmesh::par {

/// The least work of a pass, for its share of the machine's peak: bytes of memory moved at least once,
/// multiply-adds in single or double precision.
struct Work {
  double bytes = 0, multiply_adds = 0;
  bool in_double = false;
};

/// An item that does nothing: Launcher asks for for_n by it.
struct NoItem {
  MOLMESH_HD void operator()(int64_t) const {}
};

/// A launcher runs passes over arrays in its own memory. HostLauncher is one, and so are the backends of cuda/par.
/// T is trivially copyable. A kernel is an `item`: a struct of plain views with MOLMESH_HD operator()(int64_t)
/// const, so that one text serves host and device; par/passes.hpp makes count, scan, fill and union of these.
template <class L>
concept Launcher = requires(L& launcher, const char* name, int64_t n, const Work& work, const NoItem& item,
                            const int32_t* from, int32_t* to, uint64_t* keys, uint32_t* values,
                            const typename L::template Array<int32_t>& array) {
  /// n uninitialized elements; n copies of a value; a copy of n elements of the host's.
  { launcher.template array<int32_t>(n) } -> std::same_as<typename L::template Array<int32_t>>;
  { launcher.template filled<int32_t>(n, int32_t{}) } -> std::same_as<typename L::template Array<int32_t>>;
  { launcher.upload(from, n) } -> std::same_as<typename L::template Array<int32_t>>;
  /// The first n elements to the host; returns when they are there.
  launcher.download(array, n, to);
  { array.data() } -> std::convertible_to<const int32_t*>;
  /// item(i) for i in [0, n), each call independent of the others.
  launcher.for_n(name, n, item, work);
  /// count[i] → sum of count[0..i), in place; slot n, one more, gets the total, which is returned.
  { launcher.scan(name, to, n) } -> std::same_as<int32_t>;
  /// Ascending unsigned keys; equal keys keep their order, or are ordered by their values where these ascended.
  launcher.sort_pairs(name, keys, values, n);
};

/// The host's threads.
class HostLauncher {
public:
  explicit HostLauncher(int threads) : threads_(threads) {}

  template <class T>
  using Array = LargeArray<T>;

  /// Uninitialized, but soon written: memory is asked for on all threads where it is much.
  template <class T>
  Array<T> array(int64_t n) {
    constexpr int64_t much = int64_t{1} << 18; // bytes
    Array<T> out;
    if (n * static_cast<int64_t>(sizeof(T)) >= much)
      reserve_pages(out, static_cast<size_t>(n), a_few(static_cast<size_t>(n)), threads_);
    out.resize(static_cast<size_t>(n));
    return out;
  }
  template <class T>
  Array<T> filled(int64_t n, T value) {
    constexpr int64_t grain = int64_t{1} << 16;
    Array<T> out = array<T>(n);
    par::for_n((n + grain - 1) / grain, threads_for(n, grain), 1, [&](int64_t c) {
      std::fill(out.begin() + c * grain, out.begin() + std::min(n, (c + 1) * grain), value);
    });
    return out;
  }
  template <class T>
  Array<T> upload(const T* from, int64_t n) {
    return Array<T>(from, from + n);
  }
  template <class T>
  void download(const Array<T>& from, int64_t n, T* to) {
    std::copy_n(from.data(), n, to);
  }
  /// Loops of fewer pieces run on one thread: on cores shared with others every loop that all threads join may wait
  /// a time slice for the last of them, and many loops are short.
  static constexpr int64_t least_pieces = 8;
  /// item(i) for i in [0, n), each independent of the others; Item::grain at a time where it has one, and by
  /// item.run(begin, end) where that does the same for many.
  template <class Item>
  void for_n(const char*, int64_t n, const Item& item, const Work& = {}) {
    int64_t grain = 256;
    if constexpr (requires { Item::grain; })
      grain = Item::grain;
    if constexpr (requires { item.run(n, n); })
      par::for_n((n + grain - 1) / grain, threads_for(n, grain), 1,
                 [&](int64_t c) { item.run(c * grain, std::min(n, (c + 1) * grain)); });
    else
      par::for_n(n, threads_for(n, grain), grain, item);
  }
  template <class T>
  T scan(const char*, T* count, int64_t n) {
    return count[n] = exclusive_scan(count, n);
  }
  template <class K, class V>
  void sort_pairs(const char*, K* keys, V* values, int64_t n) {
    std::vector<std::pair<K, V>> pair(static_cast<size_t>(n));
    par::for_n(n, threads_, [&](int64_t i) { pair[i] = {keys[i], values[i]}; });
    par::sort(pair, threads_);
    par::for_n(n, threads_, [&](int64_t i) {
      keys[i] = pair[i].first;
      values[i] = pair[i].second;
    });
  }

  // gather and place_by as par/passes.hpp has them, by chunks that stay in the caches.

  template <class T, class Item>
  Array<T> gather(int64_t n, const Item& item) {
    constexpr int64_t grain = 4096;
    const int64_t chunks = (n + grain - 1) / grain;
    const int threads = threads_for(n, grain);
    const auto each = [&](int64_t c, auto&& f) {
      for (int64_t i = c * grain, end = std::min(n, i + grain); i < end; ++i)
        f(i);
    };
    std::vector<int64_t> start(static_cast<size_t>(chunks));
    const auto start_of = [&](int64_t c) -> int64_t& { return start[c]; };
    if constexpr (requires { Item::most; }) {
      std::vector<std::vector<T>> part(static_cast<size_t>(chunks));
      par::for_n(chunks, threads, 1, [&](int64_t c) {
        thread_local std::vector<T> found;
        found.resize(static_cast<size_t>(grain * Item::most));
        int64_t count = 0;
        each(c, [&](int64_t i) { count += item(i, found.data() + count); });
        part[c].assign(found.begin(), found.begin() + count);
        start_of(c) = count;
      });
      Array<T> out = array<T>(exclusive_scan(start));
      par::for_n(chunks, threads, 1,
                 [&](int64_t c) { std::copy(part[c].begin(), part[c].end(), out.begin() + start_of(c)); });
      return out;
    } else {
      static_assert(grain % 64 == 0); // no two chunks share a word
      std::vector<uint64_t> any(static_cast<size_t>((n + 63) / 64));
      par::for_n(chunks, threads, 1, [&](int64_t c) {
        int64_t count = 0;
        each(c, [&](int64_t i) {
          const int64_t here = item(i, static_cast<T*>(nullptr));
          any[i >> 6] |= uint64_t{here > 0} << (i & 63);
          count += here;
        });
        start_of(c) = count;
      });
      Array<T> out = array<T>(exclusive_scan(start));
      par::for_n(chunks, threads, 1, [&](int64_t c) {
        T* to = out.data() + start_of(c);
        each(c, [&](int64_t i) {
          if (any[i >> 6] >> (i & 63) & 1)
            to += item(i, to);
        });
      });
      return out;
    }
  }
  template <class Key, class Sized>
  void place_by(int64_t n, int64_t keys, const Key& key, Sized sized) {
    std::optional<decltype(sized(n))> place;
    par::place_by(
        n, keys, threads_, key, [&](int64_t slots) { place.emplace(sized(slots)); },
        [&](int64_t slot, int64_t i) { (*place)(slot, i); });
  }

private:
  int threads_for(int64_t n, int64_t grain) const { return n < least_pieces * grain ? 1 : threads_; }

  int threads_;
};

static_assert(Launcher<HostLauncher>);

} // namespace molmesh::par
