// options.cpp — the table of options as CLI11's, which reads the command line.
#include "cli/options.hpp"
#include "base/error.hpp"
#include "cli/pages.hpp"
#include "cli/run.hpp"
#include "cli/text.hpp"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string_view>
#include <type_traits>

namespace molmesh::cli {
namespace {

template <class Pointer>
using Pointed = std::remove_pointer_t<Pointer>;

/// As the help shows it: "0.25", "omp"; empty: none.
std::string default_of(const Option::Target& target) {
  return std::visit(
      [](auto* value) -> std::string {
        using T = Pointed<decltype(value)>;
        std::ostringstream text;
        if constexpr (std::is_same_v<T, std::optional<double>>) {
          if (*value)
            text << **value;
        } else if constexpr (!std::is_same_v<T, bool> && !std::is_same_v<T, std::vector<std::string>>) {
          text << *value;
        }
        return text.str();
      },
      target);
}

std::string shown(double x, bool whole) {
  std::ostringstream text;
  if (whole)
    text << static_cast<int64_t>(x);
  else
    text << x;
  return text.str();
}

std::string names_of(const Option& o) {
  return o.argument ? o.name : (o.letter.empty() ? "" : "-" + o.letter + ",") + "--" + o.name;
}

CLI::Option* add_to(CLI::App& app, Option& o) {
  return std::visit(
      [&](auto* value) -> CLI::Option* {
        if constexpr (std::is_same_v<Pointed<decltype(value)>, bool>)
          return app.add_flag(names_of(o), *value, o.meaning);
        else
          return app.add_option(names_of(o), *value, o.meaning);
      },
      o.target);
}

void describe_to(CLI::Option& to, const Option& o) {
  if (!o.value_name.empty())
    to.type_name(o.value_name);
  if (o.above_zero)
    to.check(CLI::PositiveNumber);
  if (o.limited && o.whole_number())
    to.check(CLI::Range(static_cast<int>(o.least), static_cast<int>(o.most)));
  else if (o.limited)
    to.check(CLI::Range(o.least, o.most));
  if (!o.words.empty())
    to.check(CLI::IsMember(o.words));
  if (o.must_be_given)
    to.required();
  if (o.several() && !o.argument && !o.at_once) // an option takes one value each time
    to.allow_extra_args(false);
}

/// What is wrong with a value that CLI11 may let through ("nan" is in every range, "0x10" is 16), or empty.
std::string wrong_value(const Table& table) {
  for (const Option& o : table.options) {
    for (const std::string& text : o.given)
      if (text.empty() && o.value_name == "FILE")
        return o.shown_name() + ": found '', expected a file";
    if (!o.number())
      continue;
    for (const std::string& text : o.given) {
      double x = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
      if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(x))
        return o.shown_name() + ": found '" + text + "', expected a finite decimal number";
    }
  }
  return {};
}

/// Of an option that says nothing without another one: "--json: found without --plan, expected both"; empty: there
/// is none.
std::string alone(const Table& table) {
  const auto given = [&](const std::string& name) { return table.is_given(name); };
  for (const Option& o : table.options)
    if (!o.given.empty() && !o.needed.empty() && std::none_of(o.needed.begin(), o.needed.end(), given))
      return "--" + o.name + ": found without --" + o.needed[0] + ", expected both";
  return {};
}

/// Insertions, deletions, replacements and swaps of neighbours that make b of a.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i)
    for (size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// Of the four programs of the chain, options that a user may give to a wrong one.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> others = {{
    {"pdb2hier", " model assembly levels domains rule resolution select hydrogens waters hetatm altloc radii "},
    {"hier2density", " spacing grid margin probe decay isovalue band tolerance search atoms tile "},
    {"density2tet", " region box adapt elements size regions cavities drop-below "},
    {"tetsmooth", " density effort coarsen iterations parts min-dihedral max-dihedral "},
}};

