// touch.cpp — selections by label once a residue, by distance once an atom.
#include "formats/pdb/arrangement.hpp"
#include "formats/pdb/near.hpp"
#include <algorithm>

namespace molmesh::formats {
namespace {

bool selects(const Selection& s, const Flat& flat, const Placed& p) {
  const Flat::Chain& chain = flat.chain[p.chain];
  return s.model(*chain.model) && s.chain(chain.source->name, p.name);
}

/// Calls take(item, atom of the file) for the selected atoms of all items.
template <class Take>
void for_each_selected(const Selection& s, const Arrangement& arrangement, Take take) {
  const Flat& flat = arrangement.flat;
  for (size_t i = 0; i < arrangement.items.size(); ++i) {
    const Item& item = arrangement.items[i];
    const Flat::Residue& residue = flat.residue[item.residue];
    if (!selects(s, flat, arrangement.placed[item.placed]) || !s.residue(*residue.source))
      continue;
    for (int64_t a = residue.begin; a < residue.end; ++a)
      if (s.atom(residue.source->atoms[a - residue.begin]))
        take(i, a);
  }
}

uint8_t share(int64_t touched, int64_t all) {
  return touched == 0 ? 0 : touched == all ? 2 : 1;
}

} // namespace

std::vector<uint8_t> touch(const Selection& s, const Arrangement& arrangement) {
  const Flat& flat = arrangement.flat;
  const std::vector<Placed>& placed = arrangement.placed;
  const std::vector<Item>& items = arrangement.items;
  std::vector<uint8_t> result(items.size(), 0);
  if (s.around() > 0) {
    Near near(s.around());
    for_each_selected(s, arrangement, [&](size_t i, int64_t a) {
      near.add(placed[items[i].placed].position(flat.atom[a].center));
    });
    for (size_t i = 0; i < items.size(); ++i) {
      const Flat::Residue& residue = flat.residue[items[i].residue];
      int64_t touched = 0;
      for (int64_t a = residue.begin; a < residue.end; ++a)
        touched += near.has(placed[items[i].placed].position(flat.atom[a].center));
      result[i] = share(touched, residue.end - residue.begin);
    }
    return result;
  }
  constexpr uint8_t unknown = 3;
  std::vector<uint8_t> of_residue(flat.residue.size(), unknown); // whatever the chain
  std::vector<uint8_t> of_chain(placed.size());
  for (size_t p = 0; p < placed.size(); ++p)
    of_chain[p] = selects(s, flat, placed[p]);
  for (size_t i = 0; i < items.size(); ++i) {
    if (!of_chain[items[i].placed])
      continue;
    uint8_t& known = of_residue[items[i].residue];
    if (known == unknown) {
      const Flat::Residue& residue = flat.residue[items[i].residue];
      const std::vector<gemmi::Atom>& atoms = residue.source->atoms;
      const auto touched =
          s.residue(*residue.source)
              ? std::count_if(atoms.begin(), atoms.end(), [&](const gemmi::Atom& a) { return s.atom(a); })
              : 0;
      known = share(touched, residue.end - residue.begin);
    }
    result[i] = known;
  }
  return result;
}

} // namespace molmesh::formats
