// pdb2hier.cpp — atomic structure (PDB, mmCIF, PQR and others) to molecular hierarchy (.hier).
#include "tools/options/pdb2hier.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <sstream>

using namespace molmesh;

namespace {

[[noreturn]] void usage(const std::string& option, const std::string& found, const std::string& expected) {
  fail(Status::usage, option + ": found '" + found + "', expected " + expected);
}

void resolve_domains(const Options& o, formats::PdbOptions& p) {
  using Domains = formats::PdbOptions::Domains;
  for (const std::string& domains : o.domains) {
    const Domains kind = domains == "entity" ? Domains::entity : domains == "copy" ? Domains::copy : Domains::file;
    if (p.domains != Domains::none && (p.domains != kind || kind != Domains::file))
      usage("--domains", domains, "files only, or one of entity and copy");
    p.domains = kind;
    if (kind != Domains::file)
      continue;
    cli::InputFile file(domains);
    const std::vector<DomainPart> parts = read_domains(file.stream(), file.name());
    p.domain_parts.insert(p.domain_parts.end(), parts.begin(), parts.end());
  }
}

void resolve_rules(const Options& o, formats::PdbOptions& p) {
  for (const std::string& resolution : o.resolution) {
    cli::InputFile file(resolution);
    const std::vector<Rule> rules = read_rules(file.stream(), file.name());
    p.rules.insert(p.rules.end(), rules.begin(), rules.end());
  }
  for (const std::string& rule : o.rules)
    p.rules.push_back(parse_rule(rule, "-r '" + rule + "'", Status::usage));
}

void resolve(Options& o) {
  formats::PdbOptions& p = o.pdb;
  p.levels.clear();
  std::istringstream levels(o.levels == "none" ? "" : o.levels + ","); // a last comma is a level without a name
  for (std::string level; std::getline(levels, level, ',');)
    p.levels.push_back(level);
  if (p.select.empty())
    usage("--select", "", "a selection ('*' is everything)");
  const bool number = !p.model.empty() && std::all_of(p.model.begin(), p.model.end(), is_digit);
  if (p.model != "first" && p.model != "all" && !number)
    usage("--model", p.model, "first, all or a number");
  if (p.altloc.size() != 1 && p.altloc != "occupancy" && p.altloc != "first" && p.altloc != "all")
    usage("--altloc", p.altloc, "occupancy, first, all or one letter");
  using Surface = formats::PdbOptions::Surface;
  p.surface = o.surface == "auto"        ? Surface::automatic
              : o.surface == "molecular" ? Surface::molecular
                                         : Surface::plain;
  if (o.surface == "paper")
    p.exponents.residue = 0.5;
  p.hydrogens = o.hydrogens == "keep";
  p.waters = o.waters == "keep";
  p.hetatm = o.hetatm == "keep";
  p.unknown_radius = o.unknown == "refuse" ? 0 : decimal(o.unknown).value_or(-1);
  if (!(p.unknown_radius > 0 && p.unknown_radius <= largest_radius) && o.unknown != "refuse")
    usage("--unknown", o.unknown, "a radius > 0 (Å) or refuse");
  if (o.radii != "bondi") {
    cli::InputFile file(o.radii);
    p.radii = read_radii(file.stream(), file.name());
    p.own_radii = false;
  }
  resolve_domains(o, p);
  resolve_rules(o, p);
}

Status run(Options& o, cli::Run& run) {
  resolve(o);
  run.phase("read");
  cli::InputFile in(o.input);
  cli::OutputFile out(o.output);
  const formats::PdbHierarchy hierarchy(in.stream(), in.name(), o.pdb);
  const formats::PdbReport& r = hierarchy.report();
  run.notes({r.notes.begin() + 1, r.notes.end()});

  run.phase("write");
  hierarchy.write(out.stream());
  run.complete(out);
  run.made = r.notes.front(); // what is kept

  run.counts = {{"atoms_read", r.read},   {"models_read", r.models_read}, {"atoms", r.atoms},
                {"residues", r.residues}, {"chains", r.chains},           {"domains", r.domains},
                {"copies", r.copies}};
  run.counts["dropped"] = {{"other_models", r.other_models}, {"altlocs", r.altlocs}, {"waters", r.waters},
                           {"hydrogens", r.hydrogens},       {"hetatm", r.hetatms},  {"unselected", r.unselected},
                           {"radius_0", r.no_radius}};
  run.counts["dropped"]["outside_assembly"] = r.unassembled;
  run.counts["charge"] = r.charge;
  run.counts["charges_alone"] = r.charges_alone;
  run.counts["dropped_charge"] = r.dropped_charge.all();
  run.counts["passed_over"] = r.passed_over;
  run.counts["guessed_elements"] = r.guessed_elements;
  run.counts["unknown_elements"] = cli::Value();
  for (const auto& [element, unknown] : r.unknown_elements)
    run.counts["unknown_elements"][element] = unknown.atoms;
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>(
      "pdb2hier", "Atomic structure (PDB, mmCIF, PQR and others; plain or gzip) to molecular hierarchy.", argc,
      argv, describe, run);
}
