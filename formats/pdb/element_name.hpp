// element_name.hpp — the element of an atom of which a file gives names alone.
#pragma once
#include <cstdint>
#include <gemmi/elem.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

struct Parsed;

/// Of an ion, an atom named like its residue: by its symbol ("NA", "Cl-", "ZN2"), or as CHARMM calls it ("SOD",
/// "CLA", "POT", …). X when it is none.
gemmi::Element ion_element(std::string_view atom, std::string_view residue);

/// Of any atom: an ion's; otherwise the first letter, with chlorine, bromine, silicon, selenium, arsenic and the
/// metals of cofactors by two. No metal has a name that could be that of carbon, nitrogen, …: those are the first
/// letter.
gemmi::Element named_element(std::string_view atom, std::string_view residue);

/// The same where the name stands in columns 13-16 of the PDB format: elements of two letters begin in column 13.
/// In amino acids and nucleotides the first letter.
gemmi::Element element_in_columns(std::string_view field, std::string_view residue);

/// Of an atom type of AutoDock: "A" is an aromatic carbon, "OA" an oxygen that accepts, "HD" a hydrogen, …
gemmi::Element autodock_element(std::string_view type);

/// Elements that the names told, counted; those of which the name could be a metal's are listed.
class ElementGuesses {
public:
  /// of_one_letter: the name stands where elements of one letter do.
  void add(std::string_view atom, std::string_view residue, gemmi::Element element, bool of_one_letter = false);
  int64_t all() const { return all_; }
  /// Into parsed.guessed, and a note on the doubtful ones.
  void report(Parsed& parsed) const;

private:
  int64_t all_ = 0;
  std::map<std::string, int64_t> of_element_;
  std::map<std::string, int64_t> doubtful_; ///< "CA10 of TLCL as C"
};

/// Whether the residue is an amino acid by a name of AMBER, CHARMM or GROMACS that tells its protons.
bool is_protonation_variant(std::string_view residue);

/// Takes a last word that is an element's symbol away; X when there is none.
gemmi::Element take_element(std::vector<std::string_view>& word);

} // namespace molmesh::formats
