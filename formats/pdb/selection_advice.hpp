// selection_advice.hpp — how residues are selected that somebody wrote in a way that gemmi's syntax does not have.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace molmesh::formats {

/// What to expect in place of a selection (without "around") that was refused: "names of residues in parentheses:
/// '//H/(ANS)'" for //H/ANS; numbers without names for //H/HIS57; "!" within the parentheses for !(NA). Empty where
/// none of these is meant.
std::string selection_advice(const std::string& selection);

/// Some residues of the chains of a selection that finds none: those next to the number that it asks for, else one
/// of each name, the rarest names first, since ligands are rare.
class ResiduesThere {
public:
  explicit ResiduesThere(std::optional<int> number) : number_(number) {}
  /// name: "ANS:373"; number: 373.
  void add(const std::string& chain, const std::string& name, int number);
  /// "; residues there: //H/373(ANS), //H/1(ILE)"; empty where there are none.
  std::string text() const;

private:
  struct Kind {
    int64_t residues = 0;
    std::string first;
  };
  std::optional<int> number_;
  std::map<std::string, Kind> kind_;                     ///< by name, without a number asked for
  std::vector<std::pair<int64_t, std::string>> nearest_; ///< by distance, with one
};

} // namespace molmesh::formats
