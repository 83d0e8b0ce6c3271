// notes.cpp — one sentence on what is kept, one on what is dropped, then the rest.
#include "formats/pdb/notes.hpp"
#include "molecule/grouping.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::formats {
namespace {

std::string counted(int64_t n, const char* one) {
  return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
}

std::string shortest(double v) {
  std::string s = std::to_string(v);
  s.erase(s.find_last_not_of('0') + 1);
  if (s.back() == '.')
    s.pop_back();
  return s;
}

/// Å, e: to 1e-6, and no sign of zero.
std::string rounded(double v) {
  const std::string s = shortest(v);
  return s == "-0" ? "0" : s;
}

/// The sum that a solver will see. Molecules have whole charges: anything else says that atoms are missing, or that
/// the file has few decimals.
std::string charge_note(const PdbReport& report) {
  std::string note = ", total charge " + rounded(report.charge) + " e";
  if (std::abs(report.charge - std::round(report.charge)) > 0.01)
    note += ", no whole number";
  if (report.charges_alone > 0)
    note += "; " + std::to_string(report.charges_alone) + " of radius 0 are charges without a body";
  return note;
}

/// "//H/373(ANS), NA 2 (first //H/409(NA))": residues alone of their kind as selections, else the kind and how
/// many, where asked for with the first of them. Those of the most atoms first; many, then "and 4 more kinds".
std::string listed(const PdbReport::Heteros& heteros, bool firsts = false) {
  constexpr size_t most = 20, most_firsts = 6;
  std::vector<std::pair<std::string, PdbReport::Hetero>> order(heteros.begin(), heteros.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second.atoms > b.second.atoms; });
  std::string list;
  for (size_t i = 0; i < std::min(order.size(), most); ++i) {
    const auto& [name, kind] = order[i];
    list += i > 0 ? ", " : "";
    list += kind.residues == 1 ? kind.first : name + " " + std::to_string(kind.residues);
    if (kind.residues > 1 && firsts && order.size() <= most_firsts)
      list += " (first " + kind.first + ")";
  }
  if (order.size() > most)
    list += " and " + counted(static_cast<int64_t>(order.size() - most), "more kind");
  return list;
}

} // namespace

void PdbReport::Hetero::add(const std::string& chain, const std::string& residue, int64_t its_atoms) {
  if (residues++ == 0)
    first = residue_in_selection(chain, residue);
  atoms += its_atoms;
}

void add_notes(PdbReport& report, const Parsed& parsed, const PdbOptions& options) {
  std::vector<std::string> notes;
  std::string kept = report.format + ": kept " + counted(report.atoms, "atom") + " in " +
                     counted(report.residues, "residue") + " and " + counted(report.chains, "chain");
  if (options.assembly != "none")
    kept += ", assembly " + options.assembly + " of " + std::to_string(report.copies) +
            (report.copies == 1 ? " copy" : " copies");
  const auto gives = [&](double Parsed::Values::*value) {
    return std::any_of(parsed.pqr.begin(), parsed.pqr.end(), [&](const auto& v) { return !std::isnan(v.*value); });
  };
  const bool radii = options.own_radii && gives(&Parsed::Values::radius), charges = gives(&Parsed::Values::charge);
  if (radii || (charges && options.own_radii))
    kept += std::string(", ") + (radii ? "radii" : "") + (radii && charges ? " and " : "") +
            (charges ? "charges" : "") + " of the file";
  if (charges)
    kept += charge_note(report);
  notes.push_back(kept);
  if (!report.ligands.empty())
    notes.push_back("kept ligands and ions (--hetatm): " + listed(report.ligands, true));
  if (!report.kept_waters.empty())
    notes.push_back("kept waters (--waters): " + listed(report.kept_waters, true));
  if (!report.modified.empty())
    notes.push_back("modified residues, links of the chains: " + listed(report.modified));

  std::string dropped;
  const auto add = [&](int64_t n, const std::string& what, double charge = 0) {
    if (n <= 0)
      return;
    dropped += (dropped.empty() ? "" : ", ") + std::to_string(n) + " " + what;
    if (const std::string e = rounded(charge); e != "0")
      dropped += " with a charge of " + e + " e in all";
  };
  const PdbReport::Charges& charge = report.dropped_charge;
  add(report.other_models, "in other models (" + counted(report.models_read, "model") + " read, --model)");
  add(report.altlocs, "in other alternative locations (--altloc)");
  add(report.waters, "of waters (--waters)", charge.waters);
  add(report.hydrogens, "hydrogens (--hydrogens)", charge.hydrogens);
  add(report.hetatms, "of hetero groups (--hetatm: " + listed(report.dropped_hetero) + ")", charge.hetatms);
  add(report.unselected, "outside --select", charge.unselected);
  add(report.no_radius, "of radius 0 without a charge");
  add(report.unassembled, "in chains outside assembly " + options.assembly, charge.unassembled);
  if (!dropped.empty())
    notes.push_back("dropped atoms: " + dropped);

  if (!report.surface.empty())
    notes.push_back(report.surface);
  for (const auto& [element, unknown] : report.unknown_elements)
    notes.push_back((element == "X" ? "unknown element: " : "element " + element + " without a radius: ") +
                    counted(unknown.atoms, "atom") + " given " + shortest(options.unknown_radius) +
                    " Å (--unknown), the first is " + unknown.first);
  notes.insert(notes.end(), parsed.notes.begin(), parsed.notes.end());
  report.notes.insert(report.notes.begin(), notes.begin(), notes.end());
}

} // namespace molmesh::formats
