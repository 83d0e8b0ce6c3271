// selection.hpp — gemmi's selections (MMDB syntax), split by what they say about models, chains, residues and
// atoms.
#pragma once
#include "base/error.hpp"
#define USE_STD_SNPRINTF // gemmi's own wants stb_sprintf.h, which Debian's gemmi-dev lacks; only messages are
                         // printed
#include <gemmi/select.hpp>
#include <string>

namespace molmesh::formats {

/// "SELECTION", or where allowed "around SELECTION DISTANCE": everything within DISTANCE (Å) of an atom of
/// SELECTION.
class Selection {
public:
  /// Throws Error(status) "WHERE: …" when the syntax is wrong.
  Selection(const std::string& text, const std::string& where, bool around_allowed = false,
            Status status = Status::bad_input);

  bool model(const gemmi::Model& m) const { return selection_.matches(m); }
  /// name: in the file; copy: the unique name of one copy of an assembly. Either may be selected.
  bool chain(const std::string& name, const std::string& copy) const;
  bool residue(const gemmi::Residue& r) const { return selection_.matches(r); }
  bool atom(const gemmi::Atom& a) const { return selection_.matches(a); }
  bool names_chains() const { return !selection_.chain_ids.all; }
  bool names_residues() const { return !selection_.residue_names.all || numbers_residues(); }
  bool numbers_residues() const { return !selection_.from_seqid.empty() || !selection_.to_seqid.empty(); }
  /// Does it ask for what a .hier does not hold: other models than the first, alternative locations, occupancies …?
  bool beyond_hierarchy() const {
    return selection_.mdl > 1 || !selection_.altlocs.all || !selection_.entity_types.all ||
           !selection_.atom_inequalities.empty();
  }
  /// Å; negative when the selection is no "around".
  double around() const { return around_; }

private:
  gemmi::Selection selection_;
  double around_ = -1;
};

} // namespace molmesh::formats
