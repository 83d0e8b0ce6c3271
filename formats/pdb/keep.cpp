// keep.cpp — models, alternative locations, waters, hydrogens, hetero atoms, the user's selection; in this order.
#include "formats/pdb/keep.hpp"
#include "base/error.hpp"
#include "formats/pdb/model_names.hpp"
#include "formats/pdb/polymer.hpp"
#include "formats/pdb/selection.hpp"
#include "formats/pdb/selection_advice.hpp"
#include "molecule/grouping.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace molmesh::formats {
namespace {

int64_t count_atoms(const pdb::Model& model) {
  int64_t n = 0;
  for (const pdb::Chain& chain : model.chains)
    for (const pdb::Residue& residue : chain.residues)
      n += static_cast<int64_t>(residue.atoms.size());
  return n;
}

/// Removes residues, chains and models without atoms.
void prune(pdb::Structure& st) {
  for (pdb::Model& model : st.models) {
    for (pdb::Chain& chain : model.chains)
      gemmi::vector_remove_if(chain.residues, [](const pdb::Residue& r) { return r.atoms.empty(); });
    gemmi::vector_remove_if(model.chains, [](const pdb::Chain& c) { return c.residues.empty(); });
  }
  gemmi::vector_remove_if(st.models, [](const pdb::Model& m) { return m.chains.empty(); });
}

/// Removes the atoms for which drop(model, chain, residue)(atom) holds; returns how many, adds their charges.
template <class Drop>
int64_t drop_atoms(Parsed& parsed, double& charge, Drop drop) {
  int64_t dropped = 0;
  for (pdb::Model& model : parsed.structure.models)
    for (pdb::Chain& chain : model.chains)
      for (pdb::Residue& residue : chain.residues)
        gemmi::vector_remove_if(residue.atoms, [&, drops = drop(model, chain, residue)](const pdb::Atom& a) {
          if (!drops(a))
            return false;
          ++dropped;
          if (!parsed.pqr.empty() && !std::isnan(parsed.pqr[a.serial].charge))
            charge += parsed.pqr[a.serial].charge;
          return true;
        });
  prune(parsed.structure);
  return dropped;
}

void keep_models(pdb::Structure& st, const std::string& file, const std::string& wanted, PdbReport& report) {
  prune(st);
  report.models_read = static_cast<int64_t>(st.models.size());
  for (const pdb::Model& model : st.models)
    report.read += count_atoms(model);
  if (wanted == "all")
    return;
  if (wanted == "first") {
    st.models.resize(std::min<size_t>(st.models.size(), 1), pdb::Model(""));
  } else {
    std::string names;
    for (size_t m = 0; m < st.models.size() && m < 8; ++m)
      names += (m ? ", " : "") + st.models[m].name;
    if (st.models.size() > 8)
      names += ", …";
    const std::string number = model_number(wanted);
    gemmi::vector_remove_if(st.models, [&](const pdb::Model& m) { return m.name != number; });
    if (st.models.empty())
      fail_input(file + ": found no model " + wanted + ", expected one of " + names);
  }
  report.other_models = report.read;
  for (const pdb::Model& model : st.models)
    report.other_models -= count_atoms(model);
}

/// Residues of one place in the chain: the same number, more than one where the sequence itself has alternatives.
using Place = std::vector<pdb::Residue*>;

/// The conformer of a place: the preferred letter where it is there, otherwise the highest occupancy summed over
/// the place's atoms, the first among equals.
char conformer(const Place& place, const std::string& altloc) {
  std::string letters;
  std::map<char, double> occupancy;
  for (const pdb::Residue* residue : place)
    for (const pdb::Atom& a : residue->atoms)
      if (a.altloc != '\0') {
        if (letters.find(a.altloc) == std::string::npos)
          letters += a.altloc;
        occupancy[a.altloc] += static_cast<double>(a.occ);
      }
  if (letters.empty())
    return '\0';
  if (altloc.size() == 1 && letters.find(altloc[0]) != std::string::npos)
    return altloc[0];
  if (altloc == "first")
    return letters[0];
  char best = letters[0];
  for (const char letter : letters)
    if (occupancy[letter] > occupancy[best] + 1e-6)
      best = letter;
  return best;
}

/// One conformer a place. An atom that is not in the place's conformer stays in its own best one.
int64_t keep_conformer(const Place& place, const std::string& altloc) {
  const char chosen = conformer(place, altloc);
  if (chosen == '\0')
    return 0;
  int64_t dropped = 0;
  for (pdb::Residue* residue : place) {
    std::vector<pdb::Atom>& atoms = residue->atoms;
    const bool has =
        std::any_of(atoms.begin(), atoms.end(), [&](const pdb::Atom& a) { return a.altloc == chosen; });
    const bool all_alternative =
        std::all_of(atoms.begin(), atoms.end(), [](const pdb::Atom& a) { return a.altloc != '\0'; });
    std::vector<pdb::Atom> kept;
    // Of a place with several residues, those that are not in the conformer go as a whole.
    if (place.size() == 1 || has || !all_alternative) {
      std::map<std::string, const pdb::Atom*> best;
      for (const pdb::Atom& a : atoms) {
        if (a.altloc == '\0')
          continue;
        const pdb::Atom*& b = best[a.name];
        if (b == nullptr || (b->altloc != chosen && (a.altloc == chosen || (altloc != "first" && a.occ > b->occ))))
          b = &a;
      }
      for (const pdb::Atom& a : atoms)
        if (a.altloc == '\0' || best[a.name] == &a)
          kept.push_back(a);
    }
    dropped += static_cast<int64_t>(atoms.size() - kept.size());
    atoms = std::move(kept);
  }
  return dropped;
}

bool has_altloc(const pdb::Structure& st, char letter) {
  for (const pdb::Model& model : st.models)
    for (const pdb::Chain& chain : model.chains)
      for (const pdb::Residue& residue : chain.residues)
        for (const pdb::Atom& atom : residue.atoms)
          if (atom.altloc == letter)
            return true;
  return false;
}

bool has_alternatives(const pdb::Residue& residue) {
  return std::any_of(residue.atoms.begin(), residue.atoms.end(),
                     [](const pdb::Atom& a) { return a.altloc != '\0'; });
}

/// Of each residue that has alternatives and a number: the first one with both and the same number. Of others:
/// themselves.
std::vector<uint32_t> first_of_number(const std::vector<pdb::Residue>& residues) {
  std::vector<uint32_t> first(residues.size()), order;
  for (uint32_t r = 0; r < residues.size(); ++r) {
    first[r] = r;
    if (residues[r].seqid.num && has_alternatives(residues[r]))
      order.push_back(r);
  }
  const auto number = [&](uint32_t r) {
    const pdb::Residue& residue = residues[r];
    return std::tuple<int, char, const std::string&>(*residue.seqid.num, residue.seqid.icode, residue.segment);
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const auto of_a = number(a), of_b = number(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  for (size_t i = 1; i < order.size(); ++i)
    if (number(order[i]) == number(order[i - 1]))
      first[order[i]] = first[order[i - 1]];
  return first;
}

/// Calls take(place) for each place of the chain. By number: all of one conformer may come before those of the
/// next. Residues without a number only where they follow each other.
template <class Take>
void for_each_place(std::vector<pdb::Residue>& residues, Take take) {
  const std::vector<uint32_t> first = first_of_number(residues);
  std::vector<uint32_t> place(residues.size()), order(residues.size());
  for (uint32_t r = 0; r < residues.size(); ++r) {
    const bool follows =
        r > 0 && residues[r - 1].seqid == residues[r].seqid && residues[r - 1].segment == residues[r].segment;
    place[r] = first[r] != r ? place[first[r]] : follows ? place[r - 1] : r;
    order[r] = r;
  }
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return std::pair(place[a], a) < std::pair(place[b], b); });
  Place at_place;
  for (size_t i = 0; i < order.size(); ++i) {
    at_place.push_back(&residues[order[i]]);
    if (i + 1 < order.size() && place[order[i + 1]] == place[order[i]])
      continue;
    take(at_place);
    at_place.clear();
  }
}

int64_t keep_conformers(pdb::Structure& st, const std::string& altloc) {
  int64_t dropped = 0;
  for (pdb::Model& model : st.models)
    for (pdb::Chain& chain : model.chains)
      if (std::any_of(chain.residues.begin(), chain.residues.end(), has_alternatives))
        for_each_place(chain.residues, [&](const Place& place) { dropped += keep_conformer(place, altloc); });
  prune(st);
  return dropped;
}

} // namespace

