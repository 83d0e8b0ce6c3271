// selection.cpp — names and numbers are read here, models, elements, alternative locations and the rest by gemmi.
#include "formats/pdb/selection.hpp"
#include "formats/hier/text.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/selection_advice.hpp"
#include "molecule/words.hpp"
#include <cctype>
#include <charconv>
#include <limits>

namespace molmesh::formats {
namespace {

constexpr char quote = '"';
constexpr size_t npos = std::string_view::npos;

/// gemmi's integers overflow unnoticed.
bool has_large_number(std::string_view cid) {
  constexpr size_t most_digits = 9;
  size_t digits = 0;
  return std::any_of(cid.begin(), cid.end(),
                     [&](char c) { return (digits = is_digit(c) ? digits + 1 : 0) > most_digits; });
}

/// Of gemmi's "Invalid selection syntax near "…": …" what is not the selection itself.
std::string reason(const std::string& what) {
  const size_t begin = what.find(" near "), end = what.rfind(": ");
  return begin == std::string::npos || end <= begin
             ? ""
             : " (" + in_quotes(what.substr(begin + 1, end - begin - 1)) + ")";
}

[[noreturn]] void wrong(const std::string& what) {
  throw std::invalid_argument(" (" + what + ")");
}

/// Where the quoted text that begins at `at` ends: behind its closing quote. Two quotes within it are one.
size_t end_of_quoted(std::string_view text, size_t at) {
  for (size_t i = at + 1; i < text.size(); ++i)
    if (text[i] == quote) {
      if (i + 1 == text.size() || text[i + 1] != quote)
        return i + 1;
      ++i;
    }
  wrong("a name without its second quote");
}

/// The first of `marks` outside quotes. A quote opens at the beginning of a name alone.
size_t find_unquoted(std::string_view text, std::string_view marks, size_t at = 0) {
  for (size_t i = at; i < text.size();) {
    const bool begins = i == 0 || std::string_view("/,(!;").find(text[i - 1]) != npos;
    if (text[i] == quote && begins)
      i = end_of_quoted(text, i);
    else if (marks.find(text[i]) != npos)
      return i;
    else
      ++i;
  }
  return npos;
}

std::vector<std::string_view> split(std::string_view text, std::string_view mark) {
  std::vector<std::string_view> parts;
  for (;;) {
    const size_t end = find_unquoted(text, mark);
    parts.push_back(text.substr(0, end));
    if (end == npos)
      return parts;
    text.remove_prefix(end + 1);
  }
}

/// forbidden: what a name without quotes may not hold.
NameList read_list(std::string_view text, std::string_view forbidden) {
  NameList list;
  if (text == "*")
    return list;
  list.all = false;
  list.inverted = !text.empty() && text[0] == '!';
  if (list.inverted)
    text.remove_prefix(1);
  for (const std::string_view part : split(text, ",")) {
    if (part.empty() || part[0] != quote) {
      if (part.find_first_of(forbidden) != npos)
        wrong("a name with one of " + std::string(forbidden) + ", which needs double quotes");
      list.name.emplace_back(part);
      continue;
    }
    if (end_of_quoted(part, 0) != part.size())
      wrong("text behind a quoted name");
    std::string name;
    for (size_t i = 1; i + 1 < part.size(); ++i) {
      name += part[i];
      i += part[i] == quote;
    }
    list.name.push_back(name);
  }
  return list;
}

/// Quoted names as letters, so that gemmi sees which fields there are.
std::string without_quoted(std::string_view cid) {
  std::string text;
  for (size_t i = 0; i < cid.size();) {
    const bool begins = i == 0 || std::string_view("/,(!;").find(cid[i - 1]) != npos;
    const size_t end = cid[i] == quote && begins ? end_of_quoted(cid, i) : i + 1;
    text += end > i + 1 ? std::string(end - i, 'Q') : std::string(1, cid[i]);
    i = end;
  }
  return text;
}

/// "-5", "63A", "63.A" at the beginning of `text`, which loses it.
bool read_signed(std::string_view& text, gemmi::Selection::SequenceId& id) {
  const size_t digits = text.substr(0, 1) == "-" ? 1 : 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id.seqnum);
  if (error != std::errc() || text.size() == digits)
    return false;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  id.icode = ' ';
  if (text.substr(0, 1) == ".")
    text.remove_prefix(1);
  if (!text.empty() && std::isalpha(static_cast<unsigned char>(text[0]))) {
    id.icode = text[0];
    text.remove_prefix(1);
  }
  return true;
}

/// "-5--3", "-5-3", "-5-", which are no syntax to gemmi: its numbers have no sign, and "-5" is all up to 5.
bool read_negative_range(std::string_view text, gemmi::Selection::SequenceId& first,
                         gemmi::Selection::SequenceId& last) {
  if (text.substr(0, 1) != "-" || text.find('-', 1) == npos || !read_signed(text, first) ||
      text.substr(0, 1) != "-")
    return false;
  text.remove_prefix(1);
  last = {std::numeric_limits<int>::max(), '*'};
  return text.empty() || (read_signed(text, last) && text.empty());
}

} // namespace

