// words.cpp — splits lines into words and parses numbers strictly.
#include "molecule/words.hpp"
#include "base/error.hpp"
#include <charconv>
#include <cmath>
#include <istream>

namespace molmesh {
namespace {

constexpr std::string_view blanks = " \t";

} // namespace

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> result;
  for (size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(blanks, at), text.size());
    result.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(blanks, end);
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos)
    return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

std::optional<double> decimal(std::string_view text) {
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::optional<double> signed_decimal(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-')
    text.remove_prefix(1);
  return decimal(text);
}

void read_lines(std::istream& in, const std::string& file,
                const std::function<void(const std::string&, const std::string&)>& take) {
  std::string line;
  for (int64_t number = 1; std::getline(in, line); ++number) {
    const std::string where = file + ":" + std::to_string(number);
    if (line.find('\0') != std::string::npos)
      fail_input(where + ": found a NUL byte, expected text");
    if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) // a byte order mark
      line.erase(0, 3);
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    const std::string_view record = trimmed(line);
    if (!record.empty() && record.front() != '#')
      take(std::string(record), where);
  }
  if (in.bad())
    fail_input(file + ": cannot read");
}

} // namespace molmesh
