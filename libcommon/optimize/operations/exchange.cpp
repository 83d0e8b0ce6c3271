// exchange.cpp — the exchange of a cavity's elements: faces are matched before anything changes.
#include "optimize/acceptance/sag.hpp"
#include "optimize/operations/region.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

std::array<int32_t, 3> sorted_face(const std::array<int32_t, 4>& v, size_t face) {
  std::array<int32_t, 3> f = outward_triangle(v, face);
  std::sort(f.begin(), f.end());
  return f;
}

} // namespace

Region::Face& Region::face_entry(const std::array<int32_t, 3>& v) {
  const uint64_t h = (uint64_t(uint32_t(v[0])) * 0x9E3779B97F4A7C15u) ^
                     (uint64_t(uint32_t(v[1])) * 0xC2B2AE3D27D4EB4Fu) ^
                     (uint64_t(uint32_t(v[2])) * 0x165667B19E3779F9u);
  const size_t mask = table_.size() - 1;
  for (size_t i = size_t(h >> 40) & mask;; i = (i + 1) & mask) {
    Face& f = table_[i];
    if (f.clock != table_clock_) {
      f = {v, -1, -1, -1, -1, 0, 0, false, table_clock_};
      used_.push_back(static_cast<int32_t>(i));
      return f;
    }
    if (f.v == v)
      return f;
  }
}

// Faces of the old elements towards the others and faces of the new ones: each once or twice, and only an operation
// on the surface may leave faces without a partner, in place of others that go. False otherwise, which happens in
// meshes that overlap themselves.
bool Region::match(const std::vector<int32_t>& old, const std::vector<Candidate>& now, bool surface) {
  while (table_.size() < 8 * (old.size() + now.size()))
    table_.resize(2 * table_.size());
  ++table_clock_;
  used_.clear();
  ++clock_;
  for (const int32_t e : old)
    stamp_[e] = clock_;
  for (const int32_t t : old) {
    const Element& e = mesh.element[t];
    for (size_t f = 0; f < 4; ++f) {
      const int32_t n = e.n[f];
      if (n >= 0 && stamp_[n] == clock_)
        continue;
      Face& x = face_entry(sorted_face(e.v, f));
      x.outer = true;
      x.element = n;
      x.old = 4 * int64_t(t) + int64_t(f);
      x.label = e.label[f];
      if (n < 0)
        continue;
      const Element& beyond = mesh.element[n];
      for (size_t g = 0; g < 4; ++g)
        if (beyond.n[g] == t)
          x.face = static_cast<uint8_t>(g);
    }
  }
  for (size_t k = 0; k < now.size(); ++k)
    for (size_t f = 0; f < 4; ++f) {
      Face& x = face_entry(sorted_face(now[k].v, f));
      int32_t& slot = x.first < 0 ? x.first : x.second;
      if (slot >= 0 || (x.outer && x.first >= 0))
        return false;
      slot = static_cast<int32_t>(4 * k + f);
    }
  int lost = 0, gained = 0;
  for (const int32_t i : used_) {
    const Face& x = table_[i];
    if (x.outer ? x.first >= 0 : x.second >= 0)
      continue;
    ++(x.ends_mesh() ? lost : gained);
  }
  if (!surface && (lost > 0 || gained > 0))
    return false;
  return gained == 0 || lost > 0;
}

// Of the triangles that go where the mesh ends; 0 when none does. Where several labels' go, elements say which new
// triangle has which (Candidate::label).
uint8_t Region::lost_label() const {
  uint8_t label = 0;
  for (const int32_t i : used_)
    if (table_[i].is_lost())
      label = table_[i].label;
  return label;
}

// Whether a triangle that comes to lie where the mesh ends is on a curved label and in a wall: the walls' points
// are all there for it, and nothing on its other side is in its way.
bool Region::any_in_wall(const std::vector<Candidate>& now) const {
  const uint8_t lost = lost_label();
  if (lost == 0)
    return false;
  return std::any_of(used_.begin(), used_.end(), [&](int32_t i) {
    const Face& x = table_[i];
    const auto p = [&](size_t k) { return mesh.point[x.v[k]]; };
    return (x.is_new() || x.is_bared()) && mesh.labels[x.is_new() ? label_of(x, now, lost) : lost].curved() &&
           mesh.walls.hold(p(0), p(1), p(2));
  });
}

// Whether a triangle that comes to lie on the outer sphere sags more than it may, and than those that go.
bool Region::any_sags(const std::vector<Candidate>& now) const {
  const uint8_t lost = lost_label();
  if (!mesh.labels[lost].round)
    return false;
  double before = most_sag, after = 0;
  const auto sag_of = [&](const std::array<int32_t, 3>& v) {
    return sag(mesh.sphere, mesh.point[v[0]], mesh.point[v[1]], mesh.point[v[2]]);
  };
  for (const int32_t i : used_) {
    const Face& x = table_[i];
    if (x.is_lost())
      before = std::max(before, sag_of(outward_triangle(mesh.element[x.old / 4].v, size_t(x.old & 3))));
    else if (x.is_new())
      after = std::max(after, sag_of(outward_triangle(now[x.first / 4].v, size_t(x.first & 3))));
    else if (x.is_bared())
      after = std::max(after, sag_of(outward_triangle(mesh.element[x.element].v, x.face)));
  }
  return after > before;
}

// Of a new face: its first element's own, where that has one.
uint8_t Region::label_of(const Face& x, const std::vector<Candidate>& now, uint8_t otherwise) {
  const uint8_t own = now[x.first / 4].label[x.first & 3];
  return own != 0 ? own : otherwise;
}

