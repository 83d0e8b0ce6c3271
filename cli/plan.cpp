// plan.cpp — limits of memory from options and batch systems; plans as text and JSON.
#include "cli/plan.hpp"
#include "base/error.hpp"
#include "cli/file.hpp"
#include "cli/report.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

namespace molmesh::cli {
namespace {

constexpr int64_t none = std::numeric_limits<int64_t>::max();

int64_t number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  int64_t bytes = 0;
  return in >> bytes && bytes < int64_t{1} << 60 ? bytes : none; // "max", or version 1's largest number
}

std::string text_of(const std::string& name, const Value& value);

void add_lines(const Value::Fields& fields, const std::string& before, std::string& text) {
  for (const auto& [name, value] : fields) {
    if (const auto* inner = std::get_if<Value::Fields>(&value.get())) {
      add_lines(*inner, before + "  ", text += before + name + '\n');
      continue;
    }
    std::string shown = name.substr(0, name.rfind("_bytes"));
    std::replace(shown.begin(), shown.end(), '_', ' ');
    shown.resize(std::max<size_t>(shown.size() + 1, 24 - std::min<size_t>(before.size(), 20)), ' ');
    text += before + shown + text_of(name, value) + '\n';
  }
}

std::string text_of(const std::string& name, const Value& value) {
  char text[64];
  if (const auto* n = std::get_if<int64_t>(&value.get()))
    return name.ends_with("_bytes") ? size_text(*n) : std::to_string(*n);
  if (const auto* x = std::get_if<double>(&value.get())) {
    std::snprintf(text, sizeof text, "%.3g", *x);
    return text;
  }
  if (const auto* word = std::get_if<std::string>(&value.get()))
    return *word;
  std::string all;
  if (const auto* list = std::get_if<Value::List>(&value.get()))
    for (const Value& v : *list)
      all += (all.empty() ? "" : " ") + text_of(name, v);
  return all;
}

} // namespace

int64_t bytes_of(const std::string& text) {
  const char* const end = text.data() + text.size();
  double number = 0;
  const auto [stopped, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  const std::string unit(stopped, end);
  const size_t power = unit.empty() ? 0 : std::string("KMGT").find(unit) + 1;
  if (error != std::errc() || unit.size() > 1 || (!unit.empty() && power == 0) || !(number > 0) ||
      !(number * std::pow(1024, power) < 9e18))
    fail(Status::usage, "--max-mem: found '" + text + "', expected auto, none or a size such as 500M or 2G");
  return static_cast<int64_t>(number * std::pow(1024, power));
}

std::string size_text(int64_t bytes) {
  const char* const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  double x = static_cast<double>(bytes);
  size_t u = 0;
  for (; x >= 999.5 && u + 1 < std::size(units); ++u)
    x /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %s", x, units[u]);
  return text;
}

std::string length_text(double angstroms) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g Å", angstroms);
  return text;
}

int64_t granted_memory(const char* slurm_mem_per_node, const SystemFiles& system) {
  int64_t least = none;
  for_each_group(system, "memory", [&](const std::filesystem::path& folder, int version) {
    least = std::min(least, number_in(folder / (version == 2 ? "memory.max" : "memory.limit_in_bytes")));
  });
  if (slurm_mem_per_node) {
    const char* const end = slurm_mem_per_node + std::strlen(slurm_mem_per_node);
    int64_t mebibytes = 0;
    const auto [stopped, error] = std::from_chars(slurm_mem_per_node, end, mebibytes);
    if (error == std::errc() && stopped == end && mebibytes > 0 &&
        mebibytes < int64_t{1} << 40) // 0: all of the node's
      least = std::min(least, mebibytes << 20);
  }
  return least == none ? -1 : least;
}

int64_t machine_memory(const SystemFiles& system) {
  std::ifstream in(system.proc / "meminfo");
  int64_t sum = 0, kibibytes = 0;
  std::string name, rest;
  for (; in >> name >> kibibytes; std::getline(in, rest))
    if ((name == "MemTotal:" || name == "SwapTotal:") && kibibytes > 0 && kibibytes < int64_t{1} << 50)
      sum += kibibytes << 10;
  return sum > 0 ? sum : -1;
}

int64_t PlanOptions::memory_limit() const {
  if (max_mem == "none")
    return -1;
  if (max_mem != "auto")
    return bytes_of(max_mem);
  const int64_t granted = granted_memory(std::getenv("SLURM_MEM_PER_NODE"));
  return granted >= 0 || !machine_limits ? granted : machine_memory();
}

Speeds speeds_of(const std::string& text, const std::string& where) {
  const bool one_for_all = text.find(',') == std::string::npos;
  const std::vector<double> speed = numbers(where, text, one_for_all ? 1 : 3);
  if (!std::all_of(speed.begin(), speed.end(), [](double x) { return x > 0; }))
    fail(Status::usage, where + ": found '" + text + "', expected speeds > 0");
  return one_for_all ? Speeds{speed[0], speed[0], speed[0]} : Speeds{speed[0], speed[1], speed[2]};
}

Speeds PlanOptions::speeds() const {
  if (speed != "auto")
    return speeds_of(speed, "--speed");
  const char* const measured = std::getenv("MOLMESH_SPEED");
  return measured && *measured ? speeds_of(measured, "MOLMESH_SPEED") : Speeds{};
}

void PlanOptions::check() const {
  memory_limit();
  if (plan)
    speeds();
}

void add_plan_options(Table& table, PlanOptions& o) {
  table.group("plan");
  table.add("--plan", o.plan, "tell what the run will take, and do not run");
  table.add("--json", o.json, "the plan as one JSON object (formats/report/REPORTv1.md)").needs({"plan"});
  table.add("--speed", o.speed, "speed of a core, for seconds: 2; by stage: 1,2,0.5").unit("SPEED").needs({"plan"});
  table
      .add("--max-mem", o.max_mem,
           o.machine_limits ? "memory at most: 2G, none; auto: granted, or all"
                            : "memory at most: 2G, none; auto: what is granted")
      .unit("SIZE");
}

void write_plan(const Common& o, const PlanOptions& p, const Run& run, const Value& plan) {
  OutputFile out(o.output);
  const auto& fields = std::get<Value::Fields>(plan.get());
  if (p.json) {
    Value all{{"plan", 1}, {"tool", run.tool}, {"version", version()}};
    for (const auto& [name, value] : fields)
      all[name] = value;
    out.stream() << json_text(all);
  } else {
    std::string text;
    add_lines(fields, "", text);
    out.stream() << text;
  }
  out.commit();
}

void require_memory(const PlanOptions& p, int64_t needed, const std::string& what, const std::string& instead) {
  const int64_t limit = p.memory_limit();
  if (limit < 0 || needed <= limit)
    return;
  const bool granted = granted_memory(std::getenv("SLURM_MEM_PER_NODE")) >= 0;
  fail(Status::failed, what + " takes about " + size_text(needed) + " of memory, expected at most " +
                           size_text(limit) +
                           (p.max_mem != "auto" ? " (--max-mem)"
                            : granted           ? " (the batch system's limit; --max-mem)"
                                                : " (the machine's memory and swap; --max-mem)") +
                           ": " + instead);
}

} // namespace molmesh::cli
