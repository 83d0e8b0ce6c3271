// motions.hpp — what plans of structures (.join) and of densities share: words of a line, rigid motions, copies.
#pragma once
#include "formats/plan/key_value.hpp"
#include "geom/rigid.hpp"
#include <string_view>

namespace molmesh::formats {

/// In what the two differ.
struct MotionRules {
  const char *form = "", *value = "", *count = ""; ///< rules of the format's page: numbers, directions, copies
  double bound = HUGE_VAL;                         ///< of a number
  double rounding = 0.01;                          ///< of the rows of a rotation
  bool orthonormal = false;                        ///< rows are made so, to the last bit
};

/// Words between blanks; double quotes hold blanks. Throws Error(bad_input).
std::vector<std::string> quoted_words(std::string_view line, const std::string& where, const char* rule = "");

/// The motions that a key asks for, one for each copy; none: the key is no motion. Throws Error(bad_input).
std::vector<Rigid> motions(const std::string& key, const KeyValue& line, const MotionRules& rules);

/// Each copy moved by each step, at most most_copies. Throws Error(bad_input).
void repeat(std::vector<Rigid>& copies, const std::vector<Rigid>& steps, const KeyValue& line,
            const char* rule = "");

} // namespace molmesh::formats
