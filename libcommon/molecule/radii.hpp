// radii.hpp — van der Waals radii by element, or by residue and atom name, Å.
// A. Bondi, J. Phys. Chem. 68 (1964) 441; for main-group elements that Bondi leaves out, M. Mantina et al., J.
// Phys. Chem. A 113 (2009) 5806.
#pragma once
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace molmesh {

/// Bondi's radius of an element, Mantina's where Bondi has none; none for the elements that neither lists.
/// element: symbol in any case ("Fe", "FE"); D counts as H.
std::optional<double> bondi_radius(std::string_view element);

/// Radii of a file over Bondi's.
class Radii {
public:
  /// The most specific entry wins: residue and atom name, any residue and atom name, element, Bondi.
  std::optional<double> find(std::string_view residue, std::string_view atom, std::string_view element) const;
  void set_element(std::string_view element, double radius);
  /// residue: "*" for any.
  void set_atom(std::string_view residue, std::string_view atom, double radius);

private:
  std::map<std::string, double, std::less<>> element_, atom_; ///< keys in upper case; atoms as "RESIDUE ATOM"
};

/// Lines `ELEMENT RADIUS` or `RESIDUE ATOM RADIUS`, RESIDUE may be `*`; a line that begins with `#` is a comment.
/// Radii in Å, > 0. Throws Error(bad_input) "FILE:LINE: …".
Radii read_radii(std::istream& in, const std::string& file);

} // namespace molmesh
