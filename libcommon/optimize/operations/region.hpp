// region.hpp — the part of a mesh that one thread works on: stars, rings, and the exchange of a cavity's elements.
// Parts are sets of vertices. An operation changes only elements whose four vertices belong to its part, so regions
// of different parts may be worked on at the same time, and what is done does not depend on the order.
// Of an element of no part a region also writes the one side, neighbour and label, that it shows to an element of
// its own, and reads the others to find it. No other region touches that element's sides: it has three vertices in
// this part, so every face towards an element of another part would need one vertex of each. Nor does anyone write
// its vertices, region or quality. Arrays do not grow meanwhile: slots for new elements are reserved before.
#pragma once
#include "geom/star_quality.hpp"
#include "isosurface/target.hpp"
#include "optimize/acceptance/acceptance.hpp"
#include "optimize/acceptance/failed_attempts.hpp"
#include "optimize/crossings/crossing_guard.hpp"
#include "optimize/mesh/change_log.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/mesh/parts.hpp"
#include "optimize/mesh/snapshot.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// New element of a cavity.
struct Candidate {
  std::array<int32_t, 4> v;
  int32_t region;
  float q;
  std::array<uint8_t, 4> label{}; ///< of its faces, where faces of several labels may go
};

/// Elements around the edge a b: element i is (a, b, vertex i, vertex i + 1), positive.
struct Ring {
  int32_t a = -1, b = -1;
  bool closed = true;
  std::vector<int32_t> element, vertex; ///< closed: as many; open: one vertex more
  std::vector<int> border;              ///< positions of vertices w with a labelled face a b w
  std::vector<uint8_t> label;           ///< of those faces
};

/// A triangle on the target with one vertex that moves, running as the target's normal.
struct MovingTriangle {
  std::array<Vec3d, 3> p;
  int moving;
  uint8_t label; ///< which says what target
};

/// Memory that operations use, each from the beginning.
struct Workspace {
  std::vector<int32_t> star, other_star, old;
  std::vector<Candidate> now;
  Ring ring;
  StarQuality elements; ///< of the vertex that moves
  std::vector<MovingTriangle> triangles;
};

/// What operations cost, whether they succeed or not, about: elements whose quality is looked at.
struct Looks {
  static constexpr int64_t earned = 20'000; ///< by an operation that is done: more than most cost
  int64_t done = 0, allowed = INT64_MAX / 2;
  int64_t may_earn = INT64_MAX; ///< so many operations
};

class Region;
#ifdef MOLMESH_CHECK_OPERATIONS
/// Fails where find_fault() (check.hpp) finds one.
void check_region(const Region& r, const char* operation);
/// Of a debug build: called after every operation, from any thread. A debugger's or a test's own may write the
/// region (as_mesh(), check.hpp) to a file.
inline void (*after_operation)(const Region& r, const char* operation) = check_region;
#endif

class Region {
public:
  /// target may be null: then surface points stay. free: where the mesh ends in curved surfaces, or null.
  /// stamp [elements] is scratch: nothing above `clock`.
  Region(DynamicMesh& mesh, const Target* target, const FreeTriangles* free, const Parts& parts,
         std::vector<uint32_t>& stamp, PartRoom& room, uint32_t clock = 0);

  DynamicMesh& mesh;
  const Target* const target;
  PartRoom& room; ///< slots that new elements and vertices may come to lie in
  CrossingGuard crossings;
  Workspace work;
  ChangeLog log;                ///< elements of the part that were written, their sides too, once it is kept
  std::vector<int32_t> changed; ///< elements made or changed by operations since the caller last cleared it
  Counts counts;
  mutable Looks looks; ///< those at the target count too
  int32_t time = 1;    ///< what operations write to DynamicMesh::touched

  int32_t part() const { return room.part; }
  uint32_t clock() const { return clock_; } ///< nothing above it has been stamped
  /// The mesh ends in no curved surface.
  bool is_alone() const { return !crossings.on(); }
  double spacing() const { return target ? target->spacing() : 1; }
  /// What triangles of that label are kept on; null: nothing.
  const Target* target_of(uint8_t label) const {
    const Target* own = mesh.labels[label].target;
    return own ? own : target;
  }
  void look_at(const Target& asked, size_t times) const {
    looks.done += static_cast<int64_t>(times) * asked.looks();
  }
  /// A surface vertex that is kept on the mesh's target.
  bool on_main_target(int32_t v) const {
    return mesh.vertex[v].kind == Kind::surface && !mesh.labels[mesh.vertex[v].label].target;
  }
  /// All vertices in this part.
  bool owned(int32_t e) const { return parts_.owns(room.part, mesh.element[e].v); }

