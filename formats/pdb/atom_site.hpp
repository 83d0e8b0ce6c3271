// atom_site.hpp — mmCIF's table of atoms before gemmi reads it: columns found in any case, completed, checked.
#pragma once
#include <cstdint>
#include <gemmi/cifdoc.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

inline const std::string atom_site = "_atom_site.";

class AtomColumns {
public:
  explicit AtomColumns(gemmi::cif::Loop& loop) : loop_(loop) {
    for (std::string& tag : loop_.tags)
      tag = canonical(tag);
  }

  int find(const std::string& name) const {
    const auto at = std::find(loop_.tags.begin(), loop_.tags.end(), atom_site + name);
    return at == loop_.tags.end() ? -1 : static_cast<int>(at - loop_.tags.begin());
  }

  /// Adds the column where it is missing: a copy of the first of `like` that is there, or `value`.
  void complete(const std::string& name, const std::vector<std::string>& like, const std::string& value) {
    if (find(name) >= 0)
      return;
    int from = -1;
    for (const std::string& other : like)
      if (from < 0)
        from = find(other);
    const size_t width = loop_.width(), rows = loop_.length();
    std::vector<std::string> values;
    values.reserve(loop_.values.size() + rows);
    for (size_t r = 0; r < rows; ++r) {
      for (size_t c = 0; c < width; ++c)
        values.push_back(std::move(loop_.values[r * width + c]));
      values.push_back(from < 0 ? value : values[values.size() - width + static_cast<size_t>(from)]);
    }
    loop_.tags.push_back(atom_site + name);
    loop_.values = std::move(values);
  }

private:
  /// mmCIF tags are case-insensitive, gemmi's are not.
  static std::string canonical(const std::string& tag) {
    static const char* const known[] = {"group_PDB",      "Cartn_x",           "Cartn_y",           "Cartn_z",
                                        "B_iso_or_equiv", "pdbx_PDB_ins_code", "pdbx_PDB_model_num"};
    const std::string lower = gemmi::to_lower(tag);
    for (const char* name : known)
      if (lower == atom_site + gemmi::to_lower(name))
        return atom_site + name;
    return lower;
  }
  gemmi::cif::Loop& loop_;
};

/// Coordinates are finite. Throws Error(bad_input) "WHERE:LINE: …"; line: where the table begins in `text`.
void check_coordinates(const gemmi::cif::Loop& loop, const AtomColumns& columns, std::string_view text,
                       const std::string& where, int64_t line);
/// Residue numbers are integers, perhaps with the letter of an insertion behind; what is not used but would be read
/// is cleared.
void check_integers(gemmi::cif::Loop& loop, const AtomColumns& columns, std::string_view text,
                    const std::string& where, int64_t line);
/// If `item` is _entity_poly_seq: its places are integers.
void check_sequence(const gemmi::cif::Item& item, const std::string& where);
/// Elements that the file does not give, told by the names; returns how many. Wants type_symbol and label_comp_id.
int64_t name_elements(gemmi::cif::Loop& loop, const AtomColumns& columns, class ElementGuesses& guesses);

} // namespace molmesh::formats
