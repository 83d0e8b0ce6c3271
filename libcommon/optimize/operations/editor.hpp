// editor.hpp — local operations on one part of a mesh: cavity out, cavity in, and the worst element must rise.
// Parts are sets of vertices. An operation changes only elements whose four vertices belong to its part, so editors
// of different parts may run at the same time, and what they do does not depend on the order.
// Of an element of no part an editor also writes the one side, neighbour and label, that it shows to an element of
// its own, and reads the others to find it. No other editor touches that element's sides: it has three vertices in
// this part, so every face towards an element of another part would need one vertex of each. Nor does anyone write
// its vertices, region or quality. Arrays do not grow while editors run: slots for new elements are reserved
// before.
#pragma once
#include "geom/pattern_search.hpp"
#include "geom/star_quality.hpp"
#include "isosurface/guard.hpp"
#include "isosurface/target.hpp"
#include "optimize/acceptance/failures.hpp"
#include "optimize/crossings/sheets.hpp"
#include "optimize/mesh/change_log.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/mesh/part_copy.hpp"
#include "optimize/mesh/snapshot.hpp"
#include "optimize/operations/piece.hpp"
#include "optimize/schedule/parts.hpp"
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace molmesh::optimize {

/// New element of a cavity.
struct Candidate {
  std::array<int32_t, 4> v;
  int32_t region;
  float q;
  std::array<uint8_t, 4> label{}; ///< of its faces, where faces of several labels may go
};

/// How badly triangles fit the target.
struct Fit {
  double worst = 1;  ///< misfit, at least 1
  double excess = 0; ///< sum of what misfits exceed 1 by, and of what a vertex lies off the target
  void add(double misfit) {
    worst = misfit > worst ? misfit : worst;
    excess += misfit > 1 ? misfit - 1 : 0;
  }
  float worth() const { return static_cast<float>(1 / (1 + excess)); } ///< 1: nothing to repair
};

/// Elements around the edge a b: element i is (a, b, vertex i, vertex i + 1), positive.
struct Ring {
  int32_t a = -1, b = -1;
  bool closed = true;
  std::vector<int32_t> element, vertex; ///< closed: as many; open: one vertex more
  std::vector<int> border;              ///< positions of vertices w with a labelled face a b w
  std::vector<uint8_t> label;           ///< of those faces
};

class Editor {
public:
  /// target may be null: then surface points stay. sheets: where the mesh ends in curved surfaces, or null.
  /// stamp [elements] is scratch: nothing above `clock`.
  Editor(DynamicMesh& mesh, const Target* target, const Sheets* sheets, const Parts& parts,
         std::vector<uint32_t>& stamp, PartRoom& room, Guard guard, uint32_t clock = 0);
  /// Works on a copy as `like`, which is alone(), does on the part.
  Editor(const Editor& like, PartCopy& part, std::vector<uint32_t>& stamp)
      : Editor(part.mesh, like.target_, nullptr, part.parts, stamp, part.room, like.guard_) {}

  uint32_t clock() const { return clock_; } ///< nothing above it has been stamped

  // Each tries its operation and tells whether it was done: the worst quality among the elements concerned has
  // risen. When straightening: their surface triangles fit better, and no element has fallen under the goal.
  bool smooth(int32_t v);                      ///< moves v until its elements reach the goal
  bool remove_edge(int32_t e, int i, int j);   ///< edge v[i] v[j] of element e; flips a surface edge
  bool swap_face(int32_t e, int i);            ///< face i: two elements become three
  bool contract(int32_t e, int i, int j);      ///< v[i] goes to v[j]
  bool merge(int32_t e, int i, int j);         ///< v[i] and v[j] meet where their elements are best
  bool split(int32_t e, int i, int j);         ///< a new vertex near the middle of the edge
  bool is_tiny(int32_t e, int i, int j) const; ///< under a tenth of a spacing
  /// Gives the elements on one side of a surface vertex that is off the target to the other side: the surface then
  /// runs past it. No element changes its shape but for a vertex that comes to lie on the surface.
  bool hand_over(int32_t v);
  /// The closed surface of few triangles that v is on shrinks to what the target has there, in shells that get
  /// smaller by about `ratio`.
  bool nest(int32_t v, double ratio);
  double spacing() const { return target_ ? target_->spacing() : 1; }
  /// Near a surface vertex off the target (Target::neck).
  bool find_neck(int32_t v, Neck& neck) const {
    return m_.vertex[v].kind == Kind::surface && target_ && target_->neck(m_.point[v], neck);
  }
  /// The surface near v follows the target down into a neck, in such shells.
  bool follow_neck(int32_t v, const Neck& neck, double ratio);
  /// Whether the face is a surface triangle, counted from this side, that does not keep the guard, or is turned by
  /// more than Guard::widest_unbent.
  bool bent(int32_t e, size_t face) const;
  /// Of a vertex of the surface or a trace: Target::off_by, or two spacings where the target is not known.
  double off(int32_t v) const;
  /// Moves surface vertices onto the target, in order, all the way or part of it; no element falls under `floor`;
  /// floor ≥ 1: to less than half its quality. The part has not been changed before. Triangles are not asked one
  /// move at a time whether they cross others, which few do: where one does in the end, all goes back and they are.
  void settle(const std::vector<int32_t>& vertices, float floor);
  /// Moves a vertex of the surface or a trace towards the nearest place on the target that it finds, as far as no
  /// element falls under `floor`.
  bool approach(int32_t v, float floor);

  int32_t part() const { return room_.part; }
  /// Slots that new elements may come to lie in.
  const std::vector<int32_t>& reserve() const { return room_.element; }
  /// Of the elements `inner`, all of this part, as they are now, and of what the part has in reserve.
  Snapshot save(const std::vector<int32_t>& inner);
  /// Everything as it was: operations since save() were on those elements and on reserved slots. What has not been
  /// written since is left alone.
  void restore(const Snapshot& s);
  /// Of the part.
  PartCopy copy(const std::vector<int32_t>& slots) const { return copy_part(m_, parts_, room_, slots); }
  /// There are no sheets to cross.
  bool alone() const { return !sheets_; }
  /// All vertices in this part.
  bool owned(int32_t e) const;

  /// Elements of the part that were written, their sides too, once it is kept.
  ChangeLog log;
  /// Elements made or changed by operations since the caller last cleared it.
  std::vector<int32_t> changed;
  /// How sheets differs now; to be called last.
  SheetChanges take_sheet_changes();
  Counts counts;
  float goal = 1; ///< elements of less quality count in the deficit
  bool worst_first = true;
  bool straighten = false;         ///< operations are to make the surface fit
  bool bold = false;               ///< operations may bend the surface
  bool loose = false;              ///< surface vertices move anywhere near enough to the target, not on it alone
  double least_step = finest_step; ///< pattern_search()
  float yield = 1;  ///< contractions may lower the worst element to this share where the deficit falls by a tenth
  int32_t time = 1; ///< what operations write to DynamicMesh::touched

private:
  bool star(int32_t v, std::vector<int32_t>& out);
  bool ring(int32_t e, int32_t a, int32_t b, Ring& r) const;
  bool judge(Candidate& c, float above) const;
  bool is_above(const Candidate& c, float above) const; ///< by the quality that it has
  bool match(const std::vector<int32_t>& old, const std::vector<Candidate>& now, bool surface);
  /// False, and nothing changed, when faces do not match or the surface would cross itself or lie in a wall. rim_:
  /// triangles that have moved with the operation already; surface: the operation may change them.
  bool replace(const std::vector<int32_t>& old, const std::vector<Candidate>& now, bool surface,
               bool rim_moved = false);
  /// An element of the part is written, and its quality may change.
  void note_change(int32_t e) {
    m_.note_change(e);
    log.add(e);
  }
  void note_side(int32_t e, size_t face); ///< it is written
  void touch(int32_t e);                  ///< what is at its vertices changes
  /// Whether it has failed when all that it looks at was the same. Fills in the rest.
  bool has_failed(Failures::Attempt& attempt);
  bool note_failure(const Failures::Attempt& attempt); ///< false
  bool move_to_best(int32_t v);                        ///< smooth()
  bool join(int32_t e, int i, int j);                  ///< merge()
  bool halve(int32_t e, int i, int j);                 ///< split()
  bool restore_written(const Snapshot& s);
  void list_rim(const std::vector<Candidate>& now);
  void list_rim(const std::vector<int32_t>& elements, int32_t v, int32_t without);
  uint8_t lost_label() const;
  bool rim_in_wall(const std::vector<Candidate>& now) const;
  struct FaceEntry;
  static uint8_t label_of(const FaceEntry& x, const std::vector<Candidate>& now, uint8_t otherwise);
  bool face_is_taken(const std::vector<int32_t>& old);
  /// Of a surface vertex that goes from one place to another.
  bool inside_walls(Vec3d from, Vec3d to) const { return m_.walls.allow(from, to, apart_from_walls * spacing()); }
  /// A triangle near rim_, and whether it stays where it is.
  struct Near {
    enum class Stays : uint8_t { not_asked, may_be_stale, yes, no };
    SheetTriangle triangle;
    Stays stays;
  };
  void note_edge(const Apart& apart, const std::array<int32_t, 3>& other);
  bool lie_beside(const SheetTriangle& a, const SheetTriangle& b, const Apart& apart) const;
  bool crosses(const SheetTriangle& now, Near& near, bool stamped_go);
  void gather_near(const Sheets& sheets, const Boxf& around, bool may_be_stale);
  bool stays_near(Near& n, bool stamped_go) const;
  bool rim_leaves() const;
  bool rim_crosses(bool stamped_go);
  bool turns_over(const std::array<int32_t, 3>& t) const;
  void move_rim();
  void clear_rim() { rim_.clear(), rim_face_.clear(); }
  bool has_room(size_t old, size_t now) const { return now <= old + room_.element.size(); }
  double misfit(Vec3d a, Vec3d b, Vec3d c, double most_tilt) const;
  double misfit(Vec3d a, Vec3d b, Vec3d c) const { return misfit(a, b, c, most_tilt_); }
  double misfit_face(const Element& e, size_t face, double most_tilt) const;
  double misfit_face(const Element& e, size_t face) const { return misfit_face(e, face, most_tilt_); }
  bool edge_is_labelled(int32_t a, int32_t b);
  bool surface_link_holds(int32_t a, int32_t b, const Ring& r);
  float worst(const std::vector<int32_t>& elements) const;
  float lack(float q) const { return molmesh::lack(q, goal, worst_first, guard_); }
  float lack(const std::vector<int32_t>& elements) const;
  float lack(const std::vector<Candidate>& elements) const;
  std::optional<double> off_at(Vec3d x) const; ///< off() of a place; none where the target is not known
  bool stays(Vec3d x) const;
  bool project(const Vertex& k, Vec3d& x, double reach) const;
  bool put_on_target(const Vertex& k, Vec3d from, Vec3d& x, double reach) const;
  int put_all_on_target(const Vertex& k, Vec3d from, Vec3d* x, int n, double reach) const;
  bool constrain(const Vertex& k, Vec3d from, Vec3d& x, double reach) const;
  /// Those of n trials that constrain() allows, in front and in order; how many.
  int constrain_all(const Vertex& k, Vec3d from, Vec3d* x, int n, double reach) const;
  /// A triangle on the target with one vertex that moves, running as the target's normal.
  struct Sail {
    std::array<Vec3d, 3> p;
    int moving;
  };
  void add_sail(const Element& e, size_t face, int32_t from);
  /// With the vertex at x, or where it is.
  Fit fit_of_sails(const Vec3d* x = nullptr) const;
  bool fits(const Fit& now, const Fit& before) const {
    return bold || (straighten ? now.excess < 0.98 * before.excess : now.worst <= before.worst);
  }
  bool sails_fit(Vec3d x, const Fit& before) const;
  /// What new elements must be better than.
  float demand(float before) const {
    return straighten ? 0.999999f * (before < goal ? before : goal) : before + 1e-9f + 0.01f * before;
  }
  Fit gather_sails(const std::vector<int32_t>& star, int32_t v);
  void gather(const std::vector<int32_t>& star, int32_t v, double& length, Fit& before);
  double mean_edge(const std::vector<int32_t>& star, int32_t v) const;
  float worth(Vec3d x, float above);
  /// What hand_over() moves to the other side.
  struct Side {
    std::vector<int32_t> element;
    int32_t to = -1, fresh = -1; ///< region they come to; vertex that is new on the surface, or -1
    uint8_t label = 0;
    bool grows = false; ///< the inside does
    Fit before;         ///< of the triangles at the vertex
  };
  bool find_side(int32_t v, Side& side) const;
  bool find_piece(int32_t v, Piece& piece);
  bool fit_piece(const Piece& piece, Vec3d& to, double& scale) const;
  bool find_shell(Piece& piece, Vec3d c);
  bool shrink(const Piece& piece, Vec3d c, double scale, double ratio);
  bool find_ring(int32_t v, const Neck& neck, Piece& piece);
  bool place_on_target(const Vertex& k, Vec3d& x, double length, const Fit& before, float above);
  bool search(const Vertex& k, Vec3d& x, float& best, float aim, double length, const Fit& before, float above);
  /// Moves v, star_ being its elements, as far as they stay above: all the way, or steps shorter each time.
  bool step_to(int32_t v, Vec3d to, double shorter, double least, float above);
  bool take(const std::vector<int32_t>& elements, int32_t v, Vec3d from, float above, float allowed);
  /// What has moved, in order, and was before, while nobody asks for crossings: settle().
  struct Unlooked {
    std::vector<std::pair<int32_t, Vec3d>> vertex;
    std::vector<std::pair<int32_t, float>> element; ///< and its quality
    std::vector<int64_t> face;                      ///< of triangles
  };
  void settle_each(const std::vector<int32_t>& vertices, float floor);
  void settle(int32_t v, float floor);
  bool any_crosses(Unlooked& moved);
  void put_back(const Unlooked& moved);
  bool may_contract(const Vertex& a, const Vertex& b) const;
  bool finish_contraction(int32_t a, int32_t b, bool moved);
  bool borders_allow(int32_t e, int32_t a, int32_t b);

  DynamicMesh& m_;
  const Target* target_;
  const Sheets* sheets_;
  Sheets changed_sheets_;
  const Parts& parts_;
  std::vector<uint32_t>& stamp_;
  PartRoom& room_;
  Guard guard_;
  double most_tilt_; ///< the guard's
  double bent_tilt_ = Guard{Guard::widest_unbent}.tilt();
  uint32_t clock_;
  struct FaceEntry {
    std::array<int32_t, 3> v;       ///< ascending
    int64_t old;                    ///< outer: 4 element + face of the one that goes
    int32_t element, first, second; ///< outer: beyond the face; 4 candidate + face of new ones
    uint8_t face, label;
    bool outer;
    uint32_t clock = 0;
  };
  std::vector<FaceEntry> table_;
  std::vector<int32_t> used_; ///< entries of table_
  uint32_t table_clock_ = 0;
  FaceEntry& entry(const std::array<int32_t, 3>& v);
  std::vector<std::array<int32_t, 3>> rim_;
  std::vector<int64_t> rim_face_;
  std::vector<SheetTriangle> rim_sheet_;
  std::vector<Near> near_;
  std::vector<EightBoxes> near_box_; ///< of these; EightBoxes::id: index into near_
  /// A triangle across the edge opposite one's vertex.
  struct Beyond {
    int edge;
    int32_t apex;
  };
  std::vector<Beyond> beyond_;
  Unlooked* unlooked_ = nullptr;
  std::vector<SheetTriangle> settled_; ///< and known to cross none: as changed_sheets_
  std::vector<int32_t> star_, star2_, old_, made_;
  std::vector<Candidate> now_;
  Ring ring_;
  StarQuality star_quality_;
  std::vector<Sail> sails_;
  uint64_t saved_ = 0, restored_ = 0; ///< numbers of snapshots: of the last one, and of what was last brought back
  ChangeLog::Moment restored_then_;   ///< when it was
  std::vector<int32_t> written_;
  Failures failures_;
  bool elsewhere_ = false; ///< what an operation failed for is not all at its vertices
};

} // namespace molmesh::optimize
