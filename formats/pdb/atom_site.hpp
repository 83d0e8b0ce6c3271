// atom_site.hpp — mmCIF's table of atoms, row by row, becomes models: no table of texts is kept.
#pragma once
#include "base/index_table.hpp"
#include "formats/pdb/chunks.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/gunzip.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/structure.hpp"
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gemmi::cif {
struct Item;
}

namespace molmesh::formats {

inline const std::string atom_site = "_atom_site.";

/// Is anything of this category ("_entity") used, besides the atoms?
bool is_category_read(std::string_view name);

/// The atoms of one data block. Columns are found in any case, and completed where the file has none. Residues and
/// chains are those that gemmi::make_structure_from_block() makes, each looked up by hash; pdb::Atom::serial is
/// the row.
class AtomSite {
public:
  /// Charges and radii go to parsed.pqr. bytes: of the file, which bound what its atoms may take.
  AtomSite(Parsed& parsed, std::string file, size_t bytes)
      : parsed_(parsed), file_(std::move(file)), most_memory_(most_unpacked(bytes)) {}
  AtomSite(const AtomSite&) = delete;
  AtomSite& operator=(const AtomSite&) = delete;

  /// line: of the table in the file; below 1: none. Throws Error(bad_input) "FILE:LINE: …" where a column is
  /// missing that nothing can replace.
  void begin(const std::vector<std::string>& tags, int64_t line);
  bool begun() const { return begun_; }
  /// Of the tag with this index: is its column used?
  bool uses(size_t tag) const { return used_[tag] != 0; }
  /// One value for each tag, as CIF writes it, quotes and all. Throws Error(bad_input) "FILE:LINE: …" where a value
  /// is none, and where all that is read would take more memory than 20 times the file and 64 MiB.
  void row(const std::vector<std::string_view>& values, int64_t line);
  int64_t rows() const { return rows_; }
  /// After the last row: the models into parsed.structure, and what the file did not have into parsed.notes.
  void finish();

private:
  enum Column {
    group,
    symbol,
    label_atom,
    alternative,
    label_residue,
    label_chain,
    entity,
    label_number,
    insertion,
    x,
    y,
    z,
    occupancy,
    b_factor,
    number,
    auth_residue,
    auth_chain,
    auth_atom,
    model,
    deuterium,
    charge,
    radius,
    columns
  };
  static constexpr std::array<const char*, columns> names = {"group_pdb",
                                                             "type_symbol",
                                                             "label_atom_id",
                                                             "label_alt_id",
                                                             "label_comp_id",
                                                             "label_asym_id",
                                                             "label_entity_id",
                                                             "label_seq_id",
                                                             "pdbx_pdb_ins_code",
                                                             "cartn_x",
                                                             "cartn_y",
                                                             "cartn_z",
                                                             "occupancy",
                                                             "b_iso_or_equiv",
                                                             "auth_seq_id",
                                                             "auth_comp_id",
                                                             "auth_asym_id",
                                                             "auth_atom_id",
                                                             "pdbx_pdb_model_num",
                                                             "ccp4_hd_mixture",
                                                             "pqr_partial_charge",
                                                             "pqr_radius"}; ///< in small letters

  std::string at(int64_t line) const;
  bool has(Column c) const { return at_[c] >= 0; }
  bool says(Column c) const; ///< the column is there, and its value is not null
  void complete(Column c, Column like, const char* value);
  void open_model();
  void open_chain();
  void open_residue();
  void mix_deuterium(double hydrogen);
  pdb::Label label(const std::string& text) { return parsed_.structure.labels.add(text); }
  size_t index_of(const pdb::ResidueId& id);
  void close_residue();
  void place_residues();
  gemmi::Element element();
  void check(int64_t line);
  void check_memory(int64_t line) const;

  Parsed& parsed_;
  std::string file_;
  size_t most_memory_;
  int64_t line_ = 1, rows_ = 0;
  bool begun_ = false;
  std::vector<uint8_t> used_; ///< by tag
  std::array<int, columns> at_{};
  std::array<std::string, columns> value_; ///< of the row
  std::array<std::string, 3> residue_;     ///< of the row before: name, number, insertion code
  std::string model_, chain_name_;         ///< of the row before
  Column chain_column_ = label_chain, residue_column_ = label_residue, atom_column_ = label_atom;

  std::vector<pdb::Model> models_;
  std::unordered_map<std::string, size_t> model_of_name_;
  size_t model_index_ = 0;
  bool chain_open_ = false, residue_open_ = false;
  std::string chain_; ///< name of the open one
  struct Chains {     ///< of a model
    IndexTable index;
    Chunks<pdb::Label> name;
  };
  std::vector<Chains> chains_; ///< of each model
  size_t chain_count_ = 0;     ///< of all
  struct Run {                 ///< of residues that stand together in the file, of one chain
    uint32_t model, chain, begin;
  };
  Chunks<Run> runs_;
  Chunks<pdb::Residue> residues_; ///< of all models and chains, run by run
  IndexTable known_;              ///< those of the open run: their indices in it
  size_t residue_index_ = 0;
  Chunks<pdb::Atom> atoms_; ///< of the open residue, since it has been opened
  ElementGuesses guesses_;
  int64_t named_ = 0, without_radius_ = 0, large_ = 0;
};

/// If `item` is _entity_poly_seq: its places are integers. Throws Error(bad_input) "WHERE: …".
void check_sequence(const gemmi::cif::Item& item, const std::string& where);

} // namespace molmesh::formats
