// selection.cpp — parsing with gemmi, and the lens.
#include "formats/pdb/selection.hpp"
#include "formats/pdb/parse.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <vector>

namespace molmesh::formats {
namespace {

/// gemmi's integers overflow unnoticed.
bool has_large_number(std::string_view cid) {
  constexpr size_t most_digits = 9;
  size_t digits = 0;
  return std::any_of(cid.begin(), cid.end(),
                     [&](char c) { return (digits = is_digit(c) ? digits + 1 : 0) > most_digits; });
}

/// Does the residue field end with '-', as "45-" (45 and all behind it) does?
bool is_open_range(std::string_view cid) {
  cid = cid.substr(0, cid.find(';'));
  const int omitted = gemmi::impl::determine_omitted_cid_fields(std::string(cid));
  for (int field = omitted == 0 ? -1 : omitted; field < 2; ++field)
    cid.remove_prefix(std::min(cid.find('/'), cid.size() - 1) + 1);
  const std::string_view residue = cid.substr(0, cid.find('/'));
  return !residue.empty() && residue.back() == '-';
}

/// Of gemmi's "Invalid selection syntax near "…": …" what is not the selection itself.
std::string reason(const std::string& what) {
  const size_t begin = what.find(" near "), end = what.rfind(": ");
  return begin == std::string::npos || end <= begin
             ? ""
             : " (" + in_quotes(what.substr(begin + 1, end - begin - 1)) + ")";
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
  if (has_large_number(cid))
    fail(status, where + ": found selection " + in_quotes(text) + ", expected numbers of nine digits at most");
  try {
    selection_ = gemmi::Selection(cid);
  } catch (const std::exception& e) {
    fail(status, where + ": found selection " + in_quotes(text) + ", expected gemmi's syntax" + reason(e.what()));
  }
  // gemmi 0.5.7 takes "45" for "45-"; in MMDB syntax, and in later gemmi, it is that residue alone.
  if (!selection_.from_seqid.empty() && selection_.to_seqid.empty() && !is_open_range(cid))
    selection_.to_seqid = selection_.from_seqid;
  // The chain without a name is "_" here; gemmi's syntax leaves its place empty.
  if (!selection_.chain_ids.all && selection_.chain_ids.list.empty())
    selection_.chain_ids.list.assign(1, '_');
}

bool Selection::chain(const std::string& name, const std::string& copy) const {
  const gemmi::Selection::List& list = selection_.chain_ids;
  if (list.all)
    return true;
  const bool found = gemmi::is_in_list(name, list.list) || (copy != name && gemmi::is_in_list(copy, list.list));
  return found != list.inverted;
}

} // namespace molmesh::formats
