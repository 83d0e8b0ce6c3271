// words.hpp — lines, words and numbers of the small text files that users write: rules, domains, radii.
#pragma once
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh {

/// Of the 128 characters of ASCII, in any locale.
constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/// Words between blanks (spaces, tabs).
std::vector<std::string_view> words(std::string_view text);
/// `text` without blanks at its ends.
std::string_view trimmed(std::string_view text);
/// The whole of `text` as a finite decimal number.
std::optional<double> decimal(std::string_view text);
/// The same with or without a plus sign, as Fortran and C may write it.
std::optional<double> signed_decimal(std::string_view text);
/// Calls take(line, "FILE:LINE") for each line that is neither blank nor a comment (`#`), without blanks at its
/// ends and carriage return. Throws Error(bad_input) when the stream breaks or a line holds a NUL byte.
void read_lines(std::istream& in, const std::string& file,
                const std::function<void(const std::string& line, const std::string& where)>& take);

} // namespace molmesh
