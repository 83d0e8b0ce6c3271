// text_out.hpp — words and numbers of text files, buffered; doubles in the shortest form that reads back exactly.
#pragma once
#include <charconv>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

namespace molmesh::formats {

/// The stream's state tells whether all was written, after the object is gone.
class TextOut {
public:
  explicit TextOut(std::ostream& out) : out_(out) { buffer_.reserve(full + 4096); }
  TextOut(const TextOut&) = delete;
  TextOut& operator=(const TextOut&) = delete;
  ~TextOut() { out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size())); }

  TextOut& operator<<(std::string_view text) {
    buffer_ += text;
    return *this;
  }
  TextOut& operator<<(char c) {
    buffer_ += c;
    if (c == '\n' && buffer_.size() >= full) {
      out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
      buffer_.clear();
    }
    return *this;
  }
  TextOut& operator<<(double v) { return number(v); }
  TextOut& operator<<(int32_t v) { return number(v); }
  TextOut& operator<<(int64_t v) { return number(v); }
  TextOut& operator<<(size_t v) { return number(v); }

  /// Bytes as they lie in memory.
  TextOut& bytes(const void* from, size_t n) {
    buffer_.append(static_cast<const char*>(from), n);
    if (buffer_.size() >= full) {
      out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
      buffer_.clear();
    }
    return *this;
  }

private:
  static constexpr size_t full = size_t{1} << 16;
  template <class T>
  TextOut& number(T v) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, v).ptr;
    return *this << std::string_view(text, static_cast<size_t>(end - text));
  }
  std::ostream& out_;
  std::string buffer_;
};

} // namespace molmesh::formats
