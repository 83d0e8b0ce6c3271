// key_value.hpp — KEY=VALUE of a plan: lists, numbers, and what is refused.
#pragma once
#include "base/error.hpp"
#include "geom/vec.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace molmesh::formats {

inline constexpr size_t most_copies = 100'000;

/// One KEY=VALUE of a line. Refers to the strings it is made of. rule: of the format's page, as "P3: ", or none.
class KeyValue {
public:
  KeyValue(const std::string& where, const std::string& key, const std::string& value)
      : where_(where), key_(key), value_(value) {}

  [[noreturn]] void refuse(const std::string& expected, const char* rule = "") const {
    fail_input(where_ + ": " + rule + "found '" + key_ + "=" + value_ + "', expected " + expected);
  }
  std::vector<std::string> list() const {
    std::vector<std::string> parts;
    size_t begin = 0;
    for (;;) {
      const size_t comma = value_.find(',', begin);
      parts.push_back(value_.substr(begin, comma - begin));
      if (comma == std::string::npos)
        return parts;
      begin = comma + 1;
    }
  }
  /// counts: how many there may be; all are smaller than `bound`.
  std::vector<double> numbers(std::initializer_list<size_t> counts, const std::string& expected,
                              const char* rule = "", double bound = HUGE_VAL) const {
    std::vector<double> all;
    for (const std::string& part : list()) {
      const std::optional<double> v = signed_decimal(part);
      if (!v || !(std::abs(*v) < bound))
        refuse(expected, rule);
      all.push_back(*v);
    }
    if (std::find(counts.begin(), counts.end(), all.size()) == counts.end())
      refuse(expected, rule);
    return all;
  }
  double number(double least, double most, const std::string& expected) const {
    const std::optional<double> v = decimal(value_);
    if (!v || !(*v > least && *v <= most))
      refuse(expected);
    return *v;
  }
  int count(double v, const std::string& expected, const char* rule = "") const {
    if (!(v >= 1 && v <= double{most_copies} && v == std::floor(v)))
      refuse(expected, rule);
    return static_cast<int>(v);
  }
  const std::string& text(const std::string& expected) const {
    if (value_.empty())
      refuse(expected);
    return value_;
  }

private:
  const std::string &where_, &key_, &value_;
};

/// Three numbers of many.
inline Vec3d at(const std::vector<double>& v, size_t i) {
  return {v[i], v[i + 1], v[i + 2]};
}

} // namespace molmesh::formats
