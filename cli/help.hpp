// help.hpp — the option table as people read it: unit, range and live default of every option.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace molmesh::cli {

/// The whole help text: purpose, usage, a line or more for each option.
std::string help(const CLI::App& app);

/// Throws CLI::ValidationError for a value of a numeric option that is no finite decimal number (CLI11 lets "nan"
/// through every range, and reads "0x10" as 16) and for the name of a file that is empty.
void check_values(const CLI::App& app);

/// What is wrong with the command line: of a number outside its range, the range as the help shows it.
std::string plain_error(const CLI::App& app, const CLI::ParseError& e);

} // namespace molmesh::cli
