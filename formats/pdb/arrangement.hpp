// arrangement.hpp — what goes into the .hier: residues in copies of chains, their domains, exponents, order.
#pragma once
#include "formats/pdb/placement.hpp"
#include "formats/pdb/selection.hpp"

namespace molmesh::formats {

/// A residue of the output: one residue in one copy of its chain.
struct Item {
  int32_t placed;     ///< index into the placed chains
  int32_t residue;    ///< index into Flat::residue
  int32_t domain = 0; ///< index into the domains
};

struct Arrangement {
  Flat flat;
  std::vector<Placed> placed;
  std::vector<Item> items; ///< in the order of the file, copy after copy
  std::vector<std::string> domains;
  std::vector<double> residue_exponent, chain_exponent, domain_exponent; ///< by item, placed chain, domain
  std::vector<int32_t> order;                                            ///< of the items in the output
};

/// Every residue of every placed chain.
std::vector<Item> list_items(const std::vector<Placed>& placed);

/// What of each item the selection touches: 0 nothing, 1 some atoms, 2 all.
std::vector<uint8_t> touch(const Selection& selection, const Arrangement& a);

/// Sets domains, Item::domain. Throws Error(bad_input) naming an atom that lies in no domain, in two, or in another
/// than the rest of its residue (or chain, where domains hold chains); or a part that touches nothing.
void assign_domains(Arrangement& a, const gemmi::Structure& st, const std::string& file, const PdbOptions& options);

/// Sets the exponents: the defaults, then rule after rule. Throws Error(bad_input) for a rule that touches nothing
/// or sets no level of the hierarchy.
void assign_exponents(Arrangement& a, const PdbOptions& options, PdbReport& report);

/// Sets the order in which groups of all levels are contiguous; otherwise that of the file.
void sort_items(Arrangement& a, const std::vector<std::string>& levels);

} // namespace molmesh::formats
