// arrangement.cpp — domains, exponents and order.
#include "formats/pdb/arrangement.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <map>
#include <numeric>

namespace molmesh::formats {
namespace {

const Flat::Residue& residue_of(const Arrangement& a, size_t item) {
  return a.flat.residue[a.items[item].residue];
}

/// "A/GLY:12/CA": what a message calls an atom.
std::string address(const Arrangement& a, size_t item, int64_t atom) {
  const gemmi::Residue& r = *residue_of(a, item).source;
  return a.placed[a.items[item].placed].name + "/" + r.name + ":" + r.seqid.str() + "/" +
         a.flat.names[a.flat.atom[atom].name];
}
std::string address(const Arrangement& a, size_t item) {
  return address(a, item, residue_of(a, item).begin);
}

/// The parts of a domain file, each residue in exactly one.
void domains_from_parts(Arrangement& a, const std::vector<DomainPart>& parts) {
  constexpr int32_t none = -1;
  std::map<std::string, int32_t> index;
  std::vector<const DomainPart*> part_of(a.items.size(), nullptr);
  for (Item& item : a.items)
    item.domain = none;
  for (const DomainPart& part : parts) {
    const auto [domain, is_new] = index.try_emplace(part.name, static_cast<int32_t>(a.domains.size()));
    if (is_new)
      a.domains.push_back(part.name);
    const Selection selection(part.selection, part.where);
    const std::vector<uint8_t> touched = touch(selection, a);
    bool any = false;
    for (size_t i = 0; i < a.items.size(); ++i) {
      if (touched[i] == 0)
        continue;
      any = true;
      if (touched[i] == 1) {
        const Flat::Residue& residue = residue_of(a, i);
        int64_t outside = residue.begin;
        while (selection.atom(residue.source->atoms[outside - residue.begin]))
          ++outside;
        fail_input(part.where + ": found atom " + address(a, i, outside) + " outside domain '" + part.name +
                   "' that holds other atoms of its residue, expected whole residues");
      }
      if (a.items[i].domain != none && a.items[i].domain != domain->second)
        fail_input(part.where + ": found atom " + address(a, i) + " in domains '" + part_of[i]->name + "' (" +
                   part_of[i]->where + ") and '" + part.name + "', expected exactly one");
      a.items[i].domain = domain->second;
      part_of[i] = &part;
    }
    if (!any)
      fail_input(part.where + ": found no atom in '" + part.selection + "', expected some in domain '" + part.name +
                 "'");
  }
  const auto left =
      std::find_if(a.items.begin(), a.items.end(), [](const Item& item) { return item.domain == none; });
  if (left != a.items.end())
    fail_input(parts.front().where.substr(0, parts.front().where.rfind(':')) + ": found atom " +
               address(a, static_cast<size_t>(left - a.items.begin())) +
               " in no domain, expected each in exactly one");
}

/// The entity of a chain is that of its polymer, or of its first residue.
std::string entity_of(const gemmi::Structure& st, const gemmi::Chain& chain) {
  const auto polymer = std::find_if(chain.residues.begin(), chain.residues.end(), [](const gemmi::Residue& r) {
    return r.entity_type == gemmi::EntityType::Polymer;
  });
  const gemmi::Residue& residue = polymer == chain.residues.end() ? chain.residues.front() : *polymer;
  for (const gemmi::Entity& entity : st.entities)
    if (gemmi::in_vector(residue.subchain, entity.subchains))
      return "entity_" + entity.name;
  return "entity_none";
}

} // namespace

std::vector<Item> list_items(const std::vector<Placed>& placed) {
  std::vector<Item> items;
  size_t count = 0;
  for (const Placed& p : placed)
    count += p.residues->size();
  items.reserve(count);
  for (size_t p = 0; p < placed.size(); ++p)
    for (const int64_t r : *placed[p].residues)
      items.push_back({static_cast<int32_t>(p), static_cast<int32_t>(r)});
  return items;
}

void assign_domains(Arrangement& a, const gemmi::Structure& st, const std::string& file,
                    const PdbOptions& options) {
  if (options.domains == PdbOptions::Domains::none)
    return;
  if (options.domains == PdbOptions::Domains::file) {
    domains_from_parts(a, options.domain_parts);
  } else {
    std::map<std::string, int32_t> index;
    for (Item& item : a.items) {
      const Placed& p = a.placed[item.placed];
      const std::string name = options.domains == PdbOptions::Domains::copy
                                   ? "copy_" + std::to_string(p.copy)
                                   : entity_of(st, *a.flat.chain[p.chain].source);
      const auto [domain, is_new] = index.try_emplace(name, static_cast<int32_t>(a.domains.size()));
      if (is_new)
        a.domains.push_back(name);
      item.domain = domain->second;
    }
  }
  const auto level = [&](const char* name) {
    return std::find(options.levels.begin(), options.levels.end(), name);
  };
  if (level("chain") == options.levels.end() || level("chain") < level("domain"))
    return;
  std::vector<int64_t> first(a.placed.size(), -1);
  for (size_t i = 0; i < a.items.size(); ++i) {
    int64_t& f = first[a.items[i].placed];
    if (f < 0)
      f = static_cast<int64_t>(i);
    const auto other = static_cast<size_t>(f);
    if (a.items[other].domain != a.items[i].domain)
      fail_input(file + ": found chain " + a.placed[a.items[i].placed].name + " in domains '" +
                 a.domains[a.items[other].domain] + "' (" + address(a, other) + ") and '" +
                 a.domains[a.items[i].domain] + "' (" + address(a, i) +
                 "), expected each chain in one domain; --levels chain,domain,residue has domains within chains");
  }
}

void assign_exponents(Arrangement& a, const PdbOptions& options, PdbReport& report) {
  a.residue_exponent.assign(a.items.size(), options.exponents.residue);
  a.chain_exponent.assign(a.placed.size(), options.exponents.chain);
  a.domain_exponent.assign(a.domains.size(), options.exponents.domain);
  const auto has = [&](const char* level) {
    return std::find(options.levels.begin(), options.levels.end(), level) != options.levels.end();
  };
  for (const Rule& rule : options.rules) {
    const std::vector<uint8_t> touched = touch(Selection(rule.selection, rule.where, true, rule.blame), a);
    bool any = false;
    for (size_t i = 0; i < a.items.size(); ++i) {
      if (touched[i] == 0)
        continue;
      any = true;
      if (rule.residue)
        a.residue_exponent[i] = *rule.residue;
      if (rule.chain)
        a.chain_exponent[a.items[i].placed] = *rule.chain;
      if (rule.domain && !a.domains.empty())
        a.domain_exponent[a.items[i].domain] = *rule.domain;
    }
    if (!any)
      fail_input(rule.where + ": found no atom in selection '" + rule.selection + "', expected some");
    if (!(rule.residue && has("residue")) && !(rule.chain && has("chain")) && !(rule.domain && has("domain")))
      fail_input(rule.where +
                 ": found exponents that have no effect alone, expected one of a level that --levels has");
    const auto idle = [&](const std::optional<double>& exponent, const char* name, const char* level) {
      if (exponent && !has(level))
        report.notes.push_back(rule.where + ": " + name + " has no effect, --levels has no " + level);
    };
    idle(rule.residue, "P_R", "residue");
    idle(rule.chain, "P_C", "chain");
    idle(rule.domain, "P_D", "domain");
  }
}

void sort_items(Arrangement& a, const std::vector<std::string>& levels) {
  a.order.resize(a.items.size());
  std::iota(a.order.begin(), a.order.end(), 0);
  const auto domain = std::find(levels.begin(), levels.end(), "domain");
  if (domain == levels.end())
    return;
  const bool within_chain = std::find(levels.begin(), domain, "chain") != domain;
  std::stable_sort(a.order.begin(), a.order.end(), [&](int32_t i, int32_t j) {
    const Item &x = a.items[i], &y = a.items[j];
    if (within_chain && x.placed != y.placed)
      return x.placed < y.placed;
    return x.domain < y.domain;
  });
}

} // namespace molmesh::formats