// Whether a new face between surface points is one of elements that stay: where the mesh ends in the surface, the
// new elements at it would overlap one of these, and no triangles need cross.
bool Region::face_is_taken(const std::vector<int32_t>& old) {
  const auto has = [](const std::vector<int32_t>& list, int32_t t) {
    return std::find(list.begin(), list.end(), t) != list.end();
  };
  std::vector<int32_t> around; // the first corner
  for (const int32_t i : used_) {
    const Face& x = table_[i];
    const int32_t first = mesh.incident[x.v[0]];
    if (x.outer || first < 0 ||
        std::any_of(x.v.begin(), x.v.end(), [&](int32_t v) { return !follows_target(mesh.vertex[v].kind); }))
      continue;
    around.assign(1, first);
    for (size_t k = 0; k < around.size(); ++k) {
      const Element& e = mesh.element[around[k]];
      if (e.find(x.v[1]) >= 0 && e.find(x.v[2]) >= 0 && !has(old, around[k])) {
        looked_beyond = true;
        return true;
      }
      for (size_t f = 0; f < 4; ++f)
        if (e.v[f] != x.v[0] && e.n[f] >= 0 && !has(around, e.n[f]))
          around.push_back(e.n[f]);
    }
  }
  return false;
}

// Triangles that come to lie where the mesh ends.
void Region::list_free_triangles(const std::vector<Candidate>& now) {
  const uint8_t lost = lost_label();
  for (const int32_t i : used_) {
    const Face& x = table_[i];
    if (!(x.stays() || x.is_new() || x.is_bared()) || !mesh.watched(x.v))
      continue;
    const uint8_t label = x.stays() ? x.label : x.is_new() ? label_of(x, now, lost) : lost;
    if (!mesh.labels[label].curved())
      continue;
    crossings.add(x.is_bared() ? outward_triangle(mesh.element[x.element].v, x.face)
                               : outward_triangle(now[x.first / 4].v, size_t(x.first & 3)));
  }
}

bool Region::exchange(const std::vector<int32_t>& old, const std::vector<Candidate>& now, bool surface,
                      bool moved) {
  if (!moved)
    crossings.clear();
  if (!match(old, now, surface) || (surface && (any_in_wall(now) || any_sags(now))))
    return false;
  if ((surface || moved) && crossings.on()) {
    list_free_triangles(now);
    looked_beyond |= !crossings.empty();
    if (crossings.cross(clock_))
      return false;
  }
  if (crossings.on() && face_is_taken(old))
    return false;
  commit(old, now);
  return true;
}

// What match() found is done.
void Region::commit(const std::vector<int32_t>& old, const std::vector<Candidate>& now) {
  uint8_t inner = 0;
  const uint8_t outside = lost_label();
  for (const int32_t t : old) {
    const Element& e = mesh.element[t];
    for (size_t f = 0; f < 4; ++f)
      if (e.label[f] != 0 && e.n[f] >= 0 && stamp_[e.n[f]] == clock_)
        inner = e.label[f];
  }
  for (const int32_t i : used_) {
    const Face& x = table_[i];
    for (const int32_t w : x.v) {
      if (x.outer && x.element >= 0)
        mesh.incident[w] = x.element; // where nothing new comes
      mesh.state[w] = clock_;
    }
    if (crossings.on() && x.ends_mesh() && mesh.watched(x.v))
      crossings.changes.erase(x.old);
  }
  made_.clear();
  for (size_t k = 0; k < now.size(); ++k) {
    int32_t id;
    if (k < old.size())
      id = old[k];
    else
      id = room.element.back(), room.element.pop_back();
    made_.push_back(id);
    Element& e = mesh.element[id];
    note_change(id);
    e = {};
    e.v = now[k].v;
    e.region = now[k].region;
    e.q = now[k].q;
    e.label = now[k].label;
    for (const int32_t v : now[k].v)
      mesh.incident[v] = id;
    touch(id);
  }
  for (size_t k = now.size(); k < old.size(); ++k) {
    mesh.element[old[k]] = {};
    note_change(old[k]);
    room.element.push_back(old[k]);
  }
  const auto join = [&](int32_t a, size_t f, int32_t b, size_t g, uint8_t label) {
    Element &x = mesh.element[a], &y = mesh.element[b];
    x.n[f] = b;
    y.n[g] = a;
    x.label[f] = y.label[g] = x.region == y.region ? uint8_t{0} : label;
    if (x.label[f] != 0)
      mesh.note_label(a), mesh.note_label(b);
  };
  const auto bare = [&](int32_t a, size_t f) {
    Element& e = mesh.element[a];
    e.n[f] = -1;
    if (e.label[f] == 0)
      e.label[f] = outside;
    mesh.note_label(a);
    if (crossings.on() && mesh.labels[e.label[f]].curved() && mesh.watched(outward_triangle(e.v, f)))
      crossings.changes.insert(free_triangle(mesh.point, outward_triangle(e.v, f), 4 * int64_t(a) + int64_t(f)));
  };
  for (const int32_t i : used_) {
    const Face& x = table_[i];
    const int32_t id = x.first < 0 ? -1 : made_[x.first / 4];
    const size_t face = size_t(x.first & 3);
    if (x.outer && x.element >= 0)
      note_side(x.element, x.face);
    if (x.outer && x.first < 0) {
      if (x.element >= 0)
        bare(x.element, x.face);
    } else if (x.outer) {
      if (x.element >= 0) {
        join(id, face, x.element, x.face, x.label != 0 ? x.label : inner);
      } else {
        mesh.element[id].label[face] = x.label;
        bare(id, face);
      }
    } else if (x.second >= 0) {
      join(id, face, made_[x.second / 4], size_t(x.second & 3), label_of(x, now, inner));
    } else {
      bare(id, face);
    }
  }
  changed.insert(changed.end(), made_.begin(), made_.end());
}

} // namespace molmesh::optimize
