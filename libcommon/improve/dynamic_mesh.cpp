// dynamic_mesh.cpp — neighbours and labels by groups of equal faces, and what vertices may do.
#include "improve/dynamic_mesh.hpp"
#include "error.hpp"
#include "geom/predicates.hpp" // exact sign of the volumes that come in
#include "improve/kinds.hpp"
#include "improve/quality_kernel.hpp"
#include "mesh/sorted_triangle.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <map>
#include <mutex>
#include <string>

namespace molmesh::improve {
namespace {

// From any thread.
void raise_to(int32_t& place, int32_t value) {
  const std::atomic_ref shared(place);
  int32_t seen = shared.load(std::memory_order_relaxed);
  while (seen < value && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed))
    ;
}

Tri face_at(const TetMesh& mesh, int64_t slot) {
  return outward_triangle(mesh.tet[size_t(slot / 4)], size_t(slot % 4));
}

std::string name(const char* what, int64_t i) {
  return std::string(what) + " " + std::to_string(i);
}

// The first thing wrong, whichever thread finds it.
class FirstFault {
public:
  template <class Text>
  void found(int64_t rank, Text&& text) {
    const std::lock_guard<std::mutex> lock(guard_);
    if (rank < rank_)
      rank_ = rank, text_ = text();
  }
  void fail_if_any() const {
    if (!text_.empty())
      fail_input(text_);
  }

private:
  std::mutex guard_;
  int64_t rank_ = INT64_MAX;
  std::string text_;
};

// Faces meet the face on their other side and their triangle.
void link(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label, int threads) {
  const auto faces = static_cast<int64_t>(4 * mesh.tet.size()), triangles = static_cast<int64_t>(mesh.tri.size());
  const auto key = [&](int64_t i) {
    return triangle_key(i < faces ? face_at(mesh, i) : mesh.tri[size_t(i - faces)]);
  };
  FirstFault fault;
  for_each_group(
      faces + triangles, static_cast<int64_t>(mesh.point.size()), threads, key, [&](const uint32_t* item, int n) {
        const auto sides = static_cast<int>(std::lower_bound(item, item + n, faces) - item);
        if (sides == 2 &&
            sorted_triangle(face_at(mesh, item[0])).odd == sorted_triangle(face_at(mesh, item[1])).odd)
          fault.found(item[0], [&] {
            return name("tetrahedron", item[0] / 4) + " overlaps " + name("tetrahedron", item[1] / 4) +
                   ", expected one on each side of a face";
          });
        if (sides > 2)
          fault.found(item[0], [&] {
            return name("tetrahedron", item[0] / 4) + " has a face shared by three, expected two at most";
          });
        if (sides == 0)
          fault.found(item[0], [&] { return name("triangle", item[0] - faces) + " is no face of a tetrahedron"; });
        if (sides > 0 && n > sides + 1)
          fault.found(item[sides + 1],
                      [&] { return name("triangle", item[sides + 1] - faces) + " is a duplicate"; });
        for (int i = 0; i < sides && sides <= 2; ++i) {
          Element& e = m.element[item[i] / 4];
          if (sides == 2)
            e.n[item[i] % 4] = static_cast<int32_t>(item[1 - i] / 4);
          if (n > sides)
            e.label[item[i] % 4] = label[size_t(item[sides] - faces)];
        }
      });
  fault.fail_if_any();
}

// Labels in the order of their first triangles; the index of each triangle's.
std::vector<uint8_t> set_labels(DynamicMesh& m, const TetMesh& mesh, std::vector<int64_t>& first) {
  m.labels.assign(1, {});
  first.assign(1, -1);
  std::map<int32_t, uint8_t> index;
  std::vector<uint8_t> label(mesh.tri.size());
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const auto [entry, fresh] = index.try_emplace(mesh.boundary[t], static_cast<uint8_t>(m.labels.size()));
    if (fresh) {
      if (m.labels.size() == 256)
        fail_input("more than 255 different boundary labels");
      m.labels.push_back({mesh.boundary[t], -1});
      first.push_back(int64_t(t));
    }
    label[t] = entry->second;
  }
  return label;
}

void check_labels(const DynamicMesh& m, const TetMesh& mesh, int threads) {
  const auto is_border = [&](const Element& e, size_t face) { // the input's regions lie closer together
    return e.n[face] < 0 || mesh.region[size_t(e.n[face])] != e.region;
  };
  FirstFault fault;
  par::for_n(static_cast<int64_t>(m.element.size()), threads, [&](int64_t e) {
    const Element& el = m.element[size_t(e)];
    for (size_t i = 0; i < 4; ++i)
      if (is_border(el, i) != (el.label[i] != 0))
        fault.found(4 * e + int64_t(i), [&] {
          return name("tetrahedron", e) + (is_border(el, i)
                                               ? " has a face between regions or on the outside without a triangle"
                                               : " has a triangle inside its region");
        });
  });
  fault.fail_if_any();
}

