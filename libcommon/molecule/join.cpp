// join.cpp — carves residues, names groups, then emits piece after piece in the order of domains.
#include "molecule/join.hpp"
#include "base/error.hpp"
#include "geom/near_points.hpp"
#include "molecule/limits.hpp"
#include <algorithm>
#include <cmath>
#include <set>

namespace molmesh {
namespace {

[[noreturn]] void refuse(const Piece& p, const std::string& what, std::vector<std::string> quantities = {}) {
  fail(Status::bad_input, p.where + ": " + what, std::move(quantities));
}

bool has_domains(const Hierarchy& h) {
  return !h.level.empty() && h.level[0].name == "domain";
}

std::string listed(const std::vector<std::string>& levels) {
  std::string text;
  for (const std::string& l : levels)
    text += (text.empty() ? "" : ",") + l;
  return text.empty() ? "none" : text;
}

/// A copy of a piece: which of its innermost groups (or atoms, without a level) stay.
struct Copy {
  size_t piece;
  Rigid at;
  std::vector<uint8_t> keep; ///< empty: all
};

/// Groups [begin, end) of the level below the domains, of one copy.
struct Part {
  size_t copy;
  int64_t begin, end;
};

struct Domain {
  std::string name;
  double exponent, weight;
  std::vector<Part> parts;
};

class Join {
public:
  Join(const std::vector<Piece>& pieces, Clash clash, std::vector<Joined>& joined)
      : pieces_(pieces), clash_(clash), joined_(joined) {}

  Hierarchy run() {
    joined_.assign(pieces_.size(), {});
    check_levels();
    make_copies();
    if (domains_)
      out_.level.push_back({"domain", {}});
    for (const std::string& l : levels_)
      out_.level.push_back({l, {}});
    for (const Domain& d : arranged()) {
      const int64_t begin = entries(domains_ ? 1 : 0);
      for (const Part& part : d.parts)
        for (int64_t g = part.begin; g < part.end; ++g)
          emit(part.copy, below_domains(*pieces_[copies_[part.copy].piece].hierarchy), g);
      if (domains_ && entries(1) > begin)
        out_.level[0].group.push_back({d.name, d.exponent, begin, entries(1), d.weight});
    }
    for (size_t p = 0; p < pieces_.size(); ++p)
      if (joined_[p].atoms == 0)
        refuse(pieces_[p],
               "all of the piece is carved away, expected some of it farther from the pieces before it");
    name_groups();
    return std::move(out_);
  }

private:
  static size_t below_domains(const Hierarchy& h) { return has_domains(h) ? 1 : 0; }
  int64_t entries(size_t l) const {
    return static_cast<int64_t>(l < out_.level.size() ? out_.level[l].group.size() : out_.atom.size());
  }

  void check_levels() {
    levels_ = levels_below_domains(*pieces_[0].hierarchy);
    for (const Piece& p : pieces_)
      domains_ = domains_ || !p.domain.empty() || has_domains(*p.hierarchy);
    for (const Piece& p : pieces_) {
      const std::vector<std::string> levels = levels_below_domains(*p.hierarchy);
      if (levels != levels_)
        refuse(p, "found levels " + listed(levels) + ", expected " + listed(levels_) + " as of the first piece");
      if (domains_ && p.domain.empty() && !has_domains(*p.hierarchy))
        refuse(p, "found no domain, expected one: other pieces have some");
      if (domains_ && std::find(levels.begin(), levels.end(), "domain") != levels.end())
        refuse(p, "found domains within " + levels[0] + ", expected them outermost");
      if (p.domain_exponent && !domains_)
        refuse(p, "found an exponent of domains, expected a domain");
      const auto needs = [&](const std::optional<double>& exponent, const char* level) {
        if (exponent && std::find(levels.begin(), levels.end(), level) == levels.end())
          refuse(p, std::string("found an exponent of the level ") + level + ", which the piece does not have");
      };
      needs(p.residue, "residue");
      needs(p.chain, "chain");
      if (levels.empty() && !(p.rename.empty() && p.prefix.empty() && p.suffix.empty()))
        refuse(p, "found names for chains, expected none: the piece has no level");
      if (levels.empty() && p.carve > 0)
        refuse(p, "found a distance to carve, expected none: the piece has no residues");
    }
  }

  void make_copies() {
    for (size_t p = 0; p < pieces_.size(); ++p) {
      const size_t first = copies_.size();
      for (const Rigid& at : pieces_[p].copies)
        copies_.push_back({p, at, {}});
      joined_[p].copies = static_cast<int64_t>(pieces_[p].copies.size());
      if (p > 0 && pieces_[p].carve > 0)
        carve(first);
    }
  }

  template <class Take>
  void for_kept(const Copy& c, Take take) const {
    const Hierarchy& h = *pieces_[c.piece].hierarchy;
    if (c.keep.empty()) {
      for (const Atom& a : h.atom)
        take(c.at(a.center));
      return;
    }
    const std::vector<Group>& residue = h.level.back().group;
    for (size_t r = 0; r < residue.size(); ++r)
      for (int64_t a = residue[r].begin; c.keep[r] && a < residue[r].end; ++a)
        take(c.at(h.atom[a].center));
  }

