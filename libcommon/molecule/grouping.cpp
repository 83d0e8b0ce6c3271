// grouping.cpp — reads domains, assigns residues to them and sorts residues by their groups.
#include "molecule/grouping.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <cctype>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

namespace molmesh {
namespace {

class DomainIndex {
public:
  explicit DomainIndex(Grouping& g) : g_(g) {}
  int32_t of(const std::string& name) {
    const auto [domain, is_new] = index_.try_emplace(name, static_cast<int32_t>(g_.domain.size()));
    if (is_new)
      g_.domain.push_back(name);
    return domain->second;
  }

private:
  Grouping& g_;
  std::map<std::string, int32_t> index_;
};

/// Is there a level `outer`, with `inner` within it?
bool holds(const Levels& levels, const char* outer, const char* inner) {
  const auto at = std::find(levels.begin(), levels.end(), outer);
  return std::find(at, levels.end(), inner) != levels.end();
}

} // namespace

bool has_level(const Levels& levels, const std::string& level) {
  return std::find(levels.begin(), levels.end(), level) != levels.end();
}

void check_levels(const Levels& levels, bool domains_are_defined) {
  const auto refuse = [](const std::string& what) { fail(Status::usage, what, {"levels"}); };
  for (auto level = levels.begin(); level != levels.end(); ++level) {
    if (*level != "domain" && *level != "chain" && *level != "residue")
      refuse("levels: found '" + *level + "', expected domain, chain or residue");
    if (std::find(levels.begin(), level, *level) != level)
      refuse("levels: found '" + *level + "' twice, expected each level once");
    if (*level == "residue" && level + 1 != levels.end())
      refuse("levels: found a level within 'residue', expected it innermost");
  }
  if (has_level(levels, "domain") && !domains_are_defined)
    fail(Status::usage, "levels has 'domain', expected domains to be defined, too", {"levels", "domains"});
  if (!has_level(levels, "domain") && domains_are_defined)
    fail(Status::usage, "found domains, expected 'domain' among the levels", {"domains", "levels"});
}

std::vector<DomainPart> read_domains(std::istream& in, const std::string& file) {
  std::vector<DomainPart> parts;
  read_lines(in, file, [&](const std::string& line, const std::string& where) {
    const size_t blank = line.find_first_of(" \t");
    if (blank == std::string::npos)
      fail_input(where + ": found '" + line + "', expected NAME SELECTION");
    parts.push_back({line.substr(0, blank), std::string(trimmed(std::string_view(line).substr(blank))), where});
  });
  if (parts.empty())
    fail_input(file + ": found no domain, expected lines NAME SELECTION");
  return parts;
}

void set_domains(Grouping& g, const std::vector<DomainPart>& parts, const StructureSelections& structure) {
  constexpr int32_t none = -1;
  DomainIndex index(g);
  std::vector<const DomainPart*> part_of(g.residue.size(), nullptr);
  for (Grouping::Residue& residue : g.residue)
    residue.domain = none;
  for (const DomainPart& part : parts) {
    const int32_t domain = index.of(part.name);
    const std::vector<Selected> selected = structure.select(part.selection, part.where, false, Status::bad_input);
    bool any = false;
    for (size_t r = 0; r < g.residue.size(); ++r) {
      if (selected[r] == Selected::none)
        continue;
      any = true;
      if (selected[r] == Selected::some)
        fail_input(part.where + ": found atom " +
                   structure.first_atom_outside(static_cast<int64_t>(r), part.selection, part.where) +
                   " outside domain '" + part.name +
                   "' that holds other atoms of its residue, expected whole residues");
      if (g.residue[r].domain != none && g.residue[r].domain != domain)
        fail_input(part.where + ": found atom " + structure.first_atom(static_cast<int64_t>(r)) + " in domains '" +
                   part_of[r]->name + "' (" + part_of[r]->where + ") and '" + part.name +
                   "', expected exactly one");
      g.residue[r].domain = domain;
      part_of[r] = &part;
    }
    if (!any)
      fail_input(part.where + ": found no atom in '" + part.selection + "', expected some in domain '" + part.name +
                 "'" + chains_there(g.chain));
  }
  const auto left = std::find_if(g.residue.begin(), g.residue.end(),
                                 [](const Grouping::Residue& residue) { return residue.domain == none; });
  if (left != g.residue.end())
    fail_input(parts.front().where.substr(0, parts.front().where.rfind(':')) + ": found atom " +
               structure.first_atom(left - g.residue.begin()) + " in no domain, expected each in exactly one");
}

void set_domains(Grouping& g, const std::vector<std::string>& domain_of_chain) {
  DomainIndex index(g);
  for (Grouping::Residue& residue : g.residue)
    residue.domain = index.of(domain_of_chain[residue.chain]);
}

void check_domains(const Grouping& g, const Levels& levels, const std::string& file,
                   const StructureSelections& structure) {
  if (!holds(levels, "domain", "chain"))
    return;
  constexpr int64_t none = -1;
  std::vector<int64_t> first(g.chain.size(), none); // residue of each chain
  for (size_t r = 0; r < g.residue.size(); ++r) {
    const Grouping::Residue& residue = g.residue[r];
    int64_t& f = first[residue.chain];
    if (f == none)
      f = static_cast<int64_t>(r);
    if (g.residue[f].domain != residue.domain)
      fail_input(
          file + ": found chain " + g.chain[residue.chain] + " in domains '" + g.domain[g.residue[f].domain] +
          "' (" + structure.first_atom(f) + ") and '" + g.domain[residue.domain] + "' (" +
          structure.first_atom(static_cast<int64_t>(r)) +
          "), expected each chain in one domain; the levels domain,residue have domains that share chains, as a "
          "ligand's in the protein's chain; chain,domain,residue domains within chains");
  }
}

std::vector<int32_t> hierarchy_order(const Grouping& g, const Levels& levels) {
  std::vector<int32_t> order(g.residue.size());
  std::iota(order.begin(), order.end(), 0);
  if (!has_level(levels, "domain"))
    return order;
  const bool within_chain = holds(levels, "chain", "domain");
  std::stable_sort(order.begin(), order.end(), [&](int32_t i, int32_t j) {
    const Grouping::Residue &x = g.residue[i], &y = g.residue[j];
    if (within_chain && x.chain != y.chain)
      return x.chain < y.chain;
    return x.domain < y.domain;
  });
  return order;
}

std::string in_selection(const std::string& name) {
  if (name.find_first_of("/,;:*![]()\" ") == std::string::npos)
    return name;
  std::string quoted = "\"";
  for (const char c : name)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

namespace {

/// "12", "-3", "45A".
bool is_number_of_residue(std::string_view text) {
  if (text.substr(0, 1) == "-")
    text.remove_prefix(1);
  const size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  return digits > 0 && (digits == text.size() ||
                        (digits + 1 == text.size() && std::isalpha(static_cast<unsigned char>(text[digits]))));
}

} // namespace

std::string residue_in_selection(const std::string& chain, const std::string& residue) {
  const size_t colon = residue.rfind(':');
  std::string number = colon == std::string::npos ? "" : residue.substr(colon + 1);
  if (!is_number_of_residue(number))
    number = "";
  else if (number[0] == '-') // alone it is all up to that number
    number += '-' + number;
  return "//" + (chain.empty() ? "*" : in_selection(chain)) + '/' + number + '(' +
         in_selection(residue.substr(0, colon)) + ')';
}

std::string chains_there(const std::vector<std::string>& names) {
  constexpr size_t most = 20;
  std::vector<std::string> distinct;
  std::set<std::string> seen;
  for (const std::string& name : names)
    if (seen.insert(name).second)
      distinct.push_back(name);
  if (distinct.empty())
    return "";
  std::string text = "; chains here: ";
  for (size_t i = 0; i < std::min(most, distinct.size()); ++i)
    text += (i > 0 ? ", " : "") + in_selection(distinct[i]);
  if (distinct.size() > most)
    text += " and " + std::to_string(distinct.size() - most) + " more";
  const std::string first = "'//" + in_selection(distinct[0]);
  return text + " (for example " + first + "', " + first + "/45-60', " + first + "/(HEM)')";
}

} // namespace molmesh