/// Of the first argument that looks like an option and is none: "--spacin: no such option, did you mean
/// --spacing?"; empty: there is none.
std::string unknown_option(const Table& table, int argc, char** argv) {
  for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) {
    const std::string arg = argv[i], name = arg.substr(0, arg.find('='));
    const auto same = [&](const Option& o) {
      return !o.argument && (name == "--" + o.name || (!o.letter.empty() && name.rfind("-" + o.letter, 0) == 0));
    };
    const bool value =
        i > 1 && std::any_of(table.options.begin(), table.options.end(), [&](const Option& o) {
          return !o.argument && !o.flag() &&
                 (argv[i - 1] == "--" + o.name || (!o.letter.empty() && argv[i - 1] == "-" + o.letter));
        });
    if (name.rfind("-", 0) != 0 || name == "-" || value ||
        std::any_of(table.options.begin(), table.options.end(), same))
      continue;
    const Option* near = nullptr;
    size_t least = name.size() > 6 ? 4 : 3; // "--" counts for nothing
    for (const Option& o : table.options)
      if (const size_t d = o.argument ? least : edit_distance(name, "--" + o.name); d < least) {
        least = d;
        near = &o;
      }
    if (name == "--chain" || name == "--chains")
      for (const Option& o : table.options)
        near = o.name == "select" ? &o : near;
    for (const Option& o : table.options) // a beginning of one
      if (!near && !o.argument && name.size() > 3 && ("--" + o.name).rfind(name, 0) == 0)
        near = &o;
    for (const auto& [program, options] : others)
      if (name.rfind("--", 0) == 0 && options.find(' ' + name.substr(2) + ' ') != options.npos)
        return name + ": no such option, it is " + std::string(program) + "'s";
    return name + ": no such option" + (near ? ", did you mean --" + near->name + "?" : "");
  }
  return {};
}

/// Of arguments beyond those that the program takes: "b.vdb: one argument too many, expected input".
std::string too_many(const Table& table, const std::vector<std::string>& beyond) {
  std::string takes;
  for (const Option& o : table.options)
    if (o.argument)
      takes += (takes.empty() ? "" : " and ") + o.name;
  return beyond.front() + ": one argument too many, expected " + (takes.empty() ? "options alone" : takes) +
         (table.page.several.empty() ? "" : "; " + table.page.several);
}

/// What is wrong with the command line: of a number outside its range, the range as the help shows it.
std::string plain_error(const Table& table, const CLI::ParseError& e) {
  const std::string text = e.what();
  if (!dynamic_cast<const CLI::ValidationError*>(&e) && !dynamic_cast<const CLI::ConversionError*>(&e))
    return text;
  if (const std::string wrong = wrong_value(table); !wrong.empty())
    return wrong;
  for (const Option& o : table.options) {
    const std::string range = o.shown_range(), name = o.shown_name();
    if (o.number() && !range.empty() && !o.given.empty() && text.rfind(name + ": ", 0) == 0)
      return name + ": found '" + o.given.back() + "', expected " + range;
  }
  return text;
}

int print(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout)
    fail(Status::not_written, "<stdout>: cannot write");
  return static_cast<int>(Status::good);
}

/// Empty: no argument before "--" asks for a page.
std::string page_asked_for(const Table& table, int argc, char** argv) {
  for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) {
    const std::string arg = argv[i];
    if (arg == "--help=man")
      return man_page(table);
    if (arg == "--help=markdown")
      return markdown_page(table);
    if (arg == "--help=bash")
      return bash_completion(table);
  }
  return {};
}

} // namespace

bool Option::whole_number() const {
  return std::holds_alternative<int*>(target) || std::holds_alternative<int64_t*>(target);
}

bool Option::number() const {
  return whole_number() || std::holds_alternative<double*>(target) ||
         std::holds_alternative<std::optional<double>*>(target);
}

std::string Option::shown_unit() const {
  return !value_name.empty() ? value_name : whole_number() ? "N" : number() ? "X" : "TEXT";
}

std::string Option::shown_range() const {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  if (above_zero)
    return "> 0";
  if (!limited)
    return text;
  constexpr double no_limit = 1e300;
  const std::string lower = shown(least, whole_number());
  return most >= no_limit ? ">= " + lower : lower + ".." + shown(most, whole_number());
}

