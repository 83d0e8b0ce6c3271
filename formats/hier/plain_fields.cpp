// plain_fields.cpp — finds a field's end in one word, and joins its digits there.
#include "formats/hier/plain_fields.hpp"
#include <charconv>
#include <cmath>

namespace molmesh::formats {
namespace {

constexpr double power[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

uint64_t eight_bytes(const char* p) {
  static_assert(std::endian::native == std::endian::little);
  uint64_t v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
constexpr uint64_t in_all_bytes(uint64_t byte) {
  return byte * 0x0101010101010101u;
}
constexpr uint64_t high_bits = in_all_bytes(0x80);
/// The first `n` < 8 bytes.
constexpr uint64_t low_bytes(int n) {
  return (uint64_t{1} << 8 * n) - 1;
}
/// Number of the first byte whose high bit is set; 8: none.
int first_marked(uint64_t marks) {
  return marks != 0 ? std::countr_zero(marks) / 8 : 8;
}

/// High bits of the bytes that are blanks or ends of lines; of ASCII.
constexpr uint64_t blanks(uint64_t bytes) {
  return ~((bytes | high_bits) - in_all_bytes(0x21)) & high_bits;
}
constexpr uint64_t non_digits(uint64_t bytes) {
  const uint64_t from_zero = bytes ^ in_all_bytes('0');
  return (((from_zero & ~high_bits) + in_all_bytes(0x76)) | from_zero) & high_bits;
}
constexpr bool any_percent(uint64_t bytes) {
  const uint64_t difference = bytes ^ in_all_bytes('%');
  return ((difference - in_all_bytes(1)) & ~difference & high_bits) != 0;
}
/// Of eight digits, the first in the lowest byte; 0 bytes count as '0'.
constexpr uint64_t value_of_digits(uint64_t digits) {
  digits &= in_all_bytes(0x0F);
  digits = digits * 10 + (digits >> 8);
  const uint64_t even = digits & 0x000000FF000000FF, odd = digits >> 16 & 0x000000FF000000FF;
  return (even * 0x000F424000000064 + odd * 0x0000271000000001) >> 32;
}

bool ends(char c) {
  return c == ' ' || c == '\t' || c == '\n';
}

} // namespace

bool short_decimal(std::string_view f, double& value) {
  const bool negative = f[0] == '-';
  if (negative)
    f.remove_prefix(1);
  if (f.empty() || f.size() > 15)
    return false;
  int64_t digits = 0;
  size_t decimals = 0, points = 0;
  for (const char c : f) {
    if (c == '.') {
      ++points;
      continue;
    }
    const unsigned digit = static_cast<unsigned char>(c) - unsigned{'0'};
    if (digit > 9)
      return false;
    digits = digits * 10 + digit;
    decimals += points;
  }
  if (points > 1 || f.size() == points)
    return false;
  value = static_cast<double>(digits) / power[decimals];
  if (negative)
    value = -value;
  return true;
}

bool PlainFields::name(uint64_t& key) {
  const uint64_t bytes = eight_bytes(at_);
  const int n = first_marked(blanks(bytes));
  if (n == 0 || n == 8)
    return false;
  key = bytes & low_bytes(n);
  if (any_percent(key))
    return false;
  key |= static_cast<uint64_t>(n) << 56;
  at_ += n;
  skip_blanks();
  return true;
}

bool PlainFields::number(double& value) {
  const bool negative = *at_ == '-';
  const char* const digits = at_ + negative;
  const uint64_t bytes = eight_bytes(digits), marks = non_digits(bytes);
  const int whole = first_marked(marks);
  const bool point = whole < 8 && digits[whole] == '.';
  const int n = point ? first_marked(marks & (marks - 1)) : whole;
  if (n == int{point} || !ends(digits[n]))
    return long_number(value);
  const uint64_t before_point = point ? low_bytes(whole) : ~uint64_t{0},
                 joined = (bytes & before_point) | (bytes >> 8 & ~before_point);
  const auto v = static_cast<double>(value_of_digits(joined << 8 * (8 - n + point)));
  value = v / power[point ? n - whole - 1 : 0];
  if (negative)
    value = -value;
  at_ = digits + n;
  skip_blanks();
  return true;
}

bool PlainFields::long_number(double& value) {
  const char* end = at_;
  while (!ends(*end))
    ++end;
  if (end == at_)
    return false;
  if (!short_decimal({at_, end}, value)) {
    const auto [rest, error] = std::from_chars(at_, end, value);
    if (error != std::errc{} || rest != end || !std::isfinite(value))
      return false;
  }
  at_ = end;
  skip_blanks();
  return true;
}

} // namespace molmesh::formats
