// pdb.hpp — structure files (PDB, mmCIF, mmJSON, PQR; plain or gzip) as a hierarchy of atoms (PDB.md).
#pragma once
#include "molecule/exponents.hpp"
#include "molecule/radii.hpp"
#include <cstdint>
#include <iosfwd>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace molmesh::formats {

/// The options of pdb2hier (PDB.md). Selections are gemmi's (MMDB syntax).
struct PdbOptions {
  std::string format = "auto";                            ///< auto, pdb, mmcif, mmjson, pqr
  std::string model = "first";                            ///< first, all, or a model's number
  std::string assembly = "none";                          ///< none, or the identifier of a biological assembly
  std::vector<std::string> levels = {"chain", "residue"}; ///< of domain, chain, residue; outermost first
  enum class Domains { none, file, entity, copy } domains = Domains::none;
  std::vector<DomainPart> domain_parts; ///< Domains::file
  /// Where no rule says otherwise: plain: `exponents`; molecular: those of molecular_body(); automatic: molecular
  /// for a file with hydrogens or radii of its own, else plain. Without a level "residue" always plain.
  enum class Surface { automatic, molecular, plain } surface = Surface::automatic;
  Exponents exponents;
  std::vector<Rule> rules; ///< later ones win
  std::string select = "*";
  bool hydrogens = true, waters = false, hetatm = true; ///< keep
  std::string altloc = "occupancy";                     ///< occupancy, first, all, or the letter to prefer
  bool own_radii = true; ///< PQR: the file's own radii; otherwise, and without them, `radii`
  Radii radii;
  double unknown_radius = 2; ///< Å, for elements without a radius; 0: refuse them
};

/// What was read, kept and dropped; numbers of atoms unless said otherwise.
struct PdbReport {
  std::string format;
  int64_t read = 0, models_read = 0; ///< in all models; number of models
  int64_t other_models = 0, altlocs = 0, waters = 0, hydrogens = 0, hetatms = 0, unselected = 0, no_radius = 0,
          unassembled =
              0; ///< dropped; no_radius: of radius 0 without a charge; unassembled: in no copy of the assembly
  struct Charges {
    double waters = 0, hydrogens = 0, hetatms = 0, unselected = 0, unassembled = 0;
    double all() const { return waters + hydrogens + hetatms + unselected + unassembled; }
  } dropped_charge;          ///< e, of what is dropped
  double charge = 0;         ///< e, of the atoms written
  int64_t charges_alone = 0; ///< atoms written that have a charge and the radius 0
  int64_t atoms = 0, residues = 0, chains = 0, domains = 0, copies = 1; ///< written; copies of the assembly
  struct Unknown {
    int64_t atoms = 0;
    std::string first; ///< "ATOM of RESIDUE CHAIN/NUMBER"
  };
  /// Hetero residues (HETATM) by name: what they are, and how many.
  struct Hetero {
    int64_t residues = 0, atoms = 0;
    std::string first; ///< a selection of the first: "//H/373(ANS)"
    void add(const std::string& chain, const std::string& residue, int64_t its_atoms);
  };
  using Heteros = std::map<std::string, Hetero>;
  /// Written: outside and inside of polymers, and waters; dropped by `hetatm`.
  Heteros ligands, modified, kept_waters, dropped_hetero;
  std::map<std::string, int64_t> passed_over;      ///< lines or categories that are no atoms, by record or name
  std::map<std::string, int64_t> guessed_elements; ///< that the file does not give, taken from the names
  std::map<std::string, Unknown> unknown_elements; ///< by element ("X": none known), given `unknown_radius`
  std::string surface;                             ///< which settings of the body, and why; empty: `exponents`
  std::vector<std::string> notes;                  ///< all of the above that a user should know, a sentence each
};

/// Reads and resolves everything on construction; write() streams, so that copies of an assembly are never all in
/// memory.
class PdbHierarchy {
public:
  /// name: of the file, for the source line; "<stdin>" for standard input. Throws Error(bad_input) "FILE:LINE: …"
  /// for what the file does not hold, selections that touch nothing, atoms in no domain or several; Error(usage)
  /// for options that contradict each other.
  PdbHierarchy(std::istream& in, const std::string& name, const PdbOptions& options);
  ~PdbHierarchy();
  const PdbReport& report() const;
  /// Same input, same bytes.
  void write(std::ostream& out) const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace molmesh::formats