Table::Table(const std::string& program_, const std::string& purpose_) : program(program_), purpose(purpose_) {
  add("-h,--help", asked_, "show this help and stop").not_reported();
  add("--version", asked_, "show the version and stop").not_reported();
}

Option& Table::add_row(const std::string& names, Option::Target target, const std::string& meaning) {
  Option& o = options.emplace_back();
  o.argument = names[0] != '-';
  const size_t dashes = names.find("--");
  if (names.size() > 2 && names[0] == '-' && names[1] != '-')
    o.letter = names.substr(1, 1);
  o.name = o.argument ? names : names.substr(dashes + 2);
  o.meaning = meaning;
  o.group = heading_;
  o.target = target;
  o.default_text = default_of(target);
  return o;
}

bool Table::is_given(const std::string& name) const {
  return std::any_of(options.begin(), options.end(),
                     [&](const Option& o) { return o.name == name && !o.given.empty(); });
}

std::string Table::flag_of(const std::string& quantity) const {
  for (const auto& [name, flag] : flags_)
    if (name == quantity)
      return flag;
  for (const Option& o : options)
    if (!o.argument && o.name == quantity)
      return "--" + o.name;
  return {};
}

int parse(Table& table, int argc, char** argv) {
  if (const std::string page = page_asked_for(table, argc, argv); !page.empty())
    return print(page);
  CLI::App app(table.purpose, table.program);
  app.set_help_flag("-h,--help", "");
  app.set_version_flag("--version", creator(table.program), "");
  std::vector<std::pair<Option*, CLI::Option*>> rows;
  for (Option& o : table.options) {
    if (o.name == "help" || o.name == "version")
      continue; // CLI11's own
    rows.emplace_back(&o, add_to(app, o));
    describe_to(*rows.back().second, o);
  }
  const auto note_given = [&] {
    for (const auto& [option, row] : rows)
      option->given = row->results();
  };
  const auto refuse = [&](const std::string& what) {
    std::cerr << table.program << ": " << one_line(what) << " (see " << table.program << " --help)\n";
    return static_cast<int>(Status::usage);
  };
  try {
    for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) // CLI11 would take the next argument instead
      if (const std::string arg = argv[i]; arg.rfind("--", 0) == 0 && arg.find('=') + 1 == arg.size())
        throw CLI::ArgumentMismatch(arg.substr(0, arg.size() - 1) + ": found '', expected a value");
    app.parse(argc, argv);
    note_given();
    std::string wrong = wrong_value(table);
    if (wrong.empty())
      wrong = alone(table);
    return wrong.empty() ? -1 : refuse(wrong);
  } catch (const CLI::CallForHelp&) {
    return print(help(table));
  } catch (const CLI::CallForVersion&) {
    return print(app.version() + '\n');
  } catch (const CLI::ParseError& e) {
    note_given();
    const bool extras = dynamic_cast<const CLI::ExtrasError*>(&e),
               missing = dynamic_cast<const CLI::RequiredError*>(&e);
    const std::string unknown = extras || missing ? unknown_option(table, argc, argv) : "";
    if (!extras && unknown.empty())
      return refuse(plain_error(table, e) +
                    (missing && !table.page.several.empty() ? "; " + table.page.several : ""));
    return refuse(unknown.empty() ? too_many(table, app.remaining()) : unknown);
  }
}

std::vector<double> numbers(const std::string& option, const std::string& text, size_t count) {
  const auto refuse = [&] {
    fail(Status::usage, option + ": found '" + text + "', expected " + std::to_string(count) +
                            (count == 1 ? " finite number" : " finite numbers separated by commas"));
  };
  std::vector<double> v;
  const char *p = text.data(), *end = p + text.size();
  while (v.size() < count) {
    double x = 0;
    const auto [next, error] = std::from_chars(p, end, x);
    if (error != std::errc{} || !std::isfinite(x))
      refuse();
    v.push_back(x);
    p = next;
    if (v.size() < count && (p == end || *p++ != ','))
      refuse();
  }
  if (p != end)
    refuse();
  return v;
}

} // namespace molmesh::cli
