// arrangement.hpp — the residues of a structure file, in copies of chains, and what gemmi's selections select.
#pragma once
#include "formats/pdb/placement.hpp"
#include "molecule/grouping.hpp"

namespace molmesh::formats {

struct Arrangement {
  Flat flat;
  std::vector<Placed> placed;  ///< the chains of `grouping`
  std::vector<int32_t> source; ///< of each residue of `grouping`: index into Flat::residue
  Grouping grouping;

  const Flat::Residue& residue(int64_t r) const { return flat.residue[source[r]]; }
};

/// Sets `source`, and the residues and chains of `grouping`: every residue of every placed chain.
void list_residues(Arrangement& a);

/// The domain of each placed chain: "entity_1", of the chain's polymer or of its first residue.
std::vector<std::string> domains_by_entity(const Arrangement& a, const pdb::Structure& st);
/// The domain of each placed chain: "copy_1", the operator of the assembly.
std::vector<std::string> domains_by_copy(const Arrangement& a);

class ArrangementSelections final : public StructureSelections {
public:
  /// The arrangement must outlive this.
  explicit ArrangementSelections(const Arrangement& arrangement) : a_(arrangement) {}
  std::vector<Selected> select(const std::string& selection, const std::string& where, bool may_be_around,
                               Status status) const override;
  std::string first_atom(int64_t residue) const override;
  std::string first_atom_outside(int64_t residue, const std::string& selection,
                                 const std::string& where) const override;

private:
  std::string address(int64_t residue, int64_t atom) const;
  const Arrangement& a_;
};

} // namespace molmesh::formats
