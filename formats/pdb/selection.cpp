// selection.cpp — parsing with gemmi, and the lens.
#include "formats/pdb/selection.hpp"
#include "molecule/words.hpp"
#include <vector>

namespace molmesh::formats {

Selection::Selection(const std::string& text, const std::string& where, bool around_allowed) {
  std::string cid = text;
  const std::vector<std::string_view> word = words(text);
  if (!word.empty() && word[0] == "around") {
    const double distance = word.size() >= 3 ? decimal(word.back()).value_or(0) : 0;
    if (!around_allowed || !(distance > 0))
      fail_input(where + ": found selection '" + text + "', expected " +
                 (around_allowed ? "around SELECTION DISTANCE, DISTANCE > 0 (Å)" : "no 'around' here"));
    around_ = distance;
    cid = trimmed(std::string_view(word[1].data(), static_cast<size_t>(word.back().data() - word[1].data())));
  }
  try {
    selection_ = gemmi::Selection(cid);
  } catch (const std::exception& e) {
    fail_input(where + ": found selection '" + text + "', expected gemmi's syntax (" + e.what() + ")");
  }
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
