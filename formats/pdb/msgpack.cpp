// msgpack.cpp — one byte tells the kind, then come lengths and numbers, big-endian.
#include "formats/pdb/msgpack.hpp"
#include <bit>
#include <stdexcept>
#include <string>

namespace molmesh::formats::msgpack {
namespace {

constexpr int deepest = 32;
constexpr uint64_t most_values = 1'000'000; // a file has some ten a column

class Reader {
public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  Value value(int depth = 0) {
    if (depth > deepest)
      throw std::runtime_error("values nested deeper than " + std::to_string(deepest));
    const auto code = static_cast<uint8_t>(take(1)[0]);
    Value v;
    if (code < 0x80)
      return integer(code);
    if (code >= 0xE0)
      return integer(static_cast<int8_t>(code));
    if (code < 0x90)
      return map(code & 0x0F, depth);
    if (code < 0xA0)
      return array(code & 0x0F, depth);
    if (code < 0xC0)
      return text(code & 0x1F, Value::Kind::text);
    switch (code) {
    case 0xC0:
      return v;
    case 0xC2:
    case 0xC3:
      v.kind = Value::Kind::boolean;
      v.integer = code & 1;
      return v;
    case 0xC4:
    case 0xC5:
    case 0xC6:
      return text(big_endian(1 << (code - 0xC4)), Value::Kind::bytes);
    case 0xCA:
      return real(static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(big_endian(4)))));
    case 0xCB:
      return real(std::bit_cast<double>(big_endian(8)));
    case 0xCC:
    case 0xCD:
    case 0xCE:
    case 0xCF:
      return integer(static_cast<int64_t>(big_endian(1 << (code - 0xCC))));
    case 0xD0:
      return integer(static_cast<int8_t>(big_endian(1)));
    case 0xD1:
      return integer(static_cast<int16_t>(big_endian(2)));
    case 0xD2:
      return integer(static_cast<int32_t>(big_endian(4)));
    case 0xD3:
      return integer(static_cast<int64_t>(big_endian(8)));
    case 0xD9:
    case 0xDA:
    case 0xDB:
      return text(big_endian(1 << (code - 0xD9)), Value::Kind::text);
    case 0xDC:
    case 0xDD:
      return array(big_endian(code == 0xDC ? 2 : 4), depth);
    case 0xDE:
    case 0xDF:
      return map(big_endian(code == 0xDE ? 2 : 4), depth);
    default:
      throw std::runtime_error("a byte that begins no value");
    }
  }

  bool at_end() const { return rest_.empty(); }

private:
  std::string_view take(uint64_t n) {
    if (n > rest_.size())
      throw std::runtime_error("the end within a value");
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }

  uint64_t big_endian(int bytes) {
    uint64_t n = 0;
    for (const char c : take(static_cast<uint64_t>(bytes)))
      n = n << 8 | static_cast<uint8_t>(c);
    return n;
  }

  static Value integer(int64_t i) {
    Value v;
    v.kind = Value::Kind::integer;
    v.integer = i;
    v.real = static_cast<double>(i);
    return v;
  }

  static Value real(double d) {
    Value v;
    v.kind = Value::Kind::real;
    v.real = d;
    return v;
  }

  Value text(uint64_t n, Value::Kind kind) {
    Value v;
    v.kind = kind;
    v.text = take(n);
    return v;
  }

  /// Takes memory at once for all of them; those of all arrays are counted before.
  Value array(uint64_t n, int depth) {
    if (n > most_values - values_)
      throw std::runtime_error("more than " + std::to_string(most_values) + " values");
    values_ += n;
    Value v;
    v.kind = Value::Kind::array;
    v.array.reserve(n);
    for (uint64_t i = 0; i < n; ++i)
      v.array.push_back(value(depth + 1));
    return v;
  }

  Value map(uint64_t n, int depth) {
    Value v = array(2 * n, depth);
    v.kind = Value::Kind::map;
    return v;
  }

  std::string_view rest_;
  uint64_t values_ = 0;
};

} // namespace

const Value& Value::operator[](std::string_view name) const {
  static const Value none;
  if (kind == Kind::map)
    for (size_t i = 0; i + 1 < array.size(); i += 2)
      if (array[i].kind == Kind::text && array[i].text == name)
        return array[i + 1];
  return none;
}

Value parse(std::string_view bytes) {
  Reader reader(bytes);
  Value v = reader.value();
  if (!reader.at_end())
    throw std::runtime_error("bytes behind the value");
  return v;
}

} // namespace molmesh::formats::msgpack
