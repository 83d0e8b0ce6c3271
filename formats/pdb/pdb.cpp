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
#include "formats/pdb/sha256.hpp"
#include "formats/read_all.hpp"
#include <algorithm>
#include <gemmi/polyheur.hpp>
#include <istream>

namespace molmesh::formats {

struct PdbHierarchy::Parts {
  PdbReport report;
  std::string source;
  std::vector<std::string> levels;
  Parsed parsed;
  Arrangement arrangement;
};

namespace {

bool has(const std::vector<std::string>& levels, const char* name) {
  return std::find(levels.begin(), levels.end(), name) != levels.end();
}

/// Domains by entity, and selections that say ";polymer" or ";solvent".
bool needs_entities(const PdbOptions& o) {
  const auto asks = [](const auto& part) { return part.selection.find(';') != std::string::npos; };
  return o.domains == PdbOptions::Domains::entity || o.select.find(';') != std::string::npos ||
         std::any_of(o.rules.begin(), o.rules.end(), asks) ||
         std::any_of(o.domain_parts.begin(), o.domain_parts.end(), asks);
}

void check_options(const PdbOptions& o) {
  const auto refuse = [](const std::string& what) { fail(Status::usage, what); };
  for (size_t l = 0; l < o.levels.size(); ++l) {
    const std::string& level = o.levels[l];
    if (level != "domain" && level != "chain" && level != "residue")
      refuse("--levels: found '" + level + "', expected domain, chain or residue");
    if (std::find(o.levels.begin(), o.levels.begin() + static_cast<std::ptrdiff_t>(l), level) !=
        o.levels.begin() + static_cast<std::ptrdiff_t>(l))
      refuse("--levels: found '" + level + "' twice, expected each level once");
    if (level == "residue" && l + 1 != o.levels.size())
      refuse("--levels: found a level within 'residue', expected it innermost");
  }
  if (has(o.levels, "domain") && o.domains == PdbOptions::Domains::none)
    refuse("--levels has 'domain', expected --domains too");
  if (!has(o.levels, "domain") && o.domains != PdbOptions::Domains::none)
    refuse("--domains is given, expected 'domain' in --levels");
}

} // namespace

PdbHierarchy::PdbHierarchy(std::istream& in, const std::string& name, const PdbOptions& options)
    : parts_(std::make_unique<Parts>()) {
  check_options(options);
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
  gemmi::Structure& st = p.parsed.structure;
  merge_chain_parts(st);
  if (needs_entities(options))
    gemmi::setup_entities(st);
  keep(p.parsed, name, options, p.report);

  Arrangement& a = p.arrangement;
  a.flat = flatten(p.parsed, name, options, p.report);
  a.placed = place(a.flat, st, name, options.assembly, p.report);
  a.items = list_items(a.placed);
  assign_domains(a, st, name, options);
  assign_exponents(a, options, p.report);
  sort_items(a, options.levels);

  p.report.chains = static_cast<int64_t>(a.placed.size());
  p.report.residues = static_cast<int64_t>(a.items.size());
  p.report.domains = static_cast<int64_t>(a.domains.size());
  for (const Item& item : a.items) {
    const Flat::Residue& r = a.flat.residue[item.residue];
    p.report.atoms += r.end - r.begin;
  }
  add_notes(p.report, p.parsed, options);
}

PdbHierarchy::~PdbHierarchy() = default;

const PdbReport& PdbHierarchy::report() const {
  return parts_->report;
}

void PdbHierarchy::write(std::ostream& out) const {
  const Arrangement& a = parts_->arrangement;
  const std::vector<std::string>& levels = parts_->levels;
  HierWriter writer(out, parts_->source, levels);
  std::vector<int32_t> open(levels.size(), -1);
  std::string residue_name;
  for (const int32_t i : a.order) {
    const Item& item = a.items[i];
    const Placed& placed = a.placed[item.placed];
    const Flat::Residue& residue = a.flat.residue[item.residue];
    bool opened = false;
    for (size_t l = 0; l < levels.size(); ++l) {
      const bool is_residue = levels[l] == "residue", is_chain = levels[l] == "chain";
      const int32_t id = is_residue ? i : is_chain ? item.placed : item.domain;
      if (id == open[l] && !opened)
        continue;
      opened = true;
      open[l] = id;
      if (is_residue) {
        residue_name = residue.source->name + ":" + residue.source->seqid.str();
        writer.group(l, residue_name, a.residue_exponent[i]);
      } else if (is_chain) {
        writer.group(l, placed.name, a.chain_exponent[item.placed]);
      } else {
        writer.group(l, a.domains[item.domain], a.domain_exponent[item.domain]);
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
