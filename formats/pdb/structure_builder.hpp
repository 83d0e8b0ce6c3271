// structure_builder.hpp — atoms, one after the other, become models, chains and residues.
#pragma once
#include "formats/pdb/chunks.hpp"
#include "formats/pdb/structure.hpp"
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace molmesh::formats {

/// Atoms of a PDB file in its order. A chain ends where the next atom's chain has another name. Within a chain,
/// atoms of one number, insertion code, segment and name are a residue, also where they stand apart; but a run
/// that repeats an atom of the residue is a residue of its own: its number has started again.
class StructureBuilder {
public:
  explicit StructureBuilder(pdb::Structure& structure) : structure_(structure) {}

  void open_model(const std::string& name);
  /// has_number: false where the field held none; then an atom named like the first one begins a new residue.
  void add(std::string_view chain, const pdb::ResidueId& id, bool hetero, bool has_number, const pdb::Atom& atom);
  /// What atoms and residues are named with.
  pdb::Label label(std::string_view text) { return structure_.labels.add(text); }
  /// TER: what has come of the chain is a polymer.
  void end_polymer();
  /// A line of SEQRES.
  void add_sequence(std::string_view line);
  /// After the last atom. Names the parts of chains as gemmi does.
  void finish();
  /// Residues that are apart from one of the same number and name because they repeat its atoms.
  int64_t restarted() const { return restarted_; }

private:
  struct Slot {
    size_t residue;                                         ///< in the open chain
    std::unique_ptr<std::unordered_set<std::string>> atoms; ///< labels of its atoms, once asked for
  };
  void open_chain(std::string_view name);
  void close_residue();
  bool repeats(Slot& slot) const;
  pdb::Chain& chain() { return structure_.models.back().chains.back(); }

  pdb::Structure& structure_;
  bool chain_open_ = false, after_ter_ = false;
  std::unordered_map<std::string, size_t> entity_; ///< of structure_, by name
  std::unordered_map<std::string, size_t> chains_; ///< of the model: the first of each name
  std::unordered_multimap<size_t, Slot> slot_;     ///< by the hash of what the residue is
  pdb::Residue run_;                               ///< consecutive atoms of one residue
  Chunks<pdb::Atom> atoms_;                        ///< these
  int64_t restarted_ = 0;
};

/// The same for a structure of which gemmi has joined the residues: Atom::serial is the place in the file,
/// ascending. Returns how many residues are new.
int64_t part_restarted(pdb::Structure& structure);

} // namespace molmesh::formats