  /// Elements at v. False when one of them is not of the part.
  bool star(int32_t v, std::vector<int32_t>& out);
  /// Of the edge a b of element e. False when one of its elements is not of the part, or they are very many.
  bool ring(int32_t e, int32_t a, int32_t b, Ring& r) const;
  float worst(const std::vector<int32_t>& elements) const; ///< quality
  /// Sets the quality; false unless it is above `above` and the volume is positive.
  bool judge(Candidate& c, float above) const;
  bool is_above(const Candidate& c, float above) const; ///< by the quality that it has
  bool has_room(size_t old, size_t now) const { return now <= old + room.element.size(); }
  /// Of a surface vertex that goes from one place to another.
  bool inside_walls(Vec3d from, Vec3d to) const { return mesh.walls.allow(from, to, apart_from_walls * spacing()); }

  /// Elements `old` give way to `now`. False, and nothing changed, when faces do not match or the surface would
  /// cross itself or lie in a wall. surface: the operation may change the surface; moved: crossings holds triangles
  /// that have moved with it already.
  bool exchange(const std::vector<int32_t>& old, const std::vector<Candidate>& now, bool surface,
                bool moved = false);
  /// An element of the part is written, and its quality may change.
  void note_change(int32_t e) {
    mesh.note_change(e);
    log.add(e);
  }
  void note_side(int32_t e, size_t face); ///< it is written
  /// An operation of that name has been done, all of it. Returns true.
  bool done(int64_t Counts::*count, [[maybe_unused]] const char* operation) {
    ++(counts.*count);
#ifdef MOLMESH_CHECK_OPERATIONS
    after_operation(*this, operation);
#endif
    return true;
  }
  void touch(int32_t e); ///< what is at its vertices changes

  /// operation() unless it has failed before with all that it looks at as it is now. The state is filled in here.
  template <class Operation>
  bool unless_failed(const Acceptance& accept, FailedAttempts::Attempt attempt, Operation&& operation) {
    if (has_failed(accept, attempt))
      return false;
    looked_beyond = false;
    if (operation())
      return true;
    if (!looked_beyond)
      failed_.add(attempt);
    return false;
  }
  /// Else nothing more is begun.
  bool looks_left() const {
    return looks.done < looks.allowed + Looks::earned * std::min(counts.total(), looks.may_earn);
  }
  bool looked_beyond = false; ///< what the operation failed for is not all at its vertices

  /// Of the elements `inner`, all of this part, as they are now, and of what the part has in reserve.
  Snapshot save(const std::vector<int32_t>& inner);
  /// Everything as it was: operations since save() were on those elements and on reserved slots. What has not been
  /// written since is left alone.
  void restore(const Snapshot& s);
  /// What is not as it was then, for redo(): far less than all.
  Snapshot changes_since(const Snapshot& before);
  /// Everything as it was when `changes` was made; restored to `before` of that comes first.
  void redo(const Snapshot& changes);

private:
  Snapshot record(std::vector<int32_t> elements);
  bool written_since(const Snapshot& s);
  void write(const Snapshot& s);
  void write(const Snapshot::Corner& c);
  void write_sides(const Snapshot& s);
  void put_back_rest(const Snapshot& s);
  struct Face;
  bool match(const std::vector<int32_t>& old, const std::vector<Candidate>& now, bool surface);
  Face& face_entry(const std::array<int32_t, 3>& v);
  uint8_t lost_label() const;
  static uint8_t label_of(const Face& x, const std::vector<Candidate>& now, uint8_t otherwise);
  bool any_in_wall(const std::vector<Candidate>& now) const;
  bool any_sags(const std::vector<Candidate>& now) const;
  void list_free_triangles(const std::vector<Candidate>& now);
  bool face_is_taken(const std::vector<int32_t>& old);
  void commit(const std::vector<int32_t>& old, const std::vector<Candidate>& now);
  bool has_failed(const Acceptance& accept, FailedAttempts::Attempt& attempt);
  bool restore_written(const Snapshot& s);

  const Parts& parts_;
  std::vector<uint32_t>& stamp_;
  uint32_t clock_;
  struct Face {                     ///< of a cavity
    std::array<int32_t, 3> v;       ///< ascending
    int64_t old;                    ///< outer: 4 element + face of the one that goes
    int32_t element, first, second; ///< outer: beyond the face; 4 candidate + face of new ones
    uint8_t face, label;
    bool outer;
    uint32_t clock = 0;

    bool ends_mesh() const { return outer && element < 0; }
    bool is_lost() const { return ends_mesh() && first < 0; }            ///< a triangle that goes
    bool stays() const { return ends_mesh() && first >= 0; }             ///< a triangle of a new element
    bool is_new() const { return !outer && second < 0; }                 ///< a triangle that comes
    bool is_bared() const { return outer && element >= 0 && first < 0; } ///< a triangle of what is beyond
  };
  std::vector<Face> table_;
  std::vector<int32_t> used_; ///< entries of table_
  uint32_t table_clock_ = 0;
  std::vector<int32_t> made_, written_;
  SmallNumbers corners_;              ///< of record()
  uint64_t saved_ = 0, restored_ = 0; ///< numbers of snapshots: of the last one, and of what was last brought back
  ChangeLog::Moment restored_then_;   ///< when it was
  FailedAttempts failed_;
  Guard failed_with_; ///< the guard of the attempts in failed_
};

} // namespace molmesh::optimize
