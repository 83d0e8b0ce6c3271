// dynamic_mesh.hpp — tetrahedra that know their neighbours, labelled faces and constrained vertices.
#pragma once
#include "base/array.hpp"
#include "geom/tet_measures.hpp"
#include "geom/tet_quality.hpp"
#include "mesh/region_order.hpp"
#include "mesh/tet_mesh.hpp"
#include "optimize/mesh/walls.hpp"
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

namespace molmesh {
class Target;
}

namespace molmesh::optimize {

/// What a vertex may do.
enum class Kind : uint8_t {
  interior, ///< on no labelled face: anything
  surface,  ///< on one curved label: stays on the target
  sliding,  ///< on axis planes alone (box walls): keeps the frozen coordinates
  trace,    ///< where one curved label meets one wall: stays on the target and in the wall
  line,     ///< where three triangles of curved labels meet, between domains: stays on the targets of two of these
  round,    ///< on the outer sphere alone: stays on it
  fixed,    ///< where other labels or sharp edges meet: never moves, is never removed
};
/// On a curved label, and free to move on it.
inline constexpr bool follows_target(Kind k) {
  return k == Kind::surface || k == Kind::trace || k == Kind::line;
}

struct Vertex {
  Kind kind = Kind::interior;
  uint8_t frozen = 0;   ///< sliding, trace: bit a set when coordinate a is kept
  uint8_t label = 0;    ///< of a labelled face at the vertex (0 inside)
  uint8_t second = 0;   ///< line: of another one
  bool watched = false; ///< the surface is near itself here, with no elements between: CrossingGuard

  int axis() const { return std::countr_zero(frozen); } ///< trace: of the coordinate that is kept
};

/// Face i is opposite v[i]; (v1 v2 v3), (v0 v3 v2), (v0 v1 v3), (v0 v2 v1) point out.
struct Element {
  std::array<int32_t, 4> v{-1, -1, -1, -1}; ///< positive volume; v[0] < 0: a free slot
  std::array<int32_t, 4> n{-1, -1, -1, -1}; ///< element across face i; -1: none
  std::array<uint8_t, 4> label{};           ///< of face i, an index into DynamicMesh::labels; 0: none
  int32_t region = 0;
  float q = 0;       ///< tet_quality
  int32_t tried = 0; ///< when the schedule last found nothing to do for it

  bool alive() const { return v[0] >= 0; }
  int find(int32_t vertex) const {
    const int later = (v[1] == vertex) | 2 * (v[2] == vertex) | 3 * (v[3] == vertex);
    return later - ((later == 0) & (v[0] != vertex));
  }
  /// The face that neighbour t is across; 0 when it is none.
  size_t face_towards(int32_t t) const {
    return static_cast<size_t>((n[1] == t) | 2 * (n[2] == t) | 3 * (n[3] == t));
  }
  bool any_labelled() const { return (label[0] | label[1] | label[2] | label[3]) != 0; }
};

/// Of an element: the corners of its edges.
inline constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Face of the element v, seen from outside it.
inline std::array<int32_t, 3> outward_triangle(const std::array<int32_t, 4>& v, size_t face) {
  const auto corner = [&](int i) { return v[tet_face(int(face), i)]; };
  return {corner(0), corner(1), corner(2)};
}

} // namespace molmesh::optimize

/// build() fills them on all threads.
template <>
inline constexpr bool molmesh::leave_untouched<molmesh::optimize::Element> = true;

namespace molmesh::optimize {

struct Label {
  int32_t name = 0;  ///< TetMesh::boundary
  int axis = -1;     ///< all its triangles lie in one plane normal to this axis; -1: curved or round
  bool wall = false; ///< and the mesh ends there
  /// What its triangles are kept on, between domains; null: the mesh's target.
  const Target* target = nullptr;
  bool reversed = false; ///< its triangles point into the first of the two regions, or into the mesh
  bool round = false;    ///< all its points lie on the mesh's outer sphere
  bool curved() const { return axis < 0 && !round; } ///< it is on a target
};

struct DynamicMesh {
  Array<Vec3d> point;
  Array<Vertex> vertex;
  Array<int32_t> incident; ///< [vertices] an element at the vertex; -1: free slot
  Array<int32_t> touched;  ///< [vertices] when an element at the vertex last changed
  Array<uint32_t> state;   ///< [vertices] another number whenever what is there is written, the same when put back
  LargeArray<Element> element;
  Array<Label> labels; ///< [0] is no label
  Walls walls;
  RegionOrder order;
  Sphere sphere; ///< of round labels
  /// [chunks] 1 if an element of this chunk changed since its worst quality was computed.
  Array<uint8_t> dirty;
  Array<float> worst; ///< [chunks] lowest quality where not dirty; 2 where nothing is alive
  /// [chunks] not 0 where a face of an element may be labelled.
  Array<uint8_t> labelled;
  static constexpr int64_t chunk = 512; ///< elements
  static int64_t chunks(size_t elements) { return (static_cast<int64_t>(elements) + chunk - 1) / chunk; }

