// par.hpp — loops, reductions, scans and sorts, serial and OpenMP. The only file with `#pragma omp`.
// Every function gives the same result for any number of threads.
#pragma once
#include "base/large_array.hpp"
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <vector>

namespace molmesh::par {

/// Whether this is built with OpenMP: else every loop runs on the calling thread.
bool has_threads();
/// Number of threads OpenMP would use by default (1 without OpenMP).
int default_threads();

/// f(i) for i in [0, n); calls are independent. `grain`: items a thread takes at a time (dynamic schedule).
/// The first exception thrown by f (lowest chunk not guaranteed) is rethrown after the loop; of the other items
/// some are done then.
template <class F>
void for_n(int64_t n, int threads, int64_t grain, F&& f) {
  if (n <= 0)
    return;
  if (threads <= 1 || n <= grain) {
    for (int64_t i = 0; i < n; ++i)
      f(i);
    return;
  }
  std::exception_ptr error;
  std::mutex guard;
  std::atomic<bool> failed = false;
  const int64_t chunks = (n + grain - 1) / grain;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int64_t c = 0; c < chunks; ++c) {
    if (failed.load(std::memory_order_relaxed))
      continue;
    try {
      const int64_t end = std::min(n, (c + 1) * grain);
      for (int64_t i = c * grain; i < end; ++i)
        f(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      if (!error)
        error = std::current_exception();
      failed = true;
    }
  }
  if (error)
    std::rethrow_exception(error);
}

/// work() on the calling thread, its own loops on that thread alone, while the others start that later loops are to
/// have; what it throws reaches the caller. Else the first loop waits for them, 10 ms and more where the system
/// puts a new thread on the core of the one that waits, since that one does not sleep.
template <class Work>
void start_threads_during(int threads, Work&& work) {
  if (threads <= 1)
    return work();
  std::exception_ptr error;
#pragma omp parallel num_threads(threads)
#pragma omp master
  try {
    work();
  } catch (...) {
    error = std::current_exception();
  }
  if (error)
    std::rethrow_exception(error);
}

template <class F>
void for_n(int64_t n, int threads, F&& f) {
  for_n(n, threads, int64_t{1024}, static_cast<F&&>(f));
}

/// As molmesh::prepare_pages, on all threads.
inline void prepare_pages(void* begin, size_t bytes, int threads) {
  constexpr size_t piece = size_t{1} << 22;
  for_n(static_cast<int64_t>((bytes + piece - 1) / piece), threads, 1, [&](int64_t i) {
    const size_t first = static_cast<size_t>(i) * piece;
    molmesh::prepare_pages(static_cast<std::byte*>(begin) + first, std::min(piece, bytes - first));
  });
}

/// combine(… combine(combine(init, f(0)), f(1)) …) in a fixed tree: chunks of `grain` left to right, then the
/// chunk results left to right. Same bits for any number of threads; `combine` need not commute.
template <class T, class F, class C>
T reduce(int64_t n, int threads, T init, F&& f, C&& combine, int64_t grain = 4096) {
  const int64_t chunks = n > 0 ? (n + grain - 1) / grain : 0;
  struct Part { // of std::vector<bool> several share a byte
    T sum;
  };
  std::vector<Part> part(static_cast<size_t>(chunks), Part{init});
  for_n(chunks, threads, 1, [&](int64_t c) {
    T sum = init;
    const int64_t end = std::min(n, (c + 1) * grain);
    for (int64_t i = c * grain; i < end; ++i)
      sum = combine(sum, f(i));
    part[c].sum = sum;
  });
  T sum = init;
  for (const Part& p : part)
    sum = combine(sum, p.sum);
  return sum;
}

/// count[i] → sum of count[0..i), in place; returns the total. Count → scan → fill instead of atomic appends.
template <class T>
T exclusive_scan(T* count, int64_t n) {
  T sum{};
  for (int64_t i = 0; i < n; ++i) {
    const T c = count[i];
    count[i] = sum;
    sum += c;
  }
  return sum;
}
template <class T>
T exclusive_scan(std::vector<T>& count) {
  return exclusive_scan(count.data(), static_cast<int64_t>(count.size()));
}

/// The i in [0, n) with keep(i), ascending.
template <class T = int32_t, class Keep>
LargeArray<T> select(int64_t n, int threads, Keep&& keep) {
  constexpr int64_t grain = 4096;
  const int64_t chunks = (n + grain - 1) / grain;
  std::vector<int64_t> start(static_cast<size_t>(chunks));
  const auto each = [&](int64_t c, auto&& f) {
    for (int64_t i = c * grain, end = std::min(n, i + grain); i < end; ++i)
      if (keep(i))
        f(i);
  };
  for_n(chunks, threads, 1, [&](int64_t c) {
    int64_t kept = 0;
    each(c, [&](int64_t) { ++kept; });
    start[c] = kept;
  });
  LargeArray<T> out(static_cast<size_t>(exclusive_scan(start)));
  prepare_pages(out.data(), out.size() * sizeof(T), threads);
  for_n(chunks, threads, 1, [&](int64_t c) {
    auto to = out.begin() + start[c];
    each(c, [&](int64_t i) { *to++ = static_cast<T>(i); });
  });
  return out;
}

/// Calls place(slot, i) for each i in [0, n) with key(i) ≥ 0, slots counting from 0 by ascending key, then
/// ascending i; sized(slots) before the first. key(i) < keys; n < 2^32. Counting: to buckets of keys chunk by
/// chunk, then within each bucket.
template <class Key, class Sized, class Place>
void place_by(int64_t n, int64_t keys, int threads, Key&& key, Sized&& sized, Place&& place) {
  constexpr int64_t grain = int64_t{1} << 16;
  int shift = 0;
  while (keys >> shift > 1024)
    ++shift;
  const int64_t buckets = (keys >> shift) + 1, chunks = (n + grain - 1) / grain;
  std::vector<int64_t> start(static_cast<size_t>(buckets * chunks)); // bucket by bucket, in each chunk by chunk
  const auto each = [&](int64_t c, auto&& f) {
    for (int64_t i = c * grain, end = std::min(n, i + grain); i < end; ++i)
      if (const int64_t k = key(i); k >= 0)
        f(start[(k >> shift) * chunks + c], i);
  };
  for_n(chunks, threads, 1, [&](int64_t c) { each(c, [](int64_t& count, int64_t) { ++count; }); });
  const int64_t total = exclusive_scan(start);
  sized(total);
  LargeArray<uint32_t> order(static_cast<size_t>(total));
  prepare_pages(order.data(), order.size() * sizeof(uint32_t), threads);
  for_n(chunks, threads, 1,
        [&](int64_t c) { each(c, [&](int64_t& slot, int64_t i) { order[slot++] = static_cast<uint32_t>(i); }); });
  for_n(buckets, threads, 1, [&](int64_t b) { // each start has become its end
    const int64_t first = b * chunks == 0 ? 0 : start[b * chunks - 1],
                  last = chunks == 0 ? 0 : start[(b + 1) * chunks - 1];
    if (first == last)
      return;
    std::vector<int64_t> slot(size_t{1} << shift);
    const auto slot_of = [&](int64_t i) -> int64_t& { return slot[key(i) - (b << shift)]; };
    for (int64_t m = first; m < last; ++m)
      ++slot_of(order[m]);
    exclusive_scan(slot);
    for (int64_t m = first; m < last; ++m) {
      const int64_t i = order[m];
      place(first + slot_of(i)++, i);
    }
  });
}

/// Sort by operator< or `less`. Equal elements must be interchangeable: the result is then unique.
template <class Vector, class Less>
void sort(Vector& v, int threads, Less less) {
  const int64_t n = static_cast<int64_t>(v.size());
  int64_t runs = 1;
  while (runs < threads && n / (2 * runs) > 8192)
    runs *= 2;
  const auto at = [&](int64_t r) { return v.begin() + static_cast<std::ptrdiff_t>(n * r / runs); };
  for_n(runs, threads, 1, [&](int64_t r) { std::sort(at(r), at(r + 1), less); });
  for (int64_t width = 1; width < runs; width *= 2)
    for_n(runs / (2 * width), threads, 1, [&](int64_t m) {
      const int64_t r = m * 2 * width;
      std::inplace_merge(at(r), at(r + width), at(r + 2 * width), less);
    });
}
template <class Vector>
void sort(Vector& v, int threads) {
  sort(v, threads, [](const auto& a, const auto& b) { return a < b; });
}

/// Ascending, each once.
template <class Vector>
void sort_unique(Vector& v, int threads) {
  sort(v, threads);
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

} // namespace molmesh::par
