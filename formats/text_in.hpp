// text_in.hpp — words, numbers and bytes of a file that lies in memory; refusals name FILE:LINE.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace molmesh::formats {

/// Reads forward and never past the end. What is refused throws Error(bad_input), with the line of the last word.
class TextIn {
public:
  /// comment: begins a comment that ends with its line; '\0': there are none. `file` and `text` stay where they
  /// are.
  TextIn(const std::string& file, std::string_view text, char comment = '\0')
      : file_(file), text_(text), comment_(comment) {}

  /// The next word between blanks; empty at the end.
  std::string_view word();
  /// As word(), which then gives it again.
  std::string_view peek();
  /// What is left of the line, without blanks at its ends; the line is over.
  std::string_view line();
  /// Throws unless the next word is this.
  void expect(const char* rule, std::string_view expected);
  int64_t integer(const char* rule, const char* what, int64_t least, int64_t most);
  double real(const char* rule, const char* what);
  /// A finite number of at most 1e30 in magnitude.
  double coordinate(const char* rule);
  /// A count of things that take at least `bytes` each in what is left of the file.
  int64_t count(const char* rule, const char* what, int64_t bytes);
  /// Throws unless so many things can be in what is left.
  void require_room(const char* rule, const char* what, int64_t n, int64_t bytes) const;

  /// n bytes as they are.
  const char* bytes(const char* rule, uint64_t n);
  /// A number as it lies in the file; swapped: in the other byte order.
  template <class T>
  T binary(const char* rule, bool swapped) {
    unsigned char b[sizeof(T)];
    std::memcpy(b, bytes(rule, sizeof(T)), sizeof(T));
    for (size_t i = 0; swapped && i < sizeof(T) / 2; ++i)
      std::swap(b[i], b[sizeof(T) - 1 - i]);
    T v;
    std::memcpy(&v, b, sizeof v);
    return v;
  }

  const std::string& file() const { return file_; }
  size_t size() const { return text_.size(); }
  /// What is not read yet.
  std::string_view rest() const { return text_.substr(at_); }
  void skip(size_t n) { at_ += n; }
  [[noreturn]] void refuse(const char* rule, const std::string& what) const;
  /// "found 'word', expected what".
  [[noreturn]] void refuse_word(const char* rule, std::string_view found, const std::string& expected) const;

private:
  void skip_blanks();
  const std::string& file_;
  std::string_view text_;
  char comment_;
  size_t at_ = 0, word_ = 0; ///< the next byte, the begin of the last word
};

} // namespace molmesh::formats