  /// The copies from `first` on, which are one piece's, against all before.
  void carve(size_t first) {
    const Piece& p = pieces_[copies_[first].piece];
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d lo{infinity, infinity, infinity}, hi = -lo;
    for (size_t c = first; c < copies_.size(); ++c)
      for_kept(copies_[c], [&](Vec3d v) {
        for (int a = 0; a < 3; ++a) {
          lo[a] = std::min(lo[a], v[a]);
          hi[a] = std::max(hi[a], v[a]);
        }
      });
    NearPoints near(p.carve);
    std::vector<Core> bodies; // carve by their surfaces
    std::vector<double> skin;
    for (size_t c = 0; c < first; ++c)
      for (const Body& b : pieces_[copies_[c].piece].hierarchy->body) {
        bodies.emplace_back(moved(b, copies_[c].at));
        skin.push_back(b.skin + p.carve);
      }
    const auto near_body = [&](Vec3d v) {
      for (size_t b = 0; b < bodies.size(); ++b)
        if (bodies[b].distance2(v) <= skin[b] * skin[b])
          return true;
      return false;
    };
    for (size_t c = 0; c < first; ++c)
      for_kept(copies_[c], [&](Vec3d v) {
        bool inside = true;
        for (int a = 0; a < 3; ++a)
          inside = inside && v[a] >= lo[a] - 2 * p.carve && v[a] <= hi[a] + 2 * p.carve;
        if (inside)
          near.add(v);
      });
    const Hierarchy& h = *p.hierarchy;
    for (size_t c = first; c < copies_.size(); ++c) {
      const std::vector<Group>& residue = h.level.back().group;
      copies_[c].keep.assign(residue.size(), 1);
      for (size_t r = 0; r < residue.size(); ++r)
        for (int64_t a = residue[r].begin; a < residue[r].end; ++a)
          if (const Vec3d v = copies_[c].at(h.atom[a].center); near.has(v) || near_body(v)) {
            copies_[c].keep[r] = 0;
            ++joined_[copies_[c].piece].carved[residue[r].name.substr(0, residue[r].name.find(':'))];
            break;
          }
    }
  }

  /// All parts, by domain; one domain without a name where there are none.
  std::vector<Domain> arranged() const {
    std::vector<Domain> domains;
    std::map<std::string, size_t> named;     // those that plans name
    std::map<std::string, const Piece*> own; // those of the pieces themselves
    for (size_t c = 0; c < copies_.size(); ++c) {
      const Piece& p = pieces_[copies_[c].piece];
      const Hierarchy& h = *p.hierarchy;
      const size_t l = below_domains(h);
      const auto all = static_cast<int64_t>(l < h.level.size() ? h.level[l].group.size() : h.atom.size());
      if (!domains_ || !p.domain.empty()) {
        const auto [found, is_new] = named.try_emplace(p.domain, domains.size());
        if (is_new)
          domains.push_back({p.domain, 1, 1, {}});
        Domain& d = domains[found->second];
        d.exponent = p.domain_exponent.value_or(d.exponent);
        d.parts.push_back({c, 0, all});
        continue;
      }
      for (const Group& g : h.level[0].group)
        domains.push_back(
            {copied(g.name, c), p.domain_exponent.value_or(g.exponent), g.weight, {{c, g.begin, g.end}}});
    }
    std::map<std::string, size_t> count, number;
    for (const Domain& d : domains)
      ++count[d.name];
    for (Domain& d : domains) {
      if (count[d.name] == 1)
        continue;
      if (clash_ == Clash::refuse)
        refuse(pieces_[copies_[d.parts[0].copy].piece],
               "found domain '" + d.name + "' more than once, expected distinct names or a domain for the piece",
               {"clash"});
      d.name += "_" + std::to_string(++number[d.name]);
    }
    return domains;
  }

  /// NAME_1, NAME_2, … of several copies.
  std::string copied(const std::string& name, size_t copy) const {
    const size_t p = copies_[copy].piece;
    if (pieces_[p].copies.size() == 1)
      return name;
    size_t first = copy;
    while (first > 0 && copies_[first - 1].piece == p)
      --first;
    return name + "_" + std::to_string(copy - first + 1);
  }

  std::string new_name(const std::string& name, size_t copy) {
    const Piece& p = pieces_[copies_[copy].piece];
    const auto found = p.rename.find(name);
    return copied(p.prefix + (found == p.rename.end() ? name : found->second) + p.suffix, copy);
  }

  /// Of a piece's name in the names of all.
  int32_t entry(size_t piece, int32_t name) {
    entry_.resize(pieces_.size());
    std::vector<int32_t>& known = entry_[piece];
    const Names& names = pieces_[piece].hierarchy->names;
    known.resize(static_cast<size_t>(names.size()), -1);
    if (known[name] < 0)
      known[name] = out_.names.add(names[name]);
    return known[name];
  }

