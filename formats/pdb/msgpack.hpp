// msgpack.hpp — MessagePack: values that point into the bytes they were read from.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace molmesh::formats::msgpack {

struct Value {
  enum class Kind { nil, boolean, integer, real, text, bytes, array, map } kind = Kind::nil;
  int64_t integer = 0;      ///< boolean, integer
  double real = 0;          ///< integer too
  std::string_view text;    ///< text, bytes
  std::vector<Value> array; ///< elements; of a map: key, value, key, value, …

  /// nil where there is none.
  const Value& operator[](std::string_view name) const;
};

/// All of `bytes` as one value. Throws std::runtime_error, which says what was found; at most a million values,
/// nested at most 32 deep.
Value parse(std::string_view bytes);

} // namespace molmesh::formats::msgpack
