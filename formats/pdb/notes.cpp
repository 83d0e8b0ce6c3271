// notes.cpp — one sentence on what is kept, one on what is dropped, then the rest.
#include "formats/pdb/notes.hpp"
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

} // namespace

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
  notes.push_back(kept);

  std::string dropped;
  const auto add = [&](int64_t n, const std::string& what) {
    if (n > 0)
      dropped += (dropped.empty() ? "" : ", ") + std::to_string(n) + " " + what;
  };
  add(report.other_models, "in other models (" + counted(report.models_read, "model") + " read, --model)");
  add(report.altlocs, "in other alternative locations (--altloc)");
  add(report.waters, "of waters (--waters)");
  add(report.hydrogens, "hydrogens (--hydrogens)");
  add(report.hetatms, "of hetero groups (--hetatm)");
  add(report.unselected, "outside --select");
  add(report.no_radius, "of radius 0, with a charge of " + shortest(report.no_radius_charge) + " e in all");
  add(report.unassembled, "in chains outside assembly " + options.assembly);
  if (!dropped.empty())
    notes.push_back("dropped atoms: " + dropped);

  for (const auto& [element, unknown] : report.unknown_elements)
    notes.push_back((element == "X" ? "unknown element: " : "element " + element + " without a radius: ") +
                    counted(unknown.atoms, "atom") + " given " + shortest(options.unknown_radius) +
                    " Å (--unknown), the first is " + unknown.first);
  notes.insert(notes.end(), parsed.notes.begin(), parsed.notes.end());
  report.notes.insert(report.notes.begin(), notes.begin(), notes.end());
}

} // namespace molmesh::formats