  /// To so many slots; new ones are free.
  void resize(size_t elements, size_t vertices);
  /// Of the element's quality. From any thread.
  void note_change(int32_t e) { std::atomic_ref(dirty[e / chunk]).store(1, std::memory_order_relaxed); }

  /// A face of it is labelled. From any thread.
  void note_label(int32_t e) { std::atomic_ref(labelled[e / chunk]).store(1, std::memory_order_relaxed); }
  /// f(e) for the slots of chunk s.
  template <class F>
  void for_chunk(int64_t s, F&& f) const {
    for (int64_t e = s * chunk, end = std::min(static_cast<int64_t>(element.size()), e + chunk); e < end; ++e)
      f(e);
  }

  /// Whether the face is labelled and this side's to count: the first region's.
  bool counts_here(const Element& e, size_t face) const {
    return e.label[face] != 0 && (e.n[face] < 0 || order.is_first(e.region, element[e.n[face]].region));
  }
  /// Whether a labelled face, seen as an outward one of e, runs as the target's normal does.
  bool outward(const Element& e, size_t face) const {
    const bool first = e.n[face] < 0 || order.is_first(e.region, element[e.n[face]].region);
    return first != labels[e.label[face]].reversed;
  }
  /// Whether two of its corners are.
  bool watched(const std::array<int32_t, 3>& triangle) const {
    return std::count_if(triangle.begin(), triangle.end(), [&](int32_t v) { return vertex[v].watched; }) >= 2;
  }
  float quality(const std::array<int32_t, 4>& v) const {
    return tet_quality(point[v[0]], point[v[1]], point[v[2]], point[v[3]]);
  }
};

// Indices are 32-bit, and faces and triangles are grouped together, 2^32 - 1 of them at most. Each throws one clear
// line where that does not hold.
void require_size(int64_t elements, int64_t triangles,
                  int64_t points);                      ///< of a mesh that came in: Error(bad_input)
void require_slots(int64_t elements, int64_t vertices); ///< of one that grows: Error(failed)

/// Edges of a curved label that bend by more than `sharp` degrees are kept: their ends are fixed.
/// Throws Error(bad_input) naming the first element, face or triangle that makes the mesh no valid one:
/// more than require_size allows, non-positive volume by exact sign, a face with three elements, two elements on
/// one side of a face, triangles that are not exactly the faces between regions and on the outside.
DynamicMesh build(const TetMesh& mesh, double sharp, int threads);

/// Elements, vertices and triangles in slot order, unused slots squeezed out; triangles point as they did.
TetMesh extract(const DynamicMesh& mesh, int threads = 1);
/// across [4 tets]: the tetrahedron beyond each face, -1: none. `out` lends its memory; isovalue, source and
/// creator stay as they are there. The mesh's elements are gone then.
TetMesh extract(DynamicMesh&& mesh, int threads, LargeArray<int32_t>& across, TetMesh out);

/// The vertex where faces of these labels meet in a line: it follows the two first of them by name.
Vertex line_vertex(const DynamicMesh& m, std::vector<uint8_t> labels);

/// Of a triangle, a bit of its way: it points into the first of the two regions, or into the mesh.
inline constexpr uint8_t reversed = 1;

/// Sets Label::axis, the walls and the vertices. label [tris]: indices into DynamicMesh::labels; way [tris].
/// Sliding needs planes of distinct axes, surface one curved label that is a 2-manifold there without edges that
/// bend by more than `sharp` degrees.
void set_kinds(DynamicMesh& m, const TetMesh& mesh, const std::vector<uint8_t>& label,
               const std::vector<uint8_t>& way, double sharp, int threads);

} // namespace molmesh::optimize
