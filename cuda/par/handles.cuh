// handles.cuh — checks calls; owns streams, events and page-locked memory.
#pragma once
#include "base/error.hpp"
#include <algorithm>
#include <cuda_runtime.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace molmesh::cuda {

/// Every call of CUDA but those that give back goes through here: the ordinary one-line error.
inline void check(cudaError_t e, const char* what) {
  if (e != cudaSuccess)
    fail(Status::failed, std::string("GPU: ") + what + ": " + cudaGetErrorString(e));
}

namespace detail {

struct StreamDelete {
  void operator()(cudaStream_t s) const { cudaStreamDestroy(s); }
};
struct EventDelete {
  void operator()(cudaEvent_t e) const { cudaEventDestroy(e); }
};
using Stream = std::unique_ptr<CUstream_st, StreamDelete>;
using Event = std::unique_ptr<CUevent_st, EventDelete>;

/// Page-locked memory of the host, kept when it is given back: locking costs about as much as copying.
class LockedPool {
public:
  struct Piece {
    void* data = nullptr;
    size_t bytes = 0;
  };
  LockedPool() = default;
  LockedPool(const LockedPool&) = delete;
  LockedPool& operator=(const LockedPool&) = delete;
  ~LockedPool() {
    for (const Piece& p : free_)
      cudaFreeHost(p.data);
  }
  Piece take(size_t bytes) {
    const auto p = std::find_if(free_.begin(), free_.end(), [&](const Piece& q) { return q.bytes >= bytes; });
    if (p != free_.end()) {
      const Piece piece = *p;
      free_.erase(p);
      return piece;
    }
    Piece piece{nullptr, bytes + bytes / 8 + 4096}; // the next may be a little larger
    free_.reserve(++pieces_);                       // giving back allocates nothing
    check(cudaMallocHost(&piece.data, piece.bytes), "page-locked memory");
    return piece;
  }
  void give_back(Piece p) { // ascending: the smallest that fits is found first
    free_.insert(std::find_if(free_.begin(), free_.end(), [&](const Piece& q) { return q.bytes >= p.bytes; }), p);
  }

private:
  std::vector<Piece> free_;
  size_t pieces_ = 0;
};
class Locked {
public:
  Locked(LockedPool& pool, size_t bytes) : pool_(&pool), piece_(pool.take(bytes)) {}
  Locked(Locked&& o) noexcept : pool_(std::exchange(o.pool_, nullptr)), piece_(o.piece_) {}
  Locked& operator=(Locked&&) = delete;
  ~Locked() {
    if (pool_)
      pool_->give_back(piece_);
  }
  void* data() const { return piece_.data; }

private:
  LockedPool* pool_;
  LockedPool::Piece piece_;
};

inline Stream make_stream() {
  cudaStream_t s{};
  check(cudaStreamCreateWithFlags(&s, cudaStreamNonBlocking), "a stream");
  return Stream(s);
}
inline Event make_event(unsigned flags) {
  cudaEvent_t e{};
  check(cudaEventCreateWithFlags(&e, flags), "an event");
  return Event(e);
}

} // namespace detail

} // namespace molmesh::cuda
