// arrangement.cpp — lists residues; asks selections by label once a residue, by distance once an atom.
#include "formats/pdb/arrangement.hpp"
#include "formats/pdb/keep.hpp"
#include "formats/pdb/selection.hpp"
#include "geom/near_points.hpp"
#include <algorithm>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace molmesh::formats {
namespace {

std::string entity_of(const std::unordered_map<std::string_view, std::string_view>& of_subchain,
                      const pdb::Chain& chain) {
  const auto polymer = std::find_if(chain.residues.begin(), chain.residues.end(), [](const pdb::Residue& r) {
    return r.entity_type == gemmi::EntityType::Polymer;
  });
  const pdb::Residue& residue = polymer == chain.residues.end() ? chain.residues.front() : *polymer;
  const auto known = of_subchain.find(residue.subchain.str());
  return "entity_" + std::string(known == of_subchain.end() ? "none" : known->second);
}

/// Does the selection admit the model and the name of the chain?
std::vector<uint8_t> select_chains(const Selection& s, const Arrangement& a) {
  std::vector<uint8_t> selected(a.placed.size());
  for (size_t p = 0; p < a.placed.size(); ++p) {
    const Flat::Chain& chain = a.flat.chain[a.placed[p].chain];
    selected[p] = s.model(*chain.model) && s.chain(chain.source->name, a.grouping.chain[p]);
  }
  return selected;
}

Selected share(int64_t selected, int64_t all) {
  return selected == 0 ? Selected::none : selected == all ? Selected::all : Selected::some;
}

std::vector<Selected> select_by_label(const Selection& s, const Arrangement& a) {
  std::vector<Selected> result(a.grouping.residue.size(), Selected::none);
  const std::vector<uint8_t> chains = select_chains(s, a);
  std::vector<std::optional<Selected>> of_residue(a.flat.residue.size()); // whatever the chain
  for (size_t i = 0; i < result.size(); ++i) {
    if (!chains[a.grouping.residue[i].chain])
      continue;
    std::optional<Selected>& known = of_residue[a.source[i]];
    if (!known) {
      const Flat::Residue& residue = a.residue(i);
      const std::vector<pdb::Atom>& atoms = residue.source->atoms;
      const auto selected =
          s.residue(*residue.source)
              ? std::count_if(atoms.begin(), atoms.end(), [&](const pdb::Atom& atom) { return s.atom(atom); })
              : 0;
      known = share(selected, residue.end - residue.begin);
    }
    result[i] = *known;
  }
  return result;
}

std::vector<Selected> select_by_distance(const Selection& s, const Arrangement& a) {
  std::vector<Selected> result(a.grouping.residue.size(), Selected::none);
  const std::vector<uint8_t> chains = select_chains(s, a);
  NearPoints near(s.around());
  const auto position = [&](size_t i, int64_t atom) {
    return a.placed[a.grouping.residue[i].chain].position(a.flat.atom[atom].center);
  };
  for (size_t i = 0; i < result.size(); ++i) {
    const Flat::Residue& residue = a.residue(i);
    if (!chains[a.grouping.residue[i].chain] || !s.residue(*residue.source))
      continue;
    for (int64_t n = residue.begin; n < residue.end; ++n)
      if (s.atom(residue.source->atoms[n - residue.begin]))
        near.add(position(i, n));
  }
  for (size_t i = 0; i < result.size(); ++i) {
    const Flat::Residue& residue = a.residue(i);
    int64_t selected = 0;
    for (int64_t n = residue.begin; n < residue.end; ++n)
      selected += near.has(position(i, n));
    result[i] = share(selected, residue.end - residue.begin);
  }
  return result;
}

} // namespace

void list_residues(Arrangement& a) {
  Grouping& g = a.grouping;
  g.chain = chain_names(a.flat, a.placed);
  size_t count = 0;
  const auto all_of = [&](const Placed& p) { return a.flat.chain[p.chain]; };
  for (const Placed& p : a.placed)
    count += p.residues ? p.residues->size() : static_cast<size_t>(all_of(p).end - all_of(p).begin);
  g.residue.reserve(count);
  a.source.reserve(count);
  for (size_t p = 0; p < a.placed.size(); ++p) {
    const auto add = [&](int64_t r) {
      g.residue.push_back({static_cast<int32_t>(p)});
      a.source.push_back(static_cast<int32_t>(r));
    };
    const Placed& placed = a.placed[p];
    if (placed.residues)
      std::for_each(placed.residues->begin(), placed.residues->end(), add);
    else
      for (uint32_t r = all_of(placed).begin; r < all_of(placed).end; ++r)
        add(r);
  }
}

std::vector<std::string> domains_by_entity(const Arrangement& a, const pdb::Structure& st) {
  std::unordered_map<std::string_view, std::string_view> of_subchain; // the first entity that has it
  for (const gemmi::Entity& entity : st.entities)
    for (const std::string& subchain : entity.subchains)
      of_subchain.try_emplace(subchain, entity.name);
  std::vector<std::string> names;
  for (const Flat::Chain& chain : a.flat.chain)
    names.push_back(entity_of(of_subchain, *chain.source));
  std::vector<std::string> domains;
  for (const Placed& p : a.placed)
    domains.push_back(names[p.chain]);
  return domains;
}

std::vector<std::string> domains_by_copy(const Arrangement& a) {
  std::vector<std::string> domains;
  for (const Placed& p : a.placed)
    domains.push_back("copy_" + std::to_string(p.copy));
  return domains;
}

std::vector<Selected> ArrangementSelections::select(const std::string& selection, const std::string& where,
                                                    bool may_be_around, Status status) const {
  const Selection s(selection, where, may_be_around, status);
  return s.around() > 0 ? select_by_distance(s, a_) : select_by_label(s, a_);
}

std::string ArrangementSelections::address(int64_t residue, int64_t atom) const {
  const pdb::Residue& r = *a_.residue(residue).source;
  return residue_in_selection(a_.grouping.chain[a_.grouping.residue[residue].chain], name_in_hierarchy(r)) + '/' +
         in_selection(a_.flat.names[a_.flat.atom[atom].name]);
}

std::string ArrangementSelections::first_atom(int64_t residue) const {
  return address(residue, a_.residue(residue).begin);
}

std::string ArrangementSelections::first_atom_outside(int64_t residue, const std::string& selection,
                                                      const std::string& where) const {
  const Selection s(selection, where);
  const Flat::Residue& r = a_.residue(residue);
  int64_t outside = r.begin;
  while (s.atom(r.source->atoms[outside - r.begin]))
    ++outside;
  return address(residue, outside);
}

} // namespace molmesh::formats
