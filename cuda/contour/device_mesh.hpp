// device_mesh.hpp — the assembled mesh in a Backend's memory, and its way to the host.
#pragma once
#include "cuda/par/backend.hpp"
#include "mesh/tet_mesh.hpp"

namespace molmesh::cuda {

/// Where contour::detail::assemble writes.
template <class Backend>
class DeviceMesh {
public:
  explicit DeviceMesh(Backend& b) : b_(b) {}
  Tet* tets(int64_t n) { return room(tet_, n); }
  int32_t* regions(int64_t n) { return room(region_, n); }
  Vec3d* points(int64_t n) { return room(point_, n); }
  Tri* tris(int64_t n) { return room(tri_, n); }
  int32_t* boundaries(int64_t n) { return room(boundary_, n); }

  TetMesh on_host() const {
    TetMesh mesh;
    copy(tet_, mesh.tet);
    copy(region_, mesh.region);
    copy(point_, mesh.point);
    copy(tri_, mesh.tri);
    copy(boundary_, mesh.boundary);
    return mesh;
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
  void copy(const Array<T>& from, Vector& to) const {
    to.resize(static_cast<size_t>(from.size()));
    b_.download(from, from.size(), to.data());
  }
  Backend& b_;
  Array<Tet> tet_;
  Array<int32_t> region_, boundary_;
  Array<Vec3d> point_;
  Array<Tri> tri_;
};

} // namespace molmesh::cuda