bool is_water(const pdb::Residue& residue) {
  static constexpr std::array<const char*, 17> names = {"HOH", "DOD", "WAT",  "H2O",  "HOD", "OH2",
                                                        "TIP", "TP3", "TP4",  "TP5",  "T3P", "T4P",
                                                        "SOL", "SPC", "TIP3", "TIP4", "TIP5"};
  if (std::none_of(names.begin(), names.end(), [&](const char* n) { return residue.name == n; }))
    return false;
  return std::all_of(residue.atoms.begin(), residue.atoms.end(), [](const pdb::Atom& a) {
    return a.is_hydrogen() || a.element == gemmi::El::O || a.element == gemmi::El::X;
  });
}

void keep(Parsed& parsed, const std::string& file, const PdbOptions& options, PdbReport& report) {
  pdb::Structure& st = parsed.structure;
  const pdb::Label nameless = st.labels.add("_");
  for (pdb::Model& model : st.models)
    for (pdb::Chain& chain : model.chains)
      if (chain.name.empty())
        chain.name = nameless;
  keep_models(st, file, options.model, report);
  if (options.altloc.size() == 1 && !has_altloc(st, options.altloc[0]))
    report.notes.push_back("--altloc " + options.altloc + ": no atom has this letter, as occupancy");
  if (options.altloc != "all")
    report.altlocs = keep_conformers(st, options.altloc);
  PdbReport::Charges& charge = report.dropped_charge;
  using Model = const pdb::Model&;
  using Chain = const pdb::Chain&;
  using Residue = const pdb::Residue&;
  using Atom = const pdb::Atom&;
  if (!options.waters)
    report.waters = drop_atoms(parsed, charge.waters, [](Model, Chain, Residue r) {
      return [water = is_water(r)](Atom) { return water; };
    });
  if (!options.hydrogens)
    report.hydrogens = drop_atoms(parsed, charge.hydrogens,
                                  [](Model, Chain, Residue) { return [](Atom a) { return a.is_hydrogen(); }; });
  if (!options.hetatm)
    report.hetatms = drop_atoms(parsed, charge.hetatms, [&report](Model, Chain c, Residue r) {
      const bool ligand = r.het_flag == 'H' && r.flag != modified_residue && !is_water(r);
      if (ligand)
        report.dropped_hetero[r.name].add(c.name, name_in_hierarchy(r), static_cast<int64_t>(r.atoms.size()));
      return [ligand](Atom) { return ligand; };
    });
  std::vector<std::string> chains;
  std::optional<ResiduesThere> there; // in these chains
  if (options.select != "*") {
    for (const pdb::Model& model : st.models)
      for (const pdb::Chain& chain : model.chains)
        chains.push_back(chain.name);
    const Selection selection(options.select, "--select", false, Status::usage);
    there.emplace(selection.first_number());
    report.unselected = drop_atoms(parsed, charge.unselected, [&](Model m, Chain c, Residue r) {
      const bool chosen = selection.model(m) && selection.chain(c.name, c.name),
                 inside = chosen && selection.residue(r);
      if (chosen && !inside && r.seqid.num)
        there->add(c.name, name_in_hierarchy(r), *r.seqid.num);
      return [&selection, inside](Atom a) { return !(inside && selection.atom(a)); };
    });
  }
  if (!parsed.pqr.empty() && options.own_radii) {
    double none = 0;
    report.no_radius = drop_atoms(parsed, none, [&](Model, Chain, Residue) {
      return [&](Atom a) {
        const Parsed::Values& own = parsed.pqr[a.serial];
        return own.radius == 0 && !(own.charge != 0 && std::isfinite(own.charge));
      };
    });
  }
  if (!st.models.empty())
    return;
  std::string dropped;
  const auto add = [&](int64_t n, const char* what) {
    if (n > 0)
      dropped += (dropped.empty() ? " (dropped: " : ", ") + std::to_string(n) + " " + what;
  };
  add(report.waters, "of waters");
  add(report.hydrogens, "hydrogens");
  add(report.hetatms, "hetero atoms");
  add(report.unselected, "outside --select");
  add(report.no_radius, "of radius 0 without a charge");
  fail_input(file + ": found no atom that is kept" + dropped + (dropped.empty() ? "" : ")") +
             ", expected at least one" +
             (there && !there->text().empty() ? there->text()
              : report.unselected > 0         ? chains_there(chains)
                                              : ""));
}

} // namespace molmesh::formats
