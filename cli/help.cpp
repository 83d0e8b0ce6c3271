// help.cpp — names and units on the left; meaning, range and default on the right.
#include "cli/help.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

namespace molmesh::cli {
namespace {

constexpr size_t left_width = 26, right_width = 70;

/// What CLI11 knows of an option's values: "TYPE:check:check".
struct Values {
  std::string unit, range;
  bool number = false;
};

/// "FLOAT in [0.01 - 10]" → "0.01..10", "{seq,omp}" → "seq, omp", "POSITIVE" → "> 0".
std::string range_words(const std::string& check) {
  if (check == "POSITIVE")
    return "> 0";
  if (check == "NONNEGATIVE")
    return ">= 0";
  if (check.size() > 2 && check.front() == '{' && check.back() == '}') {
    std::string words;
    for (char c : check.substr(1, check.size() - 2))
      words += c == ',' ? ", " : std::string(1, c);
    return words;
  }
  const size_t open = check.find(" in ["), dash = check.find(" - ");
  if (open == std::string::npos || dash == std::string::npos || check.back() != ']')
    return check;
  return check.substr(open + 5, dash - open - 5) + ".." + check.substr(dash + 3, check.size() - dash - 4);
}

Values values(const CLI::Option& option) {
  std::istringstream words(option.get_type_name());
  Values v;
  std::string word;
  for (bool first = true; std::getline(words, word, ':'); first = false) {
    const bool numeric = word == "POSITIVE" || word == "NONNEGATIVE" || word.rfind("FLOAT", 0) == 0 ||
                         word.rfind("INT", 0) == 0 || word.rfind("UINT", 0) == 0;
    v.number = v.number || numeric;
    if (first)
      v.unit = word == "FLOAT" ? "X" : word == "INT" || word == "UINT" ? "N" : word == "TEXT" ? "TEXT" : word;
    else if (const std::string range = range_words(word); !range.empty())
      v.range += (v.range.empty() ? "" : ", ") + range;
  }
  return v;
}

/// Columns that UTF-8 text takes, as far as the help uses it (Å, κ, ε).
size_t columns(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

bool takes_value(const CLI::Option& option) {
  return option.get_expected_min() > 0;
}

std::string left(const CLI::Option& option, const std::string& unit) {
  if (!option.nonpositional())
    return "  " + option.get_name(true);
  std::string text = option.get_snames().empty() ? "      " : "  -" + option.get_snames().front();
  if (!option.get_lnames().empty())
    text += (option.get_snames().empty() ? "--" : ", --") + option.get_lnames().front();
  return takes_value(option) ? text + ' ' + unit : text;
}

std::string right(const CLI::Option& option, const Values& v) {
  std::string text = option.get_description(), notes = v.range;
  const std::string fallback = option.get_default_str();
  const auto add = [&](const std::string& note) { notes += (notes.empty() ? "" : "; ") + note; };
  if (option.get_items_expected_max() > 1)
    add("repeatable");
  if (option.get_required())
    add("required");
  if (takes_value(option) && !fallback.empty() && fallback != "[]" && fallback != "{}")
    add("default " + fallback);
  return notes.empty() ? text : text + " (" + notes + ")";
}

void print(std::ostream& out, const CLI::Option& option) {
  const Values v = values(option);
  const std::string name = left(option, v.unit);
  out << name;
  size_t column = columns(name);
  const auto indent = [&] {
    out << '\n' << std::string(left_width, ' ');
    column = left_width;
  };
  if (column + 2 > left_width)
    indent();
  else
    out << std::string(left_width - column, ' ');
  column = 0;
  std::istringstream words(right(option, v));
  for (std::string word; words >> word;) {
    if (column > 0 && column + 1 + columns(word) > right_width) {
      indent();
      column = 0;
    }
    out << (column > 0 ? " " : "") << word;
    column += columns(word) + (column > 0 ? 1 : 0);
  }
  out << '\n';
}

} // namespace

std::string help(const CLI::App& app) {
  std::ostringstream out;
  out << app.get_name() << ": " << app.get_description() << "\n\nusage: " << app.get_name() << " [OPTIONS]";
  const auto options = app.get_options();
  for (const CLI::Option* o : options)
    if (o->get_positional())
      out << (o->get_required() ? " " + o->get_name(true) : " [" + o->get_name(true) + ']');
  out << '\n';
  for (const CLI::Option* o : options)
    if (o->get_positional())
      out << '\n', print(out, *o);
  out << "\noptions:\n";
  for (const CLI::Option* o : options)
    if (!o->get_positional())
      print(out, *o);
  out << "\nexit status: 0 good, 1 the run failed, 2 usage, 3 input unreadable or invalid, 4 output not written,\n"
         "5 valid and written, but below the quality asked for, 6 the mode is not available here\n";
  return out.str();
}

void check_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& text : option->results())
      if (text.empty() && values(*option).unit == "FILE")
        throw CLI::ValidationError(option->get_name(), "found '', expected a file");
    if (!values(*option).number)
      continue;
    for (const std::string& text : option->results()) {
      double x = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
      if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(x))
        throw CLI::ValidationError(option->get_name(), "found '" + text + "', expected a finite decimal number");
    }
  }
}

std::string plain_error(const CLI::App& app, const CLI::ParseError& e) {
  const std::string text = e.what();
  if (!dynamic_cast<const CLI::ValidationError*>(&e) && !dynamic_cast<const CLI::ConversionError*>(&e))
    return text;
  try {
    check_values(app);
  } catch (const CLI::ValidationError& value) {
    return value.what();
  }
  for (const CLI::Option* option : app.get_options()) {
    const Values v = values(*option);
    const std::string name = option->get_name();
    if (v.number && !v.range.empty() && !option->results().empty() && text.rfind(name + ": ", 0) == 0)
      return name + ": found '" + option->results().back() + "', expected " + v.range;
  }
  return text;
}

} // namespace molmesh::cli
