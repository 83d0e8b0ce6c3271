// run.cpp — common options, exit statuses, the run report.
#include "cli/run.hpp"
#include "cli/file.hpp"
#include "par/par.hpp"
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <new>
#include <sys/resource.h>

#ifndef MOLMESH_VERSION
#define MOLMESH_VERSION "0.0.0"
#endif

namespace molmesh::cli {

int Common::resolved_threads() const {
  if (mode == "cuda") fail(Status::mode_unavailable, "--mode cuda: not available in this build, use seq or omp");
  if (mode == "seq") return 1;
  return threads > 0 ? threads : par::default_threads();
}

void Run::phase(const std::string& name) {
  end_phase();
  phases.push_back({name, 0});
  started_ = std::chrono::steady_clock::now();
  open_ = true;
}

void Run::end_phase() {
  if (!open_) return;
  phases.back().seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  open_ = false;
}

void Run::note(const std::string& line) const {
  if (!quiet) std::cerr << tool << ": " << line << '\n';
}

std::string creator(const std::string& tool) {
  return tool + " " MOLMESH_VERSION;
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
    if (error != std::errc{} || !std::isfinite(x)) refuse();
    v.push_back(x);
    p = next;
    if (v.size() < count && (p == end || *p++ != ',')) refuse();
  }
  if (p != end) refuse();
  return v;
}

namespace detail {
namespace {

nlohmann::ordered_json options_json(const CLI::App& app) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_lnames().empty() || !option->get_configurable()) continue;
    const std::string name = option->get_lnames().front();
    if (option->get_expected_min() == 0)
      j[name] = option->count() > 0;
    else if (option->get_items_expected_max() > 1)
      j[name] = option->results();
    else
      j[name] = option->count() > 0 ? option->results().back() : option->get_default_str();
  }
  return j;
}

} // namespace

void describe_common(CLI::App& app, Common& o) {
  app.option_defaults()->always_capture_default();
  app.set_help_flag("-h,--help", "show this help and stop")->configurable(false);
  app.set_version_flag("--version", creator(app.get_name()))->configurable(false);
  app.add_option("input,--input", o.input, "input file; - is standard input")->configurable(false);
  app.add_option("-o,--output", o.output, "output file; - is standard output")->configurable(false);
  app.add_option("--mode", o.mode, "seq: one thread, omp: many cores, cuda: one GPU")
      ->check(CLI::IsMember({"seq", "omp", "cuda"}));
  app.add_option("-t,--threads", o.threads, "threads for --mode omp, 0: all [0..1024]")->check(CLI::Range(0, 1024));
  app.add_option("--report", o.report, "write the run report (JSON) to this file")->configurable(false);
  app.add_flag("-q,--quiet", o.quiet, "errors only on standard error")->configurable(false);
  app.add_flag("-v,--verbose", o.verbose, "phases and their seconds on standard error")->configurable(false);
}

int parse(CLI::App& app, int argc, char** argv, bool& stop) {
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& e) {
    stop = true;
    app.exit(e);
    std::cout.flush();
    return std::cout ? static_cast<int>(Status::good) : static_cast<int>(Status::not_written);
  } catch (const CLI::ParseError& e) {
    stop = true;
    std::cerr << app.get_name() << ": " << e.what() << " (see " << app.get_name() << " --help)\n";
    return static_cast<int>(Status::usage);
  }
}

int finish(const CLI::App& app, const Common& o, Run& run, Status status) {
  run.end_phase();
  if (run.verbose)
    for (const Run::Phase& p : run.phases) std::fprintf(stderr, "%s: %-16s %8.3f s\n", run.tool.c_str(), p.name.c_str(), p.seconds);
  if (!o.report.empty()) {
    nlohmann::ordered_json j;
    j["tool"] = run.tool;
    j["version"] = MOLMESH_VERSION;
    j["mode"] = o.mode;
    j["threads"] = o.resolved_threads();
    j["input"] = o.input;
    j["output"] = o.output;
    j["options"] = options_json(app);
    j["phases"] = nlohmann::ordered_json::array();
    for (const Run::Phase& p : run.phases) j["phases"].push_back({{"name", p.name}, {"seconds", p.seconds}});
    j["counts"] = run.counts;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    j["peak_rss_bytes"] = int64_t{usage.ru_maxrss} * 1024;
    OutputFile file(o.report);
    file.stream() << j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    file.commit();
  }
  return static_cast<int>(status);
}

int failed(const std::string& tool, const std::exception& e) {
  const auto* error = dynamic_cast<const Error*>(&e);
  const bool memory = dynamic_cast<const std::bad_alloc*>(&e) != nullptr;
  std::cerr << tool << ": " << (memory ? "not enough memory" : e.what()) << '\n';
  return static_cast<int>(error ? error->status : Status::failed);
}

} // namespace detail
} // namespace molmesh::cli
