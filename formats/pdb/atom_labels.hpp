// atom_labels.hpp — columns 18-27 and 73-76 of an atom's line name its residue, chain and segment.
#pragma once
#include <gemmi/seqid.hpp>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace molmesh::formats {

struct AtomLabels {
  std::string_view residue, chain, segment;
  std::string_view number;       ///< and insertion code: as ResidueNumbers reads them
  bool chain_of_segment = false; ///< the chain's columns are blank, its name is the segment's
};

/// Column 21 is the fourth letter of a residue's name (POPC, TIP3, LYSH) or the first of a chain's with two. The
/// file as a whole tells: of two letters are the chains that hold short names or, by themselves, amino acids.
class LabelColumns {
public:
  /// Each atom's line of the file, its fields in their columns; then of() may be asked.
  void look(std::string_view line);
  void finish();
  AtomLabels of(std::string_view line) const;

private:
  void end_run(std::string_view next);
  struct Run { ///< of lines with something in column 21 and the same two columns
    std::string chain;
    std::set<std::string> amino_acids;
    bool flanked = false, short_name = false, all_known = true;
    int first = 0, last = 0;
  } run_;
  std::string before_; ///< columns 18-27 of the line before
  std::set<std::string> two_letters_;
};

/// Residue numbers: decimal; past 9999 five digits, hybrid-36 in capitals, or hexadecimal, as VMD and CHARMM-GUI
/// count on. Remembers the number before.
class ResidueNumbers {
public:
  struct Number {
    gemmi::SeqId id;
    bool is_number = true; ///< false: `id` is what gemmi makes of the field
  };
  /// field: columns 23-27.
  Number read(std::string_view field);
  int64_t hexadecimal() const { return hexadecimal_; }

private:
  int before_ = 0;
  int64_t hexadecimal_ = 0;
};

} // namespace molmesh::formats
