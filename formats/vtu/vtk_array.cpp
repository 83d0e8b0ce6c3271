// vtk_array.cpp — ascii, base64, raw and zlib to values.
#include "formats/vtu/vtk_array.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <utility>
#include <zlib.h>

namespace molmesh::formats::vtk {
namespace {

constexpr size_t value_size(ValueType t) {
  constexpr size_t size[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return size[static_cast<int>(t)];
}

constexpr bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

} // namespace

/// Bytes of an array's data, base64 or raw. VTK closes a base64 run with padding between header and data where they
/// were encoded apart: groups of four characters are decoded one by one, so both ways read the same.
class ByteSource {
public:
  ByteSource(const Document& d, const ArrayTag& a)
      : d_(d), a_(a), text_(a.data), base64_(a.encoding != Encoding::appended_raw) {}

  /// Bytes that can still come at most.
  uint64_t left() const {
    return base64_ ? (text_.size() - at_) / 4 * 3 + static_cast<uint64_t>(ready_) : text_.size() - at_;
  }
  /// Raw data in place, or null.
  const unsigned char* in_place() const {
    return base64_ ? nullptr : reinterpret_cast<const unsigned char*>(text_.data()) + at_;
  }
  void read(unsigned char* out, uint64_t n) {
    if (!base64_) {
      if (n > text_.size() - at_)
        truncated();
      if (n > 0)
        std::memcpy(out, text_.data() + at_, n);
      at_ += n;
      return;
    }
    for (uint64_t i = 0; i < n; ++i) {
      if (ready_ == 0)
        group();
      out[i] = group_[size_ - ready_--];
    }
  }
  [[noreturn]] void truncated() const {
    d_.refuse(a_.line, "R4", "array '" + a_.name + "' ends early, expected a whole file: make it again");
  }

private:
  void group() {
    uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
      if (at_ == text_.size())
        truncated();
      const char c = text_[at_++];
      if (blank(c))
        continue;
      const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                        : c >= 'a' && c <= 'z' ? c - 'a' + 26
                        : c >= '0' && c <= '9' ? c - '0' + 52
                        : c == '+'             ? 62
                        : c == '/'             ? 63
                                               : -1;
      if (c == '=' && digits >= 2)
        ++padding;
      else if (digit < 0 || padding > 0)
        d_.refuse(a_.line, "R5", "array '" + a_.name + "' holds a character that is not base64");
      else
        ++digits;
      bits = bits << 6 | static_cast<uint32_t>(digit < 0 ? 0 : digit);
    }
    size_ = ready_ = 3 - padding;
    for (int i = 0; i < 3; ++i)
      group_[i] = static_cast<unsigned char>(bits >> (16 - 8 * i));
  }

