// msgpack.hpp — MessagePack: values that point into the bytes they were read from.
#pragma once
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace molmesh::formats::msgpack {

struct Value {
  enum class Kind { nil, boolean, integer, real, text, bytes, array, map } kind = Kind::nil;
  int64_t integer = 0;   ///< boolean, integer
  double real = 0;       ///< integer too
  std::string_view text; ///< text, bytes
  std::vector<Value> array;
  std::vector<std::pair<std::string_view, Value>> map; ///< with keys that are text

  /// nil where there is none.
  const Value& operator[](std::string_view key) const;
};

/// All of `bytes` as one value. Throws std::runtime_error, which says what was found; nesting is at most 32 deep,
/// and memory a fixed multiple of the bytes.
Value parse(std::string_view bytes);

} // namespace molmesh::formats::msgpack
