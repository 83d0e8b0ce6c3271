// items.hpp — elements copied, compacted, gathered and scattered. Host and device.
#pragma once
#include "base/hd.hpp"
#include <cstdint>

namespace molmesh::par {

template <class T>
struct CopyItems {
  const T* from;
  T* to;
  MOLMESH_HD void operator()(int64_t i) const { to[i] = from[i]; }
};
/// to[at[i]] = from[i] where the scanned count rises.
template <class T>
struct Compact {
  const T* from;
  const int64_t* at;
  T* to;
  MOLMESH_HD void operator()(int64_t i) const {
    if (at[i + 1] != at[i])
      to[at[i]] = from[i];
  }
};
template <class T, class Index = uint32_t>
struct Gather {
  const T* from;
  const Index* index;
  T* to;
  MOLMESH_HD void operator()(int64_t i) const { to[i] = from[index[i]]; }
};
template <class T, class Index = uint32_t>
struct Scatter {
  const T* from;
  const Index* index; ///< each once
  T* to;
  MOLMESH_HD void operator()(int64_t i) const { to[index[i]] = from[i]; }
};

} // namespace molmesh::par
