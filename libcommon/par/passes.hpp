// passes.hpp — gathers what items have (count, scan, fill), places by key and unites sets, over a launcher.
#pragma once
#include "base/hd.hpp"
#include "par/items.hpp"
#include "par/launcher.hpp"
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace molmesh::par {

/// Item: int64_t operator()(int64_t i, T* out) const; how many elements i has, written to `out` unless that is
/// null. Item::most, where it has one: no i has more, and asking twice costs more than copying.
template <class Item, class T>
struct CountElements {
  Item item;
  int64_t* count;
  MOLMESH_HD void operator()(int64_t i) const { count[i] = item(i, static_cast<T*>(nullptr)); }
};
template <class Item, class T>
struct FillElements {
  Item item;
  const int64_t* start;
  T* out;
  MOLMESH_HD void operator()(int64_t i) const {
    if (start[i + 1] != start[i])
      item(i, out + start[i]);
  }
};

/// An array of a launcher with its length.
template <Launcher L, class T>
struct List {
  typename L::template Array<T> array;
  int64_t n = 0;
  T* data() { return array.data(); }
  const T* data() const { return array.data(); }
};

/// The first n, in the host's memory.
template <class T, Launcher L>
std::vector<T> downloaded(L& m, const typename L::template Array<T>& from, int64_t n) {
  std::vector<T> to(static_cast<size_t>(n));
  m.download(from, n, to.data());
  return to;
}

/// The elements of all items, in their order.
template <class T, Launcher L, class Item>
List<L, T> gather(L& m, const char* name, int64_t n, const Item& item) {
  if constexpr (requires { m.template gather<T>(n, item); }) {
    auto all = m.template gather<T>(n, item);
    const auto total = static_cast<int64_t>(all.size());
    return {std::move(all), total};
  }
  auto count = m.template array<int64_t>(n + 1);
  m.for_n(name, n, CountElements<Item, T>{item, count.data()});
  const int64_t total = m.scan("scan", count.data(), n);
  List<L, T> out{m.template array<T>(total), total};
  m.for_n(name, n, FillElements<Item, T>{item, count.data(), out.data()});
  return out;
}

/// Places of raised flags, those of run i.
struct Flagged {
  static constexpr int64_t run = 64, most = run;
  const uint8_t* flag; ///< 0 or 1
  int64_t n;
  MOLMESH_HD int64_t operator()(int64_t i, int32_t* out) const {
    int64_t raised = 0;
    const int64_t end = n < (i + 1) * run ? n : (i + 1) * run;
    for (int64_t k = i * run; k < end; ++k) {
      if (k % 8 == 0 && k + 8 <= end && none(flag + k)) {
        k += 7;
        continue;
      }
      if (flag[k] && out)
        out[raised] = static_cast<int32_t>(k);
      raised += flag[k];
    }
    return raised;
  }

private:
  MOLMESH_HD static bool none(const uint8_t* eight) {
    uint64_t word;
    __builtin_memcpy(&word, eight, 8);
    return word == 0;
  }
};
template <Launcher L>
List<L, int32_t> flagged(L& m, const char* name, int64_t n, const uint8_t* flag) {
  return gather<int32_t>(m, name, (n + Flagged::run - 1) / Flagged::run, Flagged{flag, n});
}

template <class Key>
struct CountKeyed {
  Key key;
  uint32_t* count;
  MOLMESH_HD void operator()(int64_t i) const { count[i] = key(i) >= 0; }
};
template <class Key>
struct FillKeyed {
  Key of;
  const uint32_t* start;
  uint32_t *key, *index;
  MOLMESH_HD void operator()(int64_t i) const {
    if (const int64_t k = of(i); k >= 0) {
      key[start[i]] = static_cast<uint32_t>(k);
      index[start[i]] = static_cast<uint32_t>(i);
    }
  }
};
template <class Place>
struct PlaceIndexed {
  Place place;
  const uint32_t* index;
  MOLMESH_HD void operator()(int64_t slot) const { place(slot, index[slot]); }
};

/// place(slot, i) for each i in [0, n) with key(i) ≥ 0, slots counting from 0 by ascending key, then ascending i.
/// place: what sized(slots) makes. key(i) < keys ≤ 2^32, n < 2^32.
template <Launcher L, class Key, class Sized>
void place_by(L& m, const char* name, int64_t n, int64_t keys, const Key& key, Sized sized) {
  if constexpr (requires { m.place_by(n, keys, key, sized); }) {
    m.place_by(n, keys, key, sized);
  } else {
    auto start = m.template array<uint32_t>(n + 1);
    m.for_n(name, n, CountKeyed<Key>{key, start.data()}, {double(n) * 12});
    const int64_t slots = m.scan("scan", start.data(), n);
    auto keyed = m.template array<uint32_t>(slots), index = m.template array<uint32_t>(slots);
    m.for_n(name, n, FillKeyed<Key>{key, start.data(), keyed.data(), index.data()}, {double(n) * 20});
    start = {};
    m.sort_pairs(name, keyed.data(), index.data(), slots);
    keyed = {};
    const auto place = sized(slots);
    m.for_n(name, slots, PlaceIndexed<decltype(sized(slots))>{place, index.data()}, {double(slots) * 44});
  }
}

struct KeyedWord {
  uint64_t key, word;
};

struct SplitWords {
  const KeyedWord* from;
  uint64_t *key, *word;
  MOLMESH_HD void operator()(int64_t i) const {
    key[i] = from[i].key;
    word[i] = from[i].word;
  }
};
/// The words of equal keys as one, the bits of all.
struct UniteWords {
  const uint64_t *key, *word;
  int64_t n;
  MOLMESH_HD int64_t operator()(int64_t i, KeyedWord* out) const {
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
template <Launcher L>
List<L, KeyedWord> unite(L& m, const std::vector<const List<L, KeyedWord>*>& parts) {
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

} // namespace molmesh::par
