// unseen_residues.cpp — marks the atoms that own triangles, then looks at the atoms of each residue.
#include "label/unseen_residues.hpp"
#include "molecule/find_level.hpp"
#include "molecule/grouping.hpp"
#include <algorithm>

namespace molmesh::label {
namespace {

/// Of each group of the level: its first atom, and the end of all.
std::vector<int64_t> first_atoms(const Hierarchy& h, size_t level) {
  std::vector<int64_t> first;
  for (const Group& group : h.level[level].group) {
    int64_t begin = group.begin;
    for (size_t below = level + 1; below < h.level.size(); ++below)
      begin = h.level[below].group[begin].begin;
    first.push_back(begin);
  }
  first.push_back(static_cast<int64_t>(h.atom.size()));
  return first;
}

} // namespace

UnseenResidues unseen_residues(const Hierarchy& h, const Places& places, const Labels& labels,
                               const NamedBoundary& boundary) {
  UnseenResidues result;
  const size_t level = find_level(h, "residue"), chain_level = find_level(h, "chain");
  if (level == h.level.size())
    return result;
  std::vector<uint8_t> owns(h.atom.size(), 0);
  for (auto i = static_cast<size_t>(places.tets); i < places.cell.size(); ++i)
    if (const int32_t atom = labels.index.back()[i]; atom >= 0)
      owns[atom] = 1;
  const std::vector<int64_t> first = first_atoms(h, level);
  const bool chains = chain_level < h.level.size();
  const std::vector<int64_t> first_of_chain = chains ? first_atoms(h, chain_level) : std::vector<int64_t>{};
  for (size_t r = 0; r + 1 < first.size(); ++r) {
    bool selected = false, seen = false;
    for (int64_t a = first[r]; a < first[r + 1]; ++a) {
      selected |= boundary.atom[a] != 0;
      seen |= boundary.atom[a] != 0 && owns[a] != 0;
    }
    result.residues += selected;
    if (!selected || seen)
      continue;
    std::string chain;
    if (chains)
      chain = h.level[chain_level]
                  .group[std::upper_bound(first_of_chain.begin(), first_of_chain.end(), first[r]) -
                         first_of_chain.begin() - 1]
                  .name;
    result.unseen.push_back(residue_in_selection(chain, h.level[level].group[r].name));
  }
  return result;
}

} // namespace molmesh::label
