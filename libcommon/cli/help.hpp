// help.hpp — the option table as people read it: unit, range and live default of every option.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace molmesh::cli {

/// The whole help text: purpose, usage, a line or more for each option.
std::string help(const CLI::App& app);

/// Throws CLI::ValidationError for a value of a numeric option that is no finite decimal number: CLI11 lets "nan"
/// through every range, and reads "0x10" as 16.
void check_numbers(const CLI::App& app);

} // namespace molmesh::cli
