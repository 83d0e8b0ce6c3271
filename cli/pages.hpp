// pages.hpp — a program's table of options as people and shells read it.
#pragma once
#include "cli/options.hpp"
#include <string>

namespace molmesh::cli {

/// For a terminal: purpose, usage, every option with unit, range and default, examples, exit statuses.
std::string help(const Table& table);
/// In the language of man(7), ASCII alone.
std::string man_page(const Table& table);
/// docs/programs/NAME.md.
std::string markdown_page(const Table& table);
/// Completes options, words and files in bash.
std::string bash_completion(const Table& table);

/// Groups in the order in which they were added, those of every program last; each with its options, the
/// arguments without a name left out.
struct OptionGroup {
  std::string heading;
  std::vector<const Option*> options;
};
std::vector<OptionGroup> grouped(const Table& table);
/// "range; repeatable; required; default X", empty: nothing to say.
std::string notes_of(const Option& o);

struct ExitStatus {
  int status;
  const char* meaning;
};
inline constexpr ExitStatus exit_statuses[] = {
    {0, "good"},
    {1, "the run failed"},
    {2, "usage"},
    {3, "input unreadable or invalid"},
    {4, "output not written"},
    {5, "valid and written, but below the quality asked for"},
    {6, "the mode is not available here"},
};

} // namespace molmesh::cli
