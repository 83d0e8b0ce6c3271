// dynamic_mesh.cpp — neighbours and labels by groups of equal faces, and what vertices may do.
#include "optimize/mesh/dynamic_mesh.hpp"
#include "base/error.hpp"
#include "geom/predicates.hpp" // exact sign of the volumes that come in
#include "geom/tet_quality_simd.hpp"
#include "mesh/face_groups.hpp"
#include "mesh/sorted_triangle.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <map>
#include <mutex>
#include <string>

namespace molmesh::optimize {
namespace {

// From any thread.
void raise_to(int32_t& place, int32_t value) {
  const std::atomic_ref shared(place);
  int32_t seen = shared.load(std::memory_order_relaxed);
  while (seen < value && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed))
    ;
}

Tri face_at(const TetMesh& mesh, int64_t slot) {
  return outward_triangle(mesh.tet[slot / 4], size_t(slot % 4));
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

void require_labels(size_t before) {
  if (before == 256)
    fail_input("more than 255 different boundary labels");
}

// Labels in the order of their first triangles; the index of each triangle's.
std::vector<uint8_t> set_labels(DynamicMesh& m, const TetMesh& mesh) {
  m.labels.assign(1, {});
  std::map<int32_t, uint8_t> index;
  std::vector<uint8_t> label(mesh.tri.size());
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const auto [entry, fresh] = index.try_emplace(mesh.boundary[t], static_cast<uint8_t>(m.labels.size()));
    if (fresh) {
      require_labels(m.labels.size());
      m.labels.push_back({mesh.boundary[t], -1});
    }
    label[t] = entry->second;
  }
  return label;
}

// Beside `reversed`: it is of the molecular surface but a face of another region alone, and so looks into it
// (VTUv1) where those between two regions look out of the first.
constexpr uint8_t lone = 2;

// Faces meet the face on their other side and their triangle.
std::vector<uint8_t> link(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label, int threads) {
  std::vector<uint8_t> way(mesh.tri.size(), 0);
  const auto faces = static_cast<int64_t>(4 * mesh.tet.size());
  FirstFault fault, mislabelled; // the one comes before the other
  const auto join = [&](const uint32_t* face, int sides, bool has_triangle) {
    for (int i = 0; i < sides; ++i) {
      Element& e = m.element[face[i] / 4];
      if (sides == 2)
        e.n[face[i] % 4] = static_cast<int32_t>(face[1 - i] / 4);
      if (has_triangle) {
        e.label[face[i] % 4] = label[face[sides] - faces];
        m.note_label(static_cast<int32_t>(face[i] / 4));
      }
    }
  };
  const auto set_way = [&](const uint32_t* face, int sides) {
    const auto t = size_t(static_cast<int64_t>(face[sides]) - faces);
    const int32_t region = mesh.region[face[0] / 4];
    const bool second = sides == 2 && m.order.is_first(mesh.region[face[1] / 4], region);
    if (sorted_triangle(face_at(mesh, face[second ? 1 : 0])).odd != sorted_triangle(mesh.tri[t]).odd)
      way[t] |= reversed;
    if (sides == 1 && mesh.boundary[t] == Boundary::surface && !m.order.is_inside(region))
      way[t] |= lone;
  };
  for_each_face(mesh.tet, mesh.tri, static_cast<int64_t>(mesh.point.size()), threads,
                [&](const uint32_t* face, int n, bool same_side) {
                  const auto sides = static_cast<int>(std::lower_bound(face, face + n, faces) - face);
                  if (sides == 2 && same_side)
                    fault.found(face[0], [&] {
                      return name("tetrahedron", face[0] / 4) + " overlaps " + name("tetrahedron", face[1] / 4) +
                             ", expected one on each side of a face";
                    });
                  if (sides > 2)
                    fault.found(face[0], [&] {
                      return name("tetrahedron", face[0] / 4) + " has a face shared by three, expected two at most";
                    });
                  if (sides == 0)
                    fault.found(face[0],
                                [&] { return name("triangle", face[0] - faces) + " is no face of a tetrahedron"; });
                  if (sides > 0 && n > sides + 1)
                    fault.found(face[sides + 1],
                                [&] { return name("triangle", face[sides + 1] - faces) + " is a duplicate"; });
                  if (sides == 0 || sides > 2)
                    return;
                  const bool border = sides == 1 || mesh.region[face[0] / 4] != mesh.region[face[1] / 4];
                  if (border != (n > sides))
                    mislabelled.found(face[0], [&] {
                      return name("tetrahedron", face[0] / 4) +
                             (border ? " has a face between regions or on the outside without a triangle"
                                     : " has a triangle inside its region");
                    });
                  join(face, sides, n > sides);
                  if (n > sides)
                    set_way(face, sides);
                });
  fault.fail_if_any();
  mislabelled.fail_if_any();
  return way;
}

// A molecular surface of both kinds becomes two labels of one name: each has its own direction.
void split_surface(DynamicMesh& m, const std::vector<uint8_t>& way, std::vector<uint8_t>& label) {
  const auto surface = static_cast<uint8_t>(
      std::find_if(m.labels.begin(), m.labels.end(), [](const Label& l) { return l.name == Boundary::surface; }) -
      m.labels.begin());
  bool any_lone = false, any_other = false;
  for (size_t t = 0; t < way.size(); ++t)
    if (label[t] == surface)
      (way[t] & lone ? any_lone : any_other) = true;
  if (!any_lone || !any_other)
    return;
  require_labels(m.labels.size());
  const auto added = static_cast<uint8_t>(m.labels.size());
  m.labels.push_back(m.labels[surface]);
  for (size_t t = 0; t < way.size(); ++t)
    if (way[t] & lone)
      label[t] = added;
  for (Element& e : m.element)
    for (size_t i = 0; i < 4; ++i)
      if (e.label[i] == surface && e.n[i] < 0 && !m.order.is_inside(e.region))
        e.label[i] = added;
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
  dirty.resize(size_t(chunks(elements)), 1);
  worst.resize(dirty.size(), 2);
  labelled.resize(dirty.size(), 0);
  point.resize(vertices);
  vertex.resize(vertices);
  incident.resize(vertices, -1);
  touched.resize(vertices, 0);
  state.resize(vertices, 0);
}

DynamicMesh build(const TetMesh& mesh, double sharp, int threads) {
  require_size(static_cast<int64_t>(mesh.tet.size()), static_cast<int64_t>(mesh.tri.size()),
               static_cast<int64_t>(mesh.point.size()));
  DynamicMesh m;
  m.order = RegionOrder(mesh);
  const size_t points = mesh.point.size(), elements = mesh.tet.size();
  const auto with_room = [&](auto& v, size_t n) { // what it will grow by, untouched till then: no second copy
    par::reserve_pages(v, n, n / 4, threads);
  };
  with_room(m.point, points);
  m.point.assign(mesh.point.begin(), mesh.point.end());
  with_room(m.vertex, points);
  m.vertex.resize(points);
  with_room(m.incident, points);
  m.incident.assign(points, -1);
  with_room(m.touched, points);
  m.touched.assign(points, 0);
  with_room(m.state, points);
  m.state.assign(points, 0);
  m.element.reserve(elements + elements / 4);
  m.element.resize(elements);
  m.dirty.assign(size_t(DynamicMesh::chunks(mesh.tet.size())), 0);
  m.worst.assign(m.dirty.size(), 2);
  m.labelled.assign(m.dirty.size(), 0);
  FirstFault fault;
  constexpr int64_t chunk = DynamicMesh::chunk;
  const auto tets = static_cast<int64_t>(mesh.tet.size());
  par::for_n(DynamicMesh::chunks(mesh.tet.size()), threads, 8, [&](int64_t c) {
    float worst = 2;
    const auto first = static_cast<size_t>(c * chunk), n = static_cast<size_t>(std::min(chunk, tets - c * chunk));
    prepare_pages(&m.element[first], n * sizeof(Element));
    const auto corner = [&](size_t k, size_t i) { return m.point[mesh.tet[first + k][i]]; };
    judge_each(n, corner, [&](size_t k, float q) {
      Element& e = m.element[first + k] = {};
      e.v = mesh.tet[first + k];
      e.region = mesh.region[first + k];
      e.q = std::max(q, 0.f);
      worst = std::min(worst, e.q);
      if (q < surely_positive && orient3d(corner(k, 0), corner(k, 1), corner(k, 2), corner(k, 3)) <= 0)
        fault.found(static_cast<int64_t>(first + k), [&] {
          return name("tetrahedron", static_cast<int64_t>(first + k)) + " has no positive volume";
        });
      return true;
    });
    m.worst[c] = worst;
    for (size_t e = first + n; e-- > first;) // downwards: most find a higher one there
      for (const int32_t v : mesh.tet[e])
        raise_to(m.incident[v], static_cast<int32_t>(e));
  });
  fault.fail_if_any();
  std::vector<uint8_t> label = set_labels(m, mesh);
  const std::vector<uint8_t> way = link(m, mesh, label, threads);
  split_surface(m, way, label);
  std::vector<int64_t> against(m.labels.size());
  for (size_t t = 0; t < label.size(); ++t)
    against[label[t]] += way[t] & reversed ? 1 : -1;
  for (size_t l = 1; l < m.labels.size(); ++l) // as most of its triangles
    m.labels[l].reversed = against[l] > 0;
  set_kinds(m, mesh, label, way, sharp, threads);
  return m;
}

} // namespace molmesh::optimize
