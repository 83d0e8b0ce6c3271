// exponents.cpp — parses rules and applies them to the groups.
#include "molecule/exponents.hpp"
#include "molecule/limits.hpp"
#include "molecule/molecular_body.hpp"
#include "molecule/words.hpp"
#include <cstdio>

namespace molmesh {

Rule parse_rule(const std::string& text, const std::string& where, Status status) {
  Rule rule;
  rule.where = where;
  rule.blame = status;
  std::string_view rest = trimmed(text);
  // The exponents stand at the end; what is before them is the selection, blanks and all.
  for (;;) {
    const size_t blank = rest.find_last_of(" \t");
    const std::string_view last = blank == std::string_view::npos ? rest : rest.substr(blank + 1);
    if (last.substr(0, 2) != "P_" && last.substr(0, 4) != "W_R=")
      break;
    const std::string_view key = last.substr(0, 4);
    std::optional<double>* exponent = key == "P_R="   ? &rule.residue
                                      : key == "P_C=" ? &rule.chain
                                      : key == "P_D=" ? &rule.domain
                                      : key == "W_R=" ? &rule.weight
                                                      : nullptr;
    const std::string found = where + ": found '" + std::string(last) + "', expected ";
    if (exponent == nullptr)
      fail(status, found + "P_R=…, W_R=…, P_C=… or P_D=…");
    if (*exponent)
      fail(status, found + "each exponent once");
    *exponent = decimal(last.substr(4));
    if (!*exponent || **exponent <= 0)
      fail(status, found + "a number > 0");
    if (**exponent > largest_exponent)
      fail(status, found + "at most 1000");
    if (exponent != &rule.weight && **exponent < least_exponent)
      fail(status, found + "at least 0.0001");
    if (exponent == &rule.weight && **exponent < least_weight)
      fail(status, found + "at least 0.001");
    rest = blank == std::string_view::npos ? std::string_view{} : trimmed(rest.substr(0, blank));
  }
  if (!rule.residue && !rule.chain && !rule.domain && !rule.weight)
    fail(status,
         where + ": found '" + text + "', expected SELECTION P_R=… W_R=… P_C=… P_D=…, at least one of them");
  if (rest.empty())
    fail(status, where + ": found no selection, expected SELECTION P_R=… W_R=… P_C=… P_D=… ('*' is everything)");
  for (const char* exponent : {"P_R=", "P_C=", "P_D=", "W_R="})
    if (rest.find(exponent) != std::string_view::npos)
      fail(status, where + ": found '" + text + "', expected exponents at the end alone");
  rule.selection = rest;
  return rule;
}

std::vector<Rule> read_rules(std::istream& in, const std::string& file) {
  std::vector<Rule> rules;
  read_lines(in, file,
             [&](const std::string& line, const std::string& where) { rules.push_back(parse_rule(line, where)); });
  return rules;
}

namespace {

/// Exponents of groups within each other.
void check_products(const Grouping& g, const Levels& levels) {
  const bool residues = has_level(levels, "residue"), chains = has_level(levels, "chain"),
             domains = has_level(levels, "domain") && !g.domain.empty();
  for (size_t r = 0; r < g.residue.size(); ++r) {
    const double product = (residues ? g.residue_exponent[r] : 1) *
                           (chains ? g.chain_exponent[g.residue[r].chain] : 1) *
                           (domains ? g.domain_exponent[g.residue[r].domain] : 1);
    if (product >= least_exponent && product <= largest_exponent)
      continue;
    char text[120];
    std::snprintf(text, sizeof text, "found exponents whose product is %g in chain ", product);
    fail(Status::usage, text + g.chain[g.residue[r].chain] + ", expected 0.0001 to 1000", {"rule"});
  }
}

} // namespace

void set_exponents(Grouping& g, const Exponents& defaults, const std::vector<Rule>& rules, const Levels& levels,
                   const StructureSelections& structure, std::vector<std::string>& notes) {
  g.residue_exponent.assign(g.residue.size(), defaults.residue);
  g.residue_weight.clear();
  for (const Grouping::Residue& residue : g.residue)
    g.residue_weight.push_back(residue_weight(defaults.weight, residue.bodies));
  g.chain_exponent.assign(g.chain.size(), defaults.chain);
  g.domain_exponent.assign(g.domain.size(), defaults.domain);
  for (const Rule& rule : rules) {
    const std::vector<Selected> selected = structure.select(rule.selection, rule.where, true, rule.blame);
    bool any = false;
    for (size_t r = 0; r < g.residue.size(); ++r) {
      if (selected[r] == Selected::none)
        continue;
      any = true;
      if (rule.residue)
        g.residue_exponent[r] = *rule.residue;
      if (rule.residue || rule.weight)
        g.residue_weight[r] = residue_weight(rule.weight.value_or(1), g.residue[r].bodies);
      if (rule.chain)
        g.chain_exponent[g.residue[r].chain] = *rule.chain;
      if (rule.domain && !g.domain.empty())
        g.domain_exponent[g.residue[r].domain] = *rule.domain;
    }
    if (!any)
      fail_input(rule.where + ": found no atom in selection '" + rule.selection + "', expected some" +
                 chains_there(g.chain));
    const bool has_effect = ((rule.residue || rule.weight) && has_level(levels, "residue")) ||
                            (rule.chain && has_level(levels, "chain")) ||
                            (rule.domain && has_level(levels, "domain"));
    if (!has_effect)
      fail_input(rule.where +
                 ": found exponents that have no effect alone, expected one of a level that the hierarchy has");
    const auto note_idle = [&](const std::optional<double>& exponent, const char* name, const char* level) {
      if (exponent && !has_level(levels, level))
        notes.push_back(rule.where + ": " + name + " has no effect, the hierarchy has no level " + level);
    };
    note_idle(rule.residue, "P_R", "residue");
    note_idle(rule.weight, "W_R", "residue");
    note_idle(rule.chain, "P_C", "chain");
    note_idle(rule.domain, "P_D", "domain");
  }
  check_products(g, levels);
}

} // namespace molmesh
