// report.hpp — the run report: one JSON object (formats/report/REPORTv1.md).
#pragma once
#include "cli/run.hpp"
#include <cstdint>
#include <memory>
#include <string>

namespace molmesh::cli {

/// Opened before the run, so that a report that cannot be written stops it before any work. Null without --report.
/// Throws Error(usage) where an output or the report would be written over another file of the run.
std::unique_ptr<OutputFile> open_report(const Table& table, const Common& o);

/// Indented, with a newline at its end.
std::string json_text(const Value& value);

std::string report_text(const Table& table, const Common& o, const Run& run, int64_t peak_rss_bytes);

} // namespace molmesh::cli
