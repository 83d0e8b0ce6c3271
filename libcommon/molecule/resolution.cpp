// resolution.cpp — the text of rules and domains.
#include "molecule/resolution.hpp"
#include "molecule/words.hpp"

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
    if (last.substr(0, 2) != "P_")
      break;
    const std::string_view key = last.substr(0, 4);
    std::optional<double>* exponent = key == "P_R="   ? &rule.residue
                                      : key == "P_C=" ? &rule.chain
                                      : key == "P_D=" ? &rule.domain
                                                      : nullptr;
    const std::string found = where + ": found '" + std::string(last) + "', expected ";
    if (exponent == nullptr)
      fail(status, found + "P_R=…, P_C=… or P_D=…");
    if (*exponent)
      fail(status, found + "each exponent once");
    *exponent = decimal(last.substr(4));
    if (!*exponent || **exponent <= 0)
      fail(status, found + "a number > 0");
    rest = blank == std::string_view::npos ? std::string_view{} : trimmed(rest.substr(0, blank));
  }
  if (!rule.residue && !rule.chain && !rule.domain)
    fail(status, where + ": found '" + text + "', expected SELECTION P_R=… P_C=… P_D=…, at least one exponent");
  if (rest.empty())
    fail(status, where + ": found no selection, expected SELECTION P_R=… P_C=… P_D=… ('*' is everything)");
  for (const char* exponent : {"P_R=", "P_C=", "P_D="})
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

} // namespace molmesh
