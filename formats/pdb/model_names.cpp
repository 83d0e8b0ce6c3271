// model_names.cpp — numbers as text, in the order of the file.
#include "formats/pdb/model_names.hpp"
#include "molecule/words.hpp"
#include <algorithm>

namespace molmesh::formats {

std::string model_number(std::string_view digits) {
  const size_t first = std::min(digits.find_first_not_of('0'), digits.size() - 1);
  return std::string(digits.substr(first));
}

const std::string& ModelNames::next(std::string_view record) {
  const std::vector<std::string_view> word = words(record);
  std::string name;
  if (word.size() > 1 && std::all_of(word[1].begin(), word[1].end(), is_digit))
    name = model_number(word[1]);
  if (name.empty() || taken_.count(name) != 0) {
    renumbered_ += !name_.empty() || !name.empty();
    size_t free = name_.size() + 1;
    while (taken_.count(std::to_string(free)) != 0)
      ++free;
    name = std::to_string(free);
  }
  taken_.insert(name);
  return name_.emplace_back(std::move(name));
}

} // namespace molmesh::formats
