// device_mesh.hpp — the assembled mesh in a Backend's memory, and its way to the host beside the last kernels.
#pragma once
#include "cuda/par/run_copy.hpp"
#include "mesh/tet_mesh.hpp"
#include "par/pages.hpp"

namespace molmesh::cuda {

/// Where contour::assemble writes.
template <par::Launcher Backend>
class DeviceMesh {
public:
  /// As RunCopy has them.
  DeviceMesh(Backend& b, int threads, int64_t run_bytes) : b_(b), threads_(threads), copy_(b, threads, run_bytes) {}
  Tet* tets(int64_t n) { return room(tet_, n); }
  int32_t* regions(int64_t n) { return room(region_, n); }
  Vec3d* points(int64_t n) { return room(point_, n); }
  Tri* tris(int64_t n) { return room(tri_, n); }
  int32_t* boundaries(int64_t n) { return room(boundary_, n); }

  /// Regions and points are as they stay; renumber(begin, end) makes these tets so.
  template <class Renumber>
  void renumber_tets(Renumber&& renumber) {
    send(region_, mesh_.region);
    send(point_, mesh_.point);
    par::resize_pages(mesh_.tet, static_cast<size_t>(tet_.size()), threads_);
    copy_.send(tet_.data(), tet_.size(), mesh_.tet.data(), renumber);
  }
  TetMesh on_host() {
    send(tri_, mesh_.tri);
    send(boundary_, mesh_.boundary);
    copy_.finish();
    return std::move(mesh_);
  }

private:
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  T* room(Array<T>& array, int64_t n) {
    array = b_.template array<T>(n);
    return array.data();
  }
  template <class T, class Vector>
  void send(const Array<T>& from, Vector& to) {
    par::resize_pages(to, static_cast<size_t>(from.size()), threads_);
    copy_.send(from.data(), from.size(), to.data());
  }
  Backend& b_;
  int threads_;
  TetMesh mesh_;
  Array<Tet> tet_;
  Array<int32_t> region_, boundary_;
  Array<Vec3d> point_;
  Array<Tri> tri_;
  RunCopy<Backend> copy_; ///< the last: what is on its way ends before the arrays do
};

} // namespace molmesh::cuda