  /// Entry `i` of level l of a piece, or an atom below its levels.
  void emit(size_t copy, size_t l, int64_t i) {
    const Copy& c = copies_[copy];
    const Piece& p = pieces_[c.piece];
    const Hierarchy& h = *p.hierarchy;
    if (l == h.level.size()) {
      Atom a = h.atom[i];
      a.center = c.at(a.center);
      const auto body = std::lower_bound(h.body.begin(), h.body.end(), i,
                                         [](const Body& b, int64_t atom) { return b.atom < atom; });
      if (body != h.body.end() && body->atom == i) {
        out_.body.push_back(moved(*body, c.at));
        out_.body.back().atom = entries(out_.level.size());
        if (const std::string fault = fault_of(out_.body.back()); !fault.empty())
          refuse(p, "found a motion that makes the body none, expected " + fault);
      }
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(a.center[axis]) <= largest_coordinate))
          refuse(p, "an atom is moved beyond 1e7 Å, expected it nearer to the origin");
      a.name = entry(c.piece, a.name);
      a.element = entry(c.piece, a.element);
      out_.atom.push_back(a);
      ++joined_[c.piece].atoms;
      return;
    }
    const Level& level = h.level[l];
    const Group& g = level.group[i];
    if (l + 1 == h.level.size() && !c.keep.empty() && !c.keep[i])
      return;
    const size_t to = l - below_domains(h) + (domains_ ? 1 : 0);
    const int64_t begin = entries(to + 1);
    for (int64_t child = g.begin; child < g.end; ++child)
      emit(copy, l + 1, child);
    if (entries(to + 1) == begin)
      return; // carved away
    const double exponent = level.name == "residue" ? p.residue.value_or(g.exponent)
                            : level.name == "chain" ? p.chain.value_or(g.exponent)
                                                    : g.exponent;
    const double weight = level.name == "residue" && p.residue ? 1 : g.weight;
    const bool outer = l == below_domains(h);
    if (outer)
      owner_.push_back(c.piece);
    out_.level[to].group.push_back(
        {outer ? new_name(g.name, copy) : g.name, exponent, begin, entries(to + 1), weight});
  }

  /// Makes the names of the level below the domains unique.
  void name_groups() {
    for (const Piece& p : pieces_)
      for (const auto& [from, to] : p.rename) {
        const std::vector<Group>& group = p.hierarchy->level[below_domains(*p.hierarchy)].group;
        if (std::none_of(group.begin(), group.end(), [&, &name = from](const Group& g) { return g.name == name; }))
          refuse(p,
                 "found no " + levels_[0] + " '" + from + "' to call '" + to + "', expected its name in the piece");
      }
    if (levels_.empty())
      return;
    std::vector<Group>& group = out_.level[domains_ ? 1 : 0].group;
    std::map<std::string, int64_t> count, number;
    for (const Group& g : group)
      ++count[g.name];
    for (size_t i = 0; i < group.size(); ++i) {
      std::string& name = group[i].name;
      if (count[name] == 1)
        continue;
      if (clash_ == Clash::refuse && ++number[name] == 2) {
        size_t first = 0;
        while (group[first].name != name)
          ++first;
        refuse(pieces_[owner_[i]],
               "found " + levels_[0] + " '" + name + "', which " + pieces_[owner_[first]].where +
                   " has, too, expected other names",
               {"clash"});
      }
      if (clash_ == Clash::number) {
        std::string numbered;
        do
          numbered = name + "_" + std::to_string(++number[name]);
        while (count.count(numbered) > 0);
        name = numbered;
      }
    }
  }

  const std::vector<Piece>& pieces_;
  const Clash clash_;
  std::vector<Joined>& joined_;
  std::vector<std::string> levels_; ///< below the domains
  bool domains_ = false;
  std::vector<Copy> copies_;
  std::vector<std::vector<int32_t>> entry_; ///< [piece][its name]; -1: not yet known
  std::vector<size_t> owner_;               ///< piece of each group of the level below the domains
  Hierarchy out_;
};

} // namespace

std::vector<std::string> levels_below_domains(const Hierarchy& h) {
  std::vector<std::string> levels;
  for (size_t l = has_domains(h) ? 1 : 0; l < h.level.size(); ++l)
    levels.push_back(h.level[l].name);
  return levels;
}

Hierarchy hierarchy_of(const Body& body, const std::string& name, const std::vector<std::string>& levels) {
  Hierarchy h;
  for (const std::string& level : levels)
    h.level.push_back({level, {{name, 1, 0, 1}}});
  Atom a;
  a.center = body.center;
  a.radius = body.skin;
  a.name = h.names.add(name);
  h.atom = {a};
  h.body = {body};
  h.body[0].atom = 0;
  return h;
}

Hierarchy join(const std::vector<Piece>& pieces, Clash clash, std::vector<Joined>& joined) {
  if (pieces.empty())
    fail_input("found no piece, expected at least one");
  return Join(pieces, clash, joined).run();
}

} // namespace molmesh
