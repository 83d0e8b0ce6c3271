// bytes.hpp — numbers and strings as OpenVDB lays them out.
#pragma once
#include "geom/vec.hpp"
#include <cstdint>
#include <cstring>
#include <ostream>
#include <string>
#include <string_view>

namespace molmesh::formats {

/// Appends: little-endian, strings after their length.
class Bytes {
public:
  template <class T>
  void number(T v) {
    const size_t at = bytes_.size();
    bytes_.resize(at + sizeof v);
    std::memcpy(&bytes_[at], &v, sizeof v);
  }
  void raw(const void* p, size_t n) { bytes_.append(static_cast<const char*>(p), n); }
  void string(std::string_view s) {
    number(static_cast<uint32_t>(s.size()));
    bytes_ += s;
  }
  void vec(Vec3i v) {
    for (int a = 0; a < 3; ++a)
      number(v[a]);
  }
  const std::string& str() const { return bytes_; }
  /// Hands on what is there, and begins anew.
  void flush(std::ostream& out) {
    out.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    bytes_.clear();
  }

private:
  std::string bytes_;
};

} // namespace molmesh::formats