// Which way the first triangle of each label points.
void set_directions(DynamicMesh& m, const TetMesh& mesh, const std::vector<int64_t>& first, int threads) {
  std::vector<SortedTriangle> wanted(1);
  for (size_t l = 1; l < first.size(); ++l)
    wanted.push_back(sorted_triangle(mesh.tri[size_t(first[l])]));
  par::for_n(static_cast<int64_t>(m.element.size()), threads, [&](int64_t e) {
    const Element& el = m.element[size_t(e)];
    for (size_t i = 0; i < 4; ++i) {
      const uint8_t l = el.label[i];
      if (!m.counts_here(el, i))
        continue;
      const SortedTriangle s = sorted_triangle(face_at(mesh, 4 * e + int64_t(i)));
      if (s.v == wanted[l].v) // one face of the mesh for each label
        m.labels[l].reversed = s.odd != wanted[l].odd;
    }
  });
}

} // namespace

void require_size(int64_t elements, int64_t triangles, int64_t points) {
  if (points > INT32_MAX)
    fail_input("over 2^31 - 1 points, expected fewer");
  if (4 * elements + triangles > UINT32_MAX || triangles > INT32_MAX)
    fail_input(std::to_string(elements) + " tetrahedra and " + std::to_string(triangles) +
               " triangles, expected their faces to be fewer than 2^32");
}

void require_slots(int64_t elements, int64_t vertices) {
  if (elements > INT32_MAX || vertices > INT32_MAX)
    fail(Status::failed, "the mesh and what it may grow by take " + std::to_string(elements) + " elements and " +
                             std::to_string(vertices) + " points, expected fewer than 2^31");
}

void DynamicMesh::resize(size_t elements, size_t vertices) {
  element.resize(elements, Element{});
  restless.resize(size_t(stretches(elements)), 1);
  point.resize(vertices);
  vertex.resize(vertices);
  incident.resize(vertices, -1);
  touched.resize(vertices, 0);
}

DynamicMesh build(const TetMesh& mesh, double sharp, int threads) {
  require_size(static_cast<int64_t>(mesh.tet.size()), static_cast<int64_t>(mesh.tri.size()),
               static_cast<int64_t>(mesh.point.size()));
  DynamicMesh m;
  const auto with_room = [](auto& v, size_t n) { // what it will grow by, untouched till then: no second copy
    v.reserve(n + n / 8);
    v.resize(n);
  };
  with_room(m.point, mesh.point.size());
  std::copy(mesh.point.begin(), mesh.point.end(), m.point.begin());
  m.vertex.resize(m.point.size());
  m.incident.assign(m.point.size(), -1);
  m.touched.assign(m.point.size(), 0);
  with_room(m.element, mesh.tet.size());
  m.restless.assign(size_t(DynamicMesh::stretches(mesh.tet.size())), 1);
  FirstFault fault;
  constexpr int64_t chunk = DynamicMesh::stretch;
  const auto tets = static_cast<int64_t>(mesh.tet.size());
  par::for_n(DynamicMesh::stretches(mesh.tet.size()), threads, 1, [&](int64_t c) {
    const auto first = static_cast<size_t>(c * chunk), n = static_cast<size_t>(std::min(chunk, tets - c * chunk));
    const auto corner = [&](size_t k, size_t i) { return m.point[size_t(mesh.tet[first + k][i])]; };
    judge_each(n, corner, [&](size_t k, float q) {
      Element& e = m.element[first + k] = {};
      e.v = mesh.tet[first + k];
      e.region = mesh.region[first + k];
      e.q = std::max(q, 0.f);
      if (q < 1e-6f && orient3d(corner(k, 0), corner(k, 1), corner(k, 2), corner(k, 3)) <= 0)
        fault.found(static_cast<int64_t>(first + k), [&] {
          return name("tetrahedron", static_cast<int64_t>(first + k)) + " has no positive volume";
        });
      return true;
    });
    for (size_t e = first + n; e-- > first;) // downwards: most find a higher one there
      for (const int32_t v : mesh.tet[e])
        raise_to(m.incident[size_t(v)], static_cast<int32_t>(e));
  });
  fault.fail_if_any();
  std::vector<int64_t> first;
  const std::vector<uint8_t> label = set_labels(m, mesh, first);
  link(m, mesh, label, threads);
  check_labels(m, mesh, threads);
  set_directions(m, mesh, first, threads);
  set_kinds(m, mesh, label, sharp, threads);
  return m;
}

} // namespace molmesh::improve
