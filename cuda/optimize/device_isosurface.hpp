// device_isosurface.hpp — Isosurface in a Backend's memory.
#pragma once
#include "cuda/par/backend.hpp"
#include "isosurface/isosurface.hpp"

namespace molmesh::cuda {

template <class Backend>
class DeviceIsosurface {
public:
  DeviceIsosurface(Backend& b, const Isosurface& surface) : surface_(surface) {
    const IsosurfaceView v = surface.view();
    log_ = b.upload(v.log, surface.values());
    key_ = b.upload(v.index.key, surface.slots());
    block_ = b.upload(v.index.block, surface.slots());
  }
  /// With the offset that the surface has now.
  IsosurfaceView view() const {
    IsosurfaceView v = surface_.view();
    v.log = log_.data();
    v.index.key = key_.data();
    v.index.block = block_.data();
    return v;
  }

private:
  template <class T>
  using Array = typename Backend::template Array<T>;
  const Isosurface& surface_;
  Array<float> log_;
  Array<Vec3i> key_;
  Array<int64_t> block_;
};

} // namespace molmesh::cuda
