// model_names.hpp — the numbers that MODEL records give, or that models without one get.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

/// A model's number without zeros before it, for names to be compared: "0001" is "1", "000" is "0".
std::string model_number(std::string_view digits);

class ModelNames {
public:
  /// Of the next model: what its MODEL record says (empty: it has none); the next free number where that is none,
  /// or taken.
  const std::string& next(std::string_view record);
  const std::vector<std::string>& all() const { return name_; } ///< in order
  /// Models that have the next free number, but for a first one that says none.
  int64_t renumbered() const { return renumbered_; }

private:
  std::vector<std::string> name_;
  std::set<std::string> taken_;
  int64_t renumbered_ = 0;
};

} // namespace molmesh::formats
