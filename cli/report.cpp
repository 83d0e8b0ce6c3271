// report.cpp — options in force, phases, counts; and what a run may not write over.
#include "cli/report.hpp"
#include "base/error.hpp"
#include "base/small_letters.hpp"
#include "cli/file_kind.hpp"
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <unistd.h>

namespace molmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Value& value) {
  return std::visit(
      [](const auto& held) -> Json {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, Value::List>) {
          Json list = Json::array();
          for (const Value& v : held)
            list.push_back(json_of(v));
          return list;
        } else if constexpr (std::is_same_v<T, Value::Fields>) {
          Json fields = Json::object();
          for (const auto& [name, v] : held)
            fields[name] = json_of(v);
          return fields;
        } else {
          return held;
        }
      },
      value.get());
}

/// A number when the text is one, else the text.
Json number_or_text(const std::string& text) {
  const auto number = Json::parse(text, nullptr, false);
  return number.is_number() ? number : Json(text);
}

/// The options in force, given or by default; files and verbosity stand elsewhere or do not matter.
Json options_in_force(const Table& table) {
  Json j = Json::object();
  for (const Option& o : table.options) {
    if (!o.in_report || (o.argument && o.given.empty()))
      continue;
    if (o.argument)
      j[o.name] = o.given.back();
    else if (o.flag())
      j[o.name] = !o.given.empty();
    else if (o.several())
      j[o.name] = o.given;
    else
      j[o.name] = number_or_text(o.given.empty() ? o.default_text : o.given.back());
  }
  return j;
}

/// No output is a file that is read, from standard input too, and the report is neither.
void require_distinct_files(const Table& table, const Common& o) {
  std::vector<std::string> inputs;
  for (const Option& option : table.options)
    if (option.name != "output" && option.name != "report" && option.name != "input" &&
        (option.argument || option.value_name == "FILE"))
      inputs.insert(inputs.end(), option.given.begin(), option.given.end());
  if (o.keep_input)
    inputs.push_back(o.input);
  std::replace(inputs.begin(), inputs.end(), std::string("-"), std::string("/dev/stdin"));
  std::erase_if(inputs, [](const std::string& input) { // a keyword, or what cannot be opened
    std::error_code none;
    return !std::filesystem::exists(input, none);
  });
  for (const std::string& output : o.outputs())
    for (const std::string& input : inputs)
      if (same_file(output, input))
        fail(Status::usage, "-o: found " + output + ", which is an input, expected another file");
  if (o.report.empty())
    return;
  inputs.push_back(o.input == "-" ? "/dev/stdin" : o.input);
  for (const std::string& input : inputs)
    if (same_file(o.report, input))
      fail(Status::usage, "--report: found " + o.report + ", expected another file than the input");
  for (const std::string& output : o.outputs())
    if (o.report == output || same_file(o.report, output) ||
        (standard_stream(o.report) == STDOUT_FILENO && standard_stream(output) == STDOUT_FILENO))
      fail(Status::usage, "--report: found " + o.report + ", expected another file than the output");
}

/// No output has the name of another kind of file than the program's page says it writes. Plans may have any.
void require_own_ending(const Table& table, const Common& o) {
  const Kind kind = kind_by_name(o.output);
  if (kind == Kind::unknown || o.chooses_format || table.is_given("plan"))
    return;
  const std::string name = small_letters(o.output);
  std::string own;
  for (const Page::File& f : table.page.files) {
    if (f.meaning.find("written") == std::string::npos)
      continue;
    if (name.ends_with(f.name))
      return;
    own += (own.empty() ? "" : " or ") + f.name;
  }
  const char* way = own == ".vtu" && kind == Kind::mesh    ? ": tetconvert makes other meshes of it"
                    : own == ".vtu" && kind == Kind::other ? ": tetreport makes pages and pictures of it"
                    : own == ".vdb" && kind == Kind::map   ? ": density2map makes maps of it"
                                                           : "";
  if (!own.empty())
    fail(Status::usage, "-o: found " + o.output + ", expected a name that ends in " + own + way);
}

} // namespace

std::unique_ptr<OutputFile> open_report(const Table& table, const Common& o) {
  require_distinct_files(table, o);
  require_own_ending(table, o);
  return o.report.empty() ? nullptr : std::make_unique<OutputFile>(o.report);
}

std::string json_text(const Value& value) {
  return json_of(value).dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string report_text(const Table& table, const Common& o, const Run& run, int64_t peak_rss_bytes) {
  Json j;
  j["tool"] = run.tool;
  j["version"] = version();
  j["mode"] = o.mode;
  j["threads"] = o.resolved_threads();
  j["input"] = o.input;
  j["output"] = o.output;
  j["options"] = options_in_force(table);
  j["phases"] = Json::array();
  for (const Run::Phase& p : run.phases)
    j["phases"].push_back({{"name", p.name}, {"seconds", p.seconds}});
  j["counts"] = json_of(run.counts);
  j["peak_rss_bytes"] = peak_rss_bytes;
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

} // namespace molmesh::cli