  const Document& d_;
  const ArrayTag& a_;
  std::string_view text_;
  size_t at_ = 0;
  bool base64_;
  unsigned char group_[3] = {};
  int size_ = 0, ready_ = 0;
};

double Column::real(size_t i) const {
  switch (type_) {
  case ValueType::float32:
    return load<float>(i);
  case ValueType::float64:
    return load<double>(i);
  default:
    return static_cast<double>(integer(i));
  }
}

int64_t Column::integer(size_t i) const {
  switch (type_) {
  case ValueType::int8:
    return load<int8_t>(i);
  case ValueType::uint8:
    return load<uint8_t>(i);
  case ValueType::int16:
    return load<int16_t>(i);
  case ValueType::uint16:
    return load<uint16_t>(i);
  case ValueType::int32:
    return load<int32_t>(i);
  case ValueType::uint32:
    return load<uint32_t>(i);
  case ValueType::int64:
    return load<int64_t>(i);
  case ValueType::uint64:
    return std::max(load<int64_t>(i), int64_t{-1});
  default:
    return static_cast<int64_t>(real(i));
  }
}

Column Decoder::decode(const ArrayTag& a) {
  Column c;
  c.type_ = a.type;
  a.encoding == Encoding::ascii ? ascii(a, c) : binary(a, c);
  return c;
}

void Decoder::ascii(const ArrayTag& a, Column& c) const {
  const auto parse = [&]<class T>(T) {
    const char *p = a.data.data(), *end = p + a.data.size();
    std::vector<unsigned char>& out = c.owned_;
    for (;;) {
      while (p != end && blank(*p))
        ++p;
      if (p == end)
        break;
      T value{};
      const char* digits = *p == '+' ? p + 1 : p;
      const auto [stop, error] = std::from_chars(digits, end, value);
      if (error != std::errc{} || (stop != end && !blank(*stop))) {
        const char* word = std::find_if(p, std::min(end, p + 40), blank);
        d_.refuse(d_.line_of(p), "R5",
                  "array '" + a.name + "': found '" + std::string(p, word) + "', expected a number");
      }
      const size_t at = out.size();
      out.resize(at + sizeof(T));
      std::memcpy(out.data() + at, &value, sizeof(T));
      p = stop;
    }
    c.size_ = out.size() / sizeof(T);
  };
  // Text has no width: whole numbers are kept in 64 bits, so that none is cut.
  if (c.is_integer()) {
    c.type_ = ValueType::int64;
    parse(int64_t{});
  } else {
    c.type_ = ValueType::float64;
    parse(double{});
  }
  c.data_ = c.owned_.data();
}

void Decoder::binary(const ArrayTag& a, Column& c) {
  ByteSource source(d_, a);
  c.swap_ = d_.big_endian;
  unsigned char header[8] = {};
  source.read(header, static_cast<uint64_t>(d_.header_bytes));
  if (d_.big_endian)
    std::reverse(header, header + d_.header_bytes);
  uint64_t n = 0;
  std::memcpy(&n, header, sizeof n); // little-endian hosts: the upper half of a 4-byte header is 0
  if (d_.zlib) {
    unpack(a, source, n, c);
  } else {
    if (n > source.left())
      source.truncated();
    spend(stored_left_, n, a, "holds more than its size: arrays share their data");
    c.data_ = source.in_place();
    c.size_ = n;
    if (!c.data_) {
      c.owned_.resize(n);
      source.read(c.owned_.data(), n);
    }
  }
  if (!c.owned_.empty())
    c.data_ = c.owned_.data();
  if (c.size_ % value_size(a.type) != 0)
    d_.refuse(a.line, "R4",
              "array '" + a.name + "' has " + std::to_string(c.size_) + " bytes, expected a multiple of " +
                  std::to_string(value_size(a.type)));
  c.size_ /= value_size(a.type);
}

void Decoder::spend(uint64_t& left, uint64_t bytes, const ArrayTag& a, const char* what) {
  if (bytes > left)
    d_.refuse(a.line, "R5", "with array '" + a.name + "' the file " + what);
  left -= bytes;
}

void Decoder::unpack(const ArrayTag& a, ByteSource& source, uint64_t blocks, Column& c) {
  const auto number = [&] {
    unsigned char bytes[8] = {};
    source.read(bytes, static_cast<uint64_t>(d_.header_bytes));
    if (d_.big_endian)
      std::reverse(bytes, bytes + d_.header_bytes);
    uint64_t n = 0;
    std::memcpy(&n, bytes, sizeof n);
    return n;
  };
  if (blocks == 0)
    return;
  if (blocks > source.left() / static_cast<uint64_t>(d_.header_bytes))
    source.truncated();
  const uint64_t full = number(), partial = number(), last = partial ? partial : full;
  const bool countable =
      full <= unpacked_left_ && last <= full && blocks - 1 <= unpacked_left_ / std::max<uint64_t>(full, 1);
  const uint64_t total = countable ? (blocks - 1) * full + last : unpacked_left_ + value_size(a.type);
  spend(unpacked_left_, total / value_size(a.type) * sizeof(double), a,
        "unpacks to over 256 times its size, or 16 times and 32 MiB");
  std::vector<uint64_t> packed(blocks);
  for (uint64_t& n : packed)
    n = number();
  c.owned_.resize(total);
  std::vector<unsigned char> buffer;
  for (uint64_t b = 0; b < blocks; ++b) {
    if (packed[b] > source.left())
      source.truncated();
    buffer.resize(packed[b]);
    source.read(buffer.data(), packed[b]);
    const uint64_t expected = b + 1 == blocks ? last : full;
    uLongf size = expected;
    if (uncompress(c.owned_.data() + b * full, &size, buffer.data(), packed[b]) != Z_OK || size != expected)
      d_.refuse(a.line, "R5", "array '" + a.name + "' is not zlib data of the size declared");
  }
  c.size_ = total;
}

} // namespace molmesh::formats::vtk
