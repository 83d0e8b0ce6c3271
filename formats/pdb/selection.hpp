// selection.hpp — gemmi's selections (MMDB syntax), split by what they say about models, chains, residues and
// atoms.
#pragma once
#include "base/error.hpp"
#include "formats/pdb/structure.hpp"
#define USE_STD_SNPRINTF // gemmi's own wants stb_sprintf.h, which is not in Debian's gemmi-dev; only messages are
                         // printed
#include <algorithm>
#include <gemmi/select.hpp>
#include <optional>
#include <string>
#include <vector>

namespace molmesh::formats {

/// A list of names in a selection: all, some, or all but some.
struct NameList {
  bool all = true, inverted = false;
  std::vector<std::string> name;
  bool has(const std::string& n) const {
    return all || (std::find(name.begin(), name.end(), n) != name.end()) != inverted;
  }
};

/// "SELECTION", or where allowed "around SELECTION DISTANCE": everything within DISTANCE (Å) of an atom of
/// SELECTION. Beside gemmi's syntax: names of chains, residues and atoms in double quotes, chains' with dashes and
/// dots without, lists of residue numbers and ranges (PDB.md).
class Selection {
public:
  /// Throws Error(status) "WHERE: …" when the syntax is wrong.
  Selection(const std::string& text, const std::string& where, bool around_allowed = false,
            Status status = Status::bad_input);

  bool model(const pdb::Model& m) const { return rest_.mdl == 0 || std::to_string(rest_.mdl) == m.name; }
  /// name: in the file; copy: the unique name of one copy of an assembly. Either may be selected, as it is or as a
  /// .hier has it (percent-encoded).
  bool chain(const std::string& name, const std::string& copy) const;
  bool residue(const pdb::Residue& r) const;
  bool atom(const pdb::Atom& a) const;
  bool names_chains() const { return !chains_.all; }
  bool names_residues() const { return !residues_.all || numbers_residues(); }
  bool numbers_residues() const { return !ranges_.empty(); }
  /// The numbers and ranges of residues, as written; empty: all.
  std::vector<std::string> numbers() const;
  /// The first number asked for, if any.
  std::optional<int> first_number() const;
  /// Fits the residue's number the i-th of them?
  bool number_fits(size_t i, const pdb::Residue& r) const {
    return ranges_[i].first.compare(r.seqid) <= 0 && ranges_[i].last.compare(r.seqid) >= 0;
  }
  /// Does it ask for what a .hier does not hold: other models than the first, alternative locations, occupancies …?
  bool beyond_hierarchy() const {
    return rest_.mdl > 1 || !rest_.altlocs.all || !rest_.entity_types.all || !rest_.atom_inequalities.empty();
  }
  /// Å; negative when the selection is no "around".
  double around() const { return around_; }

private:
  struct Range {
    gemmi::Selection::SequenceId first, last;
    std::string text;
  };
  gemmi::Selection rest_; ///< what the lists below leave to gemmi
  NameList chains_, residues_, atoms_;
  std::vector<Range> ranges_; ///< of residue numbers; empty: all
  double around_ = -1;
};

} // namespace molmesh::formats
