// complex_view.hpp — contour::Complex as plain arrays, with what faces and rings ask of it.
#pragma once
#include "contour/complex.hpp"
#include "contour/detail/complex_queries.hpp"
#include "cuda/contour/device_lattice.hpp"
#include "geom/morton.hpp"

namespace molmesh::cuda {

/// Leaves along the curve: found by bisection, which needs no table beside the keys.
struct TreeView {
  const uint64_t* key;
  const uint8_t* level;
  int32_t leaves;
  Vec3i cells;

  HD int32_t size() const { return leaves; }
  HD int32_t find(Vec3i p) const {
    if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= cells.x || p.y >= cells.y || p.z >= cells.z)
      return -1;
    const uint64_t k = morton(p);
    int32_t begin = 0, end = leaves; // the last key that is not above k
    while (end - begin > 1) {
      const int32_t middle = begin + (end - begin) / 2;
      if (key[middle] <= k)
        begin = middle;
      else
        end = middle;
    }
    return begin;
  }
  HD Vec3i corner(int32_t leaf) const { return morton_point(key[leaf]); }
  HD int32_t extent(int32_t leaf) const { return 1 << level[leaf]; }
};

/// Members as in contour::Complex.
struct ComplexView {
  contour::LatticeView lattice;
  TreeView tree;
  const contour::SurfaceSample* samples;
  const contour::Side* side;
  const int32_t *grid_vertex, *split;
  int32_t grid_vertices, dual0;
  const Vec3d* position;
  const float* value;
  const Vec3i* point;
  const float* distance;
  const uint8_t* has_moved;
  const int32_t* nearest;
  const contour::CellTopology* split_topology; ///< [vertices after the leaves' duals] at a split cell's centre

  HD bool inside(int32_t vertex) const { return value[vertex] > lattice.isovalue; }
  HD bool is_split(int32_t leaf) const { return split[leaf] >= 0; }
  HD int32_t dual(int32_t leaf) const { return dual0 + leaf; }
  HD bool moved(int32_t vertex) const { return vertex < grid_vertices && has_moved[vertex]; }
  HD int32_t nearest_sample(int32_t vertex) const { return nearest[vertex]; }
  /// Of a split leaf.
  HD contour::CellTopology topology(int32_t leaf) const {
    return split_topology[split[leaf] - dual0 - tree.leaves];
  }
  HD int32_t piece_dual(int32_t leaf, const contour::SplitCell& s, int f, int off) const {
    return contour::detail::piece_dual(*this, leaf, s, f, off);
  }
  HD int32_t piece_dual(int32_t leaf, const contour::SplitCell& s, const contour::Patch& p) const {
    return contour::detail::piece_dual(*this, leaf, s, p);
  }
  HD Vec3d crossing(int32_t a, int32_t b) const { return contour::detail::crossing(*this, a, b); }
};

/// The complex in a Backend's memory.
template <class Backend>
class DeviceComplex {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  DeviceComplex(Backend& b, const contour::Complex& c) : b_(b), lattice_(b, c.lattice) {
    ComplexView& v = view;
    v.lattice = lattice_.view;
    v.tree = {up(leaf_key_, c.tree.key), up(level_, c.tree.level), c.tree.size(), c.lattice.cells};
    v.samples = up(samples_, c.samples);
    v.side = up(side_, c.side);
    v.grid_vertex = up(grid_vertex_, c.grid_vertex);
    v.point = up(point_, c.point);
    v.nearest = up(nearest_, c.nearest_samples());
    v.grid_vertices = c.grid_vertices;
    v.dual0 = c.dual0;
    v.split = up(split_, c.split);
    v.position = up(position_, c.position);
    v.value = up(value_, c.value);
    v.distance = up(distance_, c.distance);
    v.has_moved = up(moved_, c.moved_flags());
    const int32_t first = c.dual0 + c.tree.size();
    std::vector<contour::CellTopology> topology(c.position.size() - static_cast<size_t>(first));
    for (int32_t leaf = 0; leaf < c.tree.size(); ++leaf)
      if (c.is_split(leaf))
        topology[static_cast<size_t>(c.split[static_cast<size_t>(leaf)] - first)] = c.topology(leaf);
    v.split_topology = up(topology_, topology);
  }
  int64_t vertices() const { return position_.size(); }
  ComplexView view{};

private:
  template <class T, class Vector>
  const T* up(Array<T>& store, const Vector& v) {
    store = b_.upload(v.data(), static_cast<int64_t>(v.size()));
    return store.data();
  }
  Backend& b_;
  DeviceLattice<Backend> lattice_;
  Array<float> value_, distance_;
  Array<Vec3i> point_;
  Array<uint64_t> leaf_key_;
  Array<uint8_t> level_, moved_;
  Array<contour::SurfaceSample> samples_;
  Array<contour::Side> side_;
  Array<int32_t> grid_vertex_, split_, nearest_;
  Array<Vec3d> position_;
  Array<contour::CellTopology> topology_;
};

} // namespace molmesh::cuda
