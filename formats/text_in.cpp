// text_in.cpp — a cursor over text and binary data.
#include "formats/text_in.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace molmesh::formats {
namespace {

constexpr double coordinate_limit = 1e30; // squares and cubes of it stay finite

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// Text for a message: shortened, what is not printable ASCII as '?'.
std::string shown(std::string_view text) {
  std::string s(text.substr(0, 40));
  std::replace_if(
      s.begin(), s.end(), [](char c) { return c < ' ' || c == 0x7F; }, '?');
  return "'" + s + (text.size() > 40 ? "…'" : "'");
}

} // namespace

void TextIn::skip_blanks() {
  for (; at_ < text_.size(); ++at_) {
    if (comment_ != '\0' && text_[at_] == comment_)
      at_ = std::min(text_.find('\n', at_), text_.size() - 1);
    else if (!is_blank(text_[at_]))
      break;
  }
}

std::string_view TextIn::word() {
  skip_blanks();
  word_ = at_;
  while (at_ < text_.size() && !is_blank(text_[at_]))
    ++at_;
  return text_.substr(word_, at_ - word_);
}

std::string_view TextIn::peek() {
  const std::string_view w = word();
  at_ = word_;
  return w;
}

std::string_view TextIn::line() {
  word_ = at_;
  const size_t end = std::min(text_.find('\n', at_), text_.size());
  std::string_view l = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  while (!l.empty() && is_blank(l.back()))
    l.remove_suffix(1);
  while (!l.empty() && is_blank(l.front()))
    l.remove_prefix(1);
  return l;
}

void TextIn::expect(const char* rule, std::string_view expected) {
  if (const std::string_view w = word(); w != expected)
    refuse_word(rule, w, std::string(expected));
}

int64_t TextIn::integer(const char* rule, const char* what, int64_t least, int64_t most) {
  const std::string_view w = word();
  int64_t v = 0;
  const char* const begin = w.data() + (w.size() > 1 && w[0] == '+');
  const auto [end, error] = std::from_chars(begin, w.data() + w.size(), v);
  if (w.empty() || error != std::errc{} || end != w.data() + w.size() || v < least || v > most)
    refuse_word(rule, w, std::string(what) + ", " + std::to_string(least) + " to " + std::to_string(most));
  return v;
}

double TextIn::real(const char* rule, const char* what) {
  const std::string_view w = word();
  double v = 0;
  const char* const begin = w.data() + (w.size() > 1 && w[0] == '+');
  const auto [end, error] = std::from_chars(begin, w.data() + w.size(), v);
  if (w.empty() || (error != std::errc{} && error != std::errc::result_out_of_range) || end != w.data() + w.size())
    refuse_word(rule, w, what);
  if (error != std::errc{}) // too small or too large: as strtod, which tells them apart
    v = std::strtod(std::string(begin, end).c_str(), nullptr);
  return v;
}

double TextIn::coordinate(const char* rule) {
  const double v = real(rule, "a coordinate");
  if (!(std::fabs(v) <= coordinate_limit))
    refuse_word(rule, text_.substr(word_, at_ - word_), "a finite coordinate up to 1e30");
  return v;
}

void TextIn::require_room(const char* rule, const char* what, int64_t n, int64_t bytes) const {
  if (n < 0 || n > static_cast<int64_t>(text_.size() - at_) / bytes + 1)
    refuse(rule, std::to_string(n) + " " + what + ", but the file has " + std::to_string(text_.size() - at_) +
                     " more bytes, expected a whole file: make it again");
}

int64_t TextIn::count(const char* rule, const char* what, int64_t bytes) {
  const int64_t n = integer(rule, (std::string("a count of ") + what).c_str(), 0, int64_t{1} << 40);
  require_room(rule, what, n, bytes);
  return n;
}

const char* TextIn::bytes(const char* rule, uint64_t n) {
  if (n > text_.size() - at_) {
    word_ = at_;
    refuse(rule, "the file ends within binary data, expected a whole file: make it again");
  }
  const char* const b = text_.data() + at_;
  at_ += n;
  return b;
}

void TextIn::refuse(const char* rule, const std::string& what) const {
  const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(word_), '\n');
  fail_input(file_ + ':' + std::to_string(1 + lines) + ": " + rule + ": " + what);
}

void TextIn::refuse_word(const char* rule, std::string_view found, const std::string& expected) const {
  refuse(rule, (found.empty() ? "the file ends" : "found " + shown(found)) + ", expected " + expected);
}

} // namespace molmesh::formats
