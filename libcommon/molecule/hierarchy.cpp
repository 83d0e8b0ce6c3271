// hierarchy.cpp — checks a hierarchy and finds the atom nearest to a place.
#include "molecule/hierarchy.hpp"
#include "base/error.hpp"
#include "molecule/grouping.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace molmesh {

const std::string& Names::operator[](int32_t entry) const {
  const auto n = static_cast<uint32_t>(entry) + first;
  const int b = std::bit_width(n) - std::bit_width(first);
  return block_[b][n - (first << b)];
}

int32_t Names::add(std::string_view text) {
  const std::hash<std::string_view> hash;
  const auto at = [&](uint32_t i) -> const std::string& { return (*this)[static_cast<int32_t>(i)]; };
  const auto entry = static_cast<int32_t>(entry_.find_or_add(
      static_cast<uint32_t>(size_), hash(text), [&](uint32_t i) { return at(i) == text; },
      [&](uint32_t i) { return hash(at(i)); }));
  if (entry < size_)
    return entry;
  const uint32_t of_next = first << block_.size();
  if (static_cast<uint32_t>(size_) == of_next - first) // all blocks are full
    block_.emplace_back().reserve(of_next);
  block_.back().emplace_back(text);
  return size_++;
}

void check(const Hierarchy& h, const std::string& file) {
  const auto refuse = [&](const std::string& what) { fail_input(file + ": " + what); };
  if (h.atom.empty())
    refuse("no atom, expected at least one");
  if (h.source.find_first_of("\r\n") != std::string::npos)
    refuse("source of several lines, expected one");

  for (size_t l = 0; l < h.level.size(); ++l) {
    const Level& level = h.level[l];
    if (level.name.empty())
      refuse("level without a name");
    for (size_t m = 0; m < l; ++m)
      if (h.level[m].name == level.name)
        refuse("level '" + level.name + "' twice, expected distinct names");
    const size_t children = l + 1 < h.level.size() ? h.level[l + 1].group.size() : h.atom.size();
    int64_t next = 0;
    for (const Group& g : level.group) {
      const auto bad = [&](const std::string& what) { refuse(level.name + " '" + g.name + "': " + what); };
      if (g.name.empty())
        refuse(level.name + " without a name");
      if (!(std::isfinite(g.exponent) && g.exponent > 0))
        bad("exponent " + std::to_string(g.exponent) + ", expected a finite number > 0");
      if (!(std::isfinite(g.weight) && g.weight > 0))
        bad("weight " + std::to_string(g.weight) + ", expected a finite number > 0");
      if (g.begin != next)
        bad("begins at child " + std::to_string(g.begin) + ", expected " + std::to_string(next));
      if (g.end <= g.begin)
        bad("is empty, expected at least one child");
      next = g.end;
    }
    if (next != static_cast<int64_t>(children))
      refuse("level '" + level.name + "' covers " + std::to_string(next) + " of " + std::to_string(children) +
             " children, expected all");
  }

  bool any_body = false;
  for (size_t a = 0; a < h.atom.size(); ++a) {
    const Atom& atom = h.atom[a];
    any_body |= atom.radius > 0;
    const auto bad = [&](const char* what) { refuse("atom " + std::to_string(a) + ": " + what); };
    if (!(std::isfinite(atom.center.x) && std::isfinite(atom.center.y) && std::isfinite(atom.center.z)))
      bad("position not finite");
    if (!(std::isfinite(atom.radius) && atom.radius >= 0))
      bad("radius not a finite number >= 0");
    if (std::isinf(atom.charge))
      bad("charge not finite");
    if (atom.name < 0 || atom.name >= h.names.size() || h.names[atom.name].empty())
      bad("no name");
    if (atom.element < 0 || atom.element >= h.names.size() || h.names[atom.element].empty())
      bad("no element");
  }
  int64_t after = 0; // the body before
  for (const Body& b : h.body) {
    if (b.atom < after || b.atom >= static_cast<int64_t>(h.atom.size()))
      refuse("body of atom " + std::to_string(b.atom) + ", expected bodies in the order of atoms");
    after = b.atom + 1;
    const Atom& atom = h.atom[b.atom];
    const auto bad = [&](const std::string& what) { refuse("body '" + h.names[atom.name] + "': " + what); };
    if (const std::string fault = fault_of(b); !fault.empty())
      bad("expected " + fault);
    if (!(atom.center == b.center && atom.radius == b.skin && std::isnan(atom.charge)))
      bad("expected its atom at its center, with its skin as radius and without a charge");
    if (!h.level.empty()) {
      const std::vector<Group>& group = h.level.back().group;
      const auto g =
          std::upper_bound(group.begin(), group.end(), b.atom, [](int64_t i, const Group& x) { return i < x.end; });
      if (g->end - g->begin != 1)
        bad("expected alone in its " + h.level.back().name);
    }
  }
  if (!any_body)
    refuse("no atom of a radius > 0, expected at least one");
}

int64_t nearest_atom(const Hierarchy& h, Vec3d p) {
  int64_t nearest = -1;
  double best = 0;
  auto body = h.body.begin();
  for (size_t a = 0; a < h.atom.size(); ++a) {
    if (!(h.atom[a].radius > 0))
      continue;
    while (body != h.body.end() && body->atom < static_cast<int64_t>(a))
      ++body;
    const bool is_body = body != h.body.end() && body->atom == static_cast<int64_t>(a);
    const double d =
        (is_body ? std::sqrt(Core(*body).distance2(p)) : norm(p - h.atom[a].center)) - h.atom[a].radius;
    if (nearest < 0 || d < best)
      best = d, nearest = static_cast<int64_t>(a);
  }
  return nearest;
}

std::string place_of(const Hierarchy& h, int64_t atom) {
  std::string others, chain, residue;
  int64_t index = atom;
  for (size_t l = h.level.size(); l-- > 0;) {
    const std::vector<Group>& group = h.level[l].group;
    const auto g =
        std::upper_bound(group.begin(), group.end(), index, [](int64_t i, const Group& x) { return i < x.end; });
    const std::string& level = h.level[l].name;
    if (level == "chain" || level == "residue")
      (level == "chain" ? chain : residue) = g->name;
    else
      others = level + ' ' + g->name + ' ' + others;
    index = g - group.begin();
  }
  const std::string name = in_selection(h.names[h.atom[atom].name]);
  if (!residue.empty())
    return others + residue_in_selection(chain, residue) + '/' + name;
  return others + (chain.empty() ? "" : "//" + in_selection(chain) + "//") + name;
}

std::string nearest_name(const Hierarchy& h, Vec3d p) {
  return place_of(h, nearest_atom(h, p));
}

} // namespace molmesh
