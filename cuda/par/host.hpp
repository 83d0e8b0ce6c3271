// host.hpp — runs the device's algorithms on the host's threads: the same text, so that tests cover it without a
// GPU.
#pragma once
#include "cuda/par/backend.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <numeric>

namespace molmesh::cuda {

class HostBackend {
public:
  /// most: what all arrays together may take, to try what a small device does.
  explicit HostBackend(int threads = 1, Bytes most = {}) : threads_(threads), ledger_(most) {}
  HostBackend(const HostBackend&) = delete;
  HostBackend& operator=(const HostBackend&) = delete;

  template <class T>
  using Array = OwnedArray<HostBackend, T>;

  template <class T>
  class Pending {
  public:
    Pending(const T* from, int64_t n) : from_(from), n_(n) {}
    const T* get() const { return from_; }
    int64_t size() const { return n_; }

  private:
    const T* from_;
    int64_t n_;
  };

  template <class T>
  Array<T> array(int64_t n) {
    return Array<T>(*this, n);
  }
  template <class T>
  Array<T> filled(int64_t n, T value) {
    Array<T> a(*this, n);
    std::fill_n(a.data(), n, value);
    return a;
  }
  template <class T>
  Array<T> upload(const T* from, int64_t n) {
    Array<T> a(*this, n);
    timed("copies to the device", 1, {double(n) * sizeof(T)}, [&] { std::copy_n(from, n, a.data()); });
    return a;
  }
  template <class T>
  void download(const Array<T>& from, int64_t n, T* to) {
    timed("copies to the host", 1, {double(n) * sizeof(T)}, [&] { std::copy_n(from.data(), n, to); });
  }
  template <class T>
  Pending<T> fetch(const T* from, int64_t n, bool = false) {
    return {from, n};
  }
  void settle() {}

  template <class Item>
  void for_n(const char* name, int64_t n, const Item& item, const Work& work = {}) {
    timed(name, n, work, [&] { par::for_n(n, threads_, 64, [&](int64_t i) { item(i); }); });
  }
  template <class Item>
  void for_teams(const char* name, int64_t n, const Item& item, const Work& work = {}) {
    timed(name, n, work, [&] {
      par::for_n(n, threads_, 8, [&](int64_t i) {
        typename Item::Shared shared;
        item(i, Solo{}, shared);
      });
    });
  }
  template <class T>
  T scan(const char* name, T* count, int64_t n) {
    T sum{};
    timed(name, n, {2.0 * double(n) * sizeof(T)}, [&] {
      for (int64_t i = 0; i < n; ++i) {
        const T c = count[i];
        count[i] = sum;
        sum += c;
      }
      count[n] = sum;
    });
    return sum;
  }
  template <class K, class V>
  void sort_pairs(const char* name, K* keys, V* values, int64_t n) {
    timed(name, n, {2.0 * double(n) * (sizeof(K) + sizeof(V))}, [&] {
      std::vector<int64_t> order(static_cast<size_t>(n));
      std::iota(order.begin(), order.end(), int64_t{0});
      par::sort(order, threads_,
                [&](int64_t a, int64_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
      const std::vector<K> k(keys, keys + n);
      const std::vector<V> v(values, values + n);
      par::for_n(n, threads_, [&](int64_t i) {
        keys[i] = k[order[i]];
        values[i] = v[order[i]];
      });
    });
  }

  void plan(int64_t bytes) { ledger_.plan(bytes); }
  int64_t room() const { return ledger_.room(); }
  Bytes most_used() const { return ledger_.most_used(); }
  std::vector<KernelTime> times() { return times_; }

private:
  template <class, class>
  friend class cuda::OwnedArray;
  Taken take(int64_t bytes) {
    const bool paged = ledger_.is_paged(bytes);
    const Taken t{::operator new(static_cast<size_t>(bytes)), paged};
    ledger_.add(bytes, paged);
    return t;
  }
  void give_back(Taken t, int64_t bytes) noexcept {
    ledger_.subtract(bytes, t.paged);
    ::operator delete(t.data);
  }
  template <class F>
  void timed(const char* name, int64_t items, const Work& work, F&& f) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    add_time(times_, name, items, seconds.count(), work);
  }

  int threads_;
  Ledger ledger_;
  std::vector<KernelTime> times_;
};

static_assert(par::Launcher<HostBackend>);

} // namespace molmesh::cuda
