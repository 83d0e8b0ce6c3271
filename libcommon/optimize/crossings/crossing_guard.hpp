// crossing_guard.hpp — keeps the triangles where a part of a mesh ends in a curved surface from crossing others.
#pragma once
#include "optimize/crossings/free_triangles.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/mesh/parts.hpp"
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::optimize {

class CrossingGuard {
public:
  /// free: all such triangles of the mesh when work on the part began; null: there are none. stamp [elements].
  CrossingGuard(const DynamicMesh& m, const FreeTriangles* free, const Parts& parts, int32_t part,
                const std::vector<uint32_t>& stamp)
      : changes(free ? free->cell() : 1), m_(m), free_(free), parts_(parts), part_(part), stamp_(stamp) {}
  bool on() const { return free_ != nullptr; }

  // The triangles of one operation, as they are to be.
  void clear() { now_.clear(), face_.clear(); }
  bool empty() const { return now_.empty(); }
  void add(const std::array<int32_t, 3>& triangle) { now_.push_back(triangle); }
  /// Those at v of elements that keep their vertices, without those at the vertex `without` (-1: none).
  void add_at(const std::vector<int32_t>& elements, int32_t v, int32_t without);
  /// True when one of them leaves the part's cell.
  bool leave_part() const;
  /// True when one of them crosses another triangle or leaves the part's cell. leaving: stamp of elements that go,
  /// or 0.
  bool cross(uint32_t leaving);
  /// Those of add_at() are known from now on as they are now.
  void note_moved();
  const std::vector<int64_t>& faces() const { return face_; } ///< of those of add_at(): 4 element + face
  /// Vertices of the triangles on these faces that cross others, and of those others. face: all that have moved in
  /// the part since the last call; they are known from now on as they are now.
  std::vector<int32_t> find_crossing(std::vector<int64_t> face);

  FreeTriangles changes; ///< in this part, since work on it began
  /// All changes, those of find_crossing() too.
  FreeTriangleChanges take_changes() const;

private:
  /// A triangle that may be in the way, and whether it stays where it is.
  struct Near {
    enum class Stays : uint8_t { not_asked, may_be_stale, yes, no };
    FreeTriangle triangle;
    Stays stays;
  };
  /// A triangle across the edge opposite one's vertex.
  struct Beyond {
    int edge;
    int32_t apex;
  };
  void note_edge(const Apart& apart, const std::array<int32_t, 3>& other);
  bool lie_beside(const FreeTriangle& a, const FreeTriangle& b, const Apart& apart) const;
  bool crosses(const FreeTriangle& now, Near& near, uint32_t leaving);
  void gather_near(const FreeTriangles& from, const Boxf& around, bool may_be_stale);
  bool stays_near(Near& n, uint32_t leaving) const;
  bool is_there(std::array<int32_t, 3> v, uint32_t leaving);
  bool turns_over(const std::array<int32_t, 3>& t, uint32_t leaving);
  bool is_inside_out(const std::vector<std::array<int32_t, 3>>& fan, int32_t tip, int32_t other) const;
  bool fan_turns_over() const;
  void add_fans_that_turn_over(SmallNumbers& vertices) const;

  const DynamicMesh& m_;
  const FreeTriangles* free_;
  const Parts& parts_;
  const int32_t part_;
  const std::vector<uint32_t>& stamp_;
  std::vector<std::array<int32_t, 3>> now_;
  std::vector<int64_t> face_;
  std::vector<FreeTriangle> boxed_; ///< now_ with their boxes
  std::vector<Near> near_;
  std::vector<EightBoxes> near_box_; ///< of these; EightBoxes::id: index into near_
  std::vector<Beyond> beyond_;
  std::vector<std::array<int32_t, 3>> opposite_; ///< now_: the apex across the edge opposite each vertex, -1: none
  std::vector<FreeTriangle> moved_;              ///< of find_crossing(), where none crosses
};

} // namespace molmesh::optimize
