// hier_selection.cpp — chains, residues and atoms of a structure made up from the names in a .hier.
#include "formats/pdb/hier_selection.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/selection.hpp"
#include "formats/pdb/selection_advice.hpp"
#include "geom/near_points.hpp"
#include "molecule/find_level.hpp"
#include "molecule/grouping.hpp"
#include "molecule/molecular_body.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <charconv>
#include <set>

namespace molmesh::formats {
namespace {

/// A residue that holds its own name.
struct NamedResidue : pdb::Residue {
  std::string text;
};

/// "GLY:52A" as a structure has it; false when the name is none of that kind.
bool read_residue(const std::string& name, NamedResidue& r) {
  const size_t colon = name.rfind(':');
  r.text = name.substr(0, colon);
  r.name = pdb::Label(r.text);
  if (colon == std::string::npos)
    return false;
  const char *begin = name.data() + colon + 1, *end = name.data() + name.size();
  int number = 0;
  const auto [rest, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || end - rest > 1)
    return false;
  r.seqid = gemmi::SeqId(number, rest == end ? ' ' : *rest);
  return true;
}

/// The name of which chains with these names are copies: "A" for "A_1" and "A_2".
std::string copied(const std::string& name, const std::set<std::string>& chains) {
  const size_t bar = name.rfind('_');
  if (bar == std::string::npos || bar + 1 == name.size() ||
      name.find_first_not_of("0123456789", bar + 1) != std::string::npos)
    return name;
  const std::string base = name.substr(0, bar);
  return chains.count(base) == 0 && chains.count(base + "_1") && chains.count(base + "_2") ? base : name;
}

/// Of a group of level l: begin, end.
std::pair<int64_t, int64_t> atoms_of(const Hierarchy& h, size_t l, const Group& g) {
  int64_t begin = g.begin, end = g.end; // of the level below, down to the atoms
  for (size_t below = l + 1; below < h.level.size(); ++below) {
    end = h.level[below].group[end - 1].end;
    begin = h.level[below].group[begin].begin;
  }
  return {begin, end};
}

/// Sets `chosen` of all atoms of the groups of level l that take(group) does not take to 0.
template <class Take>
void filter(const Hierarchy& h, size_t l, std::vector<uint8_t>& chosen, Take take) {
  for (const Group& g : h.level[l].group) {
    if (take(g))
      continue;
    const auto [begin, end] = atoms_of(h, l, g);
    std::fill(chosen.begin() + begin, chosen.begin() + end, uint8_t{0});
  }
}

/// For a message: residues of the chains that a selection names, in whose atoms it finds nothing.
std::string residues_there(const Hierarchy& h, const std::vector<uint8_t>& in_chains, std::optional<int> number) {
  ResiduesThere there(number);
  NamedResidue r;
  const size_t chain = find_level(h, "chain"), residue = find_level(h, "residue");
  size_t c = 0;
  for (const Group& g : h.level[residue].group) {
    const int64_t atom = atoms_of(h, residue, g).first;
    while (chain < residue && atoms_of(h, chain, h.level[chain].group[c]).second <= atom)
      ++c;
    if (in_chains[atom] && read_residue(g.name, r))
      there.add(chain < residue ? h.level[chain].group[c].name : "", g.name, *r.seqid.num);
  }
  return there.text();
}

} // namespace

std::vector<uint8_t> select_atoms(const Hierarchy& h, const std::string& text, const std::string& where,
                                  std::vector<std::string>* absent) {
  const Selection s(text, where, true, Status::usage);
  const auto refuse = [&](const std::string& expected) {
    fail_input(where + ": found selection " + in_quotes(text) + ", expected " + expected);
  };
  if (s.beyond_hierarchy())
    refuse("chains, residues and atoms alone, as '//D/45,57': a .hier holds nothing else");
  std::vector<uint8_t> chosen(h.atom.size(), 1);
  const size_t chain = find_level(h, "chain"), residue = find_level(h, "residue");
  if (s.names_chains()) {
    if (chain == h.level.size())
      refuse("no chain: the .hier has no level 'chain'");
    std::set<std::string> chains;
    for (const Group& g : h.level[chain].group)
      chains.insert(g.name);
    filter(h, chain, chosen, [&](const Group& g) { return s.chain(copied(g.name, chains), g.name); });
  }
  std::vector<uint8_t> in_chains;
  if (s.names_residues()) {
    if (residue == h.level.size())
      refuse("no residue: the .hier has no level 'residue'");
    in_chains = chosen;
    NamedResidue r;
    constexpr size_t most = 100;
    if (const std::vector<std::string> numbers = s.numbers(); absent != nullptr && numbers.size() <= most)
      for (size_t i = 0; i < numbers.size(); ++i) {
        std::vector<uint8_t> fits = chosen;
        filter(h, residue, fits,
               [&](const Group& g) { return read_residue(g.name, r) && s.residue(r) && s.number_fits(i, r); });
        if (std::find(fits.begin(), fits.end(), 1) == fits.end())
          absent->push_back(numbers[i]);
      }
    filter(h, residue, chosen,
           [&](const Group& g) { return (read_residue(g.name, r) || !s.numbers_residues()) && s.residue(r); });
  }
  pdb::Atom atom;
  for (size_t a = 0; a < h.atom.size(); ++a) {
    if (!chosen[a])
      continue;
    atom.name = pdb::Label(h.names[h.atom[a].name]);
    atom.element = gemmi::Element(h.names[h.atom[a].element]);
    chosen[a] = s.atom(atom);
  }
  if (std::find(chosen.begin(), chosen.end(), 1) == chosen.end()) {
    if (std::find(in_chains.begin(), in_chains.end(), 1) != in_chains.end())
      if (const std::string there = residues_there(h, in_chains, s.first_number()); !there.empty())
        refuse("one that some atom fits" + there);
    std::vector<std::string> chains;
    if (chain < h.level.size())
      for (const Group& g : h.level[chain].group)
        chains.push_back(g.name);
    refuse("one that some atom fits" + chains_there(chains));
  }
  if (s.around() > 0) {
    NearPoints near(s.around());
    for (size_t a = 0; a < h.atom.size(); ++a)
      if (chosen[a])
        near.add(h.atom[a].center);
    for (size_t a = 0; a < h.atom.size(); ++a)
      chosen[a] = near.has(h.atom[a].center);
  }
  return chosen;
}

void apply_rules(Hierarchy& h, const std::vector<Rule>& rules) {
  const auto bodies = [&](const Group& residue) {
    return std::count_if(h.atom.begin() + residue.begin, h.atom.begin() + residue.end,
                         [](const Atom& a) { return a.radius > 0; });
  };
  for (const Rule& rule : rules) {
    // [entry of the level] selected; from atoms outwards
    std::vector<uint8_t> chosen = select_atoms(h, rule.selection, rule.where);
    for (size_t l = h.level.size(); l-- > 0;) {
      std::vector<uint8_t> groups;
      const std::string& level = h.level[l].name;
      const std::optional<double> none, &exponent = level == "residue"  ? rule.residue
                                                    : level == "chain"  ? rule.chain
                                                    : level == "domain" ? rule.domain
                                                                        : none;
      for (Group& g : h.level[l].group) {
        groups.push_back(std::find(chosen.begin() + g.begin, chosen.begin() + g.end, 1) != chosen.begin() + g.end);
        if (groups.back() && exponent)
          g.exponent = *exponent;
        if (groups.back() && level == "residue" && (rule.residue || rule.weight))
          g.weight = residue_weight(rule.weight.value_or(1), bodies(g));
      }
      chosen = std::move(groups);
    }
    const auto needs = [&](const std::optional<double>& exponent, const char* name, const char* level) {
      if (exponent && find_level(h, level) == h.level.size())
        fail_input(rule.where + ": found " + name +
                   ", expected exponents of levels that there are: there is no level " + level);
    };
    needs(rule.residue, "P_R", "residue");
    needs(rule.weight, "W_R", "residue");
    needs(rule.chain, "P_C", "chain");
    needs(rule.domain, "P_D", "domain");
  }
}

} // namespace molmesh::formats
