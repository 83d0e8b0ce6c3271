// placement.hpp — the kept atoms in flat arrays, and where copies of each chain stand.
#pragma once
#include "formats/pdb/parse.hpp"
#include "formats/pdb/pdb.hpp"
#include "molecule/hierarchy.hpp"
#include <memory>

namespace molmesh::formats {

/// The atoms of the file, without copies.
struct Flat {
  struct Residue {
    const pdb::Residue* source;
    uint32_t begin, end; ///< atoms
  };
  struct Chain {
    const pdb::Model* model;
    const pdb::Chain* source;
    uint32_t begin, end; ///< residues
  };
  std::vector<Chain> chain;
  std::vector<Residue> residue;
  std::vector<Atom> atom;
  Names names;
};

/// One copy of one chain, whole or in part.
struct Placed {
  uint32_t chain;                                       ///< in Flat::chain
  int copy;                                             ///< which operator of the assembly, from 1
  const gemmi::Transform* transform;                    ///< the structure's; null: the identity
  std::shared_ptr<const std::vector<int64_t>> residues; ///< indices into Flat::residue, ascending; null: all
  Vec3d position(Vec3d p) const;
};

/// Radii and charges are resolved here; counts unknown elements. let_go: residues give up their atoms, which nobody
/// asks for then. Throws Error(bad_input) when elements are to be refused.
Flat flatten(Parsed& parsed, const std::string& file, const PdbOptions& options, bool let_go, PdbReport& report);

/// Every chain once, or as the assembly says. Throws Error(bad_input) when the assembly is not there.
std::vector<Placed> place(const Flat& flat, const pdb::Structure& st, const std::string& file,
                          const std::string& assembly, PdbReport& report);

/// Unique names of the placed chains: NAME, or NAME_1, NAME_2, … of chains that come more than once (in copies, in
/// models).
std::vector<std::string> chain_names(const Flat& flat, const std::vector<Placed>& placed);

} // namespace molmesh::formats