Selection::Selection(const std::string& text, const std::string& where, bool around_allowed, Status status) {
  std::string cid = text;
  const std::vector<std::string_view> word = words(text);
  if (!word.empty() && word[0] == "around") {
    const double distance = word.size() >= 3 ? decimal(word.back()).value_or(0) : 0;
    if (!around_allowed || !(distance > 0))
      fail(status, where + ": found selection " + in_quotes(text) + ", expected " +
                       (around_allowed ? "around SELECTION DISTANCE, DISTANCE > 0 (Å)" : "no 'around' here"));
    around_ = distance;
    cid = trimmed(std::string_view(word[1].data(), static_cast<size_t>(word.back().data() - word[1].data())));
  }
  try {
    const std::string plain = without_quoted(cid);
    if (has_large_number(plain))
      fail(status, where + ": found selection " + in_quotes(text) + ", expected numbers of nine digits at most");
    if (cid.empty() || cid == "*")
      return;
    const size_t semicolon = std::min(plain.find(';'), cid.size());
    const std::string extensions = cid.substr(semicolon);
    // Model, chain, residue, atom; the first ones may be left out.
    const int omitted = gemmi::impl::determine_omitted_cid_fields(plain);
    const std::string_view all = std::string_view(cid).substr(0, semicolon);
    const std::vector<std::string_view> given = split(omitted == 0 ? all.substr(1) : all, "/");
    std::vector<std::string_view> field(static_cast<size_t>(omitted));
    field.insert(field.end(), given.begin(), given.end());
    if (field.size() > 4)
      throw std::invalid_argument("");
    const auto has = [&](size_t f) { return f >= static_cast<size_t>(omitted) && f < field.size(); };
    if (has(1)) {
      chains_ = read_list(field[1], "[]()!*:;");
      if (!chains_.all && chains_.name.size() == 1 && chains_.name[0].empty())
        chains_.name[0] = "_"; // the chain without a name, whose place gemmi's syntax leaves empty
    }
    if (has(2)) {
      std::string_view numbers = field[2];
      std::string outside;
      if (const size_t open = find_unquoted(numbers, "("); open != npos) {
        const size_t close = find_unquoted(numbers, ")", open + 1);
        if (close == npos)
          wrong("no ')' behind names of residues");
        residues_ = read_list(numbers.substr(open + 1, close - open - 1), "[]()!/*:;");
        outside = std::string(numbers.substr(0, open)) + std::string(numbers.substr(close + 1));
        numbers = outside;
      }
      const std::vector<std::string_view> parts = split(numbers, ",");
      for (const std::string_view item : parts) {
        const std::string_view part = trimmed(item);
        if (part.empty() && parts.size() > 1)
          wrong("a list of residues with nothing between two commas");
        Range negative{{}, {}, std::string(part)};
        if (read_negative_range(part, negative.first, negative.last)) {
          ranges_.push_back(negative);
          continue;
        }
        const gemmi::Selection one("//*/" + std::string(part));
        Range range{one.from_seqid, one.to_seqid, std::string(part)};
        // gemmi 0.5.7 takes "45" for "45-"; in MMDB syntax, and in later gemmi, it is that residue alone.
        if (!range.first.empty() && range.last.empty() && part.back() != '-')
          range.last = range.first;
        if (range.first.empty() && range.last.empty()) {
          ranges_.clear(); // all
          break;
        }
        ranges_.push_back(range);
      }
    }
    std::string atoms = has(3) ? std::string(field[3]) : "";
    if (const size_t end = std::min(find_unquoted(atoms, "[:"), atoms.size());
        atoms.substr(0, end).find(quote) != std::string::npos) {
      atoms_ = read_list(std::string_view(atoms).substr(0, end), "[]()!/*-.:;");
      atoms = "*" + atoms.substr(end);
    }
    rest_ = gemmi::Selection("/" + (has(0) ? std::string(field[0]) : "") + "/*/*" +
                             (atoms.empty() ? "" : "/" + atoms) + extensions);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    const bool own = dynamic_cast<const std::invalid_argument*>(&e) != nullptr;
    const std::string meant = selection_advice(cid), why = own ? e.what() : reason(e.what());
    fail(status, where + ": found selection " + in_quotes(text) + ", expected " +
                     (meant.empty() ? "gemmi's syntax, as '//D', '//D/45-60' or '//D/(HEM)'" + why : meant));
  }
}

bool Selection::chain(const std::string& name, const std::string& copy) const {
  if (chains_.all)
    return true;
  const auto listed = [&](const std::string& n) {
    if (chains_.has(n) != chains_.inverted)
      return true;
    std::string encoded;
    percent_encode(encoded, n);
    return encoded != n && chains_.has(encoded) != chains_.inverted;
  };
  return (listed(name) || (copy != name && listed(copy))) != chains_.inverted;
}

bool Selection::residue(const pdb::Residue& r) const {
  if (!residues_.has(r.name) || !(rest_.entity_types.all || rest_.et_flags[static_cast<size_t>(r.entity_type)]))
    return false;
  for (size_t i = 0; i < ranges_.size(); ++i)
    if (number_fits(i, r))
      return true;
  return ranges_.empty();
}

bool Selection::atom(const pdb::Atom& a) const {
  if (!atoms_.has(a.name) || !rest_.atom_names.has(a.name) ||
      !(rest_.elements.empty() || rest_.elements[static_cast<size_t>(a.element.ordinal())]) ||
      !rest_.altlocs.has(std::string(a.altloc == '\0' ? 0 : 1, a.altloc)))
    return false;
  gemmi::Atom values;
  values.occ = a.occ;
  values.b_iso = a.b_iso;
  return std::all_of(rest_.atom_inequalities.begin(), rest_.atom_inequalities.end(),
                     [&](const gemmi::Selection::AtomInequality& i) { return i.matches(values); });
}

std::optional<int> Selection::first_number() const {
  if (ranges_.empty())
    return std::nullopt;
  const auto& from = ranges_[0].first.empty() ? ranges_[0].last : ranges_[0].first;
  return from.seqnum;
}

std::vector<std::string> Selection::numbers() const {
  std::vector<std::string> all;
  for (const Range& range : ranges_)
    all.push_back(range.text);
  return all;
}

} // namespace molmesh::formats
