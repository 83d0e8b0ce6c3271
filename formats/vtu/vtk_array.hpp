// vtk_array.hpp — decoded values of a DataArray. Rules R4 and R5 of VTUv1.md.
#pragma once
#include "formats/vtu/vtk_xml.hpp"
#include <algorithm>
#include <cstring>

namespace molmesh::formats::vtk {

/// Values of one array; uncompressed raw data stay where they lie in the file's text.
class Column {
public:
  size_t size() const { return size_; }
  bool is_integer() const { return type_ < ValueType::float32; }
  double real(size_t i) const;
  int64_t integer(size_t i) const; ///< uint64 beyond int64: -1
  /// All values in memory as they are in the file, for copies of whole arrays; null unless of this type in native
  /// order.
  const unsigned char* native(ValueType type) const { return type == type_ && !swap_ ? data_ : nullptr; }

private:
  friend class Decoder;
  template <class T>
  T load(size_t i) const {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, data_ + i * sizeof(T), sizeof(T));
    if (swap_)
      for (size_t k = 0; k < sizeof(T) / 2; ++k)
        std::swap(bytes[k], bytes[sizeof(T) - 1 - k]);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }
  const unsigned char* data_ = nullptr;
  std::vector<unsigned char> owned_;
  size_t size_ = 0;
  ValueType type_{};
  bool swap_ = false;
};

/// Decodes arrays of one document; what they hold in all is bounded by a multiple of the file's size, also where
/// blocks are compressed or pieces share them.
class Decoder {
public:
  explicit Decoder(const Document& d)
      : d_(d), unpacked_left_(std::min(256 * d.text.size() + (1u << 20), 16 * d.text.size() + (32u << 20))),
        stored_left_(d.text.size()) {}
  Column decode(const ArrayTag& a);

private:
  void ascii(const ArrayTag& a, Column& c) const;
  void binary(const ArrayTag& a, Column& c);
  void spend(uint64_t& left, uint64_t bytes, const ArrayTag& a, const char* what);
  void unpack(const ArrayTag& a, class ByteSource& source, uint64_t blocks, Column& c);
  const Document& d_;
  uint64_t unpacked_left_, stored_left_; ///< bytes; 8 for every value unpacked
};

} // namespace molmesh::formats::vtk
