// polymer.cpp — by the sequence, or by peptide and phosphodiester bonds to the neighbors in the chain.
#include "formats/pdb/polymer.hpp"
#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace molmesh::formats {
namespace {

constexpr double longest_bond = 1.8; // Å; P–O3' is 1.6, C–N 1.33
constexpr size_t looked_at = 100;    // of a neighbor's atoms: the backbone comes first

bool is_any(const std::string& name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

struct Joined {
  bool before = false, after = false;
};

/// Adds the bonds of a residue to the backbone of a neighbor that belongs to the polymer: not of another ligand, as
/// parts of one inhibitor are.
void join(const pdb::Residue& residue, const pdb::Residue& neighbor, Joined& joined) {
  if (neighbor.het_flag == 'H' && neighbor.flag != modified_residue)
    return;
  for (size_t i = 0; i < std::min(neighbor.atoms.size(), looked_at); ++i) {
    const pdb::Atom& end = neighbor.atoms[i];
    const bool begins = is_any(end.name, {"N", "P"}); // of the residue after this one
    if (!begins && !is_any(end.name, {"C", "O3'", "O3*"}))
      continue;
    const gemmi::El partner = end.name == "N"   ? gemmi::El::C
                              : end.name == "P" ? gemmi::El::O
                              : end.name == "C" ? gemmi::El::N
                                                : gemmi::El::P;
    for (const pdb::Atom& own : residue.atoms)
      if (own.element == partner && own.pos.dist_sq(end.pos) < longest_bond * longest_bond) {
        (begins ? joined.after : joined.before) = true;
        break;
      }
  }
}

bool has_backbone(const pdb::Residue& residue) {
  return std::any_of(residue.atoms.begin(), residue.atoms.end(),
                     [](const pdb::Atom& a) {
                       return is_any(a.name, {"CA", "C1'", "C1*"}) && a.element == gemmi::El::C;
                     }) ||
         is_any(residue.name, {"ACE", "FOR", "NH2", "NME", "NMA"});
}

class Neighbors {
public:
  explicit Neighbors(const pdb::Chain& chain) : chain_(chain) {
    for (const pdb::Residue& residue : chain.residues)
      if (residue.seqid.num && residue.het_flag != 'H')
        of_number_.try_emplace(*residue.seqid.num, &residue);
  }
  /// Those before and after it in the file, and those of the numbers beside its own: some programs write all HETATM
  /// behind the chains.
  Joined of(size_t r) const {
    const pdb::Residue& residue = chain_.residues[r];
    Joined joined;
    if (r > 0)
      join(residue, chain_.residues[r - 1], joined);
    if (r + 1 < chain_.residues.size())
      join(residue, chain_.residues[r + 1], joined);
    if (residue.seqid.num)
      for (const int64_t beside : {int64_t{*residue.seqid.num} - 1, int64_t{*residue.seqid.num} + 1})
        if (const auto found = of_number_.find(beside); found != of_number_.end())
          join(residue, *found->second, joined);
    return joined;
  }

private:
  const pdb::Chain& chain_;
  std::unordered_map<int64_t, const pdb::Residue*> of_number_; ///< that are not hetero
};

} // namespace

void mark_modified_residues(pdb::Structure& structure, bool is_pdb) {
  const auto is_hetero = [](const pdb::Residue& r) { return r.het_flag == 'H' && !r.is_water(); };
  std::unordered_map<std::string_view, std::unordered_set<std::string_view>> sequence; // what there is in it
  if (is_pdb)
    for (const gemmi::Entity& e : structure.entities)
      sequence[e.name].insert(e.full_sequence.begin(), e.full_sequence.end());
  for (pdb::Model& model : structure.models)
    for (pdb::Chain& chain : model.chains) {
      if (std::none_of(chain.residues.begin(), chain.residues.end(), is_hetero))
        continue;
      const auto entity = is_pdb ? sequence.find(chain.name.str()) : sequence.end();
      const auto in_sequence = [&](const pdb::Residue& r) {
        return r.entity_type == gemmi::EntityType::Polymer &&
               (!is_pdb || (entity != sequence.end() && entity->second.count(r.name.str()) > 0));
      };
      const Neighbors neighbors(chain);
      const auto mark = [&](size_t r) {
        pdb::Residue& residue = chain.residues[r];
        if (!is_hetero(residue) || residue.flag == modified_residue)
          return;
        const Joined joined = neighbors.of(r);
        const int ends = int{joined.before} + int{joined.after};
        if (in_sequence(residue) || ends == 2 || (ends == 1 && has_backbone(residue)))
          residue.flag = modified_residue;
      };
      for (size_t r = 0; r < chain.residues.size(); ++r) // from a link to the next one,
        mark(r);
      for (size_t r = chain.residues.size(); r-- > 0;) // and back
        mark(r);
    }
}

} // namespace molmesh::formats
