// passes.hpp — count, scan, fill, and words by key, over a launcher (par/launcher.hpp or a Backend of cuda/par).
#pragma once
#include "geom/hd.hpp"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::contour::detail {

/// Item: int64_t operator()(int64_t i, T* out) const; how many elements i has, written to `out` unless that is
/// null.
template <class Item, class T>
struct CountElements {
  Item item;
  int64_t* count;
  HD void operator()(int64_t i) const { count[i] = item(i, static_cast<T*>(nullptr)); }
};
template <class Item, class T>
struct FillElements {
  Item item;
  const int64_t* start;
  T* out;
  HD void operator()(int64_t i) const {
    if (start[i + 1] != start[i])
      item(i, out + start[i]);
  }
};

/// An array of a launcher with its length.
template <class Launcher, class T>
struct List {
  typename Launcher::template Array<T> array;
  int64_t n = 0;
  T* data() { return array.data(); }
  const T* data() const { return array.data(); }
};

/// The elements of all items, in their order.
template <class T, class Launcher, class Item>
List<Launcher, T> gather(Launcher& m, const char* name, int64_t n, const Item& item) {
  auto count = m.template array<int64_t>(n + 1);
  m.for_n(name, n, CountElements<Item, T>{item, count.data()});
  const int64_t total = m.scan("scan", count.data(), n);
  List<Launcher, T> out{m.template array<T>(total), total};
  m.for_n(name, n, FillElements<Item, T>{item, count.data(), out.data()});
  return out;
}

struct KeyedWord {
  uint64_t key, word;
};

struct SplitWords {
  const KeyedWord* from;
  uint64_t *key, *word;
  HD void operator()(int64_t i) const {
    key[i] = from[i].key;
    word[i] = from[i].word;
  }
};
/// The words of equal keys as one, the bits of all.
struct UniteWords {
  const uint64_t *key, *word;
  int64_t n;
  HD int64_t operator()(int64_t i, KeyedWord* out) const {
    if (i > 0 && key[i] == key[i - 1])
      return 0;
    if (out) {
      *out = {key[i], word[i]};
      for (int64_t j = i + 1; j < n && key[j] == key[i]; ++j)
        out->word |= word[j];
    }
    return 1;
  }
};

/// All of them by ascending key, each key once.
template <class Launcher>
List<Launcher, KeyedWord> unite(Launcher& m, const std::vector<const List<Launcher, KeyedWord>*>& parts) {
  int64_t n = 0;
  for (const auto* p : parts)
    n += p->n;
  auto key = m.template array<uint64_t>(n), word = m.template array<uint64_t>(n);
  int64_t at = 0;
  for (const auto* p : parts) {
    m.for_n("split words", p->n, SplitWords{p->data(), key.data() + at, word.data() + at});
    at += p->n;
  }
  m.sort_pairs("sort nodes", key.data(), word.data(), n);
  return gather<KeyedWord>(m, "unite nodes", n, UniteWords{key.data(), word.data(), n});
}

} // namespace molmesh::contour::detail
