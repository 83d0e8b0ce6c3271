// choose.hpp — the few of many items that a predicate keeps, each looked at once.
#pragma once
#include "par/par.hpp"
#include <algorithm>
#include <cstdint>
#include <vector>

namespace molmesh::par {

/// The i in [0, n) with keep(i), ascending; few of many. keep is asked once for each, where par::select asks twice,
/// and not in a chunk s, of i from s · grain, that may_have(s) rules out.
template <class Keep, class MayHave>
std::vector<int32_t> choose(int64_t n, int threads, int64_t grain, MayHave&& may_have, Keep&& keep) {
  const int64_t chunks = (n + grain - 1) / grain;
  std::vector<std::vector<int32_t>> found(static_cast<size_t>(chunks));
  par::for_n(chunks, threads, std::max<int64_t>(1, (1 << 13) / grain), [&](int64_t c) {
    if (!may_have(c))
      return;
    for (int64_t i = c * grain, end = std::min(n, i + grain); i < end; ++i)
      if (keep(i))
        found[c].push_back(static_cast<int32_t>(i));
  });
  std::vector<int32_t> all;
  for (const auto& f : found)
    all.insert(all.end(), f.begin(), f.end());
  return all;
}
template <class Keep>
std::vector<int32_t> choose(int64_t n, int threads, Keep&& keep) {
  return choose(
      n, threads, int64_t{1} << 14, [](int64_t) { return true; }, keep);
}

} // namespace molmesh::par
