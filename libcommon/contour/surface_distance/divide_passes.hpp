// divide_passes.hpp — far triangles and the elements round them to the host, divided, and back; over a launcher.
#pragma once
#include "contour/relaxation/relax_items.hpp"
#include "contour/surface_distance/far_patch.hpp"
#include "mesh/disjoint_sets.hpp"
#include "par/passes.hpp"
#include <algorithm>
#include <utility>
#include <vector>

namespace molmesh::contour {

/// What relaxation has of each element and vertex, for elements that become more.
template <par::Launcher Launcher, class Elements>
struct RelaxArrays {
  Elements& elements;
  typename Launcher::template Array<float> quality;
  typename Launcher::template Array<uint8_t> bound;
  void show(RelaxView& r) {
    r.e = elements.view();
    r.quality = quality.data();
    r.bound = {bound.data()};
  }
};

struct TakeElements {
  RelaxView r;
  const int32_t* which;
  FarPatch::Element* to;
  HD void operator()(int64_t i) const {
    const int32_t t = which[i];
    to[i] = {t, r.e.tet[t], r.quality[t], r.classes.is_meshed(r.e.tet[t]) ? 1.F : unmeshed_weight};
  }
};
struct TakeTriangles {
  ElementsView e;
  const float* off;
  const int32_t* which;
  FarPatch::Triangle* to;
  HD void operator()(int64_t i) const {
    const int32_t t = which[i];
    to[i] = {t, t, e.tri[t], off[t]};
  }
};
struct TakeFree {
  Bounds bound;
  const int32_t *number, *which;
  uint8_t* to;
  HD void operator()(int64_t i) const {
    const int64_t v = which[i];
    to[i] = number[v] >= 0 && !bound.on_surface(v) && !bound.on_wall(v, 0) && !bound.on_wall(v, 1) &&
            !bound.on_wall(v, 2);
  }
};
struct PutElements {
  const FarPatch::Element* from;
  Tet* tet;
  float* quality;
  HD void operator()(int64_t i) const {
    tet[from[i].at] = from[i].tet;
    quality[from[i].at] = from[i].quality;
  }
};
struct PutTriangles {
  const FarPatch::Triangle* from;
  Tri* tri;
  std::array<int32_t, 2>* sides;
  int32_t* boundary;
  float* off;
  HD void operator()(int64_t i) const {
    const FarPatch::Triangle& f = from[i];
    tri[f.at] = f.tri;
    off[f.at] = f.off;
    if (f.at == f.parent)
      return;
    sides[f.at] = sides[f.parent];
    boundary[f.at] = boundary[f.parent];
  }
};
struct PutVertices {
  const Vec3d* from;
  Vec3d* position; ///< of the first of them
  Bounds bound;
  int64_t first;
  HD void operator()(int64_t i) const {
    position[i] = from[i];
    for (int k = 0; k < 4; ++k)
      bound.flag[4 * (first + i) + k] = k == 3; // on the surface
  }
};

/// Elements at the corners of far triangles, and triangles there: a patch for each set that hangs together.
template <par::Launcher Launcher>
class DividePasses {
public:
  DividePasses(Launcher& m, const RelaxView& r, const float* off, const par::List<Launcher, int32_t>& elements,
               const par::List<Launcher, int32_t>& triangles, const int32_t* number)
      : m_(m), r_(r) {
    FarPatch all;
    all.element = taken<FarPatch::Element>(elements, [&](auto* to) {
      return TakeElements{r, elements.data(), to};
    });
    all.triangle = taken<FarPatch::Triangle>(triangles, [&](auto* to) {
      return TakeTriangles{r.e, off, triangles.data(), to};
    });
    for (const FarPatch::Element& e : all.element) // all of a triangle's vertices are an element's
      all.vertex.insert(all.vertex.end(), e.tet.begin(), e.tet.end());
    std::sort(all.vertex.begin(), all.vertex.end());
    all.vertex.erase(std::unique(all.vertex.begin(), all.vertex.end()), all.vertex.end());
    const par::List<Launcher, int32_t> which = sent(all.vertex);
    all.position = taken<Vec3d>(which, [&](auto* to) {
      return par::Gather<Vec3d, int32_t>{r.e.position, which.data(), to};
    });
    all.is_free = taken<uint8_t>(which, [&](auto* to) { return TakeFree{r.bound, number, which.data(), to}; });
    number_vertices(all, [&](int32_t v) {
      return std::lower_bound(all.vertex.begin(), all.vertex.end(), v) - all.vertex.begin();
    });
    split(all);
  }
  std::vector<FarPatch>& patches() { return patches_; }

