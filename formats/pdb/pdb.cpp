// pdb.cpp — from the bytes of a structure file to the groups of a .hier: domains, exponents, order.
#include "formats/pdb/pdb.hpp"
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/hier/text.hpp"
#include "formats/pdb/arrangement.hpp"
#include "formats/pdb/chains.hpp"
#include "formats/pdb/gunzip.hpp"
#include "formats/pdb/keep.hpp"
#include "formats/pdb/notes.hpp"
#include "formats/pdb/polymer.hpp"
#include "formats/pdb/sha256.hpp"
#include "formats/read_all.hpp"
#include "molecule/molecular_body.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <istream>

namespace molmesh::formats {

struct PdbHierarchy::Parts {
  PdbReport report;
  std::string source;
  std::vector<std::string> levels;
  Parsed parsed;
  Arrangement arrangement;
  std::vector<int32_t> order; ///< of the residues in the output
};

namespace {

/// Domains by entity, and selections that say ";polymer" or ";solvent".
bool needs_entities(const PdbOptions& o) {
  const auto asks = [](const auto& part) { return part.selection.find(';') != std::string::npos; };
  return o.domains == PdbOptions::Domains::entity || o.select.find(';') != std::string::npos ||
         std::any_of(o.rules.begin(), o.rules.end(), asks) ||
         std::any_of(o.domain_parts.begin(), o.domain_parts.end(), asks);
}

void set_domains(Arrangement& a, const pdb::Structure& st, const std::string& file, const PdbOptions& options) {
  const ArrangementSelections selections(a);
  switch (options.domains) {
  case PdbOptions::Domains::none:
    return;
  case PdbOptions::Domains::file:
    molmesh::set_domains(a.grouping, options.domain_parts, selections);
    break;
  case PdbOptions::Domains::entity:
    molmesh::set_domains(a.grouping, domains_by_entity(a, st));
    break;
  case PdbOptions::Domains::copy:
    molmesh::set_domains(a.grouping, domains_by_copy(a));
  }
  check_domains(a.grouping, options.levels, file, selections);
}

bool has_own_radii(const Parsed& parsed, const PdbOptions& options) {
  return options.own_radii && std::any_of(parsed.pqr.begin(), parsed.pqr.end(),
                                          [](const Parsed::Values& v) { return !std::isnan(v.radius); });
}

/// Counts the bodies of all residues, and chooses by the hydrogens among them.
Exponents default_exponents(Arrangement& a, const Parsed& parsed, const PdbOptions& options, PdbReport& report) {
  Exponents e = options.exponents;
  if (options.surface == PdbOptions::Surface::plain || !has_level(options.levels, "residue"))
    return e;
  int64_t hydrogens = 0, carbons = 0, heavy = 0;
  for (int64_t r = 0; r < static_cast<int64_t>(a.grouping.residue.size()); ++r) {
    int32_t bodies = 0, h = 0, c = 0;
    for (int64_t n = a.residue(r).begin; n < a.residue(r).end; ++n) {
      const Atom& atom = a.flat.atom[n];
      const std::string& element = a.flat.names[atom.element];
      const bool body = atom.radius > 0;
      bodies += body;
      h += body && (element == "H" || element == "D");
      c += body && element == "C";
    }
    a.grouping.residue[r].bodies = bodies;
    if (c == 0)
      continue; // waters and ions do not tell
    hydrogens += h;
    carbons += c;
    heavy += bodies - h;
  }
  const Hydrogens kind = hydrogens_of(hydrogens, carbons, heavy);
  if (carbons == 0 || (options.surface == PdbOptions::Surface::automatic && kind == Hydrogens::none &&
                       !has_own_radii(parsed, options)))
    return e;
  const ResidueSettings body = molecular_body(kind);
  e.residue = body.exponent;
  e.weight = body.weight;
  char text[160];
  std::snprintf(text, sizeof text, "%s: a body near the molecular surface, P_R %g, W_R %g%s (--surface)",
                name_of(kind).c_str(), e.residue, e.weight,
                options.rules.empty() ? "" : " where no rule says otherwise");
  report.surface = text;
  return e;
}

} // namespace

PdbHierarchy::PdbHierarchy(std::istream& in, const std::string& name, const PdbOptions& options)
    : parts_(std::make_unique<Parts>()) {
  check_levels(options.levels, options.domains != PdbOptions::Domains::none);
  Parts& p = *parts_;
  p.levels = options.levels;
  {
    std::string bytes = read_all(in, name);
    percent_encode(p.source, name == "<stdin>" ? "stdin" : name.substr(name.rfind('/') + 1));
    p.source += " sha256:" + sha256(bytes);
    if (is_gzip(bytes))
      bytes = gunzip(bytes, name);
    p.parsed = parse_structure(std::move(bytes), name, options.format, options.assembly);
  }
  p.report.format = p.parsed.format;
  p.report.passed_over = p.parsed.passed_over;
  p.report.guessed_elements = p.parsed.guessed;
  pdb::Structure& st = p.parsed.structure;
  merge_chain_parts(st);
  mark_modified_residues(st, p.parsed.format == "PDB");
  if (needs_entities(options))
    pdb::set_up_entities(st);
  keep(p.parsed, name, options, p.report);

  Arrangement& a = p.arrangement;
  // Selections ask for atoms, and what is wrong with domains is said by one.
  const bool let_go = options.rules.empty() && options.domains == PdbOptions::Domains::none;
  a.flat = flatten(p.parsed, name, options, let_go, p.report);
  a.placed = place(a.flat, st, name, options.assembly, p.report);
  list_residues(a);
  set_domains(a, st, name, options);
  const Exponents exponents = default_exponents(a, p.parsed, options, p.report);
  set_exponents(a.grouping, exponents, options.rules, options.levels, ArrangementSelections(a), p.report.notes);
  p.order = hierarchy_order(a.grouping, options.levels);

  p.report.chains = static_cast<int64_t>(a.grouping.chain.size());
  p.report.residues = static_cast<int64_t>(a.grouping.residue.size());
  p.report.domains = static_cast<int64_t>(a.grouping.domain.size());
  for (int64_t r = 0; r < p.report.residues; ++r) {
    p.report.atoms += a.residue(r).end - a.residue(r).begin;
    const pdb::Residue& source = *a.residue(r).source;
    if (const bool water = options.waters && is_water(source);
        water || (source.het_flag == 'H' && !source.is_water())) {
      PdbReport::Heteros& kind = water                             ? p.report.kept_waters
                                 : source.flag == modified_residue ? p.report.modified
                                                                   : p.report.ligands;
      kind[source.name].add(a.grouping.chain[a.grouping.residue[r].chain], name_in_hierarchy(source),
                            a.residue(r).end - a.residue(r).begin);
    }
    for (int64_t n = a.residue(r).begin; n < a.residue(r).end; ++n) {
      p.report.charge += std::isnan(a.flat.atom[n].charge) ? 0 : a.flat.atom[n].charge;
      p.report.charges_alone += a.flat.atom[n].radius == 0;
    }
  }
  if (p.report.charges_alone == p.report.atoms)
    fail_input(name + ": found no atom of a radius > 0 that is kept, expected at least one");
  add_notes(p.report, p.parsed, options);
}

PdbHierarchy::~PdbHierarchy() = default;

const PdbReport& PdbHierarchy::report() const {
  return parts_->report;
}

void PdbHierarchy::write(std::ostream& out) const {
  const Arrangement& a = parts_->arrangement;
  const Grouping& g = a.grouping;
  const std::vector<std::string>& levels = parts_->levels;
  const bool weights = has_level(levels, "residue") && std::any_of(g.residue_weight.begin(), g.residue_weight.end(),
                                                                   [](double w) { return w != 1; });
  HierWriter writer(out, parts_->source, levels,
                    report().charges_alone > 0 || weights ? HierWriter::Version::v2 : HierWriter::Version::v1);
  std::vector<int32_t> open(levels.size(), -1);
  std::string residue_name;
  for (const int32_t r : parts_->order) {
    const int32_t chain = g.residue[r].chain, domain = g.residue[r].domain;
    const Placed& placed = a.placed[chain];
    const Flat::Residue& residue = a.residue(r);
    bool opened = false;
    for (size_t l = 0; l < levels.size(); ++l) {
      const bool is_residue = levels[l] == "residue", is_chain = levels[l] == "chain";
      const int32_t id = is_residue ? r : is_chain ? chain : domain;
      if (id == open[l] && !opened)
        continue;
      opened = true;
      open[l] = id;
      if (is_residue) {
        residue_name = name_in_hierarchy(*residue.source);
        writer.group(l, residue_name, g.residue_exponent[r], g.residue_weight[r]);
      } else if (is_chain) {
        writer.group(l, g.chain[chain], g.chain_exponent[chain]);
      } else {
        writer.group(l, g.domain[domain], g.domain_exponent[domain]);
      }
    }
    for (int64_t n = residue.begin; n < residue.end; ++n) {
      const Atom& atom = a.flat.atom[n];
      writer.atom(a.flat.names[atom.name], a.flat.names[atom.element], placed.position(atom.center), atom.radius,
                  atom.charge);
    }
  }
  writer.finish();
}

} // namespace molmesh::formats
