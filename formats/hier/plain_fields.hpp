// plain_fields.hpp — names and numbers as writers write them, eight bytes at a time: most of a .hier is these.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace molmesh::formats {

/// Plain decimals of up to 15 digits, as coordinates are: digits and power of ten are exact doubles, and so their
/// quotient is correctly rounded. False for anything else.
bool short_decimal(std::string_view text, double& value);

/// Goes through the fields of a line of printable ASCII and tabs that ends with a line feed. False leaves the line
/// to the reader's rules: it may be right.
class PlainFields {
public:
  static constexpr size_t padding = 8; ///< bytes that may be read behind the line

  explicit PlainFields(const char* at) : at_(at) { skip_blanks(); }
  const char* at() const { return at_; }
  bool at_end() const { return *at_ == '\n'; }

  /// 1 to 7 bytes without '%'. key: these, and their number in the last byte.
  bool name(uint64_t& key);
  bool number(double& value);

private:
  void skip_blanks() {
    while (*at_ == ' ' || *at_ == '\t')
      ++at_;
  }
  bool long_number(double& value);
  const char* at_;
};

/// Whether a line begins with "atom ".
inline bool begins_with_atom(const char* line) {
  return std::memcmp(line, "atom ", 5) == 0;
}

} // namespace molmesh::formats