  /// What has become of them: elements, triangles and vertices come to be in the mesh; off: [tris].
  template <class Elements>
  void put(RelaxArrays<Launcher, Elements>& all, typename Launcher::template Array<float>& off) {
    std::vector<FarPatch::Element> element;
    std::vector<FarPatch::Triangle> triangle;
    std::vector<int32_t> vertex;
    std::vector<Vec3d> position, added;
    auto tets = static_cast<int32_t>(r_.e.tets), tris = static_cast<int32_t>(r_.e.tris);
    for (FarPatch& p : patches_) {
      const auto known = static_cast<int32_t>(p.vertex.size());
      const auto first_added = static_cast<int32_t>(r_.e.positions + static_cast<int64_t>(added.size()));
      number_vertices(p, [&](int32_t v) { return v < known ? p.vertex[v] : first_added + v - known; });
      for (FarPatch::Element& e : p.element)
        e.at = e.at < 0 ? tets++ : e.at;
      for (FarPatch::Triangle& t : p.triangle)
        t.at = t.at < 0 ? tris++ : t.at;
      element.insert(element.end(), p.element.begin(), p.element.end());
      triangle.insert(triangle.end(), p.triangle.begin(), p.triangle.end());
      vertex.insert(vertex.end(), p.vertex.begin(), p.vertex.end());
      position.insert(position.end(), p.position.begin(), p.position.begin() + known);
      added.insert(added.end(), p.position.begin() + known, p.position.end());
    }
    const auto more = static_cast<int64_t>(added.size());
    Elements& e = all.elements;
    par::grow(m_, e.tet, tets);
    par::grow(m_, all.quality, tets);
    par::grow(m_, e.tri, tris);
    par::grow(m_, e.tri_sides, tris);
    par::grow(m_, e.boundary, tris);
    par::grow(m_, off, tris);
    par::grow(m_, e.position, r_.e.positions + more);
    par::grow(m_, all.bound, 4 * (r_.e.positions + more));
    const auto elements = sent(element);
    m_.for_n("put elements", elements.n, PutElements{elements.data(), e.tet.data(), all.quality.data()});
    const auto triangles = sent(triangle);
    m_.for_n("put triangles", triangles.n,
             PutTriangles{triangles.data(), e.tri.data(), e.tri_sides.data(), e.boundary.data(), off.data()});
    const auto which = sent(vertex);
    const auto places = sent(position);
    m_.for_n("put positions", which.n,
             par::Scatter<Vec3d, int32_t>{places.data(), which.data(), e.position.data()});
    const auto vertices = sent(added);
    m_.for_n("put vertices", more,
             PutVertices{vertices.data(), e.position.data() + r_.e.positions, {all.bound.data()}, r_.e.positions});
  }

private:
  template <class Number>
  static void number_vertices(FarPatch& p, Number number) {
    const auto numbered = [&](int32_t v) { return static_cast<int32_t>(number(v)); };
    for (FarPatch::Element& e : p.element)
      std::transform(e.tet.begin(), e.tet.end(), e.tet.begin(), numbered);
    for (FarPatch::Triangle& t : p.triangle)
      std::transform(t.tri.begin(), t.tri.end(), t.tri.begin(), numbered);
  }
  /// Into sets of elements with common vertices, in the order of their first vertices.
  void split(FarPatch& all) {
    const auto vertices = static_cast<int32_t>(all.vertex.size());
    DisjointSets sets(all.vertex.size());
    for (const FarPatch::Element& e : all.element)
      for (const int32_t v : e.tet)
        sets.join(e.tet[0], v);
    std::vector<size_t> patch(all.vertex.size());
    std::vector<int32_t> number(all.vertex.size());
    for (int32_t v = 0; v < vertices; ++v) {
      const int32_t first = sets.first(v);
      if (first == v)
        patches_.emplace_back();
      patch[v] = first == v ? patches_.size() - 1 : patch[first];
      FarPatch& p = patches_[patch[v]];
      number[v] = static_cast<int32_t>(p.vertex.size());
      p.vertex.push_back(all.vertex[v]);
      p.position.push_back(all.position[v]);
      p.is_free.push_back(all.is_free[v]);
    }
    for (const FarPatch::Element& e : all.element)
      patches_[patch[e.tet[0]]].element.push_back(e);
    for (const FarPatch::Triangle& t : all.triangle)
      patches_[patch[t.tri[0]]].triangle.push_back(t);
    for (FarPatch& p : patches_)
      number_vertices(p, [&](int32_t v) { return number[v]; });
  }
  template <class T, class Take>
  std::vector<T> taken(const par::List<Launcher, int32_t>& which, Take take) {
    auto to = m_.template array<T>(which.n);
    m_.for_n("take far", which.n, take(to.data()));
    return par::downloaded<T>(m_, to, which.n);
  }
  template <class T>
  par::List<Launcher, T> sent(const std::vector<T>& from) {
    const auto n = static_cast<int64_t>(from.size());
    return {m_.upload(from.data(), n), n};
  }

  Launcher& m_;
  const RelaxView r_;
  std::vector<FarPatch> patches_;
};

} // namespace molmesh::contour
