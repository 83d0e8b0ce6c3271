// element_name.hpp — the element of an atom of which a file gives names alone.
#pragma once
#include <gemmi/elem.hpp>
#include <string_view>
#include <vector>

namespace molmesh::formats {

/// Of an ion, an atom named like its residue: by its symbol ("NA", "Cl-", "ZN2"), or as CHARMM calls it ("SOD",
/// "CLA", "POT", …). X when it is none.
gemmi::Element ion_element(std::string_view atom, std::string_view residue);

/// Of any atom: an ion's; otherwise the first letter, with halogens, silicon, selenium and the metals of
/// cofactors by their two.
gemmi::Element named_element(std::string_view atom, std::string_view residue);

/// Whether the residue is an amino acid by a name of AMBER, CHARMM or GROMACS that tells its protons.
bool is_protonation_variant(std::string_view residue);

/// Takes a last word that is an element's symbol away; X when there is none.
gemmi::Element take_element(std::vector<std::string_view>& word);

} // namespace molmesh::formats
