// options.hpp — the table of a program's options: one table feeds the parser, --help, the pages and the run report.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace molmesh::cli {

/// One option, or one argument without a name. Made by Table::add(), then described by what follows there:
/// table.add("-t,--threads", o.threads, "threads of the host").within(0, 1024);
struct Option {
  using Target =
      std::variant<bool*, int*, int64_t*, double*, std::optional<double>*, std::string*, std::vector<std::string>*>;

  std::string letter, name; ///< "t" or none; "threads"
  bool argument = false;    ///< without a name on the command line
  std::string meaning, group;
  Target target; ///< bool: a flag; vector: may be given several times
  std::string value_name;
  double least = 0, most = 0; ///< numbers: limits, included
  bool limited = false, above_zero = false;
  std::vector<std::string> words; ///< what it may be; empty: anything
  std::string default_text;
  bool must_be_given = false, in_report = true;
  std::vector<std::string> needed; ///< names of options; empty: none
  bool at_once = false;            ///< several(): also several values after one name
  std::vector<std::string> given;  ///< on the command line, after parse()

  /// Unit of a number (Å), or what stands for the value in the help (FILE: a file's name, which may not be empty).
  Option& unit(const std::string& text) { return value_name = text, *this; }
  Option& within(double lower, double upper) { return least = lower, most = upper, limited = true, *this; }
  Option& positive() { return above_zero = true, *this; }
  Option& one_of(std::vector<std::string> w) { return words = std::move(w), *this; }
  Option& required() { return must_be_given = true, *this; }
  /// It says something only where one of these is given, too.
  Option& needs(std::vector<std::string> names) { return needed = std::move(names), *this; }
  /// The default as the help shows it, where the target does not hold it.
  Option& shown_default(const std::string& text) { return default_text = text, *this; }
  Option& several_at_once() { return at_once = true, *this; }
  /// The run report has it elsewhere, or not at all.
  Option& not_reported() { return in_report = false, *this; }

  bool flag() const { return std::holds_alternative<bool*>(target); }
  bool several() const { return std::holds_alternative<std::vector<std::string>*>(target); }
  bool number() const;
  bool whole_number() const;
  /// "--threads", or an argument's bare name.
  std::string shown_name() const { return argument ? name : "--" + name; }
  /// "Å", "FILE"; N and X for numbers without a unit.
  std::string shown_unit() const;
  /// "0..1024", "> 0", "seq, omp, cuda"; empty: any.
  std::string shown_range() const;
};

/// What a program's page says besides its options.
struct Page {
  struct Example {
    std::string command, meaning;
  };
  struct File {
    std::string name, meaning;
  };
  std::string about; ///< a paragraph
  std::vector<Example> examples;
  std::vector<File> files;
  std::vector<std::string> see_also; ///< programs
  std::string several;               ///< how to name more than one input, where a user may try
};

class Table {
public:
  /// Holds --help and --version.
  Table(const std::string& program_, const std::string& purpose_);
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// names: "-o,--output", "--mode", or "input" for an argument. The target holds the default and lives as long as
  /// the table.
  template <class T>
  Option& add(const std::string& names, T& target, const std::string& meaning) {
    return add_row(names, &target, meaning);
  }
  /// The heading of the options that are added next.
  void group(const std::string& heading) { heading_ = heading; }
  /// How the program names a quantity that an Error names, where no option of its own has that name.
  void quantity(const std::string& name, const std::string& flag) { flags_.push_back({name, flag}); }
  /// After parse(); false where there is no such option.
  bool is_given(const std::string& name) const;
  /// The flag of a quantity, empty: none.
  std::string flag_of(const std::string& quantity) const;

  std::string program, purpose;
  std::deque<Option> options;
  Page page;

private:
  Option& add_row(const std::string& names, Option::Target target, const std::string& meaning);
  std::string heading_;
  bool asked_ = false; ///< what --help and --version would set; parse() answers them itself
  std::vector<std::pair<std::string, std::string>> flags_;
};

/// Sets the targets. Returns the exit status when the run stops here (help, version, usage), else -1.
/// Throws Error(not_written) when what it prints cannot be written.
int parse(Table& table, int argc, char** argv);

/// Numbers with a fixed count separated by commas ("0.9,1.1"), strictly parsed. Throws Error(usage).
std::vector<double> numbers(const std::string& option, const std::string& text, size_t count);

} // namespace molmesh::cli
